(() => {
  "use strict";
  const SVG = "http://www.w3.org/2000/svg";
  const colours = JSON.parse(document.getElementById("level-colours").textContent);
  const levelOf = new Map(colours.map(([red, green, blue], level) => [(red << 16) | (green << 8) | blue, level]));
  const readout = document.querySelector(".readout");

  const make = (name, attributes, parent) => {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (parent) parent.append(element);
    return element;
  };
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // as many decimals as a thousandth of the range is worth
  const written = (value, range) => {
    const decimals = clamp(Math.ceil(-Math.log10(Math.abs(range) / 1000)), 0, 9);
    return value.toFixed(decimals).replace("-", "−");
  };
  // "time (s)" and 3.2 are "time 3.2 s"
  const named = (title, value, range) => {
    const parts = /^(.*) \((.*)\)$/.exec(title);
    return parts ? `${parts[1]} ${written(value, range)} ${parts[2]}` : `${title} ${written(value, range)}`.trim();
  };
  const roundTicks = (from, to, count) => {
    const raw = (to - from) / count;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((times) => times * power).find((step) => step >= raw);
    const ticks = [];
    for (let k = Math.ceil(from / step); k * step <= to; k += 1) ticks.push(k * step);
    return { ticks, step };
  };

  class Picture {
    constructor(image) {
      this.image = image;
      this.from = Number(image.dataset.xFrom);
      this.to = Number(image.dataset.xTo);
      this.low = Number(image.dataset.levelLowDb);
      this.high = Number(image.dataset.levelHighDb);
    }
    async open() {
      if (this.pixels || this.opening) return;
      this.opening = true;
      const image = new Image();
      image.src = this.image.getAttribute("href");
      await image.decode();
      const canvas = document.createElement("canvas");
      canvas.width = image.naturalWidth;
      canvas.height = image.naturalHeight;
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      this.pixels = context.getImageData(0, 0, canvas.width, canvas.height);
    }
    // the level under a place, x in the panel's unit, y as a share from the top
    level(x, share) {
      this.open();
      if (!this.pixels) return null;
      const { width, height, data } = this.pixels;
      const column = clamp(Math.floor(((x - this.from) / (this.to - this.from)) * width), 0, width - 1);
      const row = clamp(Math.floor(share * height), 0, height - 1);
      const at = 4 * (row * width + column);
      const level = levelOf.get((data[at] << 16) | (data[at + 1] << 8) | data[at + 2]);
      return level === undefined ? null : this.low + (level / (colours.length - 1)) * (this.high - this.low);
    }
  }

  class Panel {
    constructor(svg, group) {
      const data = group.dataset;
      this.svg = svg;
      this.ticks = group.querySelector(".ticks");
      for (const side of ["left", "top", "right", "bottom"]) this[side] = Number(data[side]);
      this.home = { xFrom: Number(data.xFrom), xTo: Number(data.xTo), yFrom: Number(data.yFrom), yTo: Number(data.yTo) };
      this.view = { ...this.home };
      this.xTitle = data.xTitle;
      this.yTitle = data.yTitle;
      this.rightTitle = data.rightTitle;
      this.rightUnit = Number(data.rightUnit);
      const layers = [...svg.querySelectorAll(`g[data-panel="${data.panel}"] > .zoomable`)];
      this.layers = layers;
      this.pictures = layers.flatMap((layer) => [...layer.querySelectorAll("image.picture")]).map((image) => new Picture(image));
      this.xTickCount = 8;
      this.yTickCount = 6;
    }
    get isTime() { return this.xTitle === "time (s)"; }
    holds(at) { return at.x >= this.left && at.x <= this.right && at.y >= this.top && at.y <= this.bottom; }
    xOf(at) { return this.view.xFrom + ((at.x - this.left) / (this.right - this.left)) * (this.view.xTo - this.view.xFrom); }
    yOf(at) { return this.view.yFrom + ((this.bottom - at.y) / (this.bottom - this.top)) * (this.view.yTo - this.view.yFrom); }
    px(x) { return this.left + ((x - this.view.xFrom) / (this.view.xTo - this.view.xFrom)) * (this.right - this.left); }
    py(y) { return this.bottom - ((y - this.view.yFrom) / (this.view.yTo - this.view.yFrom)) * (this.bottom - this.top); }
    get isWhole() { return Object.keys(this.home).every((key) => this.home[key] === this.view[key]); }

    words(at) {
      const { view } = this;
      const [x, y] = [this.xOf(at), this.yOf(at)];
      const lines = [named(this.xTitle || this.sharedXTitle || "", x, view.xTo - view.xFrom), named(this.yTitle, y, view.yTo - view.yFrom)];
      if (this.rightTitle) lines.push(named(this.rightTitle, y / this.rightUnit, (view.yTo - view.yFrom) / this.rightUnit));
      const picture = this.pictures.find((picture) => x >= picture.from && x <= picture.to);
      if (picture) {
        const level = picture.level(x, (this.home.yTo - y) / (this.home.yTo - this.home.yFrom));
        if (level !== null) lines.push(`level ${written(level, 100)} dB re full scale`);
      }
      return lines.join("\n");
    }

    show(view) {
      const { home } = this;
      const width = clamp(view.xTo - view.xFrom, (home.xTo - home.xFrom) * 1e-4, home.xTo - home.xFrom);
      const height = clamp(view.yTo - view.yFrom, (home.yTo - home.yFrom) * 1e-4, home.yTo - home.yFrom);
      const xFrom = clamp(view.xFrom, home.xFrom, home.xTo - width);
      const yFrom = clamp(view.yFrom, home.yFrom, home.yTo - height);
      const isAll = width === home.xTo - home.xFrom && height === home.yTo - home.yFrom;
      this.view = isAll ? { ...home } : { xFrom, xTo: xFrom + width, yFrom, yTo: yFrom + height };
      this.draw();
    }

    draw() {
      const { home, view } = this;
      const across = (home.xTo - home.xFrom) / (view.xTo - view.xFrom);
      const up = (home.yTo - home.yFrom) / (view.yTo - view.yFrom);
      const homeX = (x) => this.left + ((x - home.xFrom) / (home.xTo - home.xFrom)) * (this.right - this.left);
      const homeY = (y) => this.bottom - ((y - home.yFrom) / (home.yTo - home.yFrom)) * (this.bottom - this.top);
      const [shiftX, shiftY] = [this.left - across * homeX(view.xFrom), this.top - up * homeY(view.yTo)];
      for (const layer of this.layers) {
        layer.classList.toggle("enlarged", !this.isWhole);
        if (this.isWhole) layer.removeAttribute("transform");
        else layer.setAttribute("transform", `matrix(${across} 0 0 ${up} ${shiftX} ${shiftY})`);
        // dots stay round
        for (const dot of layer.querySelectorAll("circle")) {
          const [cx, cy] = [Number(dot.getAttribute("cx")), Number(dot.getAttribute("cy"))];
          if (this.isWhole) dot.removeAttribute("transform");
          else dot.setAttribute("transform", `translate(${cx} ${cy}) scale(${1 / across} ${1 / up}) translate(${-cx} ${-cy})`);
        }
      }
      this.drawTicks();
      if (this.svg.moveCursors) this.svg.moveCursors();
    }

    drawTicks() {
      if (this.own) this.own.remove();
      this.ticks.classList.toggle("hidden", !this.isWhole);
      if (this.isWhole) return;
      const { view } = this;
      this.own = make("g", { class: "ticks" });
      this.ticks.after(this.own);
      const line = (x1, y1, x2, y2, stroke) => make("line", { x1, y1, x2, y2, stroke, "stroke-width": 2 }, this.own);
      const text = (words, x, y, anchor) => {
        make("text", { x, y, dy: "0.35em", "text-anchor": anchor, "font-size": 28, fill: "#1B1B1F" }, this.own).textContent = words;
      };
      const label = (value, step) => value.toFixed(clamp(Math.ceil(-Math.log10(step * 1.0001)), 0, 9)).replace("-", "−");
      const x = roundTicks(view.xFrom, view.xTo, this.xTickCount);
      for (const tick of x.ticks) {
        line(this.px(tick), this.bottom, this.px(tick), this.bottom + 10, "#1B1B1F");
        text(label(tick, x.step), this.px(tick), this.bottom + 30, "middle");
      }
      const y = roundTicks(view.yFrom, view.yTo, this.yTickCount);
      for (const tick of y.ticks) {
        line(this.left, this.py(tick), this.right, this.py(tick), "#D9DCE1");
        text(label(tick, y.step), this.left - 16, this.py(tick), "end");
      }
      if (!this.rightTitle) return;
      const right = roundTicks(view.yFrom / this.rightUnit, view.yTo / this.rightUnit, this.yTickCount);
      for (const tick of right.ticks) {
        const at = this.py(tick * this.rightUnit);
        line(this.right, at, this.right + 10, at, "#1B1B1F");
        text(label(tick, right.step), this.right + 16, at, "start");
      }
    }
  }

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
    if (!panels.length) return panels;
    svg.setAttribute("tabindex", "0");
    const place = (event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const reset = () => panels.forEach((panel) => panel.show(panel.home));
    let [drag, active] = [null, panels[0]];

    svg.addEventListener("pointermove", (event) => {
      const at = place(event);
      const panel = drag ? drag.panel : panels.find((panel) => panel.holds(at));
      if (!panel) {
        readout.hidden = true;
        return;
      }
      active = panel;
      readout.textContent = panel.words(at);
      readout.hidden = false;
      readout.style.left = `${clamp(event.clientX + 16, 0, innerWidth - readout.offsetWidth - 8)}px`;
      readout.style.top = `${clamp(event.clientY + 16, 0, innerHeight - readout.offsetHeight - 8)}px`;
      if (!drag) return;
      const box = {
        x: clamp(Math.min(at.x, drag.from.x), panel.left, panel.right), y: clamp(Math.min(at.y, drag.from.y), panel.top, panel.bottom),
        right: clamp(Math.max(at.x, drag.from.x), panel.left, panel.right), bottom: clamp(Math.max(at.y, drag.from.y), panel.top, panel.bottom),
      };
      drag.box = box;
      drag.lasso ??= make("rect", { class: "lasso" }, svg);
      for (const [key, value] of Object.entries({ x: box.x, y: box.y, width: box.right - box.x, height: box.bottom - box.y })) drag.lasso.setAttribute(key, value);
    });
    svg.addEventListener("pointerleave", () => { readout.hidden = true; });
    svg.addEventListener("pointerdown", (event) => {
      const at = place(event);
      const panel = panels.find((panel) => panel.holds(at));
      if (!panel || event.button !== 0 || event.pointerType === "touch") return;
      svg.setPointerCapture(event.pointerId);
      drag = { from: at, panel };
    });
    svg.addEventListener("pointerup", (event) => {
      if (!drag) return;
      const { panel, box, lasso, from } = drag;
      drag = null;
      if (lasso) lasso.remove();
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

  for (const svg of document.querySelectorAll("figure svg")) svg.panels = prepare(svg);

  // sound and its place in the pictures
  for (const trial of document.querySelectorAll("details.trial")) {
    const [audio, svg] = [trial.querySelector("audio"), trial.querySelector("svg")];
    if (!audio || !svg) continue;
    const fromS = Number(trial.dataset.soundFromS);
    const cursors = svg.panels.filter((panel) => panel.isTime).map((panel) => {
      const lines = ["cursor edge", "cursor"].map((name) => make("line", { class: `${name} hidden`, y1: panel.top, y2: panel.bottom }, svg));
      return { panel, lines };
    });
    svg.moveCursors = () => {
      const time = fromS + audio.currentTime;
      const isSilent = audio.currentTime === 0 && audio.paused;
      for (const { panel, lines } of cursors) {
        const isOutside = time < panel.view.xFrom || time > panel.view.xTo;
        for (const line of lines) {
          line.classList.toggle("hidden", isSilent || isOutside);
          line.setAttribute("x1", panel.px(time));
          line.setAttribute("x2", panel.px(time));
        }
      }
    };
    svg.seek = (timeS) => {
      audio.currentTime = Math.max(timeS - fromS, 0);
      audio.play().catch(() => {});
    };
    const follow = () => {
      svg.moveCursors();
      if (!audio.paused) requestAnimationFrame(follow);
    };
    for (const event of ["play", "seeked", "pause", "timeupdate"]) audio.addEventListener(event, follow);
    audio.addEventListener("play", () => {
      for (const other of document.querySelectorAll("audio")) if (other !== audio) other.pause();
    });
  }

  for (const swatch of document.querySelectorAll(".swatch")) swatch.style.background = swatch.dataset.colour;
  for (const toggle of document.querySelectorAll(".method-toggles input")) {
    toggle.addEventListener("change", () => {
      for (const shown of document.querySelectorAll(`.method-${toggle.dataset.method}`)) shown.classList.toggle("hidden", !toggle.checked);
    });
  }
})();
