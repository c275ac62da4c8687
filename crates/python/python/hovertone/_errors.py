"""Exceptions. Their text is the line that the command line prints after ``error:``."""

from __future__ import annotations

import os


class HovertoneError(Exception):
    """A call that could not be done.

    Parameters
    ----------
    words : str
        The whole message, as the command line prints it.
    what : str
        What happened, and why.
    hint : str
        What to do; empty where `what` has it.
    path : str or os.PathLike, optional
        The file that it is about.
    """

    def __init__(self, words: str, what: str = "", hint: str = "", path: str | os.PathLike[str] | None = None) -> None:
        super().__init__(words)
        self.words = words
        self.what = what or words
        self.hint = hint
        self.path = None if path is None else os.fspath(path)

    def __reduce__(self) -> tuple[type[HovertoneError], tuple[str, str, str, str | None]]:
        return type(self), (self.words, self.what, self.hint, self.path)


class WrongUseError(HovertoneError, ValueError):
    """A flag or a number has no meaning, or a file that exists would be replaced (exit code 2 of the command line)."""


class FileError(HovertoneError):
    """A file or folder is not there, is of another kind, or cannot be read or written (exit code 1)."""


class NoRotorToneError(HovertoneError):
    """No recording has the rotor tone that the result needs (exit code 3)."""
