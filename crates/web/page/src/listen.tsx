// The microphone on the screen: the speed now, its last minute, and the guided campaign.

import { useEffect, useRef } from "preact/hooks";
import { STRIP_S, type Listening } from "./listening";
import { useObserved } from "./observed";
import { Guide } from "./guide";
import type { Store } from "./store";

/** Level at the left end of its bar. */
const LEVEL_DB_MIN = -80;
/** Levels above this are close to clipping. */
const LOUD_DB = -3;
/** Smallest part of the speed that the strip chart shows, so that a steady speed looks steady. */
const STRIP_SHARE_MIN = 0.01;
/** Distance of points that are no longer joined. */
const GAP_S = 0.35;

export function Listen({ store }: { store: Store }) {
  const { listening } = store;
  useObserved(listening);
  if (listening.state === "asking") {
    return <section class="card listen" aria-label="Microphone"><p class="now none" role="status">Waiting for the microphone. Allow it where the browser asks.</p></section>;
  }
  if (listening.state === "off") {
    return listening.fault ? <div class="fault" role="alert"><p>{listening.fault}</p><button type="button" onClick={() => listening.stop()}>Close</button></div> : null;
  }
  return (
    <section class="card listen" aria-label="Microphone">
      <div class="head">
        <h2>Listening</h2>
        <span class="group">
          <button type="button" aria-pressed={listening.isFrozen} onClick={() => listening.freeze()}>Freeze</button>
          <button type="button" onClick={() => listening.stop()}>Stop listening</button>
        </span>
      </div>
      {listening.altered.length > 0 && (
        <p class="fault" role="alert">
          This browser changes the sound although it was asked not to: {listening.altered.join(", ")}. That can hide or shift the lines of a rotor. Use another browser, or a recording app without such filters.
        </p>
      )}
      <div class="both">
        <div class="live">
          <Speed listening={listening} />
          <Level listening={listening} />
          <Rotors listening={listening} />
          <Choices store={store} />
          <Strip listening={listening} />
        </div>
        <Guide store={store} />
      </div>
    </section>
  );
}

function Speed({ listening }: { listening: Listening }) {
  const { now, isFrozen } = listening;
  if (!now || now.status === "listening") return <p class="now none" role="status">The first answer comes after two seconds of sound.</p>;
  const { words, status_words } = now;
  // a ± is that of one speed
  const isOne = now.status !== "ambiguous";
  const silent = isOne ? "no rotor tone" : status_words;
  return (
    <>
      <p class={`now ${now.status}`} data-time={now.time_s}>
        {words ? <><strong>{words.speed_rev_s}</strong> <span class="beside">{isOne && <span class="plusminus">± {words.plus_minus_rev_s}</span>} <span>rev/s{!isOne && "?"}</span></span></> : <span class="words">{silent}</span>}
      </p>
      <p class="quiet others">
        {words && !isOne ? "one of several possible speeds" : words ? `${words.speed_rpm} rpm · ${words.speed_rad_s} rad/s · ± ${words.plus_minus_percent} %` : status_words.slice(silent.length).replace(/^: /, "")}
        {isFrozen && " · frozen"}
      </p>
      <p class="unseen" role="status">{words ? (isOne ? "a rotor is heard" : "a rotor is heard, at one of several possible speeds") : silent}</p>
    </>
  );
}

function Level({ listening }: { listening: Listening }) {
  const { now } = listening;
  if (!now) return null;
  const share = Math.min(1, Math.max(0, 1 - now.level_db / LEVEL_DB_MIN));
  const isClipped = now.clipped_share > 0;
  return (
    <div class="bar">
      <span>level</span>
      <meter class={isClipped || now.level_db > LOUD_DB ? "loud" : ""} value={share} aria-label="Level of the sound">{now.level_db.toFixed(0)} dB</meter>
      <span class="value">{now.level_db.toFixed(0).replace("-", "−")} dB</span>
      {isClipped && <span class="clipped" role="status">clipped: move away</span>}
    </div>
  );
}

