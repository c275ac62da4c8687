// In the browser's audio thread: collects what the microphone hears into blocks, and hands them to the worker that listens.

declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

const BLOCK_SAMPLES = 2048;

registerProcessor("microphone", class extends AudioWorkletProcessor {
  private block = new Float32Array(BLOCK_SAMPLES);
  private filled = 0;
  private ear: MessagePort | undefined;

  constructor() {
    super();
    this.port.onmessage = ({ data }) => (this.ear = data);
  }

  process(inputs: Float32Array[][]): boolean {
    const samples = inputs[0]?.[0] ?? [];
    for (const sample of samples) {
      this.block[this.filled++] = sample;
      if (this.filled < BLOCK_SAMPLES) continue;
      this.ear?.postMessage(this.block, [this.block.buffer]);
      [this.block, this.filled] = [new Float32Array(BLOCK_SAMPLES), 0];
    }
    return true;
  }
});

export {};
