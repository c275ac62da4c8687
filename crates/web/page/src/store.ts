// What the page knows. Each of its jobs, which change it, has a file of its own. The experiment file's entries are the one place of vehicle,
// loads and masses.

import type { Entries, Identified, KnownVehicle, Lines } from "./answers";
import { Campaign } from "./campaign";
import { Files } from "./files";
import { Fitting } from "./fitting";
import { Hearing } from "./hearing";
import { Listening } from "./listening";
import { Loads } from "./loads";
import { Observed } from "./observed";
import type { Recording } from "./recording";
import { Cancelled, Requests, wordsOf } from "./requests";
import { Trials } from "./trials";

export interface Fit {
  state: "none" | "running" | "done" | "fault";
  share: number;
  fault?: string;
  result?: Identified;
  reportShare?: number;
}

/** Time without a change after which loads are fitted again. */
const SETTLE_MS = 350;

export class Store extends Observed {
  version = "";
  vehicles: KnownVehicle[] = [];
  colours: Uint8Array = new Uint8Array();
  recordings: Recording[] = [];
  entries: Entries = { vehicle: {} };
  fit: Fit = { state: "none", share: 0 };
  pasted: { name: string; lines: Lines[] } | undefined;
  fault = "";
  /** Progress of what is made for a person: the example, a report. */
  busy: { words: string; share: number } | undefined;
  readonly requests = new Requests();
  readonly listening = new Listening();
  readonly files = new Files(this);
  readonly hearing = new Hearing(this);
  readonly trials = new Trials(this);
  readonly loads = new Loads(this);
  readonly fitting = new Fitting(this);
  readonly campaign = new Campaign(this, this.listening);
  private timers = new Map<string, number>();

  constructor() {
    super();
    let state = this.listening.state;
    this.listening.listen(() => this.listening.state !== state && this.change(() => (state = this.listening.state)));
    void this.start();
  }

  private async start() {
    try {
      const { version, vehicles, colours } = await this.requests.ask({ kind: "start" });
      this.change(() => Object.assign(this, { version, vehicles, colours }));
    } catch (error) {
      this.fail(error);
    }
    await this.trials.takeKept();
  }

  /** Changes what the page knows, and tells those who listen. */
  override change(what: () => void) {
    super.change(what);
    if (this.recordings.some((recording) => recording.isTrial)) this.trials.keepExperiment();
  }

  fail(error: unknown) {
    if (!(error instanceof Cancelled)) this.change(() => (this.fault = wordsOf(error)));
  }

  dismiss() {
    this.change(() => ((this.fault = ""), (this.pasted = undefined)));
  }

  byName(name: string): Recording | undefined {
    return this.recordings.find((recording) => recording.name === name);
  }

  /** Does some work once nothing has asked for it again for a while. */
  soon(what: string, work: () => void) {
    clearTimeout(this.timers.get(what));
    this.timers.set(what, setTimeout(work, SETTLE_MS) as unknown as number);
  }
}
