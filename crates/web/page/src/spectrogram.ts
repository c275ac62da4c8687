// A spectrogram on a canvas: pictures from the worker, placed in time and frequency, with lines over them.

import type { Picture, Point } from "./answers";

export interface View {
  fromS: number;
  toS: number;
  hzLow: number;
  hzHigh: number;
  isLog: boolean;
}

export interface Overlay {
  /** Curves of frequency over time, with their colours. */
  curves: { points: Point[]; colour: string; width: number; stepS: number }[];
  /** The used stretches; everything else is dimmed. */
  usedS: Point[];
  bandsHz: Point[];
  cursor?: { timeS: number; hz: number };
  ruler: { hz: number; words: string; isStrong: boolean }[];
  playedS?: number;
  selection?: { spanS?: Point; bandHz?: Point };
}

/** Space for the numbers of the axes, in pixels of the page: it grows with the letters. */
export const MARGIN = { left: 52, bottom: 26, top: 6, right: 6 };

/** Height of the letters of the axes, and with it the space for them. */
function letterOf(): number {
  const letter = 0.75 * parseFloat(getComputedStyle(document.documentElement).fontSize);
  [MARGIN.left, MARGIN.bottom] = [4.2 * letter, 2.2 * letter];
  return letter;
}
/** The lowest frequency of a logarithmic axis. */
const LOG_HZ_LOW = 30;
const LOGICAL_ROWS_MAX = 1200;

