// Which vehicle it is: one that is known, or its numbers.

import { useId } from "preact/hooks";
import type { VehicleEntries } from "./answers";
import { NumberField, thousand, thousandth } from "./field";
import type { Store } from "./store";

export function Vehicle({ store }: { store: Store }) {
  const id = useId();
  const { vehicle } = store.entries;
  const known = store.vehicles.find((each) => each.id === vehicle.preset);
  const set = (entries: Partial<VehicleEntries>) => store.loads.setVehicle({ ...vehicle, ...entries });
  const shown = (value: number | undefined) => (value === undefined ? "" : String(value));
  return (
    <section class="card" aria-labelledby={`${id}-title`}>
      <h2 id={`${id}-title`}>Vehicle</h2>
      <div class="fields">
        <span class="field wide">
          <label for={id}>Known vehicle</label>
          <select id={id} value={vehicle.preset ?? ""} onChange={(event) => set({ preset: event.currentTarget.value || undefined })}>
            <option value="">not in this list</option>
            {store.vehicles.map((each) => <option value={each.id} key={each.id}>{each.name}</option>)}
          </select>
        </span>
        <NumberField label="Rotors" value={vehicle.rotors} min={1} step="1" placeholder={shown(known?.rotor_count?.value)} set={(rotors) => set({ rotors })} />
        <NumberField label="Blades each" value={vehicle.blades} min={1} step="1" placeholder={shown(known?.blade_count?.value)} set={(blades) => set({ blades })} />
        <NumberField label="Diameter" unit="mm" value={thousand(vehicle.propeller_diameter_m)} placeholder={shown(thousand(known?.propeller_diameter_m?.value))}
          set={(mm) => set({ propeller_diameter_m: thousandth(mm) })} />
        <NumberField label="Mass ready to fly" unit="g" value={thousand(vehicle.mass_kg)} placeholder={shown(thousand(known?.mass_kg?.value))}
          set={(grams) => set({ mass_kg: thousandth(grams) })} />
      </div>
      <details open={vehicle.gear !== undefined}>
        <summary>Gear, gravity</summary>
        <div class="fields">
          <NumberField label="Teeth of the motor's pinion" value={vehicle.gear?.pinion} min={1} step="1" placeholder={shown(known?.gear?.value.pinion)}
            set={(pinion) => set({ gear: gearOf(pinion, vehicle.gear?.wheel) })} />
          <NumberField label="Teeth of the rotor's wheel" value={vehicle.gear?.wheel} min={1} step="1" placeholder={shown(known?.gear?.value.wheel)}
            set={(wheel) => set({ gear: gearOf(vehicle.gear?.pinion, wheel) })} />
          <NumberField label="Latitude of the flights" unit="°" min={-90} value={vehicle.latitude_deg as number | undefined}
            set={(latitude_deg) => set({ latitude_deg })} hint={vehicle.gravity_m_s2 ? `gravity ${vehicle.gravity_m_s2} m/s² is given` : "makes the ± smaller"} />
        </div>
      </details>
      {!known && !vehicle.blades && (
        <p class="quiet">With the number of blades, half and double the speed can be ruled out; diameter, mass and rotors help too.</p>
      )}
    </section>
  );
}

/** A wheel alone is enough: the pinion makes no difference to the tone. */
function gearOf(pinion: number | undefined, wheel: number | undefined) {
  return wheel === undefined ? undefined : { pinion: pinion ?? 1, wheel };
}
