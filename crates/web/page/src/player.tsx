// Plays a recording: the file itself, or, where the browser cannot, its sound as hovertone decodes it.

import { useEffect, useRef, useState } from "preact/hooks";
import type { Recording } from "./recording";
import type { Store } from "./store";

/** Most seconds of sound that are decoded for a player. */
const DECODED_S_MAX = 600;

export function Player(props: {
  store: Store; recording: Recording; lengthS: number; onTime: (timeS: number | undefined) => void; seek: { current: (timeS: number) => void };
}) {
  const { store, recording } = props;
  const [source, setSource] = useState(recording.url);
  const [hasFailed, setFailed] = useState(false);
  const audio = useRef<HTMLAudioElement>(null);
  useEffect(() => () => void (source !== recording.url && URL.revokeObjectURL(source)), [source]);
  props.seek.current = (timeS) => {
    if (audio.current) audio.current.currentTime = timeS;
  };
  const decode = async () => {
    if (source !== recording.url) return setFailed(true);
    try {
      const wav = await store.hearing.sound(recording, [0, Math.min(props.lengthS, DECODED_S_MAX)]);
      setSource(URL.createObjectURL(new Blob([wav], { type: "audio/wav" })));
    } catch {
      setFailed(true);
    }
  };
  if (hasFailed) return <p class="quiet">This browser cannot play the recording.</p>;
  return (
    <audio ref={audio} controls preload="metadata" src={source} onError={decode} aria-label={`Sound of ${recording.name}`}
      onTimeUpdate={(event) => props.onTime(event.currentTarget.currentTime || undefined)} />
  );
}
