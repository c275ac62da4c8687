"""Files per second and accuracy beside scripts of librosa and scipy, over the recordings of the demo: run by people, never in a test.

    pip install librosa scipy 'ray[data]' pyarrow pandas
    python -c 'import hovertone; hovertone.demo("demo")'
    python crates/python/examples/peers.py demo

Every script is told the best that its options allow: the blade pass between 90 and 160 Hz, or the gear mesh between 3450 and 4830 Hz. The truth is
the mean speed of the four rotors.
"""

import os

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

import statistics
import sys
import time
from pathlib import Path

import hovertone
import hovertone.ray
import librosa
import numpy as np
import pandas as pd
import ray
from scipy.signal import spectrogram

HOP_S = 0.05
FRAME = 16_384


def by_hovertone(file):
    return hovertone.speed(file, vehicle="ardrone").speed_rev_s


def by_hovertone_mean_only(file):
    return hovertone.speed(file, vehicle="ardrone", mean_only=True).speed_rev_s


def by_scipy(file):
    sound = hovertone.load(file)
    overlap = FRAME - int(HOP_S * sound.rate_hz)
    hz, _, level = spectrogram(sound.samples, sound.rate_hz, "hann", FRAME, overlap, mode="magnitude")
    band = (hz >= 3450) & (hz <= 4830)
    return hz[band][level[band].argmax(0)].mean() / 69


def by_yin(file):
    sound = hovertone.load(file)
    hop = int(HOP_S * sound.rate_hz)
    return np.median(librosa.yin(sound.samples, fmin=90, fmax=160, sr=sound.rate_hz, frame_length=8192, hop_length=hop)) / 2


def by_pyin(file):
    sound = hovertone.load(file)
    hop = int(HOP_S * sound.rate_hz)
    options = {"fmin": 90, "fmax": 160, "frame_length": 8192, "max_transition_rate": 8, "fill_na": None}
    return np.median(librosa.pyin(sound.samples, sr=sound.rate_hz, hop_length=hop, **options)[0]) / 2


def by_ray(folder, files):
    """All at once on Ray, with two workers: speeds, and files per second of the clock on the wall once the workers are there."""
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    paths = [(folder / file).absolute() for file in files]
    hovertone.ray.speeds(paths[:2], vehicle="ardrone").materialize()
    started = time.perf_counter()
    found = hovertone.ray.speeds(paths, vehicle="ardrone").to_pandas().set_index("file")["speed_rev_s"]
    return [found[str(path)] for path in paths], len(paths) / (time.perf_counter() - started)


def print_row(name, rate, heard, true_rev_s) -> None:
    errors = [100 * abs(speed / true - 1) for speed, true in zip(heard, true_rev_s, strict=True)]
    print(f"| {name} | {rate:.2g} | {statistics.median(errors):.2g} | {max(errors):.2g} |", flush=True)


def main(folder: Path) -> None:
    truth = pd.read_csv(folder / "truth.csv")
    true_rev_s = truth[[f"rotor_{rotor}_mean_speed_rev_s" for rotor in range(1, 5)]].mean(axis=1)
    print("| script | files/s of a core | median error, % | largest error, % |\n|---|---|---|---|")
    for hear in (by_hovertone, by_hovertone_mean_only, by_scipy, by_yin, by_pyin):
        hear(folder / truth["recording"][0])
        started = time.process_time()
        heard = [hear(folder / file) for file in truth["recording"]]
        print_row(hear.__name__[3:], len(heard) / (time.process_time() - started), heard, true_rev_s)
    heard, rate = by_ray(folder, truth["recording"])
    print_row("hovertone.ray, two workers together", rate, heard, true_rev_s)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
