// What the worker answers: the shapes of crates/web.

export interface Notice {
  text: string;
  hint: string;
}

export interface SpeedWords {
  tone_hz: string;
  speed_rev_s: string;
  plus_minus_rev_s: string;
  plus_minus_percent: string;
  spread_rev_s: string;
  speed_rpm: string;
  speed_rad_s: string;
}

export type Point = [number, number];

export interface Rotor {
  speed: SpeedWords;
  track: Point[];
}

export interface Reading {
  meaning: string;
  speed_rev_s: number;
  speed_rpm: number;
  plausibility: number;
  order: number;
  blades: number | null;
  gear_wheel: number | null;
}

export interface Answer {
  status: "ok" | "error" | "ambiguous" | "no_rotor_tone";
  reason: string | null;
  speed: SpeedWords | null;
  order: number | null;
  rotors: Rotor[];
  track: Point[];
  readings: Reading[];
  why: string | null;
  cuts: string | null;
  hover_s: Point[];
  heard_s: Point | null;
  bands_hz: Point[];
  notices: Notice[];
  facts: { container: string; codec: string; sample_rate_hz: number; channel_count: number } | null;
  json: string;
}

/** What is heard of a block of the microphone. */
export interface Told {
  speeds: ToldSpeed[];
  rotors_rev_s: number[];
  choices: { words: string; blades: number | null }[];
  recorded_s: number | null;
}

export interface ToldSpeed {
  time_s: number;
  status: "ok" | "ambiguous" | "no_rotor_tone" | "listening";
  speed_rev_s: number | null;
  level_db: number;
  clipped_share: number;
  words: { speed_rev_s: string; plus_minus_rev_s: string; plus_minus_percent: string; speed_rpm: string; speed_rad_s: string } | null;
  status_words: string;
}

export interface Picture {
  cells: Uint8Array;
  columns: number;
  rows: number;
  from_s: number;
  to_s: number;
  hz_low: number;
  hz_high: number;
  level_db_low: number;
  level_db_high: number;
  declared_s: number;
}

export interface Table {
  heads: { title: string; unit: string; is_number: boolean }[];
  rows: string[][];
}

export interface Lines {
  name: string;
  text: string;
}

export interface Identified {
  quote: string;
  headline: string;
  holds: "holds" | "fails" | "untested" | null;
  has_constant: boolean;
  warnings: Notice[];
  loads: Table | null;
  budget: Table | null;
  fit_svg: string | null;
  budget_svg: string | null;
  units: { unit: string; text: string; pasted: string }[];
  inputs: { file: number; answer: Answer }[];
  simulators: Lines[];
  results: string;
}

export interface KnownVehicle {
  id: string;
  name: string;
  blade_count?: { value: number } | null;
  rotor_count?: { value: number } | null;
  gear?: { value: { pinion: number; wheel: number } } | null;
  mass_kg?: { value: number } | null;
  propeller_diameter_m?: { value: number } | null;
}

export interface Start {
  version: string;
  vehicles: KnownVehicle[];
  colours: Uint8Array;
}

export interface ExamplePlan {
  experiment: Entries;
  recordings: { name: string; load: number; trial: number }[];
}

// An experiment file, entry by entry. Entries that the page does not know are kept.
export interface Entries {
  vehicle: VehicleEntries;
  load?: LoadEntries[];
  tone?: { band_hz?: Point; [key: string]: unknown };
  [key: string]: unknown;
}

export interface VehicleEntries {
  preset?: string;
  rotors?: number;
  blades?: number;
  gear?: { pinion: number; wheel: number };
  propeller_diameter_m?: number;
  mass_kg?: number;
  [key: string]: unknown;
}

export interface LoadEntries {
  name: string;
  added_mass_kg?: number;
  recordings: (string | { file: string; log?: string })[];
  from_s?: number | string;
  to_s?: number | string;
  [key: string]: unknown;
}
