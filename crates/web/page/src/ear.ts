// The worker that listens to the microphone. It is not the one that reads files, so that the speed goes on while a trial is judged.

import init, { Ear } from "hovertone-bindings";
import type { FromEar, ToEar } from "./microphone";

const started = init({ module_or_path: new URL("hovertone_bg.wasm", self.location.href) });
const tell = (message: FromEar, transfer: Transferable[] = []) => self.postMessage(message, { transfer });
let ear: Ear | undefined;

self.onmessage = async ({ data, ports }: MessageEvent<ToEar>) => {
  try {
    await started;
    switch (data.kind) {
      case "open":
        ear = new Ear(data.rateHz, JSON.stringify(data.said));
        ports[0].onmessage = ({ data: block }: MessageEvent<Float32Array>) => hear(block);
        return;
      case "said":
        return ear?.hear_by(JSON.stringify(data.said));
      case "choose":
        return ear?.choose(data.possible);
      case "begin":
        return ear?.begin(data.lengthS);
      case "end": {
        const wav = (ear?.end() ?? new Uint8Array()) as Uint8Array<ArrayBuffer>;
        return tell({ kind: "trial", wav }, [wav.buffer]);
      }
    }
  } catch (error) {
    fail(error);
  }
};

function hear(block: Float32Array) {
  try {
    const told = ear?.push(block);
    if (told) tell({ kind: "told", told: JSON.parse(told) });
  } catch (error) {
    fail(error);
  }
}

function fail(error: unknown) {
  // a trap of the module leaves its memory in an unknown state
  const isBroken = error instanceof WebAssembly.RuntimeError;
  tell({ kind: "fault", words: isBroken ? "listening broke: that is a fault of hovertone; please report it" : String(error) });
}
