// The recordings: what each tells, and why not where it tells nothing.

import type { Answer, Reading } from "./answers";
import { save } from "./save";
import type { Recording } from "./recording";
import type { Store } from "./store";
import { Viewer } from "./viewer";

export const DRAGGED = "application/x-hovertone-recording";

export function Recordings({ store }: { store: Store }) {
  if (store.recordings.length === 0) return null;
  return (
    <section aria-label="Recordings">
      <h2 class="list">{store.recordings.length === 1 ? "1 recording" : `${store.recordings.length} recordings`}</h2>
      {store.recordings.map((recording) => <Card key={recording.number} store={store} recording={recording} />)}
    </section>
  );
}

function Card({ store, recording }: { store: Store; recording: Recording }) {
  const drag = (event: DragEvent) => {
    event.dataTransfer!.setData(DRAGGED, String(recording.number));
    event.dataTransfer!.effectAllowed = "move";
  };
  return (
    <article class={`card recording ${recording.answer?.status ?? ""}`} aria-label={recording.name}>
      <div class="head" draggable onDragStart={drag} title="Drag it into a load">
        <span class="grip" aria-hidden="true">⠿</span>
        <h3>{recording.name}</h3>
        <LoadChoice store={store} recording={recording} />
        <button type="button" class="plain" aria-label={`Remove ${recording.name}`} onClick={() => store.files.remove(recording.number)}>✕</button>
      </div>
      <Status store={store} recording={recording} />
      <p class="actions">
        {recording.answer?.status !== "error" && <button type="button" aria-expanded={recording.isOpen} onClick={() => store.files.toggle(recording)}>
          {recording.isOpen ? "Hide the picture" : "Picture and sound"}
        </button>}
        {recording.answer && <button type="button" onClick={() => save(`${recording.name}.json`, recording.answer!.json + "\n", "application/json")}>All numbers</button>}
        {recording.isTrial && <button type="button" onClick={() => save(recording.name, recording.file, "audio/wav")}>Save the sound</button>}
      </p>
      {recording.isOpen && recording.answer?.status !== "error" && <Viewer store={store} recording={recording} />}
    </article>
  );
}

/** The load of a recording, for the keyboard and for fingers. */
function LoadChoice({ store, recording }: { store: Store; recording: Recording }) {
  const choose = (event: { currentTarget: HTMLSelectElement }) => {
    const { value } = event.currentTarget;
    const load = value === "new" ? store.loads.addLoad() : value === "" ? undefined : Number(value);
    store.loads.put(recording.number, load);
  };
  return (
    <select aria-label={`Load of ${recording.name}`} value={store.loads.loadOf(recording) ?? ""} onChange={choose}>
      <option value="">no load</option>
      {store.loads.all().map((load, index) => <option value={index} key={index}>{load.name}</option>)}
      <option value="new">a new load …</option>
    </select>
  );
}

function Status({ store, recording }: { store: Store; recording: Recording }) {
  const { state, answer, fault, share } = recording;
  if (state === "waiting" && store.fit.state === "running" && store.fitting.isFitted(recording)) {
    return <p class="working" role="status">is heard with its load …</p>;
  }
  if (state === "waiting" || state === "hearing") {
    return (
      <p class="working" role="status">
        {state === "waiting" ? "waits …" : "listening …"}
        <progress value={state === "waiting" ? undefined : share} aria-label={`Progress of ${recording.name}`} />
        <button type="button" onClick={() => store.hearing.cancel(recording)}>Cancel</button>
      </p>
    );
  }
  if (state === "cancelled") {
    return <p class="working">cancelled <button type="button" onClick={() => store.hearing.hear(recording)}>Hear it again</button></p>;
  }
  if (fault) return <p class="fault" role="alert">{fault}</p>;
  if (!answer) return null;
  return (
    <>
      {answer.speed ? <Speed answer={answer} /> : <NoSpeed store={store} recording={recording} answer={answer} />}
      <Notes answer={answer} />
    </>
  );
}

function Speed({ answer }: { answer: Answer }) {
  const speed = answer.speed!;
  return (
    <>
      <p class="answer">
        <strong>{speed.speed_rev_s}</strong> <span class="plusminus">± {speed.plus_minus_rev_s}</span> rev/s
        <span class="others">{speed.speed_rpm} rpm · {speed.speed_rad_s} rad/s · tone {speed.tone_hz} Hz, order {answer.order}</span>
      </p>
      {answer.rotors.length > 0 && (
        <ul class="rotors" aria-label="Rotors by speed">
          {answer.rotors.map((rotor, index) => (
            <li key={index} class={`rotor-${index % 6}`}>{rotor.speed.speed_rev_s} <span class="quiet">± {rotor.speed.plus_minus_rev_s}</span></li>
          ))}
        </ul>
      )}
    </>
  );
}

