"""Draws docs/synthetic-and-real.png: a simulated AR.Drone beside a real small multirotor.

    hovertone simulate validation/spectrogram/ardrone.toml -o /tmp/ardrone
    python draw.py /tmp/ardrone/sound.wav DRONE_001.wav ../../docs/synthetic-and-real.png

Needs numpy, matplotlib and pillow. DRONE_001.wav is of the DroneDetectionThesis data set (CC0); it is not part of this
project, only the picture is.
"""

import io
import sys
import wave

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

SPANS_HZ = [(0.0, 9000.0, 2048), (0.0, 1000.0, 16384)]
RANGE_DB = 55.0


def samples_of(path):
    """First channel and rate of a 16-bit WAV file."""
    with wave.open(path) as file:
        assert file.getsampwidth() == 2, "16 bits are expected"
        data = np.frombuffer(file.readframes(file.getnframes()), "<i2")
        return data.reshape(-1, file.getnchannels())[:, 0] / 32768.0, file.getframerate()


def spectrogram(samples, length):
    """Power of Hann frames that overlap by three quarters, dB."""
    window = np.hanning(length)
    starts = np.arange(0, len(samples) - length, length // 4)
    frames = np.stack([samples[start : start + length] * window for start in starts])
    return 10 * np.log10(np.abs(np.fft.rfft(frames)) ** 2 + 1e-12).T, starts + length / 2


def main(simulated, real, picture):
    figure, axes = plt.subplots(2, 2, figsize=(10.5, 7.0), sharex=True, constrained_layout=True)
    sounds = [("simulated AR.Drone, microphone 3.7 m away", simulated), ("real multirotor (DRONE_001, CC0)", real)]
    for column, (title, path) in enumerate(sounds):
        samples, rate_hz = samples_of(path)
        for row, (low_hz, high_hz, length) in enumerate(SPANS_HZ):
            power_db, centres = spectrogram(samples, length)
            frequency_hz = np.arange(power_db.shape[0]) * rate_hz / length
            seen = (frequency_hz >= low_hz) & (frequency_hz <= high_hz)
            top_db = np.percentile(power_db[seen], 99.7)
            axis = axes[row, column]
            axis.pcolormesh(
                centres / rate_hz, frequency_hz[seen] / 1000, power_db[seen],
                vmin=top_db - RANGE_DB, vmax=top_db, cmap="magma", shading="auto", rasterized=True,
            )
            axis.set_ylim(low_hz / 1000, high_hz / 1000)
            axis.set_xlim(0, 7.5)  # then the real one is spliced
            if row == 0:
                axis.set_title(title, fontsize=10)
            if row == 1:
                axis.set_xlabel("time, s")
            if column == 0:
                axis.set_ylabel("frequency, kHz")
    memory = io.BytesIO()
    figure.savefig(memory, dpi=100)
    # 128 colours are plenty for one colour map
    Image.open(memory).convert("RGB").quantize(128).save(picture, optimize=True)


if __name__ == "__main__":
    main(*sys.argv[1:4])
