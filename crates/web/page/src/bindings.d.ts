// What crates/web offers. `cargo xtask page` makes the module itself.
declare module "hovertone-bindings" {
  export default function init(options?: { module_or_path: URL | string }): Promise<unknown>;
  export class Ear {
    constructor(sampleRateHz: number, said: string);
    push(block: Float32Array): string;
    choose(possible: number): void;
    hear_by(said: string): void;
    begin(lengthS: number): void;
    end(): Uint8Array;
  }
  export class Desk {
    add(number: number, name: string, bytes: number): void;
    remove(number: number): void;
    coded(number: number): Coded | undefined;
    add_decoded(
      number: number, decoded: number, bytes: number, channelCount: number, sampleRateHz: number, firstPacketS: number,
    ): void;
    hear(number: number, said: string, onShare: (share: number) => void): string;
    levels(
      number: number, fromS: number, toS: number, hzLow: number, hzHigh: number, columns: number, rows: number,
    ): Levels;
    sound(number: number, fromS: number, toS: number): Uint8Array;
    identify(text: string, files: string, onShare: (share: number) => void): string;
    report(onShare: (share: number) => void): string;
  }
  /** Packets for the decoder of the browser. */
  export class Coded {
    codec(): string;
    description(): Uint8Array<ArrayBuffer>;
    sample_rate_hz(): number;
    channel_count(): number;
    next_packet(): Packet | undefined;
    free(): void;
  }
  export interface Packet {
    readonly at_s: number;
    take(): Uint8Array<ArrayBuffer>;
    free(): void;
  }
  /** A picture whose cells are still in the module. */
  export type Levels = Omit<import("./answers").Picture, "cells"> & { take(): Uint8Array; free(): void };
  export function version(): string;
  export function vehicles(): string;
  export function level_colours(): Uint8Array;
  export function experiment_text(entries: string): string;
  export function experiment_entries(text: string): string;
  export function simulator_lines(results: string): string;
  export function example_plan(): string;
  export function example_recording(load: number, trial: number): Uint8Array;
}

declare module "*.css";
