// The microphone: listening by what is said of the vehicle, and trials, which the browser keeps.

import { keepEntries, keepTrial, keptTrials } from "./kept";
import type { Recording } from "./recording";
import type { Store } from "./store";

export class Trials {
  /** The experiment as it was kept last. */
  private keptText = "";

  constructor(private store: Store) {}

  listen() {
    void this.store.listening.start(this.store.hearing.saidOfVehicle(this.store.campaign.addedKg));
  }

  /** Listens by what is said of the vehicle now. */
  hearLive() {
    this.store.listening.hearBy(this.store.hearing.saidOfVehicle(this.store.campaign.addedKg));
  }

  /** Decides for one of the possible speeds: by the blades, where they decide, so that the trials know it too. */
  choose(index: number) {
    const { blades } = this.store.listening.choices[index];
    if (blades && !this.store.entries.vehicle.blades) this.store.loads.setVehicle({ ...this.store.entries.vehicle, blades });
    else this.store.listening.choose(index);
  }

  /** Takes a trial of the microphone into a load, keeps it, and judges it. */
  take(bytes: Uint8Array<ArrayBuffer>, load: number): Recording {
    const name = `${this.store.loads.all()[load].name.replace(/[^\p{L}\p{N}.+-]+/gu, "_")}_${this.store.loads.all()[load].recordings.length + 1}.wav`;
    const recording = this.store.files.takeRecording(new File([bytes], name, { type: "audio/wav" }), name, { load, isTrial: true });
    void navigator.storage?.persist?.().catch(() => false);
    keepTrial({ name: recording.name, bytes }, this.store.entries).catch(() =>
      this.store.fail(new Error("this browser keeps no trials: save their sound before you close the page")),
    );
    if (!this.store.fitting.isFitted(recording)) this.store.hearing.hear(recording);
    return recording;
  }

  /** Trials of an earlier visit. */
  async takeKept() {
    try {
      const { trials, entries } = await keptTrials();
      if (trials.length === 0) return;
      // who was faster, and has described another vehicle already, keeps it
      if (entries && this.store.recordings.length === 0 && this.store.loads.all().length === 0) this.store.change(() => (this.store.entries = entries));
      for (const { name, bytes, answer } of trials) {
        const recording = this.store.files.takeRecording(new File([bytes], name, { type: "audio/wav" }), name, { isTrial: true, answer });
        if (!answer && !this.store.fitting.isFitted(recording)) this.store.hearing.hear(recording);
      }
    } catch {
      // a browser that keeps nothing has nothing to bring back
    }
  }

  keepExperiment() {
    const text = JSON.stringify(this.store.entries);
    if (text === this.keptText) return;
    this.keptText = text;
    void keepEntries(this.store.entries).catch(() => {});
  }

  /** Takes all trials away, for another vehicle. */
  newCampaign() {
    for (const { isTrial, number } of [...this.store.recordings]) if (isTrial) this.store.files.remove(number);
    this.store.change(() => (this.store.entries = { ...this.store.entries, load: this.store.loads.all().filter((load) => load.recordings.length > 0) }));
    this.store.campaign.nextLoad();
  }
}
