"""Exceptions of the package."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple


class Fault(NamedTuple):
    """One fault of a file or an argument: where it is, what is wrong, and what would be right."""

    file: str
    line: int
    text: str


class InputError(ValueError):
    """Bad input: a file, or a problem that can't be planned.

    `faults` lists all faults. The text of the exception has one line for each fault.
    """

    def __init__(self, text: str, faults: Iterable[tuple[str, int, str]] = ()):
        super().__init__(text, faults)
        self.text = text
        self.faults = [Fault(*fault) for fault in faults]

    def __str__(self) -> str:
        return self.text
