// A plot of a figure: its axes, what is shown of them, and what stands at a place.
class Panel {
  constructor(svg, group) {
    const data = group.dataset;
    this.svg = svg;
    this.ticks = group.querySelector(".ticks");
    for (const side of ["left", "top", "right", "bottom"]) this[side] = Number(data[side]);
    this.home = { xFrom: Number(data.xFrom), xTo: Number(data.xTo), yFrom: Number(data.yFrom), yTo: Number(data.yTo) };
    this.view = { ...this.home };
    // what is shown before and after a zoom: the whole, unless methods are hidden
    this.start = { ...this.home };
    this.xTitle = data.xTitle;
    this.yTitle = data.yTitle;
    this.rightTitle = data.rightTitle;
    this.rightUnit = Number(data.rightUnit);
    const groups = all(`g[data-panel="${data.panel}"]:not(.panel)`, svg);
    this.layers = groups.flatMap((layer) => all(":scope > .zoomable", layer));
    this.pictures = this.layers.flatMap((layer) => all("image.picture", layer)).map((image) => new Picture(image));
    this.curves = groups.filter((layer) => layer.dataset.curve).map((layer) => new Curve(layer));
    this.labels = groups.filter((layer) => layer.classList.contains("label"));
    this.needs = groups.filter((layer) => layer.matches(".data[data-y-from]"));
    this.data = groups.filter((layer) => layer.classList.contains("data")).flatMap((layer) => all("circle", layer));
    this.xTickCount = 8;
    this.yTickCount = 6;
  }
  // a panel without layers of its own has rows, which cannot be enlarged
  get isZoomable() { return this.layers.length > 0; }
  get isTime() { return this.xTitle === "time (s)"; }
  holds(at) { return at.x >= this.left && at.x <= this.right && at.y >= this.top && at.y <= this.bottom; }
  xOf(at) { return this.view.xFrom + ((at.x - this.left) / (this.right - this.left)) * (this.view.xTo - this.view.xFrom); }
  yOf(at) { return this.view.yFrom + ((this.bottom - at.y) / (this.bottom - this.top)) * (this.view.yTo - this.view.yFrom); }
  px(x) { return this.left + ((x - this.view.xFrom) / (this.view.xTo - this.view.xFrom)) * (this.right - this.left); }
  py(y) { return this.bottom - ((y - this.view.yFrom) / (this.view.yTo - this.view.yFrom)) * (this.bottom - this.top); }
  get isStart() {
    const { home, start, view } = this;
    const [width, height] = [home.xTo - home.xFrom, home.yTo - home.yFrom];
    return Object.keys(home).every((key) => Math.abs(start[key] - view[key]) <= 1e-9 * (key.startsWith("x") ? width : height));
  }
  get isWhole() { return Object.keys(this.home).every((key) => this.home[key] === this.view[key]); }

  words(at) {
    const { view } = this;
    const [x, y] = [this.xOf(at), this.yOf(at)];
    const lines = [named(this.xTitle || this.sharedXTitle || "", x, view.xTo - view.xFrom), named(this.yTitle, y, view.yTo - view.yFrom)];
    if (this.rightTitle) lines.push(named(this.rightTitle, y / this.rightUnit, (view.yTo - view.yFrom) / this.rightUnit));
    const curveUnit = this.rightTitle ? this.rightUnit : 1;
    for (const curve of this.curves.filter((curve) => isShown(curve.layer))) {
      const height = curve.height(this.homeX(x));
      if (height === null) continue;
      const value = this.homeValue(height) / curveUnit;
      lines.push(named(`${curve.name}: ${this.rightTitle || this.yTitle}`, value, (view.yTo - view.yFrom) / curveUnit));
    }
    const picture = this.pictures.find((picture) => x >= picture.from && x <= picture.to);
    if (picture) {
      const level = picture.level(x, (this.home.yTo - y) / (this.home.yTo - this.home.yFrom));
      if (level !== null) lines.push(`level ${written(level, 100)} dB re full scale`);
    }
    return lines.join("\n");
  }

  // places of the whole view, where everything is drawn
  homeX(x) { return this.left + ((x - this.home.xFrom) / (this.home.xTo - this.home.xFrom)) * (this.right - this.left); }
  homeY(y) { return this.bottom - ((y - this.home.yFrom) / (this.home.yTo - this.home.yFrom)) * (this.bottom - this.top); }
  homeValue(height) { return this.home.yFrom + ((this.bottom - height) / (this.bottom - this.top)) * (this.home.yTo - this.home.yFrom); }

  // the nearest point with words, with its place
  nearest(at) {
    let best = null;
    for (const datum of this.data.filter(isShown)) {
      const place = { x: this.px(Number(datum.dataset.x)), y: this.py(Number(datum.dataset.y)) };
      const distance = Math.hypot(place.x - at.x, place.y - at.y);
      if (this.holds(place) && (!best || distance < best.distance)) best = { datum, place, distance };
    }
    return best;
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

  // starts with the points that are shown, where they say what they need
  startWithShown() {
    const shown = this.needs.filter(isShown).map((layer) => layer.dataset);
    if (shown.length === 0) return;
    const { home } = this;
    const [least, most] = [(key) => Math.min(...shown.map((data) => Number(data[key]))), (key) => Math.max(...shown.map((data) => Number(data[key])))];
    this.start = {
      xFrom: Math.max(least("xFrom"), home.xFrom), xTo: Math.min(most("xTo"), home.xTo),
      yFrom: Math.max(least("yFrom"), home.yFrom), yTo: Math.min(most("yTo"), home.yTo),
    };
    this.show(this.start);
  }

  draw() {
    const { home, view } = this;
    const across = (home.xTo - home.xFrom) / (view.xTo - view.xFrom);
    const up = (home.yTo - home.yFrom) / (view.yTo - view.yFrom);
    const [shiftX, shiftY] = [this.left - across * this.homeX(view.xFrom), this.top - up * this.homeY(view.yTo)];
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
    this.moveLabels();
    this.drawTicks();
    if (this.svg.moveCursors) this.svg.moveCursors();
  }

  // a label stays at its point, and goes with it
  moveLabels() {
    for (const label of this.labels) {
      const x = Number(label.dataset.x);
      const y = label.dataset.y === undefined ? null : Number(label.dataset.y);
      const [toX, toY] = [this.px(x), y === null ? null : this.py(y)];
      const isOutside = toX < this.left || toX > this.right || (toY !== null && (toY < this.top || toY > this.bottom));
      label.classList.toggle("outside", isOutside);
      if (this.isWhole) label.removeAttribute("transform");
      else label.setAttribute("transform", `translate(${toX - this.homeX(x)} ${toY === null ? 0 : toY - this.homeY(y)})`);
    }
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
