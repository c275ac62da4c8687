// What is heard now: the newest speed, the last minute, and what the last review found.

import type { Point, Told, ToldSpeed } from "./answers";
import { Microphone } from "./microphone";
import { Observed } from "./observed";

/** Length of the strip chart. */
export const STRIP_S = 60;

export class Listening extends Observed {
  state: "off" | "asking" | "on" = "off";
  fault = "";
  /** The newest speed; of a frozen screen the one at which it froze. */
  now: ToldSpeed | undefined;
  strip: Point[] = [];
  rotorsRevS: number[] = [];
  choices: Told["choices"] = [];
  isFrozen = false;
  /** Is told of everything, frozen or not. */
  onTold: (told: Told) => void = () => {};
  private microphone: Microphone | undefined;
  private said = "";

  get altered(): string[] {
    return this.microphone?.altered ?? [];
  }

  async start(said: unknown) {
    if (this.state !== "off") return;
    this.change(() => Object.assign(this, { state: "asking", fault: "", now: undefined, strip: [], rotorsRevS: [], choices: [], isFrozen: false }));
    this.said = JSON.stringify(said);
    try {
      const microphone = await Microphone.open(said, (told) => this.take(told), (why) => this.stop(why));
      this.change(() => ((this.microphone = microphone), (this.state = "on")));
    } catch (error) {
      this.change(() => ((this.state = "off"), (this.fault = (error as Error).message)));
    }
  }

  stop(why = "") {
    this.microphone?.close();
    this.change(() => ((this.microphone = undefined), (this.state = "off"), (this.fault = why)));
  }

  /** Listens by what is said of the vehicle now. */
  hearBy(said: unknown) {
    const text = JSON.stringify(said);
    if (this.state !== "on" || text === this.said) return;
    this.said = text;
    this.microphone!.send({ kind: "said", said });
  }

  choose(possible: number) {
    this.microphone?.send({ kind: "choose", possible });
  }

  freeze() {
    this.change(() => (this.isFrozen = !this.isFrozen));
  }

  /** Records the next seconds. */
  begin(lengthS: number) {
    this.microphone?.send({ kind: "begin", lengthS });
  }

  async end(): Promise<Uint8Array<ArrayBuffer>> {
    return this.microphone?.end() ?? new Uint8Array();
  }

  private take(told: Told) {
    if (this.state !== "on") return;
    this.onTold(told);
    if (this.isFrozen) return;
    this.change(() => {
      const newest = told.speeds.at(-1)!;
      // time begins anew where the vehicle was described anew
      if (this.now && newest.time_s < this.now.time_s) this.strip = [];
      for (const { time_s, speed_rev_s } of told.speeds) if (speed_rev_s !== null) this.strip.push([time_s, speed_rev_s]);
      this.strip = this.strip.filter(([time_s]) => time_s > newest.time_s - STRIP_S);
      [this.now, this.rotorsRevS, this.choices] = [newest, told.rotors_rev_s, told.choices];
    });
  }
}
