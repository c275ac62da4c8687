// The page's side of the worker: requests in a queue, one at a time. To cancel the running one, the worker is ended and another is
// started; files are handed to it again, and records are made again where they are needed.

import type { Answer, Entries, ExamplePlan, Identified, Lines, Picture, Point, Start } from "./answers";

export type Request =
  | { kind: "start" }
  | { kind: "add"; number: number; name: string; file: File }
  | { kind: "remove"; number: number }
  | { kind: "hear"; number: number; said: unknown }
  | { kind: "levels"; number: number; spanS: Point; bandHz: Point; columns: number; rows: number }
  | { kind: "sound"; number: number; spanS: Point }
  | { kind: "identify"; text: string; files: Record<string, number> }
  | { kind: "report" }
  | { kind: "text"; entries: Entries }
  | { kind: "entries"; text: string }
  | { kind: "simulators"; results: string }
  | { kind: "plan" }
  | { kind: "example"; load: number; trial: number };

interface Answers {
  start: Start;
  add: void;
  remove: void;
  hear: Answer;
  levels: Picture;
  sound: Uint8Array<ArrayBuffer>;
  identify: Identified;
  report: string;
  text: string;
  entries: Entries;
  simulators: Lines[];
  plan: ExamplePlan;
  example: Uint8Array<ArrayBuffer>;
}

interface Waiting {
  id: number;
  request: Request;
  tag: string;
  onShare?: (share: number) => void;
  resolve: (value: never) => void;
  reject: (error: Error) => void;
}

/** A request that was cancelled: nobody waits for its answer. */
export class Cancelled extends Error {}

export function wordsOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

const BROKEN = "this broke the analysis: that is a fault of hovertone; please report it";

export class Requests {
  private worker: Worker;
  private queue: Waiting[] = [];
  private running: Waiting | undefined;
  private files = new Map<number, { name: string; file: File }>();
  private nextId = 1;

  constructor() {
    this.worker = this.started();
  }

  /** Sends a request. `tag` names what it is about, for `cancel`; `first` lets it overtake all that wait. */
  ask<R extends Request>(
    request: R,
    options: { tag?: string; first?: boolean; onShare?: (share: number) => void } = {},
  ): Promise<Answers[R["kind"]]> {
    return new Promise((resolve, reject) => {
      const { tag = "", onShare } = options;
      const waiting = { id: this.nextId++, request, tag, onShare, resolve: resolve as never, reject };
      if (options.first) this.queue.unshift(waiting);
      else this.queue.push(waiting);
      this.next();
    });
  }

  add(number: number, name: string, file: File) {
    this.files.set(number, { name, file });
    void this.ask({ kind: "add", number, name, file }).catch(() => {});
  }

  remove(number: number) {
    this.files.delete(number);
    void this.ask({ kind: "remove", number }).catch(() => {});
  }

  /** Ends all requests of a tag, the running one too. */
  cancel(tag: string) {
    const [gone, kept] = [this.queue.filter((w) => w.tag === tag), this.queue.filter((w) => w.tag !== tag)];
    this.queue = kept;
    for (const waiting of gone) waiting.reject(new Cancelled());
    if (this.running?.tag === tag) this.restart(new Cancelled());
  }

  private started(): Worker {
    const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    worker.onmessage = ({ data }) => this.answered(data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.restart(new Error("the page could not start its worker: load the page again"));
    };
    return worker;
  }

  private restart(error: Error) {
    this.worker.terminate();
    const { running } = this;
    this.running = undefined;
    this.worker = this.started();
    const adds = [...this.files].map(([number, { name, file }]) => ({
      id: this.nextId++, request: { kind: "add" as const, number, name, file }, tag: "", resolve: () => {}, reject: () => {},
    }));
    this.queue = [...adds, ...this.queue.filter((waiting) => waiting.request.kind !== "add")];
    // whose adding waits in the queue resolves now: the file is handed over before anything else
    running?.reject(error);
    this.next();
  }

  private next() {
    if (this.running || this.queue.length === 0) return;
    this.running = this.queue.shift();
    this.worker.postMessage({ id: this.running!.id, request: this.running!.request });
  }

  private answered(data: { id: number; share?: number; value?: unknown; error?: string; isBroken?: boolean }) {
    const { running } = this;
    if (!running || running.id !== data.id) return;
    if (data.share !== undefined) return running.onShare?.(data.share);
    if (data.isBroken) return this.restart(new Error(BROKEN));
    this.running = undefined;
    if (data.error !== undefined) running.reject(new Error(data.error));
    else running.resolve(data.value as never);
    this.next();
  }
}
