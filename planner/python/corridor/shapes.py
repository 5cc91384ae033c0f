"""Shapes of links, obstacles and rigid bodies. Lengths are metres.

`pose` is a 4×4 matrix, or a `Pose`; default: the identity. For the 3×3 part M of a matrix, each element of MᵀM may
differ from the identity by 1e-6; M then stands for the nearest rotation. The vertices of a mesh are moved to the pose
in double, with rounding.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arguments import _array, _file, _flag, _number, _whole


@dataclass(frozen=True)
class Pose:
    """A position, m, and roll, pitch and yaw, rad, as in URDF. NumPy takes it as a 4×4 matrix.

    rpy: rotations about the fixed axes x, then y, then z. Multiples of a quarter turn are exact.
    """

    xyz: Sequence[float] = (0.0, 0.0, 0.0)
    rpy: Sequence[float] = (0.0, 0.0, 0.0)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[np.float64]:
        """Returns the 4×4 matrix."""
        matrix = _native.pose_matrix(_numbers("xyz", self.xyz, 3), _numbers("rpy", self.rpy, 3))
        return matrix if dtype is None else matrix.astype(dtype)


class Shape(tuple[Any, ...]):
    """A shape: its kind, its numbers, and its pose. The functions of this module make shapes."""

    __slots__ = ()


def _require_shape(shape: object) -> None:
    if not isinstance(shape, Shape):
        hint = "; shapes.mesh_file(FILE) reads a mesh" if isinstance(shape, (str, os.PathLike)) else ""
        raise TypeError(f"a shape of corridor.shapes is needed, not {shape!r}{hint}")


def _numbers(name: str, value: Any, count: int) -> tuple[float, ...]:
    array = _array(name, value)
    if array.shape != (count,):
        raise ValueError(f"{name}: {count} numbers are needed, not an array of shape {array.shape}")
    return tuple(array.tolist())


def _pose(name: str, value: Any) -> Any:
    """Returns a pose in the form that the native module takes."""
    if isinstance(value, Pose):
        return (_numbers(f"{name}: xyz", value.xyz, 3), _numbers(f"{name}: rpy", value.rpy, 3))
    return None if value is None else _array(name, value)


def _indices(triangles: Any) -> NDArray[np.int64]:
    try:
        array = np.array(triangles)
    except ValueError as error:
        raise ValueError(f"triangles: an array of whole numbers is needed: {error}") from None
    if not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"triangles: an array of whole numbers is needed, not of {array.dtype}")
    return array.astype(np.int64)


def _shape(kind: str, *numbers: Any, pose: ArrayLike | None) -> Shape:
    return Shape((kind, *numbers, _pose("pose", pose)))


def _size(size: ArrayLike) -> NDArray[np.float64]:
    array = _array("size", size)
    if array.shape != (3,):
        raise ValueError(f"size: three numbers are needed, not an array of shape {array.shape}")
    return array.reshape(1, 3)


def box(size: ArrayLike, pose: ArrayLike | None = None) -> Shape:
    """A solid box with the full edge lengths `size`, (3,), centred at the pose."""
    return _shape("box", _size(size), pose=pose)


def sphere(radius: float, pose: ArrayLike | None = None) -> Shape:
    """A solid sphere."""
    return _shape("sphere", _number("radius", radius), pose=pose)


def capsule(radius: float, length: float, pose: ArrayLike | None = None) -> Shape:
    """A solid capsule along z; `length` is the distance of the centres of its end spheres."""
    return _shape("capsule", _number("radius", radius), _number("length", length), pose=pose)


def cylinder(radius: float, length: float, pose: ArrayLike | None = None) -> Shape:
    """A solid cylinder along z; `length` is its full length."""
    return _shape("cylinder", _number("radius", radius), _number("length", length), pose=pose)


def convex(points: ArrayLike, pose: ArrayLike | None = None) -> Shape:
    """The solid convex hull of points, (N, 3)."""
    return _shape("convex", _array("points", points), pose=pose)


def mesh(vertices: ArrayLike, triangles: ArrayLike, solid: bool = False, pose: ArrayLike | None = None) -> Shape:
    """A mesh of vertices, (V, 3), and triangles, (T, 3) indices from 0.

    The shape is a surface. With `solid`, everything inside belongs to the shape, and the mesh must be watertight.
    """
    return _shape("mesh", _array("vertices", vertices), _indices(triangles), _flag("solid", solid), pose=pose)


def points(points: ArrayLike, radius: float, pose: ArrayLike | None = None) -> Shape:
    """A cloud: balls of a radius about points, (N, 3), such as a camera's."""
    return _shape("points", _array("points", points), _number("radius", radius), pose=pose)


def isolated(points: ArrayLike, distance: float, neighbours: int = 1) -> NDArray[np.bool_]:
    """For each point, whether fewer than `neighbours` other points are at most `distance` (m) away.

    A camera's stray points are mostly so: `points[~isolated(points, 0.05)]` are the others. What is left out is no
    obstacle: a thin wire may be among it.
    """
    number = _number("distance", distance)
    return _native.isolated(_array("points", points), number, _whole("neighbours", neighbours, 1))


def mesh_file(
    file: str | os.PathLike[str], metres_per_unit: float | None = None, solid: bool = False, pose: ArrayLike | None = None
) -> Shape:
    """A mesh file: OBJ, STL, PLY, OFF, Collada, glTF and more. If metres_per_unit is None, the file's unit is used."""
    unit = None if metres_per_unit is None else _number("metres_per_unit", metres_per_unit)
    return _shape("file", os.fsencode(_file("file", file)), unit, _flag("solid", solid), pose=pose)
