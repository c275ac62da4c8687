// A number with its unit.

import { useId, useState } from "preact/hooks";

export function NumberField(props: {
  label: string; unit?: string; value: number | undefined; hint?: string; placeholder?: string; min?: number; step?: string;
  set: (value: number | undefined) => void;
}) {
  const id = useId();
  const draft = useDraft(props.value === undefined ? "" : String(props.value), ({ value, valueAsNumber, validity }) => {
    if (value === "" && !validity.badInput) props.set(undefined);
    else if (Number.isFinite(valueAsNumber)) props.set(valueAsNumber);
  });
  return (
    <span class="field">
      <label for={id}>{props.label}{props.unit && <span class="quiet"> {props.unit}</span>}</label>
      <input id={id} type="number" inputMode="decimal" min={props.min ?? 0} step={props.step ?? "any"} placeholder={props.placeholder} {...draft} />
      {props.hint && <span class="quiet hint">{props.hint}</span>}
    </span>
  );
}

/** What is being typed stays as it is while the page is drawn again; it counts when the field is left, or at Enter. */
export function useDraft(value: string, commit: (input: HTMLInputElement) => void) {
  const [draft, setDraft] = useState<string>();
  return {
    value: draft ?? value,
    onInput: (event: { currentTarget: HTMLInputElement }) => setDraft(event.currentTarget.value),
    onChange: (event: { currentTarget: HTMLInputElement }) => {
      commit(event.currentTarget);
      setDraft(undefined);
    },
    onBlur: () => setDraft(undefined),
  };
}

/** Thousandths without the dust of binary fractions. */
export function thousand(value: number | undefined): number | undefined {
  return value === undefined ? undefined : +(value * 1000).toPrecision(12);
}

export function thousandth(value: number | undefined): number | undefined {
  return value === undefined ? undefined : +(value / 1000).toPrecision(12);
}
