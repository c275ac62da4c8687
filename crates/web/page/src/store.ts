// What the page knows, and what changes it. The experiment file's entries are the one place of vehicle, loads and masses.

import type { Answer, Entries, Identified, KnownVehicle, Lines, LoadEntries, Picture, Point, VehicleEntries } from "./answers";
import { Campaign } from "./campaign";
import { forgetTrial, keepAnswer, keepEntries, keepTrial, keptTrials } from "./kept";
import { Listening } from "./listening";
import { nameOf, uniqueName, matches } from "./names";
import { Observed } from "./observed";
import { Cancelled, Requests } from "./requests";

export interface Recording {
  number: number;
  name: string;
  file: File;
  url: string;
  state: "waiting" | "hearing" | "heard" | "cancelled";
  share: number;
  answer?: Answer;
  fault?: string;
  picture?: Picture;
  isOpen: boolean;
  /** A trial of the microphone, which the browser keeps. */
  isTrial: boolean;
  /** The part that a person chose, where the recording is in no load. */
  spanS?: Point;
  bandHz?: Point;
}

export interface Fit {
  state: "none" | "running" | "done" | "fault";
  share: number;
  fault?: string;
  result?: Identified;
  reportShare?: number;
}

/** Columns and rows of the first picture. */
const PICTURE = { columns: 1200, rows: 384 };
const HZ_MAX = 24_000;
const END_S = 1e9;
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
  readonly listening = new Listening();
  readonly campaign = new Campaign(this, this.listening);
  private requests = new Requests();
  private nextNumber = 1;
  private timers = new Map<string, number>();

  /** The experiment as it was kept last. */
  private keptText = "";

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
    await this.takeKept();
  }

  protected override change(what: () => void) {
    super.change(what);
    if (this.recordings.some((recording) => recording.isTrial)) this.keepExperiment();
  }

  fail(error: unknown) {
    if (!(error instanceof Cancelled)) this.change(() => (this.fault = wordsOf(error)));
  }

  dismiss() {
    this.change(() => ((this.fault = ""), (this.pasted = undefined)));
  }

  // --- files ---

  /** Takes files: recordings, experiment files and results. A load may be named for the recordings. */
  async take(files: Iterable<File>, load?: number) {
    this.change(() => (this.fault = ""));
    const taken: Recording[] = [];
    for (const file of files) {
      const name = nameOf(file);
      if (/\.toml$/i.test(name)) await this.openExperiment(file);
      else if (/\.json$/i.test(name)) await this.openResults(file, name);
      else taken.push(this.takeRecording(file, name, { load }));
    }
    for (const recording of taken) if (!this.isFitted(recording)) this.hear(recording);
  }

  /** Whether the fit of the loads hears a recording, with its load. */
  isFitted(recording: Recording): boolean {
    return this.loadOf(recording) !== undefined && this.lacks().length === 0;
  }

  private takeRecording(file: File, name: string, { load, isTrial = false, answer }: { load?: number; isTrial?: boolean; answer?: Answer } = {}): Recording {
    const wanted = this.loads().flatMap((each) => each.recordings.map(fileOf)).filter((each) => !this.byName(each));
    const known = wanted.find((each) => matches(each, name));
    const number = this.nextNumber++;
    const recording: Recording = {
      number, file, name: known ?? uniqueName(name, (each) => this.byName(each) !== undefined),
      url: URL.createObjectURL(file), state: answer ? "heard" : "waiting", share: 0, answer, isTrial,
      isOpen: this.recordings.length === 0 && !isTrial,
    };
    this.requests.add(number, recording.name, file);
    this.change(() => this.recordings.push(recording));
    if (load !== undefined) this.put(number, load);
    this.draw(recording);
    if (known) this.fitSoon();
    return recording;
  }

  remove(number: number) {
    const recording = this.recordings.find((each) => each.number === number);
    if (!recording) return;
    const load = this.loadOf(recording);
    this.requests.cancel(tagOf(recording));
    this.requests.remove(number);
    URL.revokeObjectURL(recording.url);
    if (recording.isTrial) void forgetTrial(recording.name).catch(() => {});
    this.change(() => {
      this.takeOut(recording.name);
      this.recordings = this.recordings.filter((each) => each !== recording);
    });
    if (load !== undefined) this.fitSoon();
  }

  private async openExperiment(file: File) {
    try {
      const entries = await this.requests.ask({ kind: "entries", text: await file.text() }, { first: true });
      this.change(() => {
        this.entries = { ...entries, vehicle: entries.vehicle ?? {} };
        for (const load of this.loads()) {
          const names = load.recordings.flatMap((each) => {
            const pattern = fileOf(each);
            const found = this.recordings.filter((recording) => matches(pattern, recording.name));
            return found.length > 0 ? found.map((recording) => recording.name) : [each];
          });
          load.recordings = names;
        }
      });
      this.hearAll();
      this.fitSoon();
    } catch (error) {
      this.fail(new Error(`${file.name}: ${wordsOf(error)}`));
    }
  }

  private async openResults(file: File, name: string) {
    try {
      const lines = await this.requests.ask({ kind: "simulators", results: await file.text() }, { first: true });
      this.change(() => (this.pasted = { name, lines }));
    } catch (error) {
      this.fail(new Error(`${name}: ${wordsOf(error)}`));
    }
  }

  // --- hearing ---

  private draw(recording: Recording) {
    const { columns, rows } = PICTURE;
    this.levels(recording, [0, END_S], [0, HZ_MAX], columns, rows).then(
      (picture) => this.change(() => (recording.picture = picture)),
      () => {}, // the answer has the reason
    );
  }

  levels(recording: Recording, spanS: Point, bandHz: Point, columns: number, rows: number): Promise<Picture> {
    const { number } = recording;
    return this.requests.ask({ kind: "levels", number, spanS, bandHz, columns, rows }, { tag: `${tagOf(recording)} levels` });
  }

  forgetLevels(recording: Recording) {
    if (recording.state !== "waiting") this.requests.cancel(`${tagOf(recording)} levels`);
  }

  sound(recording: Recording, spanS: Point): Promise<Uint8Array<ArrayBuffer>> {
    return this.requests.ask({ kind: "sound", number: recording.number, spanS }, { tag: tagOf(recording) });
  }

  hear(recording: Recording) {
    this.requests.cancel(tagOf(recording));
    this.change(() => Object.assign(recording, { state: "waiting", share: 0, fault: undefined }));
    const onShare = (share: number) => this.change(() => Object.assign(recording, { state: "hearing", share }));
    const said = this.saidOf(recording);
    this.requests.ask({ kind: "hear", number: recording.number, said }, { tag: tagOf(recording), onShare }).then(
      (answer) => this.change(() => this.setAnswer(recording, answer)),
      (error) => {
        if (error instanceof Cancelled) return;
        this.change(() => Object.assign(recording, { state: "heard", answer: undefined, fault: wordsOf(error) }));
      },
    );
  }

  private setAnswer(recording: Recording, answer: Answer) {
    Object.assign(recording, { state: "heard", answer, fault: undefined });
    if (recording.isTrial) void keepAnswer(recording.name, answer).catch(() => {});
  }

  cancel(recording: Recording) {
    this.requests.cancel(tagOf(recording));
    this.change(() => Object.assign(recording, { state: "cancelled", share: 0 }));
  }

  cancelFit() {
    this.requests.cancel("fit");
    this.change(() => (this.fit = { state: "none", share: 0 }));
    for (const recording of this.recordings) if (!recording.answer && recording.state === "waiting") this.hear(recording);
  }

  private hearAll() {
    for (const recording of this.recordings) if (!this.isFitted(recording)) this.hear(recording);
  }

  /** What is said of a recording before it is heard: the vehicle, its mass as flown, and the chosen part. */
  private saidOf(recording: Recording) {
    const load = this.loadOf(recording);
    const addedKg = load === undefined ? 0 : (this.loads()[load].added_mass_kg ?? 0);
    const [from_s, to_s] = recording.spanS ?? [];
    return { ...this.saidOfVehicle(addedKg), band_hz: recording.bandHz, from_s, to_s };
  }

  private saidOfVehicle(addedKg: number) {
    const { preset, blades, gear, rotors, mass_kg, propeller_diameter_m: diameter_m } = this.entries.vehicle;
    const known = this.vehicles.some((vehicle) => vehicle.id === preset) ? preset : undefined;
    return { preset: known, blades, gear, rotors, diameter_m, mass_kg: mass_kg && mass_kg + addedKg };
  }

  // --- the microphone ---

  startListening() {
    void this.listening.start(this.saidOfVehicle(this.campaign.addedKg));
  }

  /** Listens by what is said of the vehicle now. */
  hearLive() {
    this.listening.hearBy(this.saidOfVehicle(this.campaign.addedKg));
  }

  /** Decides for one of the possible speeds: by the blades, where they decide, so that the trials know it too. */
  chooseLive(index: number) {
    const { blades } = this.listening.choices[index];
    if (blades && !this.entries.vehicle.blades) this.setVehicle({ ...this.entries.vehicle, blades });
    else this.listening.choose(index);
  }

  /** Takes a trial of the microphone into a load, keeps it, and judges it. */
  takeTrial(bytes: Uint8Array<ArrayBuffer>, load: number): Recording {
    const name = `${this.loads()[load].name.replace(/[^\p{L}\p{N}.+-]+/gu, "_")}_${this.loads()[load].recordings.length + 1}.wav`;
    const recording = this.takeRecording(new File([bytes], name, { type: "audio/wav" }), name, { load, isTrial: true });
    void navigator.storage?.persist?.().catch(() => false);
    keepTrial({ name: recording.name, bytes }, this.entries).catch(() =>
      this.fail(new Error("this browser keeps no trials: save their sound before you close the page")),
    );
    if (!this.isFitted(recording)) this.hear(recording);
    return recording;
  }

  /** Trials of an earlier visit. */
  private async takeKept() {
    try {
      const { trials, entries } = await keptTrials();
      if (trials.length === 0) return;
      // who was faster, and has described another vehicle already, keeps it
      if (entries && this.recordings.length === 0 && this.loads().length === 0) this.change(() => (this.entries = entries));
      for (const { name, bytes, answer } of trials) {
        const recording = this.takeRecording(new File([bytes], name, { type: "audio/wav" }), name, { isTrial: true, answer });
        if (!answer && !this.isFitted(recording)) this.hear(recording);
      }
    } catch {
      // a browser that keeps nothing has nothing to bring back
    }
  }

  private keepExperiment() {
    const text = JSON.stringify(this.entries);
    if (text === this.keptText) return;
    this.keptText = text;
    void keepEntries(this.entries).catch(() => {});
  }

  /** Takes all trials away, for another vehicle. */
  newCampaign() {
    for (const { isTrial, number } of [...this.recordings]) if (isTrial) this.remove(number);
    this.change(() => (this.entries = { ...this.entries, load: this.loads().filter((load) => load.recordings.length > 0) }));
    this.campaign.nextLoad();
  }

  // --- the experiment ---

  loads(): LoadEntries[] {
    return (this.entries.load ??= []);
  }

  byName(name: string): Recording | undefined {
    return this.recordings.find((recording) => recording.name === name);
  }

  loadOf(recording: Recording): number | undefined {
    const index = this.loads().findIndex((load) => load.recordings.some((each) => fileOf(each) === recording.name));
    return index < 0 ? undefined : index;
  }

  recordingsOf(load: LoadEntries): { name: string; recording?: Recording }[] {
    return load.recordings.map((each) => ({ name: fileOf(each), recording: this.byName(fileOf(each)) }));
  }

  setVehicle(vehicle: VehicleEntries) {
    this.change(() => (this.entries = { ...this.entries, vehicle: withoutNothing(vehicle) }));
    this.soon("hear", () => this.hearAll());
    this.hearLive();
    this.fitSoon();
  }

  addLoad(): number {
    const number = this.loads().length + 1;
    this.change(() => this.loads().push({ name: `load ${number}`, added_mass_kg: 0, recordings: [] }));
    return number - 1;
  }

  /** The load with a mass: one of the same mass, one without recordings, or a new one. */
  loadOfMass(addedKg: number): number {
    const loads = this.loads();
    const same = loads.findIndex((load) => (load.added_mass_kg ?? 0) === addedKg);
    const empty = loads.findIndex((load) => load.recordings.length === 0);
    const load = same >= 0 ? same : empty >= 0 ? empty : this.addLoad();
    this.setLoad(load, { added_mass_kg: addedKg });
    return load;
  }

  setLoad(index: number, load: Partial<LoadEntries>) {
    this.change(() => Object.assign(this.loads()[index], load));
    this.fitSoon();
  }

  removeLoad(index: number) {
    this.change(() => this.loads().splice(index, 1));
    this.fitSoon();
  }

  /** Puts a recording into a load, or into none. */
  put(number: number, load: number | undefined) {
    const recording = this.recordings.find((each) => each.number === number);
    if (!recording || this.loadOf(recording) === load) return;
    this.change(() => {
      this.takeOut(recording.name);
      if (load !== undefined) this.loads()[load].recordings.push(recording.name);
    });
    this.fitSoon();
    if (load === undefined && recording.answer) this.hear(recording);
  }

  private takeOut(name: string) {
    for (const load of this.loads()) load.recordings = load.recordings.filter((each) => fileOf(each) !== name);
  }

  forget(load: LoadEntries, name: string) {
    this.change(() => (load.recordings = load.recordings.filter((each) => fileOf(each) !== name)));
    this.fitSoon();
  }

  /** The part of a recording to use; in a load it holds for all its recordings. */
  setSpan(recording: Recording, spanS: Point | undefined) {
    const load = this.loadOf(recording);
    if (load === undefined) {
      this.change(() => (recording.spanS = spanS));
      this.soon(`span ${recording.number}`, () => this.hear(recording));
    } else this.setLoad(load, { from_s: spanS?.[0], to_s: spanS?.[1] });
  }

  spanOf(recording: Recording): Point | undefined {
    const load = this.loadOf(recording);
    if (load === undefined) return recording.spanS;
    const { from_s, to_s } = this.loads()[load];
    return typeof from_s === "number" && typeof to_s === "number" ? [from_s, to_s] : undefined;
  }

  /** The band of the tone; in a load it holds for the experiment. */
  setBand(recording: Recording, bandHz: Point | undefined) {
    if (this.loadOf(recording) === undefined) {
      this.change(() => (recording.bandHz = bandHz));
      this.soon(`span ${recording.number}`, () => this.hear(recording));
    } else {
      this.change(() => (this.entries = { ...this.entries, tone: { ...this.entries.tone, band_hz: bandHz } }));
      this.fitSoon();
    }
  }

  bandOf(recording: Recording): Point | undefined {
    return this.loadOf(recording) === undefined ? recording.bandHz : this.entries.tone?.band_hz;
  }

  /** What the experiment still lacks; empty where it can be fitted. */
  lacks(): string[] {
    const { vehicle } = this.entries;
    const loads = this.loads();
    const known = this.vehicles.find((each) => each.id === vehicle.preset);
    const missing: string[] = [];
    const hasTone = vehicle.blades || vehicle.gear || known?.blade_count || known?.gear || (this.entries.tone as { order?: unknown })?.order;
    if (!vehicle.preset && !vehicle.rotors) missing.push("the number of rotors");
    if (!hasTone) missing.push("the blades of a propeller");
    if (!vehicle.mass_kg && !known?.mass_kg) missing.push("the mass of the vehicle");
    if (loads.every((load) => load.recordings.length === 0)) missing.push("a recording in a load");
    const absent = loads.flatMap((load) => this.recordingsOf(load)).filter(({ recording }) => !recording);
    for (const { name } of absent.slice(0, 3)) missing.push(`the recording ${name}: drop it here`);
    return missing;
  }

  private fitSoon() {
    this.requests.cancel("fit");
    if (this.lacks().length > 0) return this.change(() => (this.fit = { state: "none", share: 0 }));
    this.change(() => (this.fit = { ...this.fit, state: "running", share: 0, fault: undefined }));
    this.soon("fit", () => void this.runFit());
  }

  /** The experiment as a file: without loads that have no recording. */
  async experimentText(): Promise<string> {
    const load = this.loads().filter((each) => each.recordings.length > 0);
    return this.requests.ask({ kind: "text", entries: { ...this.entries, load } }, { first: true });
  }

  private async runFit() {
    const files = Object.fromEntries(this.recordings.map((recording) => [recording.name, recording.number]));
    const onShare = (share: number) => this.change(() => (this.fit = { ...this.fit, state: "running", share }));
    try {
      const text = await this.experimentText();
      const result = await this.requests.ask({ kind: "identify", text, files }, { tag: "fit", onShare });
      this.change(() => {
        this.fit = { state: "done", share: 1, result };
        for (const { file, answer } of result.inputs) {
          const recording = this.recordings.find((each) => each.number === file);
          if (recording) this.setAnswer(recording, answer);
        }
      });
    } catch (error) {
      if (error instanceof Cancelled) return;
      this.change(() => (this.fit = { state: "fault", share: 0, fault: wordsOf(error) }));
      for (const recording of this.recordings) if (!recording.answer && recording.state === "waiting") this.hear(recording);
    }
  }

  async report(): Promise<string> {
    const onShare = (share: number) => this.change(() => (this.busy = { words: "The report is written", share }));
    onShare(0);
    try {
      return await this.requests.ask({ kind: "report" }, { tag: "report", onShare });
    } finally {
      this.change(() => (this.busy = undefined));
    }
  }

  /** Simulated hovers of the paper's vehicle with three loads. */
  async example() {
    const say = (share: number) =>
      this.change(() => (this.busy = { words: "A drone is flown in simulation", share }));
    try {
      say(0);
      const { experiment, recordings } = await this.requests.ask({ kind: "plan" });
      for (const [index, { name, load, trial }] of recordings.entries()) {
        const bytes = await this.requests.ask({ kind: "example", load, trial }, { first: true });
        say((index + 1) / recordings.length);
        if (index === 0) this.change(() => (this.entries = { ...experiment, load: [] }));
        this.hear(this.takeRecording(new File([bytes], name, { type: "audio/wav" }), name));
      }
      this.change(() => (this.entries = experiment));
      this.fitSoon();
    } catch (error) {
      this.fail(error);
    } finally {
      this.change(() => (this.busy = undefined));
    }
  }

  toggle(recording: Recording) {
    this.change(() => (recording.isOpen = !recording.isOpen));
  }

  private soon(what: string, work: () => void) {
    clearTimeout(this.timers.get(what));
    this.timers.set(what, setTimeout(work, SETTLE_MS) as unknown as number);
  }
}

export function fileOf(recording: string | { file: string }): string {
  return typeof recording === "string" ? recording : recording.file;
}

export function wordsOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

function tagOf(recording: Recording): string {
  return `recording ${recording.number}`;
}

function withoutNothing(vehicle: VehicleEntries): VehicleEntries {
  return Object.fromEntries(Object.entries(vehicle).filter(([, value]) => value !== undefined && value !== ""));
}
