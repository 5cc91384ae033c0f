"""Collision queries of two bodies. Poses are 4×4 matrices, or N×4×4 for N queries at once.

A matrix may be any affine map, even a map that scales, and is used as it is. Only the poses of `first_contact` must be
rigid. For their 3×3 part M, each element of MᵀM may differ from the identity by 1e-6; M then stands for the nearest
rotation.
"""

from __future__ import annotations

import copy
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arguments import _array, _number, _whole
from .results import Verdict
from .shapes import Shape, _require_shape

_ORIGIN = np.eye(4)


class Body:
    """A body of one shape (`corridor.shapes`): a mesh or a convex solid.

    Its trees are built when a query first needs them. Raises ValueError for a solid mesh that is not watertight. A body
    can be pickled. Unpickling reads a mesh file again, and raises ValueError if the mesh has changed.
    """

    def __init__(self, shape: Shape):
        _require_shape(shape)
        self._shape = copy.deepcopy(shape)
        self._native = _native.body(shape)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self._shape, _native.shape_fingerprint(self._shape))

    def __repr__(self) -> str:
        return f"<Body: {self._shape[0]}>"


def _restored(kind: type[Body], shape: Shape, fingerprint: str) -> Body:
    if _native.shape_fingerprint(shape) != fingerprint:
        raise ValueError(f"{shape[1]}: this mesh file has changed since the body was pickled")
    return kind(shape)


class Distances(NamedTuple):
    """Distances of two bodies at N poses, and the closest points of the bodies."""

    distance: NDArray[np.float64]  #: N metres; 0 if and only if the bodies touch
    on_a: NDArray[np.float64]  #: N×3, the closest point of a, world coordinates
    on_b: NDArray[np.float64]  #: N×3, the closest point of b, world coordinates


class Contacts(NamedTuple):
    """The pairs of triangles of two meshes that touch."""

    pairs: NDArray[np.int64]  #: N×2, indices of a triangle of a and a triangle of b that touch
    segments: NDArray[np.float64]  #: N×2×3, the ends of the segment that the two triangles share, world coordinates


class FirstContact(NamedTuple):
    """The first contact of a motion."""

    verdict: Verdict
    free_until: float  #: the motion is proved free on [0, free_until]
    time: float  #: if CONTACT: the first contact is in [free_until, time]; if UNDECIDED: an undecided time; if FREE: −1


def _natives(a: Body, b: Body) -> tuple[_native.Body, _native.Body]:
    for name, body in (("a", a), ("b", b)):
        if not isinstance(body, Body):
            hint = "; Body(shape) makes one" if isinstance(body, Shape) else ""
            raise TypeError(f"{name}: a Body is needed, not {body!r}{hint}")
    return a._native, b._native


def _poses(pose_a: ArrayLike, pose_b: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return _array("pose_a", pose_a), _array("pose_b", pose_b)


def touch(
    a: Body, b: Body, pose_a: ArrayLike = _ORIGIN, pose_b: ArrayLike = _ORIGIN, threads: int = 0
) -> NDArray[np.bool_]:
    """Returns whether the bodies touch: N bool. Exact for meshes; one common point is contact."""
    return _native.touch(*_natives(a, b), *_poses(pose_a, pose_b), _whole("threads", threads, 0))


def closer_than(
    a: Body, b: Body, distance: float, pose_a: ArrayLike = _ORIGIN, pose_b: ArrayLike = _ORIGIN, threads: int = 0
) -> NDArray[np.bool_]:
    """Returns whether the bodies are at most `distance` metres apart: N bool. False is a proof."""
    limit = _number("distance", distance)
    return _native.closer_than(*_natives(a, b), limit, *_poses(pose_a, pose_b), _whole("threads", threads, 0))


def distance(
    a: Body, b: Body, pose_a: ArrayLike = _ORIGIN, pose_b: ArrayLike = _ORIGIN, threads: int = 0
) -> Distances:
    """Returns the distances of the bodies, and the closest points of the bodies."""
    return Distances(*_native.distance(*_natives(a, b), *_poses(pose_a, pose_b), _whole("threads", threads, 0)))


def contacts(a: Body, b: Body, pose_a: ArrayLike = _ORIGIN, pose_b: ArrayLike = _ORIGIN) -> Contacts:
    """Returns all pairs of triangles of two meshes that touch, for one pair of poses."""
    return Contacts(*_native.contacts(*_natives(a, b), *_poses(pose_a, pose_b)))


def first_contact(a: Body, b: Body, start: ArrayLike, end: ArrayLike, tolerance: float = 0.0) -> FirstContact:
    """Returns the first contact while a moves from pose `start` to pose `end`, and b rests at the origin.

    The position moves along a line, and the rotation is a slerp.
    tolerance: metres; 0: a default that depends on the sizes of the bodies.
    """
    if not _number("tolerance", tolerance) >= 0:
        raise ValueError("tolerance: a number of 0 or more is needed")
    verdict, until, time = _native.first_contact(*_natives(a, b), _array("start", start), _array("end", end), tolerance)
    return FirstContact(Verdict(verdict), until, time)
