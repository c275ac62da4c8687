// The picture of a recording: look into it, choose its hover and its band, play it.

import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Answer, Picture, Point } from "./answers";
import { useDraft } from "./field";
import { Player } from "./player";
import { Axes, bitmapOf, drawSpectrogram, MARGIN, timeInWords, type Overlay, type View } from "./spectrogram";
import type { Recording } from "./recording";
import type { Store } from "./store";

/** Colours of rotors that stand out from those of the levels; style.css has the same. */
const COLOURS = ["#ffffff", "#ff9d4d", "#f7a8d8", "#ff6b6b", "#c9b6ff", "#ffd9b3"];
/** Wait before a detailed picture is asked for. */
const DETAIL_MS = 250;
/** What a detailed picture shows beyond the edges, as a share of the view. */
const EDGE = 0.15;
const HARMONICS = 3;
type Tool = "move" | "hover" | "band";

export function Viewer({ store, recording }: { store: Store; recording: Recording }) {
  const { picture } = recording;
  if (!picture) return <p class="quiet">{recording.state === "heard" ? "There is no picture." : "The picture is drawn …"}</p>;
  return <Picturesque key={recording.number} store={store} recording={recording} picture={picture} />;
}

function Picturesque({ store, recording, picture }: { store: Store; recording: Recording; picture: Picture }) {
  const answer = recording.answer;
  const whole = useMemo<View>(
    () => ({ fromS: picture.from_s, toS: picture.to_s, hzLow: 0, hzHigh: picture.hz_high, isLog: false }),
    [picture],
  );
  const [view, setView] = useState<View>(whole);
  const [tool, setTool] = useState<Tool>("move");
  const [cursor, setCursor] = useState<{ timeS: number; hz: number }>();
  const [isFixed, setFixed] = useState(false);
  const [playedS, setPlayedS] = useState<number>();
  const [ruler, setRuler] = useState(0);
  const [selection, setSelection] = useState<Overlay["selection"]>();
  const [detail, setDetail] = useState<Picture>();
  const canvas = useRef<HTMLCanvasElement>(null);
  const seek = useRef<(timeS: number) => void>(() => {});
  const bitmap = useMemo(() => bitmapOf(picture, store.colours), [picture]);
  const detailBitmap = useMemo(() => detail && bitmapOf(detail, store.colours), [detail]);

  // with an answer, the picture shows the lines that were followed
  const top = answer?.bands_hz.at(-1)?.[1];
  useEffect(() => {
    if (top) setView((now) => (now.hzHigh === picture.hz_high ? { ...now, hzHigh: Math.min(picture.hz_high, top * 1.25) } : now));
  }, [top]);

  useEffect(() => {
    const isWhole = view.toS - view.fromS > 0.9 * (whole.toS - whole.fromS) && view.hzHigh - view.hzLow > 0.9 * whole.hzHigh;
    if (isWhole) return setDetail(undefined);
    let isWanted = true;
    const timer = setTimeout(() => {
      const width = Math.round((canvas.current?.clientWidth ?? 800) * Math.min(window.devicePixelRatio, 2));
      const [edgeS, edgeHz] = [EDGE * (view.toS - view.fromS), EDGE * (view.hzHigh - view.hzLow)];
      const spanS: Point = [Math.max(0, view.fromS - edgeS), view.toS + edgeS];
      store.hearing.levels(recording, spanS, [Math.max(0, view.hzLow - edgeHz), view.hzHigh + edgeHz], Math.min(width, 2048), 512).then(
        (picture) => isWanted && setDetail(picture),
        () => {},
      );
    }, DETAIL_MS);
    return () => {
      isWanted = false;
      clearTimeout(timer);
    };
  }, [view.fromS, view.toS, view.hzLow, view.hzHigh, picture]);

  const curves = useMemo(() => curvesOf(answer), [answer]);
  const overlay: Overlay = {
    curves,
    usedS: answer?.hover_s ?? [],
    bandsHz: answer?.bands_hz.slice(0, HARMONICS) ?? [],
    ruler: rulerOf(ruler, cursor, picture.hz_high),
    cursor, playedS, selection,
  };
  const draw = useRef(() => {});
  draw.current = () => {
    const layers = [{ picture, bitmap }, ...(detail && detailBitmap ? [{ picture: detail, bitmap: detailBitmap }] : [])];
    if (canvas.current) drawSpectrogram(canvas.current, view, layers, overlay);
  };
  useEffect(() => {
    const frame = requestAnimationFrame(() => draw.current());
    return () => cancelAnimationFrame(frame);
  });
  useEffect(() => {
    const again = () => draw.current();
    const watcher = new ResizeObserver(again);
    watcher.observe(canvas.current!);
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    scheme.addEventListener("change", again);
    return () => {
      scheme.removeEventListener("change", again);
      watcher.disconnect();
    };
  }, []);

  const moves = useMoves({
    canvas, view, whole, tool, setView, setSelection,
    onCursor: (at) => !isFixed && setCursor(at),
    onTap: (at) => (setFixed(!isFixed), setCursor(at), seek.current(at.timeS)),
    onSelected: (selected) => {
      setSelection(undefined);
      setTool("move");
      if (selected.spanS) store.loads.setSpan(recording, selected.spanS);
      if (selected.bandHz) store.loads.setBand(recording, selected.bandHz);
    },
  });
  const zoom = (factor: number) => setView(zoomed(view, whole, factor, 0.5, 0.5));
  return (
    <div class="viewer">
      <div class="tools" role="toolbar" aria-label="Picture">
        <Choice value={tool} set={(value) => setTool(value as Tool)} options={[["move", "Move"], ["hover", "Choose hover"], ["band", "Choose band"]]} />
        <span class="group">
          <button type="button" onClick={() => zoom(0.5)} aria-label="Zoom in">+</button>
          <button type="button" onClick={() => zoom(2)} aria-label="Zoom out">−</button>
          <button type="button" onClick={() => setView({ ...whole, isLog: view.isLog })}>All</button>
        </span>
        <label class="check">
          <input type="checkbox" checked={view.isLog} onChange={() => setView({ ...view, isLog: !view.isLog })} /> log
        </label>
        <label>
          ruler{" "}
          <select value={ruler} onChange={(event) => setRuler(Number(event.currentTarget.value))}>
            <option value={0}>none</option>
            {rulersOf(store, answer).map(([lines, words]) => <option value={lines} key={lines}>{words}</option>)}
          </select>
        </label>
      </div>
      <canvas ref={canvas} class={`spectrogram ${tool}`} tabIndex={0} role="img"
        aria-label={`Spectrogram of ${recording.name}. Arrows move, plus and minus zoom, 0 shows all.`} {...moves} />
      <p class="cursor" aria-live="off">{cursor ? inWords(cursor, answer, view) : "Point at the picture to read it; tap to hold the cursor and to play from there."}</p>
      <Player store={store} recording={recording} lengthS={picture.to_s} onTime={setPlayedS} seek={seek} />
      <Limits store={store} recording={recording} />
    </div>
  );
}

