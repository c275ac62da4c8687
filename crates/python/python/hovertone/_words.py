"""From keywords to the words of the command line, so that a flag has one meaning and a refusal one wording."""

from __future__ import annotations

import numbers
import os
from collections.abc import Iterable, Mapping, Sequence

Path = str | os.PathLike[str]


def words(command: str, paths: Iterable[Path], flags: Mapping[str, object]) -> list[str]:
    """The words of a command: its name, its files, its flags.

    Examples
    --------
    >>> words("speed", ["hover.wav"], {"blades": 2, "band": (100, 200.5), "from_": "1:02.5", "mean_only": True, "gear": None})
    ['speed', 'hover.wav', '--blades=2', '--band=100:200.5', '--from=1:02.5', '--mean-only']
    >>> words("identify", [], {"mass": {"413g": ["a.wav", "b.wav"], 0.5: "loaded"}})
    ['identify', '--mass=413g=a.wav', '--mass=413g=b.wav', '--mass=0.5=loaded']
    """
    of_flags = [word for name, value in flags.items() for word in _flag(name, value)]
    return [command, *(_file(path) for path in paths), *of_flags]


def _flag(name: str, value: object) -> list[str]:
    flag = "--" + name.rstrip("_").replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [flag]
    if isinstance(value, Mapping):
        return [f"{flag}={_text(load)}={file}" for load, files in value.items() for file in _each(files)]
    return [f"{flag}={_text(value)}"]


def _text(value: object) -> str:
    match value:
        case str() | os.PathLike():
            return os.fspath(value)
        case numbers.Integral():
            return str(int(value))
        case numbers.Real():
            return repr(float(value))
        case [*parts] if all(isinstance(part, numbers.Real) for part in parts):
            return ":".join(_text(part) for part in parts)
        case [*parts]:
            return ",".join(_text(part) for part in parts)
        case _:
            return str(value)


def _each(files: Path | Sequence[Path]) -> list[str]:
    return [os.fspath(files)] if isinstance(files, str | os.PathLike) else [os.fspath(file) for file in files]


def _file(path: Path) -> str:
    # such a word is a file and no flag; nor is it stdin, which is that of the interpreter
    return "./" + os.fspath(path) if os.fspath(path).startswith("-") else os.fspath(path)
