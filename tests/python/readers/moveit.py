"""Reads MoveIt's messages PlanningScene and MotionPlanRequest, as YAML. For tests only.

Written from the definitions of the messages, with no code of Corridor. All scalars are texts, as problems.load gives.
"""

import numpy as np
from solids import Shape
from transforms import pose, rotation_of_quaternion

_TYPES = {"1": "box", "2": "sphere", "3": "cylinder", "4": "cone"}


def _vector(keys, names="xyz"):
    """A vector or quaternion: a map of its components, or a list."""
    return [float(keys.get(name, 0)) for name in names] if isinstance(keys, dict) else [float(v) for v in keys]


def _pose(keys):
    if not keys:
        return np.eye(4)
    rotation = None
    if "orientation" in keys:
        rotation = rotation_of_quaternion(_vector(keys["orientation"], "xyzw"))
    return pose(_vector(keys.get("position", (0, 0, 0))), rotation)


def _primitive(keys, X):
    kind, size = _TYPES.get(keys["type"], keys["type"]), _vector(keys["dimensions"])
    if kind == "box":
        return Shape("box", X, size=size)
    if kind == "sphere":
        return Shape("sphere", X, radius=size[0])
    assert kind == "cylinder", kind
    return Shape("cylinder", X, length=size[0], radius=size[1])


class Scene:
    """Obstacles, pairs of bodies that may touch (`allowed`) and that may not (`denied`), and whether the matrix of these
    pairs replaces the SRDF's."""

    def __init__(self, keys, base, root):
        self.objects = {}
        for thing in keys.get("world", {}).get("collision_objects", []):
            frame = thing.get("header", {}).get("frame_id", "").lstrip("/")
            X = (base if frame == root else np.eye(4)) @ _pose(thing.get("pose"))
            poses = thing.get("primitive_poses", [])
            shapes = [_primitive(p, X @ _pose(at)) for p, at in zip(thing.get("primitives", []), poses)]
            for mesh, at in zip(thing.get("meshes", []), thing.get("mesh_poses", [])):
                vertices = np.array([_vector(v) for v in mesh["vertices"]])
                triangles = np.array([[int(i) for i in t["vertex_indices"]] for t in mesh["triangles"]])
                shapes.append(Shape("mesh", X @ _pose(at), vertices=vertices, triangles=triangles))
            self.objects[thing["id"]] = shapes
        matrix = keys.get("allowed_collision_matrix", {})
        names = matrix.get("entry_names", [])
        self.allowed, self.denied, self.replaces = set(), set(), bool(names)
        for a, row in zip(names, matrix.get("entry_values", [])):
            for b, value in zip(names, row["enabled"] if isinstance(row, dict) else row):
                (self.allowed if value == "true" else self.denied).add(frozenset((a, b)))
        self.padding = {entry["link_name"]: float(entry["padding"]) for entry in keys.get("link_padding", [])}


def request(keys):
    """Returns the group, the start (values by joint) and the goals (a list of values by joint)."""
    state = keys.get("start_state", {}).get("joint_state", {})
    start = {name: [float(v)] for name, v in zip(state.get("name", []), state.get("position", []))}
    goals = [{c["joint_name"]: float(c["position"]) for c in goal["joint_constraints"]}
             for goal in keys.get("goal_constraints", [])]  # fmt: skip
    return keys.get("group_name"), start, goals
