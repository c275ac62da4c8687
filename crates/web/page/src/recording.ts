// A recording of the page, and what it is called in requests and in the experiment file.

import type { Answer, Picture, Point } from "./answers";

export interface Recording {
  number: number;
  name: string;
  file: File;
  url: string;
  state: "waiting" | "hearing" | "heard" | "cancelled";
  share: number;
  answer?: Answer;
  fault?: string;
  picture?: Picture;
  isOpen: boolean;
  /** A trial of the microphone, which the browser keeps. */
  isTrial: boolean;
  /** The part that a person chose, where the recording is in no load. */
  spanS?: Point;
  bandHz?: Point;
}

/** The name of a recording in an entry of an experiment file. */
export function fileOf(recording: string | { file: string }): string {
  return typeof recording === "string" ? recording : recording.file;
}

/** The tag of all requests about a recording. */
export function tagOf(recording: Recording): string {
  return `recording ${recording.number}`;
}
