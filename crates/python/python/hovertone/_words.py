"""From keywords to the words of the command line, so that a flag has one meaning and a refusal one wording."""

from __future__ import annotations

import numbers
import os
from collections.abc import Iterable, Mapping, Set

from ._errors import WrongUseError

Path = str | os.PathLike[str]
_PATHS_HINT = "give names of files; leave out empty cells"


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
        return [f"{flag}={_text(load)}={os.fspath(file)}" for load, files in value.items() for file in paths_of(files)]
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


def paths_of(given: Path | Iterable[Path], hint: str = _PATHS_HINT) -> list[Path]:
    """The paths of one path or of any iterable of paths; a set is sorted, so that its sequence is the same in every run.

    Examples
    --------
    >>> paths_of("a.wav"), paths_of(name for name in ["b.wav", "a.wav"]), paths_of({"b.wav", "a.wav"})
    (['a.wav'], ['b.wav', 'a.wav'], ['a.wav', 'b.wav'])
    """
    if isinstance(given, str | os.PathLike):
        return [given]
    if is_table(given):
        raise refused("paths are needed, and this is a table", 'give the column with the names, such as table["file"]')
    if not isinstance(given, Iterable) or isinstance(given, bytes) or getattr(given, "shape", None) == ():
        raise refused(f"paths are needed, and this is {_named(given)}", hint)
    # a scalar of Arrow is the word in it
    paths = [path.as_py() if hasattr(path, "as_py") else path for path in given]
    for number, path in enumerate(paths, 1):
        if not isinstance(path, str | os.PathLike):
            raise refused(f"paths are needed, and number {number} of them is {_named(path)}", hint)
    return sorted(paths, key=os.fspath) if isinstance(given, Set) else paths


def is_table(given: object) -> bool:
    """Whether this has columns: a mapping, or a table of pandas, Polars or Arrow."""
    return isinstance(given, Mapping) or any(hasattr(given, name) for name in ("columns", "to_pydict", "__dataframe__"))


def refused(what: str, hint: str) -> WrongUseError:
    """The refusal in the form of the command line."""
    return WrongUseError(f"{what} (hint: {hint})", what, hint)


def _named(value: object) -> str:
    if value is None:
        return "None"
    kind = type(value).__name__
    return f"{value!r:.40} ({kind})" if isinstance(value, numbers.Number | bytes) else f"of the type {kind}"


def _file(path: Path) -> str:
    # such a word is a file and no flag; nor is it stdin, which is that of the interpreter
    return "./" + os.fspath(path) if os.fspath(path).startswith("-") else os.fspath(path)