function Choice(props: { value: string; set: (value: string) => void; options: [string, string][] }) {
  return (
    <span class="group">
      {props.options.map(([value, words]) => (
        <button type="button" key={value} aria-pressed={props.value === value} onClick={() => props.set(value)}>{words}</button>
      ))}
    </span>
  );
}

/** The chosen hover and band as numbers, for the keyboard and for exact values. */
function Limits({ store, recording }: { store: Store; recording: Recording }) {
  const isInLoad = store.loads.loadOf(recording) !== undefined;
  return (
    <div class="limits">
      <Pair words="Hover" unit="s" isFound={!store.loads.spanOf(recording)} value={store.loads.spanOf(recording) ?? hoverOf(recording.answer)}
        set={(pair) => store.loads.setSpan(recording, pair)} note={isInLoad ? "of all recordings of this load" : ""} />
      <Pair words="Band" unit="Hz" isFound={!store.loads.bandOf(recording)} value={store.loads.bandOf(recording) ?? recording.answer?.bands_hz[0]}
        set={(pair) => store.loads.setBand(recording, pair)} note={isInLoad ? "of the experiment" : ""} />
    </div>
  );
}

function Pair(props: {
  words: string; unit: string; isFound: boolean; value?: Point; note: string; set: (pair: Point | undefined) => void;
}) {
  const { value, set, words, unit } = props;
  const shown = (number?: number) => (number === undefined ? "" : String(+number.toFixed(2)));
  const change = (index: 0 | 1) => ({ valueAsNumber }: HTMLInputElement) => {
    const pair: Point = value ? [...value] : [0, 0];
    pair[index] = valueAsNumber;
    if (Number.isFinite(valueAsNumber) && valueAsNumber >= 0 && pair[1] > pair[0]) set(pair);
  };
  const [low, high] = [useDraft(shown(value?.[0]), change(0)), useDraft(shown(value?.[1]), change(1))];
  return (
    <fieldset class="pair">
      <legend>{words}</legend>
      <input type="number" min="0" step="any" aria-label={`${words} from, ${unit}`} {...low} />
      {" to "}
      <input type="number" min="0" step="any" aria-label={`${words} to, ${unit}`} {...high} />
      {` ${unit} `}
      {props.isFound ? <span class="quiet">found</span> : <button type="button" onClick={() => set(undefined)}>Find it</button>}
      {!props.isFound && props.note && <span class="quiet"> {props.note}</span>}
    </fieldset>
  );
}

