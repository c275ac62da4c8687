// Sound that hovertone cannot decode and the browser can (WebCodecs). It is decoded packet by packet into a file that the browser keeps
// for this page, and read from there as other files are: memory does not grow with its length.

import type { Coded, Desk } from "hovertone-bindings";

/** Most packets that wait in the decoder. */
const WAITING_MAX = 32;
/** Samples that are written at once. */
const PIECE_SAMPLES = 1 << 18;
/** Decoded files have numbers above those of the page's own files. */
const DECODED = 2 ** 31;
const FOLDER = "decoded";

export class DecodedFiles {
  private files = new Map<number, FileSystemSyncAccessHandle>();
  private prepared = new Set<number>();
  private folder: Promise<FileSystemDirectoryHandle> | undefined;

  /** Decodes a file where only the browser can. Where the browser cannot either, hovertone's own answer says what to do. */
  async prepare(desk: Desk, number: number) {
    if (this.prepared.has(number) || typeof AudioDecoder === "undefined" || !navigator.storage?.getDirectory) return;
    const coded = desk.coded(number);
    this.prepared.add(number);
    if (!coded) return;
    try {
      const config = configOf(coded);
      if (!(await isSupported(config))) return;
      this.folder ??= emptyFolder();
      const folder = await this.folder.catch(() => undefined);
      if (!folder) return;
      const file = await (await folder.getFileHandle(crypto.randomUUID(), { create: true })).createSyncAccessHandle();
      const { samples, firstPacketS } = await decoded(coded, config, file);
      if (samples.bytes === 0) return file.close();
      this.files.set(number + DECODED, file);
      desk.add_decoded(number, number + DECODED, samples.bytes, samples.channelCount, samples.sampleRateHz, firstPacketS);
    } catch (error) {
      this.prepared.delete(number);
      throw inWords(error);
    } finally {
      coded.free();
    }
  }

  /** Reads from a decoded file; `undefined` where there is none of this number. */
  read(number: number, at: number, into: Uint8Array): number | undefined {
    return this.files.get(number)?.read(into, { at });
  }

  remove(number: number) {
    const file = this.files.get(number + DECODED);
    file?.truncate(0);
    file?.close();
    this.files.delete(number + DECODED);
    this.prepared.delete(number);
  }
}

/** The folder, without what earlier visits left there. What another window of the page uses is locked, and stays. */
async function emptyFolder(): Promise<FileSystemDirectoryHandle> {
  const root = await navigator.storage.getDirectory();
  const folder = await root.getDirectoryHandle(FOLDER, { create: true });
  const names: string[] = [];
  for await (const name of folder.keys()) names.push(name);
  await Promise.all(names.map((name) => folder.removeEntry(name).catch(() => {})));
  return folder;
}

function configOf(coded: Coded): AudioDecoderConfig {
  return {
    codec: coded.codec(), description: coded.description(),
    sampleRate: coded.sample_rate_hz(), numberOfChannels: coded.channel_count(),
  };
}

async function isSupported(config: AudioDecoderConfig): Promise<boolean> {
  try {
    return (await AudioDecoder.isConfigSupported(config)).supported === true;
  } catch {
    return false;
  }
}

/** Decodes all packets into a file. At a packet that cannot be decoded the sound ends, as that of a file whose end is missing. */
async function decoded(coded: Coded, config: AudioDecoderConfig, file: FileSystemSyncAccessHandle) {
  const samples = new SamplesFile(file);
  let firstPacketS: number | undefined;
  let failure: unknown;
  let wake = () => {};
  const output = (sound: AudioData) => {
    try {
      if (failure === undefined) samples.take(sound);
    } catch (error) {
      failure = error;
    } finally {
      sound.close();
    }
  };
  const decoder = new AudioDecoder({ output, error: () => wake() });
  decoder.ondequeue = () => wake();
  decoder.configure(config);
  const isGood = () => decoder.state === "configured" && failure === undefined;
  try {
    while (isGood()) {
      const packet = coded.next_packet();
      if (!packet) break;
      firstPacketS ??= packet.at_s;
      decoder.decode(new EncodedAudioChunk({ type: "key", timestamp: Math.round(1e6 * packet.at_s), data: packet.take() }));
      packet.free();
      while (isGood() && decoder.decodeQueueSize > WAITING_MAX) await new Promise<void>((resolve) => (wake = resolve));
    }
    if (isGood()) await decoder.flush().catch(() => {});
    if (failure === undefined) samples.write();
  } finally {
    if (decoder.state !== "closed") decoder.close();
  }
  if (failure !== undefined) throw failure;
  return { samples, firstPacketS: firstPacketS ?? 0 };
}

/** Interleaved samples on their way into a file. */
class SamplesFile {
  bytes = 0;
  channelCount = 0;
  sampleRateHz = 0;
  private piece = new Float32Array(PIECE_SAMPLES);
  private filled = 0;
  private plane = new Float32Array();

  constructor(private file: FileSystemSyncAccessHandle) {}

  take(sound: AudioData) {
    const { numberOfChannels, numberOfFrames, sampleRate } = sound;
    if (this.channelCount === 0) [this.channelCount, this.sampleRateHz] = [numberOfChannels, sampleRate];
    // sound of another format cannot follow in the same file: it ends here
    if (numberOfChannels !== this.channelCount || sampleRate !== this.sampleRateHz) throw new DOMException("", "EncodingError");
    const count = numberOfChannels * numberOfFrames;
    if (this.filled + count > this.piece.length) this.write();
    if (count > this.piece.length) this.piece = new Float32Array(count);
    if (this.plane.length < numberOfFrames) this.plane = new Float32Array(numberOfFrames);
    for (let channel = 0; channel < numberOfChannels; channel++) {
      sound.copyTo(this.plane, { planeIndex: channel, format: "f32-planar" });
      for (let frame = 0; frame < numberOfFrames; frame++) this.piece[this.filled + frame * numberOfChannels + channel] = this.plane[frame];
    }
    this.filled += count;
  }

  /** Writes what is collected. */
  write() {
    const piece = this.piece.subarray(0, this.filled);
    if (this.file.write(piece, { at: this.bytes }) < piece.byteLength) throw new DOMException("", "QuotaExceededError");
    this.bytes += piece.byteLength;
    this.filled = 0;
  }
}

function inWords(error: unknown): string {
  const name = error instanceof DOMException ? error.name : "";
  if (name === "QuotaExceededError") return "the browser has no room to decode this recording; free some disk space, or convert the sound to WAV or FLAC";
  if (name === "EncodingError") return "the sound changes its format within the recording, which the page cannot hear; convert the sound to WAV or FLAC";
  return error instanceof Error ? error.message : String(error);
}
