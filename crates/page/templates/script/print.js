// Paper: a figure that is higher than a page is parted between its panels or rows, so that its letters keep their size.

// of the 235 mm that a figure has on a page, in tenths of a millimetre
const PAGE_UNITS = 2350;
// a panel has its title above it, and the numbers and the title of its axis below
const [ABOVE, BELOW] = [80, 90];

// the places at which a drawing is parted, from its top to its bottom: nothing that belongs together has one inside
const cutsOf = (svg) => {
  const { a: scale, f: top } = svg.getScreenCTM();
  const span = (part) => {
    const box = part.getBoundingClientRect();
    return { from: (box.top - top) / scale, to: (box.bottom - top) / scale };
  };
  const panels = svg.panels.filter((panel) => panel.isZoomable).map((panel) => ({ from: panel.top - ABOVE, to: panel.bottom + BELOW }));
  const whole = [...panels, ...all("text, .trial", svg).map(span)];
  const { height } = svg.viewBox.baseVal;
  const cuts = [0];
  while (height - cuts.at(-1) > PAGE_UNITS) {
    let cut = cuts.at(-1) + PAGE_UNITS;
    for (let over; (over = whole.find(({ from, to }) => from < cut && cut < to)); ) cut = over.from - 1;
    if (cut <= cuts.at(-1)) break;
    cuts.push(cut);
  }
  return [...cuts, height];
};

const partFigures = () => {
  for (const svg of all("figure svg").filter((svg) => svg.checkVisibility())) {
    const cuts = cutsOf(svg);
    if (cuts.length === 2) continue;
    const parts = cuts.slice(1).map((to, index) => {
      const part = svg.cloneNode(true);
      const from = cuts[index];
      part.setAttribute("viewBox", `0 ${from} ${svg.viewBox.baseVal.width} ${to - from}`);
      part.removeAttribute("height");
      part.classList.add("part");
      return part;
    });
    svg.after(...parts);
    svg.classList.add("hidden");
    svg.closest("figure").classList.add("parted");
  }
};
const joinFigures = () => {
  for (const figure of all("figure.parted")) {
    for (const part of all("svg.part", figure)) part.remove();
    figure.querySelector("svg").classList.remove("hidden");
    figure.classList.remove("parted");
  }
};
addEventListener("beforeprint", () => {
  joinFigures();
  partFigures();
});
addEventListener("afterprint", joinFigures);
