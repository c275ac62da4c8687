// The worker: all reading of files and all arithmetic. One request at a time; the page never waits for it.

import init, * as hovertone from "hovertone-bindings";
import { DecodedFiles } from "./decoded";
import type { Request } from "./requests";

const files = new Map<number, File>();
const decoded = new DecodedFiles();
const reader = new FileReaderSync();
let desk: hovertone.Desk | undefined;

// hovertone reads its files through this: a slice at a time, at any place.
(globalThis as Record<string, unknown>).hovertoneFiles = {
  read(number: number, at: number, into: Uint8Array): number {
    const count = decoded.read(number, at, into);
    if (count !== undefined) return count;
    const file = files.get(number);
    if (!file) throw "the file is gone; add it again";
    let bytes: ArrayBuffer;
    try {
      bytes = reader.readAsArrayBuffer(file.slice(at, at + into.length));
    } catch {
      throw "the browser can no longer read the file: it was moved or changed; add it again";
    }
    into.set(new Uint8Array(bytes));
    return bytes.byteLength;
  },
};

const started = init({ module_or_path: new URL("hovertone_bg.wasm", self.location.href) });

self.onmessage = async ({ data }: MessageEvent<{ id: number; request: Request }>) => {
  const { id, request } = data;
  let shownAt = 0;
  const onShare = (share: number) => {
    const now = performance.now();
    if (now - shownAt < 80) return;
    shownAt = now;
    self.postMessage({ id, share });
  };
  try {
    await started;
    desk ??= new hovertone.Desk();
    for (const number of heardBy(request)) await decoded.prepare(desk, number);
    const value = answerTo(desk, request, onShare);
    const moved = value && (value as { cells?: Uint8Array }).cells ? [(value as { cells: Uint8Array }).cells.buffer] : [];
    self.postMessage({ id, value }, { transfer: moved as Transferable[] });
  } catch (error) {
    // a trap of the module leaves its memory in an unknown state: the page starts another worker
    const isBroken = error instanceof WebAssembly.RuntimeError;
    self.postMessage({ id, error: isBroken ? "" : String(error), isBroken });
  }
};

/** The files whose sound a request needs. */
function heardBy(request: Request): number[] {
  switch (request.kind) {
    case "hear":
    case "levels":
    case "sound":
      return [request.number];
    case "identify":
      return Object.values(request.files);
    default:
      return [];
  }
}

function answerTo(desk: hovertone.Desk, request: Request, onShare: (share: number) => void): unknown {
  switch (request.kind) {
    case "start":
      return {
        version: hovertone.version(),
        vehicles: JSON.parse(hovertone.vehicles()),
        colours: hovertone.level_colours(),
      };
    case "add":
      files.set(request.number, request.file);
      return desk.add(request.number, request.name, request.file.size);
    case "remove":
      files.delete(request.number);
      decoded.remove(request.number);
      return desk.remove(request.number);
    case "hear":
      return JSON.parse(desk.hear(request.number, JSON.stringify(request.said), onShare));
    case "levels": {
      const { number, spanS, bandHz, columns, rows } = request;
      const levels = desk.levels(number, spanS[0], spanS[1], bandHz[0], bandHz[1], columns, rows);
      const { from_s, to_s, hz_low, hz_high, level_db_low, level_db_high, declared_s } = levels;
      const picture = {
        cells: levels.take(), columns: levels.columns, rows: levels.rows,
        from_s, to_s, hz_low, hz_high, level_db_low, level_db_high, declared_s,
      };
      levels.free();
      return picture;
    }
    case "sound":
      return desk.sound(request.number, request.spanS[0], request.spanS[1]);
    case "identify":
      return JSON.parse(desk.identify(request.text, JSON.stringify(request.files), onShare));
    case "report":
      return desk.report(onShare);
    case "text":
      return hovertone.experiment_text(JSON.stringify(request.entries));
    case "entries":
      return JSON.parse(hovertone.experiment_entries(request.text));
    case "simulators":
      return JSON.parse(hovertone.simulator_lines(request.results));
    case "plan":
      return JSON.parse(hovertone.example_plan());
    case "example":
      return hovertone.example_recording(request.load, request.trial);
  }
}
