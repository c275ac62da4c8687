// Pointing at a figure reads values, dragging enlarges a part of it.
const loadWords = JSON.parse(document.getElementById("load-words").textContent);

// panels over the same x axis are enlarged together
const showTogether = (panels, panel, view) => {
  panel.show(view);
  for (const other of panels) {
    const isLinked = other !== panel && other.home.xFrom === panel.home.xFrom && other.home.xTo === panel.home.xTo;
    if (isLinked) other.show({ ...other.view, xFrom: panel.view.xFrom, xTo: panel.view.xTo });
  }
};

const prepare = (svg) => {
  const panels = [...svg.querySelectorAll("g.panel")].map((group) => new Panel(svg, group));
  const titled = panels.map((panel) => panel.xTitle).filter(Boolean);
  for (const panel of panels) panel.sharedXTitle = titled[0];
  // the title would cover the reading
  const title = svg.querySelector("title");
  if (title) {
    svg.setAttribute("aria-label", title.textContent);
    svg.removeAttribute("aria-labelledby");
    title.remove();
  }
  if (!panels.some((panel) => panel.isZoomable)) return panels;
  svg.setAttribute("tabindex", "0");
  const place = (event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  const ring = make("circle", { class: "ring hidden", r: 20 }, svg);
  let [drag, active] = [null, panels.find((panel) => panel.isZoomable)];
  const hide = () => {
    readout.hidden = true;
    ring.classList.add("hidden");
  };
  // shows what stands under the pointer: the nearest point with words, or values of the axes
  const read = (event) => {
    const at = place(event);
    const panel = drag ? drag.panel : panels.find((panel) => panel.holds(at));
    if (!panel || !panel.isZoomable) {
      hide();
      return null;
    }
    active = panel;
    const nearest = drag ? null : panel.nearest(at);
    ring.classList.toggle("hidden", !nearest);
    if (nearest) for (const [key, value] of [["cx", nearest.place.x], ["cy", nearest.place.y]]) ring.setAttribute(key, value);
    readout.textContent = nearest ? loadWords[nearest.datum.dataset.key] : panel.words(at);
    readout.hidden = false;
    readout.style.left = `${clamp(event.clientX + 16, 0, innerWidth - readout.offsetWidth - 8)}px`;
    readout.style.top = `${clamp(event.clientY + 16, 0, innerHeight - readout.offsetHeight - 8)}px`;
    return at;
  };
  const reset = () => panels.forEach((panel) => panel.show(panel.start));

  svg.addEventListener("pointermove", (event) => {
    const at = read(event);
    if (!at || !drag) return;
    const { panel } = drag;
    const box = {
      x: clamp(Math.min(at.x, drag.from.x), panel.left, panel.right), y: clamp(Math.min(at.y, drag.from.y), panel.top, panel.bottom),
      right: clamp(Math.max(at.x, drag.from.x), panel.left, panel.right), bottom: clamp(Math.max(at.y, drag.from.y), panel.top, panel.bottom),
    };
    drag.box = box;
    drag.lasso ??= make("rect", { class: "lasso" }, svg);
    for (const [key, value] of Object.entries({ x: box.x, y: box.y, width: box.right - box.x, height: box.bottom - box.y })) drag.lasso.setAttribute(key, value);
  });
  svg.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") hide(); });
  svg.addEventListener("pointercancel", () => {
    drag = null;
    hide();
  });
  // a drag marks a part of the figure, never text
  svg.addEventListener("mousedown", (event) => {
    event.preventDefault();
    svg.focus({ preventScroll: true });
  });
  svg.addEventListener("pointerdown", (event) => {
    const at = place(event);
    const panel = panels.find((panel) => panel.holds(at));
    if (event.pointerType === "touch") read(event);
    if (!panel || !panel.isZoomable || event.button !== 0 || event.pointerType === "touch") return;
    svg.setPointerCapture(event.pointerId);
    drag = { from: at, panel };
  });
  svg.addEventListener("pointerup", (event) => {
    if (!drag) return;
    const { panel, box, lasso, from } = drag;
    drag = null;
    if (lasso) lasso.remove();
    hide();
    if (box && box.right - box.x > 12 && box.bottom - box.y > 12) {
      const [low, high] = [{ x: box.x, y: box.bottom }, { x: box.right, y: box.y }];
      showTogether(panels, panel, { xFrom: panel.xOf(low), xTo: panel.xOf(high), yFrom: panel.yOf(low), yTo: panel.yOf(high) });
    } else if (svg.seek && panel.isTime) {
      svg.seek(panel.xOf(from));
    }
    event.preventDefault();
  });
  svg.addEventListener("dblclick", reset);
  svg.addEventListener("keydown", (event) => {
    // the arrows scroll a figure that is not enlarged
    if (active.isStart && event.key.startsWith("Arrow")) return;
    const { view } = active;
    const [width, height] = [view.xTo - view.xFrom, view.yTo - view.yFrom];
    const scaled = (share) => ({
      xFrom: view.xFrom + (width * (1 - share)) / 2, xTo: view.xTo - (width * (1 - share)) / 2,
      yFrom: view.yFrom + (height * (1 - share)) / 2, yTo: view.yTo - (height * (1 - share)) / 2,
    });
    const moved = (x, y) => ({ xFrom: view.xFrom + x * width, xTo: view.xTo + x * width, yFrom: view.yFrom + y * height, yTo: view.yTo + y * height });
    const views = {
      "+": () => scaled(0.5), "=": () => scaled(0.5), "-": () => scaled(2),
      ArrowLeft: () => moved(-0.25, 0), ArrowRight: () => moved(0.25, 0), ArrowUp: () => moved(0, 0.25), ArrowDown: () => moved(0, -0.25),
    };
    if (event.key === "Escape" || event.key === "0") reset();
    else if (views[event.key]) showTogether(panels, active, views[event.key]());
    else return;
    event.preventDefault();
  });
  return panels;
};

for (const svg of all("figure svg")) svg.panels = prepare(svg);
document.addEventListener("pointerdown", (event) => { if (!event.target.closest("figure svg")) readout.hidden = true; });