/** The separated rotors. The slowest has a quarter of the bar of the fastest, so that differences show. */
function Rotors({ listening }: { listening: Listening }) {
  const speeds = listening.rotorsRevS;
  if (speeds.length < 2) return null;
  const [fastest, slowest] = [Math.max(...speeds), Math.min(...speeds)];
  const share = (speed: number) => (fastest > slowest ? 0.25 + (0.75 * (speed - slowest)) / (fastest - slowest) : 1);
  return (
    <div role="group" aria-label="Rotors by speed">
      {speeds.map((speed, index) => (
        <div class="bar" key={index}>
          <span>rotor {index + 1}</span>
          <meter value={share(speed)} aria-label={`Rotor ${index + 1}`}>{speed.toFixed(2)} rev/s</meter>
          <span class="value">{speed.toFixed(2)} rev/s</span>
        </div>
      ))}
    </div>
  );
}

function Choices({ store }: { store: Store }) {
  const { choices } = store.listening;
  if (choices.length === 0) return null;
  return (
    <div role="group" aria-label="Possible speeds">
      <p>Several speeds are possible. Which one is it?</p>
      <ul class="readings">
        {choices.map((choice, index) => <li key={choice.words}><button type="button" onClick={() => store.trials.choose(index)}>{choice.words}</button></li>)}
      </ul>
    </div>
  );
}

/** The speed in the last minute. */
function Strip({ listening }: { listening: Listening }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { strip, now } = listening;
  const speeds = strip.map(([, speed]) => speed);
  const [lowest, highest] = [Math.min(...speeds), Math.max(...speeds)];
  useEffect(() => {
    if (canvas.current) draw(canvas.current, listening, lowest, highest);
  }, [now, strip]);
  const words = speeds.length === 0 ? "no rotor in the last minute" : `speed in the last minute: ${lowest.toFixed(1)} to ${highest.toFixed(1)} rev/s`;
  return <canvas ref={canvas} class="strip" role="img" aria-label={words} />;
}

function draw(canvas: HTMLCanvasElement, { strip, now }: Listening, lowest: number, highest: number) {
  const scale = Math.min(window.devicePixelRatio, 3);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  [canvas.width, canvas.height] = [width * scale, height * scale];
  const context = canvas.getContext("2d")!;
  context.scale(scale, scale);
  const style = getComputedStyle(canvas);
  const size = parseFloat(style.fontSize);
  context.font = `${size}px ${style.fontFamily}`;
  const [left, bottom] = [4.2 * size, 1.6 * size];
  context.fillStyle = context.strokeStyle = style.color;
  const newestS = now?.time_s ?? 0;
  const x = (timeS: number) => left + ((width - left) * (timeS - newestS + STRIP_S)) / STRIP_S;
  for (const [backS, align, words] of [[60, "left", "−60 s"], [30, "center", "−30 s"], [0, "right", "now"]] as const) {
    context.textAlign = align;
    context.fillText(words, x(newestS - backS), height - 0.3 * size);
  }
  if (strip.length === 0) return;
  const middle = (lowest + highest) / 2;
  const half = Math.max(0.55 * (highest - lowest), (STRIP_SHARE_MIN * middle) / 2);
  const y = (speed: number) => size + (height - bottom - 2 * size) * (0.5 - (speed - middle) / (2 * half));
  context.textAlign = "left";
  for (const speed of [middle + half, middle, middle - half]) {
    context.globalAlpha = 1;
    context.fillText(speed.toFixed(half < 1 ? 2 : 1), 0, y(speed) + size / 3);
    context.globalAlpha = 0.25;
    context.fillRect(left, y(speed), width - left, 1);
  }
  context.globalAlpha = 1;
  context.strokeStyle = style.stroke;
  context.lineWidth = 2;
  context.lineJoin = "round";
  context.beginPath();
  let lastS = -Infinity;
  for (const [timeS, speed] of strip) {
    if (timeS - lastS > GAP_S) context.moveTo(x(timeS), y(speed));
    else context.lineTo(x(timeS), y(speed));
    lastS = timeS;
  }
  context.stroke();
}
