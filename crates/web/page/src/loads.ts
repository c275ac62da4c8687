// The entries of the experiment: the vehicle, its loads with their recordings, and the parts of recordings to use.

import type { LoadEntries, Point, VehicleEntries } from "./answers";
import { fileOf, type Recording } from "./recording";
import type { Store } from "./store";

export class Loads {
  constructor(private store: Store) {}

  all(): LoadEntries[] {
    return (this.store.entries.load ??= []);
  }

  loadOf(recording: Recording): number | undefined {
    const index = this.all().findIndex((load) => load.recordings.some((each) => fileOf(each) === recording.name));
    return index < 0 ? undefined : index;
  }

  recordingsOf(load: LoadEntries): { name: string; recording?: Recording }[] {
    return load.recordings.map((each) => ({ name: fileOf(each), recording: this.store.byName(fileOf(each)) }));
  }

  setVehicle(vehicle: VehicleEntries) {
    this.store.change(() => (this.store.entries = { ...this.store.entries, vehicle: withoutNothing(vehicle) }));
    this.store.soon("hear", () => this.store.hearing.hearAll());
    this.store.trials.hearLive();
    this.store.fitting.fitSoon();
  }

  addLoad(): number {
    const number = this.all().length + 1;
    this.store.change(() => this.all().push({ name: `load ${number}`, added_mass_kg: 0, recordings: [] }));
    return number - 1;
  }

  /** The load with a mass: one of the same mass, one without recordings, or a new one. */
  loadOfMass(addedKg: number): number {
    const loads = this.all();
    const same = loads.findIndex((load) => (load.added_mass_kg ?? 0) === addedKg);
    const empty = loads.findIndex((load) => load.recordings.length === 0);
    const load = same >= 0 ? same : empty >= 0 ? empty : this.addLoad();
    this.setLoad(load, { added_mass_kg: addedKg });
    return load;
  }

  setLoad(index: number, load: Partial<LoadEntries>) {
    this.store.change(() => Object.assign(this.all()[index], load));
    this.store.fitting.fitSoon();
  }

  removeLoad(index: number) {
    this.store.change(() => this.all().splice(index, 1));
    this.store.fitting.fitSoon();
  }

  /** Puts a recording into a load, or into none. */
  put(number: number, load: number | undefined) {
    const recording = this.store.recordings.find((each) => each.number === number);
    if (!recording || this.loadOf(recording) === load) return;
    this.store.change(() => {
      this.takeOut(recording.name);
      if (load !== undefined) this.all()[load].recordings.push(recording.name);
    });
    this.store.fitting.fitSoon();
    if (load === undefined && recording.answer) this.store.hearing.hear(recording);
  }

  takeOut(name: string) {
    for (const load of this.all()) load.recordings = load.recordings.filter((each) => fileOf(each) !== name);
  }

  forget(load: LoadEntries, name: string) {
    this.store.change(() => (load.recordings = load.recordings.filter((each) => fileOf(each) !== name)));
    this.store.fitting.fitSoon();
  }

  /** The part of a recording to use; in a load it holds for all its recordings. */
  setSpan(recording: Recording, spanS: Point | undefined) {
    const load = this.loadOf(recording);
    if (load === undefined) {
      this.store.change(() => (recording.spanS = spanS));
      this.store.soon(`span ${recording.number}`, () => this.store.hearing.hear(recording));
    } else this.setLoad(load, { from_s: spanS?.[0], to_s: spanS?.[1] });
  }

  spanOf(recording: Recording): Point | undefined {
    const load = this.loadOf(recording);
    if (load === undefined) return recording.spanS;
    const { from_s, to_s } = this.all()[load];
    return typeof from_s === "number" && typeof to_s === "number" ? [from_s, to_s] : undefined;
  }

  /** The band of the tone; in a load it holds for the experiment. */
  setBand(recording: Recording, bandHz: Point | undefined) {
    if (this.loadOf(recording) === undefined) {
      this.store.change(() => (recording.bandHz = bandHz));
      this.store.soon(`span ${recording.number}`, () => this.store.hearing.hear(recording));
    } else {
      this.store.change(() => (this.store.entries = { ...this.store.entries, tone: { ...this.store.entries.tone, band_hz: bandHz } }));
      this.store.fitting.fitSoon();
    }
  }

  bandOf(recording: Recording): Point | undefined {
    return this.loadOf(recording) === undefined ? recording.bandHz : this.store.entries.tone?.band_hz;
  }
}

function withoutNothing(vehicle: VehicleEntries): VehicleEntries {
  return Object.fromEntries(Object.entries(vehicle).filter(([, value]) => value !== undefined && value !== ""));
}
