"""Certificates: the proof of an edge, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from .results import Verdict

if TYPE_CHECKING:
    from .problem import Problem


class CertificateFault(NamedTuple):
    """Why a certificate is not accepted."""

    kind: str
    """One of these words:

    "gap": the intervals of the pair do not cover time t. "refuted": at t, the pair is closer than an interval claims,
    or one body is inside the other. "unproved": the edge keeps the margin at t, but the method of `check` can't prove
    the interval with tube and rounding. "work limit": the check took too long. "malformed": the arrays are no
    certificate of this problem. "ambiguous": the edge is no motion, such as a half turn. "floating point": the
    processor's rounding mode is not the usual one.
    """
    pair: int  #: index into `Certificate.pairs`
    t: float  #: time on the edge, from 0 to 1


@dataclass(eq=False)
class Certificate:
    """The proof of one edge from q0 to q1, as data. Time t is 0 at q0 and 1 at q1.

    Interval k states: on all of [t0[k], t1[k]], for every path in the tube, the two shapes of `shapes[pair[k]]` stay
    at least `clearance[k]` metres apart. This distance includes the margin; all rounding is covered. For each pair, the
    intervals cover [0, free_until] without a gap. They are in any order, and some may lie beyond `free_until`.
    Intervals are statements about surfaces. `Problem.certificate` also tests whether a body is inside a solid mesh; if
    only this test decides the verdict, there are no intervals.

    Pairs that are not tested, such as adjacent links, are not listed.
    """

    problem: Problem
    q0: NDArray[np.float64]  #: (J,)
    q1: NDArray[np.float64]  #: (J,)
    verdict: Verdict
    reason: str  #: why undecided: "clearance", "work limit", "ambiguous", "rounding", "floating point",
    #: "beyond proofs" (outside of the joint limits, where never_in_contact proves nothing); or ""
    free_until: float  #: proved free on [0, free_until]; 0: nothing is proved. The bounds of joints are not tested
    shapes: list[tuple[str, str]]  #: P names of shapes, a and b of each tested pair
    pairs: NDArray[np.int64]  #: P×2, the bodies of each tested pair, indices into `problem.bodies`
    margins: NDArray[np.float64]  #: P, the distance that each pair must keep, m
    pair: NDArray[np.int64]  #: K, index into `pairs`
    t0: NDArray[np.float64]  #: K, multiples of 2^-48
    t1: NDArray[np.float64]  #: K
    clearance: NDArray[np.float64]  #: K, m
    contact: tuple[int, int] | None  #: the two bodies in contact or undecided, indices into `problem.bodies`
    time: float | None  #: time of the contact, or a time at which the edge is undecided
    point: NDArray[np.float64] | None  #: (3,), the point of contact, in the frame of the body `contact[0]`, m
    tolerance: float  #: the checker's tolerance, m: UNDECIDED is possible if the clearance is below twice this

    @property
    def tube(self) -> NDArray[np.float64]:
        """`Problem.tube`, (J,)."""
        return self.problem.tube

    def covered(self) -> NDArray[np.float64]:
        """Returns (P,): for each pair, the time up to which the pair's intervals cover the edge from 0 without a gap."""
        ends = np.zeros(len(self.pairs))
        for k in np.lexsort((self.t0, self.pair)):
            p = self.pair[k]
            if 0 <= p < len(ends) and 0 <= self.t0[k] <= ends[p] and self.t1[k] <= 1:
                ends[p] = max(ends[p], self.t1[k])
        return ends

    def _mismatch(self) -> CertificateFault | None:
        """Returns a fault if the pairs are not the problem's, or if the verdict is FREE and `free_until` is not 1."""
        known = _native.certificate_pairs(self.problem._native)
        same = (
            self.shapes == known["shapes"]
            and np.array_equal(self.pairs, known["pairs"])
            and np.array_equal(self.margins, known["margins"])
        )
        if not same or self.pair.dtype.kind not in "iu":
            return CertificateFault("malformed", 0, 0.0)
        if self.verdict == Verdict.FREE and self.free_until != 1:
            return CertificateFault("gap", 0, self.free_until)
        return None

    def check(self) -> CertificateFault | None:
        """Proves the intervals again, by another method on other trees. Returns None, or the first fault.

        Proves that each pair stays farther apart than margin + (clearance − margin)/2 in its intervals, and that the
        intervals of each pair cover [0, free_until]. If `free_until` is 0, nothing is proved. The fault "unproved" is
        no refutation. With default options and without a tube, at most one in 100 certificates of random edges gets
        this fault.
        """
        if mismatch := self._mismatch():
            return mismatch
        fault = _native.certificate_fault(
            self.problem._native, self.q0, self.q1, self.free_until, self.pair, self.t0, self.t1, self.clearance
        )
        return None if fault is None else CertificateFault(*fault)

    def __repr__(self) -> str:
        return (
            f"<Certificate: {self.verdict.name.lower().replace('_', ' ')}, {len(self.pairs)} pairs, "
            f"{len(self.pair)} intervals>"
        )


def certificate_of(problem: Problem, q0: NDArray[np.float64], q1: NDArray[np.float64], earliest: bool) -> Certificate:
    """Makes the certificate of an edge; see `Problem.certificate`."""
    made: dict[str, Any] = _native.certificate(problem._native, q0, q1, earliest)
    made["verdict"] = Verdict(made["verdict"])
    return Certificate(problem=problem, q0=q0, q1=q1, **made)
