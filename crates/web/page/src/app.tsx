// The whole page.

import { useEffect, useRef, useState } from "preact/hooks";
import { Experiment } from "./experiment";
import { Listen } from "./listen";
import { filesOf } from "./names";
import { useObserved } from "./observed";
import { Recordings } from "./recordings";
import { Result } from "./result";
import { save } from "./save";
import type { Store } from "./store";
import { Vehicle } from "./vehicle";

export function App({ store }: { store: Store }) {
  useObserved(store);
  const isListening = store.listening.state === "on";
  const isEmpty = store.recordings.length === 0 && !store.busy && store.loads.all().length === 0 && !isListening;
  return (
    <>
      <header class="top">
        <h1>hovertone</h1>
        <p>The thrust constant of a multirotor, from the sound of its hover.</p>
      </header>
      <main>
        <Faults store={store} />
        {isEmpty && <Steps />}
        <Listen store={store} />
        {!isListening && store.recordings.some((recording) => recording.isTrial) && (
          <p class="quiet kept">The trials of the microphone are kept in this browser. Listen again to go on with the campaign.</p>
        )}
        <Drop store={store} isEmpty={isEmpty} isListening={isListening} />
        {store.busy && (
          <p class="busy" role="status">
            {store.busy.words} … <progress value={store.busy.share} aria-label={store.busy.words} />
          </p>
        )}
        <Pasted store={store} />
        {!isEmpty && (
          <div class="columns">
            <div>
              <Vehicle store={store} />
              <Recordings store={store} />
            </div>
            <div class="side">
              <Experiment store={store} />
              <Result store={store} />
            </div>
          </div>
        )}
      </main>
      <footer class="quiet">
        <p>All is computed in this browser: no recording leaves this computer. {store.version && `hovertone ${store.version}`}</p>
      </footer>
    </>
  );
}

function Steps() {
  const steps = [
    ["Record a hover", "Ten quiet seconds beside the vehicle, with any phone or camera, or with this page. Then the same with a weight on it."],
    ["Drop the recordings", "Video or audio, as they are. Each tells the speed of its rotors, with its ±."],
    ["Weigh and compare", "Say what each hover weighed. The loads give C_f, its uncertainty, and whether F = C_f ω² holds."],
  ];
  return (
    <ol class="steps">
      {steps.map(([title, words]) => (
        <li key={title}>
          <h2>{title}</h2>
          <p>{words}</p>
        </li>
      ))}
    </ol>
  );
}

function Drop({ store, isEmpty, isListening }: { store: Store; isEmpty: boolean; isListening: boolean }) {
  const [isOver, setOver] = useState(false);
  const input = useRef<HTMLInputElement>(null);
  useEffect(() => {
    const isOfFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files");
    const over = (event: DragEvent) => {
      if (!isOfFiles(event)) return;
      event.preventDefault();
      setOver(true);
    };
    const leave = (event: DragEvent) => event.relatedTarget === null && setOver(false);
    const drop = (event: DragEvent) => {
      if (!isOfFiles(event) || event.defaultPrevented) return setOver(false);
      event.preventDefault();
      setOver(false);
      void filesOf(event.dataTransfer!).then((files) => store.files.take(files));
    };
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", leave);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragover", over);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("drop", drop);
    };
  }, [store]);
  const choose = () => {
    const chosen = [...(input.current!.files ?? [])];
    input.current!.value = "";
    void store.files.take(chosen);
  };
  return (
    <section class={`drop ${isEmpty ? "large" : ""} ${isOver ? "over" : ""}`} aria-label="Add recordings">
      <p>
        <button type="button" class="main" onClick={() => input.current!.click()}>Choose recordings</button>
        {!isListening && <button type="button" onClick={() => store.trials.listen()}>Listen with the microphone</button>}
        {isEmpty && <button type="button" disabled={store.busy !== undefined} onClick={() => void store.files.example()}>Try an example</button>}
      </p>
      <p class="quiet">
        {isEmpty ? "or drop them anywhere on this page: MOV, MP4, MKV, WebM, WAV, FLAC, MP3, M4A, Ogg …" : "or drop more anywhere; experiment.toml and results.json too"}
      </p>
      <input ref={input} type="file" multiple hidden aria-hidden="true" tabIndex={-1} onChange={choose}
        accept="audio/*,video/*,.mov,.mkv,.wav,.flac,.opus,.caf,.aif,.aiff,.toml,.json" />
    </section>
  );
}

function Faults({ store }: { store: Store }) {
  if (!store.fault) return null;
  return (
    <div class="fault" role="alert">
      <p>{store.fault}</p>
      <button type="button" onClick={() => store.dismiss()}>Close</button>
    </div>
  );
}

/** Lines for simulators from a results.json that was opened. */
function Pasted({ store }: { store: Store }) {
  if (!store.pasted) return null;
  const { name, lines } = store.pasted;
  return (
    <section class="card" aria-label={`Constant of ${name}`}>
      <h2>{name}</h2>
      <pre>{lines.find((each) => each.name === "json" || each.name === "generic")?.text ?? lines[0].text}</pre>
      <p class="group">
        {lines.map((each) => (
          <button type="button" key={each.name} onClick={() => save(`${each.name}.txt`, each.text)}>{each.name}</button>
        ))}
        <button type="button" onClick={() => store.dismiss()}>Close</button>
      </p>
    </section>
  );
}
