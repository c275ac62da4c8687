"""hovertone hears a multirotor hover and tells its rotor speeds and its thrust constant.

>>> import hovertone
>>> found = hovertone.speed("hover.wav", blades=2)
>>> f"{found.speed_rev_s:.1f} rev/s"
'61.3 rev/s'

The calls are the commands of the command line: the same flags, the same numbers, the same refusals. Each runs without the GIL, so that
threads of Python hear recordings at the same time.
"""

from ._errors import FileError, HovertoneError, NoRotorToneError, WrongUseError
from ._simulation import Simulation, demo, simulate
from ._sound import Sound, load
from ._speed import Reading, Rotor, Speed, Track, speed, speeds, track
from ._thrust import Estimate, Fit, FlightPlan, Identification, Weighed, export, fit, fits, identify, plan, weigh
from ._tones import ToneFamily, Tones, tones

__all__ = [
    "Estimate",
    "FileError",
    "Fit",
    "FlightPlan",
    "HovertoneError",
    "Identification",
    "NoRotorToneError",
    "Reading",
    "Rotor",
    "Simulation",
    "Sound",
    "Speed",
    "ToneFamily",
    "Tones",
    "Track",
    "Weighed",
    "WrongUseError",
    "demo",
    "export",
    "fit",
    "fits",
    "identify",
    "load",
    "plan",
    "simulate",
    "speed",
    "speeds",
    "tones",
    "track",
    "weigh",
]
