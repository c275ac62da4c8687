// The guided campaign on the screen: one step at a time, in large words for somebody who flies.

import { useEffect, useRef } from "preact/hooks";
import { TRIAL_S, verdictOf, type Campaign } from "./campaign";
import { NumberField, thousand, thousandth } from "./field";
import { useObserved } from "./observed";
import { Quoted } from "./result";
import type { Store } from "./store";

export function Guide({ store }: { store: Store }) {
  const { campaign } = store;
  useObserved(campaign);
  useObserved(store);
  const step = useRef<HTMLDivElement>(null);
  // the pressed button goes with its step: the keyboard goes on from the next one
  useEffect(() => {
    if (document.activeElement === document.body) step.current?.querySelector<HTMLElement>(".order")?.focus({ preventScroll: true });
  }, [campaign.phase]);
  const lacks = store.fitting.lacks().filter((each) => !each.startsWith("a recording"));
  return (
    <section class="campaign" aria-label="Guided campaign">
      <h3>Step by step to the constant</h3>
      <div ref={step} class={`step ${campaign.phase}`}>
        <Step store={store} campaign={campaign} />
      </div>
      <p class="unseen" role="status">{spoken(campaign)}</p>
      {lacks.length > 0 && <p class="quiet">For the constant, say under Vehicle: {lacks.join(", ")}.</p>}
      <Trials store={store} />
      {store.fit.result?.has_constant && <Quoted quote={store.fit.result.quote} />}
    </section>
  );
}

/** What a screen reader says of a new step. */
function spoken({ phase, trial }: Campaign): string {
  switch (phase) {
    case "weigh":
      return "";
    case "hover":
      return "Hover now";
    case "recording":
      return `Hold the hover for ${TRIAL_S} seconds`;
    case "judging":
      return "Land. The trial is judged";
    case "judged":
      return trial ? verdictOf(trial).words : "";
  }
}

function Step({ store, campaign }: { store: Store; campaign: Campaign }) {
  const { phase, trial } = campaign;
  switch (phase) {
    case "weigh":
      return <Weigh store={store} campaign={campaign} />;
    case "hover":
      return (
        <>
          <p class="order" tabIndex={-1}>Hover now</p>
          <p>{campaign.note || "Low noise, no turns, above your head or more. The ten seconds begin when the rotors are heard."}</p>
          <p class="group">
            <button type="button" onClick={() => campaign.beginNow()}>Begin now</button>
            <button type="button" onClick={() => campaign.cancel()}>Cancel</button>
          </p>
        </>
      );
    case "recording":
      return (
        <>
          <p class="order" tabIndex={-1}>Hold it: {Math.max(0, Math.ceil(TRIAL_S - campaign.recordedS))} s</p>
          <progress value={campaign.recordedS / TRIAL_S} aria-label="Progress of the trial" />
          <p><button type="button" onClick={() => campaign.cancel()}>Cancel</button></p>
        </>
      );
    case "judging":
      return <p class="order" tabIndex={-1}>Land. <span class="quiet">The trial is judged …</span></p>;
    case "judged":
      return trial ? <Judged campaign={campaign} /> : null;
  }
}

function Weigh({ store, campaign }: { store: Store; campaign: Campaign }) {
  const { vehicle } = store.entries;
  const known = store.vehicles.find((each) => each.id === vehicle.preset)?.mass_kg?.value;
  const { isFirst } = campaign;
  return (
    <>
      <p class="order" tabIndex={-1}>{isFirst ? "Weigh it" : "Add a load"}</p>
      <p>{isFirst ? "Weigh the vehicle ready to fly, with its battery. Fly without a load first." : "Fasten a weight near the middle, and say how much it weighs. Three loads show whether F = C_f ω² holds."}</p>
      <div class="fields">
        {isFirst && (
          <NumberField label="Vehicle ready to fly" unit="g" value={thousand(vehicle.mass_kg)} placeholder={known === undefined ? "" : String(thousand(known))}
            set={(grams) => store.loads.setVehicle({ ...vehicle, mass_kg: thousandth(grams) })} />
        )}
        <NumberField label="Added mass" unit="g" value={thousand(campaign.addedKg)} set={(grams) => campaign.weigh(thousandth(grams) ?? 0)} />
      </div>
      <p><button type="button" class="main" onClick={() => campaign.ready()}>I am ready to hover</button></p>
    </>
  );
}

function Judged({ campaign }: { campaign: Campaign }) {
  const verdict = verdictOf(campaign.trial!);
  return (
    <>
      <p class={`order ${verdict.isGood ? "good" : "bad"}`} tabIndex={-1}>{verdict.words}</p>
      {verdict.isGood ? (
        <>
          <p>Land. Then add a load, or fly the same load once more: two trials of each tell how much flights differ.</p>
          <p class="group">
            <button type="button" class="main" onClick={() => campaign.nextLoad()}>Add a load</button>
            <button type="button" onClick={() => campaign.ready()}>The same load again</button>
          </p>
        </>
      ) : (
        <p class="group">
          <button type="button" class="main" onClick={() => campaign.flyAgain()}>Fly it again</button>
          <button type="button" onClick={() => campaign.nextLoad()}>Keep it, and go on</button>
        </p>
      )}
    </>
  );
}

/** The trials so far, load by load. */
function Trials({ store }: { store: Store }) {
  const loads = store.loads.all().filter((load) => load.recordings.length > 0);
  if (loads.length === 0) return null;
  const forget = () => confirm("Take all trials of the microphone away?") && store.trials.newCampaign();
  return (
    <>
      <ul class="chips" aria-label="Trials so far">
      {loads.flatMap((load) => store.loads.recordingsOf(load).map(({ name, recording }) => (
        <li key={name} class={recording?.answer?.status ?? ""}>
          <span>{load.name}, {thousand(load.added_mass_kg ?? 0)} g</span>
          <span class="quiet">
            {recording?.answer?.speed ? `${recording.answer.speed.speed_rev_s} ± ${recording.answer.speed.plus_minus_rev_s} rev/s` : recording?.state === "heard" ? "no speed" : "…"}
          </span>
        </li>
      )))}
    </ul>
    <p><button type="button" class="plain" onClick={forget}>Begin a new campaign</button></p>
    </>
  );
}
