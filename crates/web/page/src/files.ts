// The files of the page: recordings, experiment files and results come in, and recordings go.

import type { Answer } from "./answers";
import { forgetTrial } from "./kept";
import { matches, nameOf, uniqueName } from "./names";
import { fileOf, tagOf, type Recording } from "./recording";
import { wordsOf } from "./requests";
import type { Store } from "./store";

export class Files {
  private nextNumber = 1;

  constructor(private store: Store) {}

  /** Takes files: recordings, experiment files and results. A load may be named for the recordings. */
  async take(files: Iterable<File>, load?: number) {
    this.store.change(() => (this.store.fault = ""));
    const taken: Recording[] = [];
    for (const file of files) {
      const name = nameOf(file);
      if (/\.toml$/i.test(name)) await this.openExperiment(file);
      else if (/\.json$/i.test(name)) await this.openResults(file, name);
      else taken.push(this.takeRecording(file, name, { load }));
    }
    for (const recording of taken) if (!this.store.fitting.isFitted(recording)) this.store.hearing.hear(recording);
  }

  takeRecording(file: File, name: string, { load, isTrial = false, answer }: { load?: number; isTrial?: boolean; answer?: Answer } = {}): Recording {
    const wanted = this.store.loads.all().flatMap((each) => each.recordings.map(fileOf)).filter((each) => !this.store.byName(each));
    const known = wanted.find((each) => matches(each, name));
    const number = this.nextNumber++;
    const recording: Recording = {
      number, file, name: known ?? uniqueName(name, (each) => this.store.byName(each) !== undefined),
      url: URL.createObjectURL(file), state: answer ? "heard" : "waiting", share: 0, answer, isTrial,
      isOpen: this.store.recordings.length === 0 && !isTrial,
    };
    this.store.requests.add(number, recording.name, file);
    this.store.change(() => this.store.recordings.push(recording));
    if (load !== undefined) this.store.loads.put(number, load);
    this.store.hearing.draw(recording);
    if (known) this.store.fitting.fitSoon();
    return recording;
  }

  remove(number: number) {
    const recording = this.store.recordings.find((each) => each.number === number);
    if (!recording) return;
    const load = this.store.loads.loadOf(recording);
    this.store.requests.cancel(tagOf(recording));
    this.store.requests.remove(number);
    URL.revokeObjectURL(recording.url);
    if (recording.isTrial) void forgetTrial(recording.name).catch(() => {});
    this.store.change(() => {
      this.store.loads.takeOut(recording.name);
      this.store.recordings = this.store.recordings.filter((each) => each !== recording);
    });
    if (load !== undefined) this.store.fitting.fitSoon();
  }

  private async openExperiment(file: File) {
    try {
      const entries = await this.store.requests.ask({ kind: "entries", text: await file.text() }, { first: true });
      this.store.change(() => {
        this.store.entries = { ...entries, vehicle: entries.vehicle ?? {} };
        for (const load of this.store.loads.all()) {
          const names = load.recordings.flatMap((each) => {
            const pattern = fileOf(each);
            const found = this.store.recordings.filter((recording) => matches(pattern, recording.name));
            return found.length > 0 ? found.map((recording) => recording.name) : [each];
          });
          load.recordings = names;
        }
      });
      this.store.hearing.hearAll();
      this.store.fitting.fitSoon();
    } catch (error) {
      this.store.fail(new Error(`${file.name}: ${wordsOf(error)}`));
    }
  }

  private async openResults(file: File, name: string) {
    try {
      const lines = await this.store.requests.ask({ kind: "simulators", results: await file.text() }, { first: true });
      this.store.change(() => (this.store.pasted = { name, lines }));
    } catch (error) {
      this.store.fail(new Error(`${name}: ${wordsOf(error)}`));
    }
  }

  /** Simulated hovers of the paper's vehicle with three loads. */
  async example() {
    const say = (share: number) =>
      this.store.change(() => (this.store.busy = { words: "A drone is flown in simulation", share }));
    try {
      say(0);
      const { experiment, recordings } = await this.store.requests.ask({ kind: "plan" });
      for (const [index, { name, load, trial }] of recordings.entries()) {
        const bytes = await this.store.requests.ask({ kind: "example", load, trial }, { first: true });
        say((index + 1) / recordings.length);
        if (index === 0) this.store.change(() => (this.store.entries = { ...experiment, load: [] }));
        this.store.hearing.hear(this.takeRecording(new File([bytes], name, { type: "audio/wav" }), name));
      }
      this.store.change(() => (this.store.entries = experiment));
      this.store.fitting.fitSoon();
    } catch (error) {
      this.store.fail(error);
    } finally {
      this.store.change(() => (this.store.busy = undefined));
    }
  }

  toggle(recording: Recording) {
    this.store.change(() => (recording.isOpen = !recording.isOpen));
  }
}
