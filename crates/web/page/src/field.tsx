// A number with its unit.

import { useId } from "preact/hooks";

export function NumberField(props: {
  label: string; unit?: string; value: number | undefined; hint?: string; placeholder?: string; min?: number; step?: string;
  set: (value: number | undefined) => void;
}) {
  const id = useId();
  const change = (event: { currentTarget: HTMLInputElement }) => {
    const { value, valueAsNumber, validity } = event.currentTarget;
    if (value === "" && !validity.badInput) props.set(undefined);
    else if (Number.isFinite(valueAsNumber)) props.set(valueAsNumber);
  };
  return (
    <span class="field">
      <label for={id}>{props.label}{props.unit && <span class="quiet"> {props.unit}</span>}</label>
      <input id={id} type="number" inputMode="decimal" min={props.min ?? 0} step={props.step ?? "any"} value={props.value ?? ""}
        placeholder={props.placeholder} onChange={change} />
      {props.hint && <span class="quiet hint">{props.hint}</span>}
    </span>
  );
}

/** Thousandths without the dust of binary fractions. */
export function thousand(value: number | undefined): number | undefined {
  return value === undefined ? undefined : +(value * 1000).toPrecision(12);
}

export function thousandth(value: number | undefined): number | undefined {
  return value === undefined ? undefined : +(value / 1000).toPrecision(12);
}
