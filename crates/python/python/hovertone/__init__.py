"""hovertone hears a multirotor hover and tells its rotor speeds and its thrust constant.

>>> import hovertone
>>> found = hovertone.speed("hover.wav", blades=2)
>>> f"{found.speed_rev_s:.1f} rev/s"
'61.3 rev/s'

The calls are the commands of the command line: the same flags, the same numbers, the same refusals. Each runs without the GIL, so that
threads of Python hear recordings at the same time.
"""

from ._errors import FileError, HovertoneError, NoRotorToneError, WrongUseError
from ._estimate import Estimate
from ._export import export
from ._fit import Fit, fit, fits
from ._identify import Identification, identify
from ._plan import FlightPlan, plan
from ._simulation import Simulation, demo, simulate
from ._sound import Sound, load
from ._speed import Reading, Rotor, Speed, Track, speed, speeds, track
from ._tones import ToneFamily, Tones, tones
from ._weigh import Weighed, weigh

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