function hoverOf(answer?: Answer): Point | undefined {
  const first = answer?.hover_s[0];
  const last = answer?.hover_s.at(-1);
  return first && last && [first[0], last[1]];
}

/** The track of each rotor, or of all together, at the first harmonics of the tone. */
function curvesOf(answer?: Answer): Overlay["curves"] {
  const order = answer?.order;
  if (!answer || !order) return [];
  const tracks = answer.rotors.length > 0 ? answer.rotors.map((rotor) => rotor.track) : [answer.track];
  return tracks.flatMap((track, index) => {
    const stepS = stepOf(track);
    return Array.from({ length: HARMONICS }, (_, harmonic) => ({
      points: track.map(([timeS, speed]): Point => [timeS, speed * order * (harmonic + 1)]),
      colour: COLOURS[index % COLOURS.length],
      width: harmonic === 0 ? 2.2 : 1.4,
      stepS,
    }));
  });
}

function stepOf(track: Point[]): number {
  const steps = track.slice(1).map((point, index) => point[0] - track[index][0]).sort((a, b) => a - b);
  return steps[Math.floor(steps.length / 2)] ?? 1;
}

/** The mean shaft speed at a time, from the nearest point of the track. */
function speedAt(answer: Answer | undefined, timeS: number): number | undefined {
  let nearest: Point | undefined;
  for (const point of answer?.track ?? []) {
    if (!nearest || Math.abs(point[0] - timeS) < Math.abs(nearest[0] - timeS)) nearest = point;
  }
  return nearest && Math.abs(nearest[0] - timeS) < 1 ? nearest[1] : undefined;
}

function inWords({ timeS, hz }: { timeS: number; hz: number }, answer: Answer | undefined, view: View): string {
  const parts = [timeInWords(timeS, Math.min(view.toS - view.fromS, 60)), `${hz.toFixed(1)} Hz`];
  const speed = speedAt(answer, timeS);
  if (speed) parts.push(`order ${(hz / speed).toFixed(2)} of ${speed.toFixed(2)} rev/s`);
  if (answer?.order) parts.push(`as the tone: ${(hz / answer.order).toFixed(2)} rev/s, ${((60 * hz) / answer.order).toFixed(0)} rpm`);
  return parts.join(" · ");
}

