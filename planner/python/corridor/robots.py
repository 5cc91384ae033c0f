"""Robots from a URDF, from links and joints, or from a rigid body. Pass the results to `corridor.Problem`."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from ._arguments import _array, _file, _flag, _text
from .shapes import Shape, _numbers, _pose, _require_shape


@dataclass(frozen=True)
class Joint:
    """A joint between two links. At the value 0, the child link is at the joint's `origin`; the child link moves as the
    value changes.

    type: "fixed", "revolute", "continuous" (revolute without limits), "prismatic", "planar" or "floating".
    parent, child: names of links. origin: a `Pose` or 4×4, the joint in its parent link. axis: (3,), in the joint's
    frame, of any length except 0; fixed and floating joints have none. limits: (lower, upper), rad or m; revolute and
    prismatic joints need them. velocity: the largest speed, rad/s or m/s, for trajectories. mimic: (joint, multiplier,
    offset); the value is multiplier·(value of the other joint) + offset, and the joint's own limits have no effect.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Any = None
    axis: Sequence[float] = (1.0, 0.0, 0.0)
    limits: tuple[float, float] | None = None
    velocity: float | None = None
    mimic: tuple[str, float, float] | None = None


def robot(
    links: Mapping[str, Shape | Iterable[Shape] | None] | Iterable[tuple[str, Shape | Iterable[Shape] | None]],
    joints: Iterable[Joint], allow: Iterable[tuple[str, str]] = (), planned: Sequence[str] = (),
    base: ArrayLike | None = None, bounds: Mapping[str, ArrayLike] | None = None, name: str = "",
) -> dict[str, Any]:  # fmt: skip
    """Describes a robot by links and joints, which form a tree with one root.

    links: the shapes of each link by its name, in the link's frame; None or () for a link without shapes.
    joints: in any order. allow: pairs of links that may touch. As for a robot from a URDF, two links that a joint
    connects are not tested against each other, unless the joint is planar or floating.
    planned: the names of the joints that are planned for; default: all that can move. The other joints stay at the
    value within their limits that is nearest to 0. base: a `Pose` or 4×4, the pose of the root link. bounds: for each
    planar and floating joint, [[x, y, z], [x, y, z]], the lower and the upper corner of its position, m. name: needed
    if there are several robots.

    `corridor.Problem` raises InputError with all faults. If all poses are given as `Pose`, the robot is the same, to
    the last bit, as the robot of a URDF with equal numbers.
    """
    pairs = links.items() if isinstance(links, Mapping) else links
    return {
        "links": [(_text("links", link), _shapes(shapes)) for link, shapes in pairs],
        "joints": [_joint(joint) for joint in joints],
        "allow": [_pair(pair) for pair in allow],
        "plan": _names("planned", planned),
        "base": _pose("base", base),
        "bounds": _bounds(bounds),
        "name": _text("name", name),
    }


def urdf(
    file: str | os.PathLike[str], srdf: str | os.PathLike[str] | None = None, joints: Sequence[str] = (),
    base: ArrayLike | None = None, bounds: Mapping[str, ArrayLike] | None = None, name: str = "",
) -> dict[str, Any]:  # fmt: skip
    """Describes a robot by a URDF file.

    srdf: a file with pairs of links that may touch. joints: the names of the joints that are planned for; default: all
    that can move. base: a `Pose` or 4×4, the pose of the root link. bounds: for each planar and floating joint,
    [[x, y, z], [x, y, z]], the lower and the upper corner of its position, m. name: needed if there are several robots.
    """
    name_of_file = _file("urdf", file)
    if name_of_file.endswith((".yaml", ".yml")):
        raise ValueError(f"urdf: {file} is no URDF; a robot.yaml belongs to a problem's file, for read_problem")
    return {
        "urdf": os.fsencode(name_of_file),
        "srdf": b"" if srdf is None else os.fsencode(_file("srdf", srdf)),
        "plan": _names("joints", joints),
        "base": _pose("base", base),
        "bounds": _bounds(bounds),
        "name": _text("name", name),
    }


def rigid_body(
    shapes: Shape | Iterable[Shape], bounds: ArrayLike, planar: bool = False, name: str = "body"
) -> dict[str, Any]:
    """Describes a rigid body that moves in space, or in the plane (`planar`).

    bounds: [[x, y, z], [x, y, z]], the lower and the upper corner of its position, m.
    """
    return {
        "shapes": _shapes(shapes),
        "bounds": _array("bounds", bounds),
        "planar": _flag("planar", planar),
        "name": _text("name", name),
    }


def _shapes(shapes: Shape | Iterable[Shape] | None) -> list[Shape]:
    if shapes is None:
        return []
    several = list(shapes) if isinstance(shapes, Iterable) and not isinstance(shapes, (Shape, str)) else [shapes]
    for shape in several:
        _require_shape(shape)
    return several


def _bounds(bounds: Mapping[str, ArrayLike] | None) -> dict[str, Any]:
    if bounds is not None and not isinstance(bounds, Mapping):
        raise ValueError(f"bounds: corners by the names of joints are needed, not {bounds!r}")
    return {joint: _array(f"bounds of {joint}", corners) for joint, corners in (bounds or {}).items()}


def _names(what: str, value: Any) -> list[str]:
    if isinstance(value, str):
        raise ValueError(f"{what}: a list of names is needed, not {value!r}")
    return [_text(what, name) for name in value]


def _pair(pair: Any) -> tuple[str, str]:
    if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
        raise ValueError(f"allow: two names are needed, not {pair!r}")
    return _text("allow", pair[0]), _text("allow", pair[1])


def _joint(joint: Joint) -> dict[str, Any]:
    if not isinstance(joint, Joint):
        raise ValueError(f"joints: a corridor.Joint is needed, not {joint!r}")
    name = _text("name of a joint", joint.name)
    what = f'joint "{name}"'
    limits: tuple[Any, ...] = (None, None) if joint.limits is None else _numbers(f"{what}: limits", joint.limits, 2)
    mimic: tuple[Any, ...] | None = joint.mimic
    if mimic is not None:
        if isinstance(mimic, str) or len(mimic) != 3:
            raise ValueError(f"{what}: mimic: (joint, multiplier, offset) is needed, not {mimic!r}")
        mimic = (_text(f"{what}: mimic", mimic[0]), *_numbers(f"{what}: mimic", mimic[1:], 2))
    return {
        "name": name,
        "type": _text(f"{what}: type", joint.type),
        "parent": _text(f"{what}: parent", joint.parent),
        "child": _text(f"{what}: child", joint.child),
        "origin": _pose(f"{what}: origin", joint.origin),
        "axis": _numbers(f"{what}: axis", joint.axis, 3),
        "lower": limits[0],
        "upper": limits[1],
        "velocity": None if joint.velocity is None else _numbers(f"{what}: velocity", [joint.velocity], 1)[0],
        "mimic": mimic,
    }


def _obstacles(obstacles: Mapping[str, Shape | Iterable[Shape]] | None) -> dict[str, list[Shape]]:
    if obstacles is not None and not isinstance(obstacles, Mapping):
        raise TypeError(f"obstacles: shapes by name are needed, such as {{'table': shape}}, not {obstacles!r}")
    return {_text("obstacles", name): _shapes(shapes) for name, shapes in (obstacles or {}).items()}
