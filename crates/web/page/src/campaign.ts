// The guided campaign: weigh, hover, land, add a load. Each trial is recorded as the microphone hears it, and judged at once.

import type { Answer, Told } from "./answers";
import type { Listening } from "./listening";
import { Observed } from "./observed";
import type { Recording } from "./recording";
import type { Store } from "./store";

/** Length of a trial. */
export const TRIAL_S = 10;
/** Shortest hover in a trial that counts: one sample of the paper's tables. */
const HOVER_S_MIN = 5;
/** A rotor tone of this length begins the trial. */
const HEARD_S = 1;
/** A tone that is away for longer is lost: the trial begins anew. */
const LOST_S = 1.5;

export type Phase = "weigh" | "hover" | "recording" | "judging" | "judged";

export class Campaign extends Observed {
  phase: Phase = "weigh";
  addedKg = 0;
  recordedS = 0;
  note = "";
  trial: Recording | undefined;
  private load = 0;
  /** When the tone came, or when it went. */
  private sinceS: number | undefined;
  /** A person began the trial: it does not depend on the live speed. */
  private isByHand = false;

  constructor(private store: Store, private listening: Listening) {
    super();
    listening.onTold = (told) => this.hear(told);
    store.listen(() => this.phase === "judging" && this.trial?.state === "heard" && this.go("judged"));
    // a trial that is not recorded to its end is lost with the microphone
    listening.listen(() => listening.state === "off" && this.phase !== "weigh" && !this.trial && this.go("weigh"));
  }

  private go(phase: Phase, note = "") {
    this.sinceS = undefined;
    this.change(() => ((this.phase = phase), (this.note = note)));
  }

  /** Whether no load has been flown yet. */
  get isFirst(): boolean {
    return this.store.loads.all().every((load) => load.recordings.length === 0);
  }

  weigh(addedKg: number) {
    this.change(() => (this.addedKg = addedKg));
    this.store.trials.hearLive();
  }

  /** A person is about to take off. */
  ready() {
    this.load = this.store.loads.loadOfMass(this.addedKg);
    this.isByHand = false;
    this.trial = undefined;
    this.go("hover");
  }

  /** Starts the trial without waiting for a rotor tone. */
  beginNow() {
    this.isByHand = true;
    this.begin();
  }

  private begin() {
    this.listening.begin(TRIAL_S);
    this.recordedS = 0;
    this.go("recording");
  }

  cancel() {
    void this.listening.end();
    this.go("weigh");
  }

  /** Takes a trial away that is not good, and flies it again. */
  flyAgain() {
    if (this.trial) this.store.files.remove(this.trial.number);
    this.ready();
  }

  nextLoad() {
    this.trial = undefined;
    this.go("weigh");
  }

  private hear({ speeds, recorded_s }: Told) {
    for (const { time_s, status } of speeds) {
      const isHeard = (status === "ok" || status === "ambiguous");
      if (this.phase === "hover" && this.hasLasted(isHeard, time_s, HEARD_S)) this.begin();
      else if (this.phase === "recording" && !this.isByHand && this.hasLasted(!isHeard, time_s, LOST_S)) {
        void this.listening.end();
        this.go("hover", "The rotors were no longer heard. Hover on: the ten seconds begin again.");
      }
    }
    if (this.phase !== "recording" || recorded_s === null) return;
    this.change(() => (this.recordedS = recorded_s));
    if (recorded_s >= TRIAL_S) void this.finish();
  }

  private hasLasted(isSo: boolean, timeS: number, lengthS: number): boolean {
    this.sinceS = isSo ? Math.min(this.sinceS ?? timeS, timeS) : undefined;
    return this.sinceS !== undefined && timeS - this.sinceS >= lengthS;
  }

  private async finish() {
    this.go("judging");
    const wav = await this.listening.end();
    this.trial = this.store.trials.take(wav, this.load);
  }
}

export interface Verdict {
  isGood: boolean;
  words: string;
}

/** What a trial is worth. */
export function verdictOf(trial: Recording): Verdict {
  const { answer, fault } = trial;
  if (!answer) return { isGood: false, words: fault ?? "It could not be read." };
  if (!answer.speed) return { isGood: false, words: REASONS[answer.status] };
  const hoverS = answer.hover_s.reduce((sum, [fromS, toS]) => sum + toS - fromS, 0);
  if (hoverS < HOVER_S_MIN) return { isGood: false, words: `Only ${hoverS.toFixed(1)} s of it hover quietly.` };
  return { isGood: true, words: `Good: ± ${answer.speed.plus_minus_percent} %` };
}

const REASONS: Record<Answer["status"], string> = {
  ok: "",
  error: "It could not be read.",
  no_rotor_tone: "No rotor was heard. Come closer, and keep other noise away.",
  ambiguous: "Several speeds are possible: say the blades of a propeller under Vehicle.",
};