/** Levels as pixels, highest frequency at the top. */
export function bitmapOf(picture: Picture, colours: Uint8Array): HTMLCanvasElement {
  const { columns, rows, cells } = picture;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [columns, rows];
  const context = canvas.getContext("2d")!;
  const image = context.createImageData(columns, rows);
  const last = colours.length / 3 - 1;
  const table = new Uint32Array(256);
  for (let level = 0; level < 256; level++) {
    const at = 3 * Math.round((level / 255) * last);
    table[level] = 0xff000000 | (colours[at + 2] << 16) | (colours[at + 1] << 8) | colours[at];
  }
  const pixels = new Uint32Array(image.data.buffer);
  for (let column = 0; column < columns; column++) {
    for (let row = 0; row < rows; row++) {
      pixels[(rows - 1 - row) * columns + column] = table[cells[column * rows + row]];
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/** Distance of points of a curve that are drawn, px. */
const CURVE_STEP_PX = 0.5;

/** Between time, frequency and places of a canvas of a size in pixels of the page. */
export class Axes {
  readonly width: number;
  readonly height: number;
  constructor(readonly view: View, size: { width: number; height: number }) {
    this.width = Math.max(1, size.width - MARGIN.left - MARGIN.right);
    this.height = Math.max(1, size.height - MARGIN.top - MARGIN.bottom);
  }

  x(timeS: number): number {
    const { fromS, toS } = this.view;
    return MARGIN.left + ((timeS - fromS) / (toS - fromS)) * this.width;
  }

  y(hz: number): number {
    return MARGIN.top + (1 - this.share(hz)) * this.height;
  }

  timeS(x: number): number {
    const { fromS, toS } = this.view;
    return fromS + ((x - MARGIN.left) / this.width) * (toS - fromS);
  }

  hz(y: number): number {
    return this.hzOfShare(1 - (y - MARGIN.top) / this.height);
  }

  hzOfShare(share: number): number {
    const { hzLow, hzHigh, isLog } = this.view;
    if (!isLog) return hzLow + share * (hzHigh - hzLow);
    const low = Math.max(hzLow, LOG_HZ_LOW);
    return low * (hzHigh / low) ** share;
  }

  private share(hz: number): number {
    const { hzLow, hzHigh, isLog } = this.view;
    if (!isLog) return (hz - hzLow) / (hzHigh - hzLow);
    const low = Math.max(hzLow, LOG_HZ_LOW);
    return Math.log(Math.max(hz, 1) / low) / Math.log(hzHigh / low);
  }
}

export function drawSpectrogram(
  canvas: HTMLCanvasElement,
  view: View,
  layers: { picture: Picture; bitmap: HTMLCanvasElement }[],
  overlay: Overlay,
) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = window.devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  }
  const context = canvas.getContext("2d")!;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const axes = new Axes(view, { width, height });
  const style = getComputedStyle(canvas);
  context.font = `${letterOf()}px ${style.getPropertyValue("font-family") || "sans-serif"}`;
  context.save();
  context.beginPath();
  context.rect(MARGIN.left, MARGIN.top, axes.width, axes.height);
  context.clip();
  context.fillStyle = "#440154";
  context.fillRect(MARGIN.left, MARGIN.top, axes.width, axes.height);
  for (const { picture, bitmap } of layers) drawLayer(context, axes, picture, bitmap);
  drawOverlay(context, axes, overlay);
  context.restore();
  drawNumbers(context, axes, style.color);
}

function drawLayer(context: CanvasRenderingContext2D, axes: Axes, picture: Picture, bitmap: HTMLCanvasElement) {
  const [left, right] = [axes.x(picture.from_s), axes.x(picture.to_s)];
  if (!axes.view.isLog) {
    const [top, bottom] = [axes.y(picture.hz_high), axes.y(picture.hz_low)];
    context.drawImage(bitmap, left, top, right - left, bottom - top);
    return;
  }
  const rowHz = (picture.hz_high - picture.hz_low) / picture.rows;
  const count = Math.min(Math.ceil(axes.height), LOGICAL_ROWS_MAX);
  const step = axes.height / count;
  for (let line = 0; line < count; line++) {
    const y = MARGIN.top + line * step;
    const [low, high] = [axes.hz(y + step), axes.hz(y)];
    if (high < picture.hz_low || low > picture.hz_high) continue;
    const row = picture.rows - (high - picture.hz_low) / rowHz;
    const rows = Math.max((high - low) / rowHz, 0.2);
    context.drawImage(bitmap, 0, Math.max(row, 0), picture.columns, rows, left, y, right - left, step + 0.5);
  }
}

function drawOverlay(context: CanvasRenderingContext2D, axes: Axes, overlay: Overlay) {
  const bottom = MARGIN.top + axes.height;
  context.fillStyle = "rgba(10, 10, 20, 0.5)";
  let edge = MARGIN.left;
  for (const [fromS, toS] of overlay.usedS) {
    context.fillRect(edge, MARGIN.top, Math.max(0, axes.x(fromS) - edge), axes.height);
    edge = Math.max(edge, axes.x(toS));
  }
  if (overlay.usedS.length > 0) context.fillRect(edge, MARGIN.top, MARGIN.left + axes.width - edge, axes.height);
  context.strokeStyle = "rgba(255, 209, 102, 0.8)";
  context.setLineDash([6, 4]);
  context.lineWidth = 1;
  for (const hz of overlay.bandsHz.flat()) line(context, MARGIN.left, axes.y(hz), MARGIN.left + axes.width, axes.y(hz));
  context.setLineDash([]);
  for (const curve of overlay.curves) drawCurve(context, axes, curve);
  for (const { hz, words, isStrong } of overlay.ruler) {
    const y = axes.y(hz);
    if (y < MARGIN.top || y > bottom) continue;
    context.strokeStyle = isStrong ? "rgba(255, 255, 255, 0.95)" : "rgba(255, 255, 255, 0.45)";
    line(context, MARGIN.left, y, MARGIN.left + axes.width, y);
    if (!words) continue;
    context.fillStyle = "#fff";
    context.textAlign = "right";
    context.textBaseline = "bottom";
    context.fillText(words, MARGIN.left + axes.width - 4, y - 1);
  }
  if (overlay.cursor) {
    context.strokeStyle = "rgba(255, 255, 255, 0.7)";
    line(context, axes.x(overlay.cursor.timeS), MARGIN.top, axes.x(overlay.cursor.timeS), bottom);
    line(context, MARGIN.left, axes.y(overlay.cursor.hz), MARGIN.left + axes.width, axes.y(overlay.cursor.hz));
  }
  if (overlay.playedS !== undefined) {
    context.strokeStyle = "#ff5a5f";
    context.lineWidth = 2;
    line(context, axes.x(overlay.playedS), MARGIN.top, axes.x(overlay.playedS), bottom);
  }
  if (overlay.selection) {
    const { spanS, bandHz } = overlay.selection;
    const [left, right] = spanS ? spanS.map((s) => axes.x(s)) : [MARGIN.left, MARGIN.left + axes.width];
    const [low, high] = bandHz ? bandHz.map((hz) => axes.y(hz)) : [bottom, MARGIN.top];
    context.fillStyle = "rgba(86, 180, 233, 0.35)";
    context.fillRect(left, high, right - left, low - high);
  }
}

function drawCurve(context: CanvasRenderingContext2D, axes: Axes, curve: Overlay["curves"][number]) {
  const { fromS, toS } = axes.view;
  const path = new Path2D();
  let before = -Infinity;
  let [lastX, lastY] = [-Infinity, -Infinity];
  for (const [timeS, hz] of curve.points) {
    if (timeS < fromS - curve.stepS || timeS > toS + curve.stepS) continue;
    const [x, y] = [axes.x(timeS), axes.y(hz)];
    const isNew = timeS - before > 1.6 * curve.stepS;
    before = timeS;
    // of a long recording, most points lie upon each other
    if (!isNew && Math.abs(x - lastX) < CURVE_STEP_PX && Math.abs(y - lastY) < CURVE_STEP_PX) continue;
    if (isNew) path.moveTo(x, y);
    else path.lineTo(x, y);
    [lastX, lastY] = [x, y];
  }
  for (const [width, colour] of [[curve.width + 2, "rgba(0, 0, 0, 0.55)"], [curve.width, curve.colour]] as const) {
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.stroke(path);
  }
}

function drawNumbers(context: CanvasRenderingContext2D, axes: Axes, colour: string) {
  const { fromS, toS } = axes.view;
  context.fillStyle = colour;
  context.strokeStyle = colour;
  context.lineWidth = 1;
  const bottom = MARGIN.top + axes.height;
  context.textAlign = "center";
  context.textBaseline = "top";
  const steps = stepsOf(fromS, toS, axes.width / (2 * MARGIN.left));
  for (const timeS of steps) {
    line(context, axes.x(timeS), bottom, axes.x(timeS), bottom + 4);
    context.fillText(timeInWords(timeS, toS - fromS), axes.x(timeS), bottom + 7);
  }
  context.textAlign = "right";
  context.textBaseline = "middle";
  const low = axes.hzOfShare(0);
  const high = axes.hzOfShare(1);
  const wanted = axes.view.isLog
    ? [50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000].filter((hz) => hz >= low && hz <= high)
    : stepsOf(low, high, axes.height / (1.6 * MARGIN.bottom));
  for (const hz of wanted) {
    line(context, MARGIN.left - 4, axes.y(hz), MARGIN.left, axes.y(hz));
    context.fillText(hzInWords(hz, high), MARGIN.left - 7, axes.y(hz));
  }
}

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

/** Round numbers between two values, about as many as wanted. */
function stepsOf(low: number, high: number, count: number): number[] {
  const raw = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((each) => each * power >= raw) ?? 10);
  const steps: number[] = [];
  for (let value = Math.ceil(low / step) * step; value <= high && steps.length < 60; value += step) steps.push(value);
  return steps;
}

export function timeInWords(timeS: number, spanS: number): string {
  if (spanS > 90) {
    const seconds = Math.round(timeS);
    return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  }
  return `${+timeS.toFixed(spanS > 8 ? 0 : spanS > 0.8 ? 1 : 3)} s`;
}

function hzInWords(hz: number, high: number): string {
  return high >= 2000 ? `${+(hz / 1000).toFixed(hz % 1000 === 0 ? 0 : 3)} k` : `${+hz.toFixed(1)}`;
}