const TITLES = { error: "could not be read", no_rotor_tone: "no rotor tone", ambiguous: "possible speeds, each with its plausibility", ok: "" };

/** Readings that are less plausible are folded away. */
const LIKELY = 0.01;

function NoSpeed({ store, recording, answer }: { store: Store; recording: Recording; answer: Answer }) {
  const likely = answer.readings.filter((reading) => reading.plausibility >= LIKELY);
  const unlikely = answer.readings.filter((reading) => reading.plausibility < LIKELY);
  return (
    <div class="nospeed">
      <p class="answer"><strong class="words">{TITLES[answer.status]}</strong></p>
      {likely.length > 0 && (
        <ReadingList store={store} recording={recording} readings={likely} />
      )}
      {unlikely.length > 0 && (
        <details>
          <summary>{unlikely.length} more, each below {Math.round(100 * LIKELY)} %</summary>
          <ReadingList store={store} recording={recording} readings={unlikely} />
        </details>
      )}
      {answer.readings.length > 0 && <p>Which one is it? Count the blades of a propeller, and choose; or give diameter, mass and rotors above.</p>}
      {answer.reason && answer.status !== "ambiguous" && <p>{plain(answer.reason)}</p>}
    </div>
  );
}

function ReadingList({ store, recording, readings }: { store: Store; recording: Recording; readings: Reading[] }) {
  return (
    <ul class="readings">
      {readings.map((reading) => (
        <li key={`${reading.speed_rev_s} ${reading.meaning}`}>
          <button type="button" onClick={() => say(store, recording, reading)}>{reading.meaning}</button>{" "}
          {+reading.speed_rev_s.toPrecision(4)} rev/s, {+reading.speed_rpm.toPrecision(4)} rpm <span class="quiet">({percent(reading.plausibility)} %)</span>
        </li>
      ))}
    </ul>
  );
}

/** A probability in per cent, with one digit where it is small. */
function percent(share: number): string {
  return share >= LIKELY || share === 0 ? (100 * share).toFixed(0) : share >= 0.001 ? (100 * share).toFixed(1) : "below 0.1";
}

/** Half width of the band around the tone of a chosen speed, as a ratio: all of the band is far from an octave away. */
const CHOSEN_BAND = 1.25;

/** The chosen reading says what the vehicle has; and where others differ from it by the speed alone, where the tone is. */
function say(store: Store, recording: Recording, reading: Reading) {
  const { vehicle } = store.entries;
  const blades = reading.blades ?? vehicle.blades;
  const gear = reading.gear_wheel ? { pinion: vehicle.gear?.pinion ?? 1, wheel: reading.gear_wheel } : vehicle.gear;
  // another vehicle makes the page hear all recordings again
  if (blades !== vehicle.blades || gear?.wheel !== vehicle.gear?.wheel) store.loads.setVehicle({ ...vehicle, blades, gear });
  const alike = recording.answer?.readings.filter((other) => other.meaning === reading.meaning) ?? [];
  if (alike.length > 1) {
    const toneHz = reading.order * reading.speed_rev_s;
    store.loads.setBand(recording, [toneHz / CHOSEN_BAND, toneHz * CHOSEN_BAND]);
  } else if (store.loads.loadOf(recording) === undefined) store.hearing.hear(recording);
}

/** Advice for the command line is about its flags; here there are fields. */
function plain(text: string): string {
  return text
    .replace(/--blades N/g, "the blades").replace(/--diameter-m/g, "the diameter").replace(/--mass-kg/g, "the mass")
    .replace(/--rotors/g, "the rotors").replace(/`hovertone tones` shows the other readings/, "they are above");
}

function Notes({ answer }: { answer: Answer }) {
  const { notices, cuts, facts } = answer;
  return (
    <details class="notes">
      <summary>
        {notices.length === 0 ? "no warning" : notices.length === 1 ? "1 warning" : `${notices.length} warnings`}
        {facts && <span class="quiet"> · {facts.container}, {facts.codec}, {facts.sample_rate_hz / 1000} kHz</span>}
      </summary>
      <ul>
        {notices.map((notice) => <li key={notice.text}>{plain(notice.text)} <span class="quiet">{plain(notice.hint)}</span></li>)}
        {cuts && <li>left out: {cuts}</li>}
        {answer.why && <li>why this speed: {answer.why}</li>}
      </ul>
    </details>
  );
}
