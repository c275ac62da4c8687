// The level under a place of a spectrogram, read back from its colour.
const colours = JSON.parse(document.getElementById("level-colours").textContent);
const levelOf = new Map(colours.map(([red, green, blue], level) => [(red << 16) | (green << 8) | blue, level]));

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

// A curve of a panel that has a name: its height over a place, in units of the drawing.
class Curve {
  constructor(layer) {
    this.name = layer.dataset.curve;
    this.layer = layer;
  }
  // the lines as points, once somebody asks; a line over its own edge counts once
  get lines() {
    const isNew = (points, index, every) => every.indexOf(points) === index;
    const drawn = all("polyline", this.layer).map((line) => line.getAttribute("points").trim()).filter(isNew);
    const pairs = (points) => points.split(/\s+/).map((pair) => pair.split(",").map(Number));
    return (this.parsed ??= drawn.map(pairs));
  }
  height(x) {
    for (const line of this.lines) {
      const index = line.findIndex((point) => point[0] >= x);
      if (index < 0 || (index === 0 && line[0][0] > x)) continue;
      const [[x1, y1], [x2, y2]] = [line[Math.max(index - 1, 0)], line[index]];
      return x2 === x1 ? y2 : y1 + ((x - x1) / (x2 - x1)) * (y2 - y1);
    }
    return null;
  }
}
