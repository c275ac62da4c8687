"""What a call of Python costs beside the command itself, on a recording of 10 s: run by people, never in a test.

    python crates/python/examples/overhead.py demo/no_hull/trial_1.wav
"""

import statistics
import sys
import time

import hovertone
from hovertone import _native

CALLS = 20


def main(file: str) -> None:
    inside: list[float] = []
    heard = _native.heard

    def timed(*arguments, **more):
        started = time.perf_counter()
        found = heard(*arguments, **more)
        inside.append(time.perf_counter() - started)
        return found

    _native.heard = timed
    for name, recording in (("file", file), ("array", hovertone.load(file))):
        inside.clear()
        whole = []
        for _ in range(CALLS):
            started = time.perf_counter()
            hovertone.speed(recording, vehicle="ardrone")
            whole.append(time.perf_counter() - started)
        core = statistics.median(inside)
        beside = statistics.median(all_s - core_s for all_s, core_s in zip(whole, inside, strict=True))
        print(f"{name}: core {1e3 * core:.0f} ms, beside it {1e3 * beside:.2f} ms = {100 * beside / core:.2f} %")


if __name__ == "__main__":
    main(sys.argv[1])
