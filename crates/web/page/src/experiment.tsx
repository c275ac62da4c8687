// The loads: which recordings hover with which mass.

import { useId, useState } from "preact/hooks";
import type { LoadEntries } from "./answers";
import { NumberField, thousand, thousandth, useDraft } from "./field";
import { filesOf } from "./names";
import { DRAGGED } from "./recordings";
import type { Store } from "./store";

export function Experiment({ store }: { store: Store }) {
  const loads = store.loads.all();
  const lacks = store.fitting.lacks();
  return (
    <section class="card experiment" aria-label="Experiment">
      <h2>Loads</h2>
      {loads.length === 0 && <p class="quiet">A load is the vehicle with a mass on it, or with none. Each has one recording or more; three loads show whether F = C_f ω² holds.</p>}
      {loads.map((load, index) => <Load key={index} store={store} load={load} index={index} />)}
      <p><button type="button" onClick={() => store.loads.addLoad()}>Add a load</button></p>
      {loads.length > 0 && lacks.length > 0 && <p class="lacks">The constant still needs {inWords(lacks)}.</p>}
    </section>
  );
}

function Load({ store, load, index }: { store: Store; load: LoadEntries; index: number }) {
  const [isOver, setOver] = useState(false);
  const id = useId();
  const name = useDraft(load.name, ({ value }) => value && store.loads.setLoad(index, { name: value }));
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setOver(false);
    const number = event.dataTransfer!.getData(DRAGGED);
    if (number) store.loads.put(Number(number), index);
    else void filesOf(event.dataTransfer!).then((files) => store.files.take(files, index));
  };
  const over = (event: DragEvent) => {
    event.preventDefault();
    setOver(true);
  };
  const vehicle_kg = store.entries.vehicle.mass_kg;
  const flown = vehicle_kg === undefined ? undefined : thousand(vehicle_kg + (load.added_mass_kg ?? 0));
  return (
    <div class={`load ${isOver ? "over" : ""}`} onDragOver={over} onDragLeave={() => setOver(false)} onDrop={drop} role="group" aria-label={load.name}>
      <div class="fields">
        <span class="field">
          <label for={id}>Name</label>
          <input id={id} type="text" {...name} />
        </span>
        <NumberField label="Added mass" unit="g" value={thousand(load.added_mass_kg)} hint={flown === undefined ? undefined : `${+flown.toFixed(3)} g as flown`}
          set={(grams) => store.loads.setLoad(index, { added_mass_kg: thousandth(grams) ?? 0 })} />
        <button type="button" class="plain" aria-label={`Remove ${load.name}`} onClick={() => store.loads.removeLoad(index)}>✕</button>
      </div>
      <ul class="chips">
        {store.loads.recordingsOf(load).map(({ name, recording }) => (
          <li key={name} class={recording ? (recording.answer?.status ?? "") : "missing"}>
            <span>{name}</span>
            {recording?.answer?.speed && <span class="quiet"> {recording.answer.speed.speed_rev_s} rev/s</span>}
            {!recording && <span class="quiet"> missing: drop it here</span>}
            <button type="button" class="plain" aria-label={`Take ${name} out of ${load.name}`} onClick={() => store.loads.forget(load, name)}>✕</button>
          </li>
        ))}
        {load.recordings.length === 0 && <li class="empty">drag recordings here</li>}
      </ul>
    </div>
  );
}

function inWords(lacks: string[]): string {
  return lacks.length < 2 ? lacks.join("") : `${lacks.slice(0, -1).join(", ")} and ${lacks.at(-1)}`;
}
