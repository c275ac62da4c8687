"""Sound: recordings that were decoded, and arrays."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._words import Path, refused, words

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._flags import HearingFlags

__all__ = ["Recording", "Sound", "load"]

#: What to do with samples where paths are needed.
SAMPLES_HINT = "give names of files, without empty cells; hovertone.speed() hears a Sound, or an array with its rate_hz"
#: Channels that a recording may have. A second axis that is longer is time.
_CHANNELS_MAX = 256


@dataclass(frozen=True, eq=False)
class Sound:
    """The sound of a recording as hovertone hears it: one channel, at its own rate.

    Attributes
    ----------
    samples : numpy.ndarray
        Samples, float32, shape (frames,); full scale is 1.
    rate_hz : float
        Samples per second, with the correction of the recorder's clock.
    start_s : float
        Time of the first sample on the clock of the recording, in s.
    name : str
        Name of the file.
    facts : dict
        Container, codec, decoder, channels and audio tracks of the file.
    warnings : tuple of str
        What weakens the recording.
    """

    samples: NDArray[np.float32]
    rate_hz: float
    start_s: float
    name: str
    facts: Mapping[str, Any]
    warnings: tuple[str, ...]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is None:
            # NumPy 1 knows no such argument of array()
            return np.asarray(self.samples, dtype=dtype)
        return np.array(self.samples, dtype=dtype, copy=copy)

    def __len__(self) -> int:
        return len(self.samples)


#: A file, a decoded recording, or an array of frames, or of frames and channels.
Recording = Union[Path, Sound, NDArray[Any]]


def load(recording: Path | None = None, **flags: Unpack[HearingFlags]) -> Sound:
    """Decode a video or audio file.

    The sound is not resampled. The samples come without a copy.

    Parameters
    ----------
    recording : path
        A video or audio file.
    audio_track : int, optional
        Audio track, counted from 1; the first that is not silent where absent.
    channel : int, optional
        Channel, counted from 1; the mean of all where absent.
    clock_correction_ppm : float, optional
        Correction of the recorder's clock, in millionths.

    Returns
    -------
    Sound
        Samples and their rate.

    Raises
    ------
    FileError
        The file is not there, or has no sound.

    Examples
    --------
    >>> sound = load("hover.wav")
    >>> sound.samples.dtype, sound.rate_hz
    (dtype('float32'), 16000.0)
    """
    if recording is not None and not isinstance(recording, str | os.PathLike):
        raise refused("load decodes one file, and this is no path", "give the name of one file")
    paths = [] if recording is None else [recording]
    samples, rate_hz, start_s, facts, warnings = _native.loaded(words("tones", paths, flags))
    name = "" if recording is None else os.fspath(recording)
    return Sound(samples, rate_hz, start_s, name, json.loads(facts), tuple(warnings))


@dataclass(frozen=True)
class Heard:
    """What a command hears: the word for it, and for an array the array itself with its rate."""

    paths: list[Path]
    samples: NDArray[Any] | None
    rate_hz: float


def to_hear(recording: Recording | None, rate_hz: float | None) -> Heard:
    """What a command hears, from what a user gives."""
    match recording:
        case None:
            return Heard([], None, 0.0)
        case Sound():
            return Heard([recording.name or "sound"], recording.samples, rate_hz or recording.rate_hz)
        case str() | os.PathLike():
            if rate_hz is not None:
                raise refused("rate_hz belongs to an array: a file has a rate of its own", "leave rate_hz out")
            return Heard([recording], None, 0.0)
        case _:
            if _is_several(recording):
                raise refused("this call hears one recording, and several are given",
                              "call hovertone.speeds() for several files, or give one recording")
            return _array(np.asarray(recording), rate_hz)


def _is_several(recording: Any) -> bool:
    """Whether these are recordings, not samples: names of files, or sounds."""
    if isinstance(recording, Mapping | Set | Iterator):
        return True
    if isinstance(recording, list | tuple) and any(isinstance(one, Sound) for one in recording):
        return True
    array = np.asarray(recording)
    return array.dtype.kind in "UT" or (array.dtype.kind == "O" and any(isinstance(one, str | os.PathLike) for one in array.flat))


def _array(samples: NDArray[Any], rate_hz: float | None) -> Heard:
    if rate_hz is None:
        raise refused("an array has no rate of its own", "give rate_hz, the samples per second")
    if samples.ndim not in (1, 2):
        raise refused(f"samples have one or two axes, frames and channels, and this array has {samples.ndim}",
                       "give one array for each recording")
    if samples.ndim == 2 and samples.shape[1] > _CHANNELS_MAX:
        raise refused(f"the array has {samples.shape[0]} frames of {samples.shape[1]} channels", "frames come first: give samples.T")
    return Heard(["array"], np.ascontiguousarray(samples), float(rate_hz))
