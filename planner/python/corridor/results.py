"""Answers for states and edges."""

from __future__ import annotations

import enum

import numpy as np
from numpy.typing import NDArray


class Verdict(enum.IntEnum):
    """The answer for a state or an edge."""

    FREE = 0  #: proved: all pairs keep the margin; the proof covers tube and rounding
    CONTACT = 1  #: a pair touches, or is not farther apart than the margin
    UNDECIDED = 2  #: neither FREE nor CONTACT is proved; usually the clearance is below twice the tolerance
    OUT_OF_BOUNDS = 3  #: a joint or a position is out of bounds


class Results:
    """Answers for N states or edges, as arrays.

    verdict: N int8, values of Verdict.
    time: N float, the time on the edge, in [0, 1], at which there is a contact or the edge is undecided; else NaN.
    gap: N float, metres, the distance of an undecided pair beyond the margin.
    pairs: N×2 int64, indices into `bodies`; −1 if there is no pair.
    """

    def __init__(self, bodies: list[str], verdict: NDArray[np.int8], time: NDArray[np.float64],
                 gap: NDArray[np.float64], pairs: NDArray[np.int64]):  # fmt: skip
        self.bodies, self.verdict, self.time, self.gap, self.pairs = bodies, verdict, time, gap, pairs

    @property
    def free(self) -> NDArray[np.bool_]:
        """N bool: whether each row is proved free."""
        free: NDArray[np.bool_] = self.verdict == Verdict.FREE
        return free

    def pair(self, i: int) -> tuple[str, str] | None:
        """Returns the names of the two bodies of row i; None if the row has no pair."""
        a, b = self.pairs[i]
        return None if a < 0 else (self.bodies[a], self.bodies[b])

    def __len__(self) -> int:
        return len(self.verdict)

    def __bool__(self) -> bool:
        """Returns whether all rows are free."""
        return bool(self.free.all())

    def __repr__(self) -> str:
        counts = ", ".join(f"{int((self.verdict == v).sum())} {v.name.lower().replace('_', ' ')}" for v in Verdict)
        return f"<Results: {counts}>"