/** Which lines a ruler can show: multiples of the cursor's frequency, read as the shaft, the blade pass or the mesh. */
function rulersOf(store: Store, answer?: Answer): [number, string][] {
  const known = store.vehicles.find((vehicle) => vehicle.id === store.entries.vehicle.preset);
  const blades = store.entries.vehicle.blades ?? known?.blade_count?.value;
  const wheel = store.entries.vehicle.gear?.wheel ?? known?.gear?.value.wheel;
  const choices: [number, string][] = [[1, "multiples of the cursor"]];
  if (blades) choices.push([blades, `cursor is the blade pass (${blades})`]);
  if (wheel) choices.push([wheel, `cursor is the mesh (${wheel})`]);
  if (answer?.order && !choices.some(([lines]) => lines === answer.order)) choices.push([answer.order, `cursor is order ${answer.order}`]);
  return choices;
}

function rulerOf(lines: number, cursor: { hz: number } | undefined, hzMax: number): Overlay["ruler"] {
  if (!lines || !cursor) return [];
  const shaft = cursor.hz / lines;
  const marks: Overlay["ruler"] = [];
  const isDense = lines > 8;
  for (let order = isDense ? lines : 1; order * shaft <= hzMax && marks.length < 80; order += isDense ? lines : 1) {
    const isStrong = order % lines === 0;
    marks.push({ hz: order * shaft, words: isStrong || lines === 1 ? `order ${order}` : "", isStrong });
  }
  return marks;
}

function zoomed(view: View, whole: View, factor: number, x: number, y: number, isTimeOnly = false): View {
  const span = Math.min(Math.max((view.toS - view.fromS) * factor, 0.05), whole.toS - whole.fromS);
  const atS = view.fromS + x * (view.toS - view.fromS);
  const band = isTimeOnly ? view.hzHigh - view.hzLow : Math.min(Math.max((view.hzHigh - view.hzLow) * factor, 20), whole.hzHigh);
  const atHz = view.hzLow + y * (view.hzHigh - view.hzLow);
  return within({ ...view, fromS: atS - x * span, toS: atS + (1 - x) * span, hzLow: atHz - y * band, hzHigh: atHz + (1 - y) * band }, whole);
}

function within(view: View, whole: View): View {
  const [span, band] = [view.toS - view.fromS, view.hzHigh - view.hzLow];
  const fromS = Math.min(Math.max(view.fromS, whole.fromS), whole.toS - span);
  const hzLow = Math.min(Math.max(view.hzLow, 0), whole.hzHigh - band);
  return { ...view, fromS, toS: fromS + span, hzLow, hzHigh: hzLow + band };
}

interface Moves {
  canvas: { current: HTMLCanvasElement | null };
  view: View;
  whole: View;
  tool: Tool;
  setView: (view: View) => void;
  setSelection: (selection: Overlay["selection"]) => void;
  onCursor: (at: { timeS: number; hz: number }) => void;
  onTap: (at: { timeS: number; hz: number }) => void;
  onSelected: (selection: NonNullable<Overlay["selection"]>) => void;
}

