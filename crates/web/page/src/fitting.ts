// The fit of the loads: when it runs, what it lacks, and what is written of its result.

import type { Recording } from "./recording";
import { Cancelled, wordsOf } from "./requests";
import type { Store } from "./store";

export class Fitting {
  constructor(private store: Store) {}

  /** Whether the fit of the loads hears a recording, with its load. */
  isFitted(recording: Recording): boolean {
    return this.store.loads.loadOf(recording) !== undefined && this.lacks().length === 0;
  }

  /** What the experiment still lacks; empty where it can be fitted. */
  lacks(): string[] {
    const { vehicle } = this.store.entries;
    const loads = this.store.loads.all();
    const known = this.store.vehicles.find((each) => each.id === vehicle.preset);
    const missing: string[] = [];
    const hasTone = vehicle.blades || vehicle.gear || known?.blade_count || known?.gear || (this.store.entries.tone as { order?: unknown })?.order;
    if (!vehicle.preset && !vehicle.rotors) missing.push("the number of rotors");
    if (!hasTone) missing.push("the blades of a propeller");
    if (!vehicle.mass_kg && !known?.mass_kg) missing.push("the mass of the vehicle");
    if (loads.every((load) => load.recordings.length === 0)) missing.push("a recording in a load");
    const absent = loads.flatMap((load) => this.store.loads.recordingsOf(load)).filter(({ recording }) => !recording);
    for (const { name } of absent.slice(0, 3)) missing.push(`the recording ${name}: drop it here`);
    return missing;
  }

  fitSoon() {
    this.store.requests.cancel("fit");
    if (this.lacks().length > 0) return this.store.change(() => (this.store.fit = { state: "none", share: 0 }));
    this.store.change(() => (this.store.fit = { ...this.store.fit, state: "running", share: 0, fault: undefined }));
    this.store.soon("fit", () => void this.runFit());
  }

  /** The experiment as a file: without loads that have no recording. */
  async experimentText(): Promise<string> {
    const load = this.store.loads.all().filter((each) => each.recordings.length > 0);
    return this.store.requests.ask({ kind: "text", entries: { ...this.store.entries, load } }, { first: true });
  }

  private async runFit() {
    const files = Object.fromEntries(this.store.recordings.map((recording) => [recording.name, recording.number]));
    const onShare = (share: number) => this.store.change(() => (this.store.fit = { ...this.store.fit, state: "running", share }));
    try {
      const text = await this.experimentText();
      const result = await this.store.requests.ask({ kind: "identify", text, files }, { tag: "fit", onShare });
      this.store.change(() => {
        this.store.fit = { state: "done", share: 1, result };
        for (const { file, answer } of result.inputs) {
          const recording = this.store.recordings.find((each) => each.number === file);
          if (recording) this.store.hearing.setAnswer(recording, answer);
        }
      });
    } catch (error) {
      if (error instanceof Cancelled) return;
      this.store.change(() => (this.store.fit = { state: "fault", share: 0, fault: wordsOf(error) }));
      this.store.hearing.hearUnanswered();
    }
  }

  async report(): Promise<string> {
    const onShare = (share: number) => this.store.change(() => (this.store.busy = { words: "The report is written", share }));
    onShare(0);
    try {
      return await this.store.requests.ask({ kind: "report" }, { tag: "report", onShare });
    } finally {
      this.store.change(() => (this.store.busy = undefined));
    }
  }

  cancel() {
    this.store.requests.cancel("fit");
    this.store.change(() => (this.store.fit = { state: "none", share: 0 }));
    this.store.hearing.hearUnanswered();
  }
}
