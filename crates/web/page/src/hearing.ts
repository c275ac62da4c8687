// What the worker hears of a recording: its picture, its sound, its answer.

import type { Answer, Picture, Point } from "./answers";
import { keepAnswer } from "./kept";
import { tagOf, type Recording } from "./recording";
import { Cancelled, wordsOf } from "./requests";
import type { Store } from "./store";

/** Columns and rows of the first picture. */
const PICTURE = { columns: 1200, rows: 384 };
const HZ_MAX = 24_000;
const END_S = 1e9;

export class Hearing {
  constructor(private store: Store) {}

  draw(recording: Recording) {
    const { columns, rows } = PICTURE;
    this.levels(recording, [0, END_S], [0, HZ_MAX], columns, rows).then(
      (picture) => this.store.change(() => (recording.picture = picture)),
      () => {}, // the answer has the reason
    );
  }

  levels(recording: Recording, spanS: Point, bandHz: Point, columns: number, rows: number): Promise<Picture> {
    const { number } = recording;
    return this.store.requests.ask({ kind: "levels", number, spanS, bandHz, columns, rows }, { tag: `${tagOf(recording)} levels` });
  }

  forgetLevels(recording: Recording) {
    if (recording.state !== "waiting") this.store.requests.cancel(`${tagOf(recording)} levels`);
  }

  sound(recording: Recording, spanS: Point): Promise<Uint8Array<ArrayBuffer>> {
    return this.store.requests.ask({ kind: "sound", number: recording.number, spanS }, { tag: tagOf(recording) });
  }

  hear(recording: Recording) {
    this.store.requests.cancel(tagOf(recording));
    this.store.change(() => Object.assign(recording, { state: "waiting", share: 0, fault: undefined }));
    const onShare = (share: number) => this.store.change(() => Object.assign(recording, { state: "hearing", share }));
    const said = this.saidOf(recording);
    this.store.requests.ask({ kind: "hear", number: recording.number, said }, { tag: tagOf(recording), onShare }).then(
      (answer) => this.store.change(() => this.setAnswer(recording, answer)),
      (error) => {
        if (error instanceof Cancelled) return;
        this.store.change(() => Object.assign(recording, { state: "heard", answer: undefined, fault: wordsOf(error) }));
      },
    );
  }

  setAnswer(recording: Recording, answer: Answer) {
    Object.assign(recording, { state: "heard", answer, fault: undefined });
    if (recording.isTrial) void keepAnswer(recording.name, answer).catch(() => {});
  }

  cancel(recording: Recording) {
    this.store.requests.cancel(tagOf(recording));
    this.store.change(() => Object.assign(recording, { state: "cancelled", share: 0 }));
  }

  /** Hears the recordings of loads whose fit was given up. */
  hearUnanswered() {
    for (const recording of this.store.recordings) if (!recording.answer && recording.state === "waiting") this.hear(recording);
  }

  hearAll() {
    for (const recording of this.store.recordings) if (!this.store.fitting.isFitted(recording)) this.hear(recording);
  }

  /** What is said of a recording before it is heard: the vehicle, its mass as flown, and the chosen part. */
  private saidOf(recording: Recording) {
    const load = this.store.loads.loadOf(recording);
    const addedKg = load === undefined ? 0 : (this.store.loads.all()[load].added_mass_kg ?? 0);
    const [from_s, to_s] = recording.spanS ?? [];
    return { ...this.saidOfVehicle(addedKg), band_hz: recording.bandHz, from_s, to_s };
  }

  saidOfVehicle(addedKg: number) {
    const { preset, blades, gear, rotors, mass_kg, propeller_diameter_m: diameter_m } = this.store.entries.vehicle;
    const known = this.store.vehicles.some((vehicle) => vehicle.id === preset) ? preset : undefined;
    return { preset: known, blades, gear, rotors, diameter_m, mass_kg: mass_kg && mass_kg + addedKg };
  }
}
