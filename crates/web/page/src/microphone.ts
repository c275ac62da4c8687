// The microphone: opened without what browsers do to voices, and connected to the worker that listens.

import type { Told } from "./answers";

export type ToEar =
  | { kind: "open"; rateHz: number; said: unknown }
  | { kind: "said"; said: unknown }
  | { kind: "choose"; possible: number }
  | { kind: "begin"; lengthS: number }
  | { kind: "end" };

export type FromEar =
  | { kind: "told"; told: Told }
  | { kind: "trial"; wav: Uint8Array<ArrayBuffer> }
  | { kind: "fault"; words: string };

/** What a browser may do to the sound of a voice. All of it changes the lines of a rotor. */
const PROCESSING = {
  echoCancellation: "echo cancellation",
  noiseSuppression: "noise suppression",
  autoGainControl: "automatic gain",
} as const;
type Processing = keyof typeof PROCESSING;

/** Some browsers start their sound only where there is something to play it, and wait for that without end. */
const RESUME_MS = 8000;

export class Microphone {
  private waiting: ((wav: Uint8Array<ArrayBuffer>) => void)[] = [];

  private constructor(
    private context: AudioContext,
    private stream: MediaStream,
    private ear: Worker,
    /** What the browser does to the sound although it was asked not to. */
    readonly altered: string[],
    private lock: Promise<WakeLockSentinel | undefined>,
  ) {}

  /** Opens the microphone; to be called in answer to a click, as browsers ask for that. */
  static async open(said: unknown, onTold: (told: Told) => void, onEnd: (why: string) => void): Promise<Microphone> {
    if (!navigator.mediaDevices?.getUserMedia) {
      throw new Error("browsers hand out the microphone only over HTTPS, or on this computer itself; open the page from such an address");
    }
    const context = new AudioContext();
    let stream: MediaStream | undefined;
    try {
      stream = await navigator.mediaDevices.getUserMedia({ audio: mapped(() => false) });
      const [track] = stream.getAudioTracks();
      await within(RESUME_MS, context.resume(), "the browser's sound did not start; connect a loudspeaker or headphones, and press Listen again");
      await context.audioWorklet.addModule(new URL("microphone.worklet.js", import.meta.url));
      const ear = new Worker(new URL("ear.js", import.meta.url), { type: "module" });
      const settings = track.getSettings();
      const altered = (Object.keys(PROCESSING) as Processing[]).filter((each) => settings[each] === true).map((each) => PROCESSING[each]);
      const lock = navigator.wakeLock?.request("screen").catch(() => undefined) ?? Promise.resolve(undefined);
      const microphone = new Microphone(context, stream, ear, altered, lock);
      ear.onmessage = ({ data }: MessageEvent<FromEar>) => {
        if (data.kind === "told") onTold(data.told);
        else if (data.kind === "trial") microphone.waiting.shift()?.(data.wav);
        else onEnd(data.words);
      };
      ear.onerror = () => onEnd("the page could not start its worker: load the page again");
      track.onended = () => onEnd("the microphone was taken away");
      const node = new AudioWorkletNode(context, "microphone", { outputChannelCount: [1] });
      const { port1, port2 } = new MessageChannel();
      node.port.postMessage(port1, [port1]);
      ear.postMessage({ kind: "open", rateHz: context.sampleRate, said } satisfies ToEar, [port2]);
      context.createMediaStreamSource(stream).connect(node);
      // it writes nothing: browsers call what leads to an output
      node.connect(context.destination);
      return microphone;
    } catch (error) {
      stream?.getTracks().forEach((track) => track.stop());
      void context.close();
      throw new Error(inWords(error));
    }
  }

  send(message: ToEar) {
    this.ear.postMessage(message);
  }

  /** The samples since the trial began, as a WAV file. */
  end(): Promise<Uint8Array<ArrayBuffer>> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.send({ kind: "end" });
    });
  }

  close() {
    this.stream.getTracks().forEach((track) => {
      track.onended = null;
      track.stop();
    });
    this.ear.terminate();
    void this.context.close();
    void this.lock.then((lock) => lock?.release());
  }
}

/** What comes within a time, or an error with these words. */
function within<T>(limitMs: number, coming: Promise<T>, words: string): Promise<T> {
  const late = new Promise<never>((_, reject) => setTimeout(() => reject(new Error(words)), limitMs));
  return Promise.race([coming, late]);
}

function mapped<T>(of: (each: Processing) => T) {
  return Object.fromEntries((Object.keys(PROCESSING) as Processing[]).map((each) => [each, of(each)]));
}

function inWords(error: unknown): string {
  const name = error instanceof DOMException ? error.name : "";
  if (name === "NotAllowedError") return "the browser did not allow the microphone; allow it for this page beside its address, and press Listen again";
  if (name === "NotFoundError") return "there is no microphone; connect one and press Listen again";
  if (name === "NotReadableError") return "another program holds the microphone; close it and press Listen again";
  return error instanceof Error ? error.message : String(error);
}