/** Pointers, wheel and keys over the picture. */
function useMoves(moves: Moves) {
  const pointers = useRef(new Map<number, { x: number; y: number }>());
  const start = useRef<{ x: number; y: number; view: View; hasMoved: boolean } | undefined>(undefined);
  const place = (event: PointerEvent | WheelEvent) => {
    const box = moves.canvas.current!.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const axesOf = (view: View) => new Axes(view, { width: moves.canvas.current!.clientWidth, height: moves.canvas.current!.clientHeight });
  const selected = (from: { x: number; y: number }, to: { x: number; y: number }) => {
    const axes = axesOf(moves.view);
    const sorted = (a: number, b: number): Point => [Math.max(0, Math.min(a, b)), Math.max(a, b)];
    return moves.tool === "hover" ? { spanS: sorted(axes.timeS(from.x), axes.timeS(to.x)) } : { bandHz: sorted(axes.hz(from.y), axes.hz(to.y)) };
  };
  useEffect(() => {
    const element = moves.canvas.current!;
    const onWheel = (event: WheelEvent) => {
      if (!event.ctrlKey && !event.metaKey && document.activeElement !== element) return; // the page scrolls
      event.preventDefault();
      const at = place(event);
      const axes = axesOf(moves.view);
      const x = (at.x - MARGIN.left) / axes.width;
      const y = 1 - (at.y - MARGIN.top) / axes.height;
      moves.setView(zoomed(moves.view, moves.whole, 1.002 ** event.deltaY, x, y, event.shiftKey));
    };
    element.addEventListener("wheel", onWheel, { passive: false });
    return () => element.removeEventListener("wheel", onWheel);
  });
  return {
    onPointerDown(event: PointerEvent) {
      const at = place(event);
      moves.canvas.current!.setPointerCapture(event.pointerId);
      pointers.current.set(event.pointerId, at);
      start.current = { ...at, view: moves.view, hasMoved: false };
    },
    onPointerMove(event: PointerEvent) {
      const at = place(event);
      const axes = axesOf(moves.view);
      moves.onCursor({ timeS: axes.timeS(at.x), hz: Math.max(0, axes.hz(at.y)) });
      if (!pointers.current.has(event.pointerId) || !start.current) return;
      const before = pointers.current.get(event.pointerId)!;
      pointers.current.set(event.pointerId, at);
      if (Math.hypot(at.x - start.current.x, at.y - start.current.y) > 4) start.current.hasMoved = true;
      if (pointers.current.size === 2) {
        const other = [...pointers.current].find(([id]) => id !== event.pointerId)![1];
        const ratio = Math.hypot(before.x - other.x, before.y - other.y) / Math.max(Math.hypot(at.x - other.x, at.y - other.y), 1);
        return moves.setView(zoomed(moves.view, moves.whole, ratio, (other.x - MARGIN.left) / axes.width, 1 - (other.y - MARGIN.top) / axes.height));
      }
      if (!start.current.hasMoved) return;
      if (moves.tool !== "move") return moves.setSelection(selected(start.current, at));
      const { view } = start.current;
      const shiftS = ((start.current.x - at.x) / axes.width) * (view.toS - view.fromS);
      const shiftHz = ((at.y - start.current.y) / axes.height) * (view.hzHigh - view.hzLow);
      moves.setView(within({ ...view, fromS: view.fromS + shiftS, toS: view.toS + shiftS, hzLow: view.hzLow + shiftHz, hzHigh: view.hzHigh + shiftHz }, moves.whole));
    },
    onPointerUp(event: PointerEvent) {
      const at = place(event);
      pointers.current.delete(event.pointerId);
      const began = start.current;
      if (!began || pointers.current.size > 0) return;
      start.current = undefined;
      const axes = axesOf(moves.view);
      if (began.hasMoved && moves.tool !== "move") moves.onSelected(selected(began, at));
      else if (!began.hasMoved) moves.onTap({ timeS: axes.timeS(at.x), hz: axes.hz(at.y) });
    },
    onPointerCancel(event: PointerEvent) {
      pointers.current.delete(event.pointerId);
      moves.setSelection(undefined);
    },
    onKeyDown(event: KeyboardEvent) {
      const { view, whole } = moves;
      const [span, band] = [(view.toS - view.fromS) / 8, (view.hzHigh - view.hzLow) / 8];
      const shifted = (s: number, hz: number) =>
        within({ ...view, fromS: view.fromS + s, toS: view.toS + s, hzLow: view.hzLow + hz, hzHigh: view.hzHigh + hz }, whole);
      const next = {
        ArrowLeft: () => shifted(-span, 0), ArrowRight: () => shifted(span, 0), ArrowUp: () => shifted(0, band), ArrowDown: () => shifted(0, -band),
        "+": () => zoomed(view, whole, 0.5, 0.5, 0.5), "-": () => zoomed(view, whole, 2, 0.5, 0.5), "0": () => ({ ...whole, isLog: view.isLog }),
      }[event.key];
      if (!next) return;
      event.preventDefault();
      moves.setView(next());
    },
  };
}
