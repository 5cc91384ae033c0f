"""Reads robot and problem files. For tests only; written from planner/problem/README.md, with no code of Corridor."""

import math
import pathlib

import moveit
import numpy as np
import yaml
from meshes import read_mesh
from solids import Shape
from transforms import apply, pose, quaternion_of_rpy, rotation_about, rotation_of_quaternion, rotation_of_rpy
from urdf import Srdf, Urdf

_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}
_UPS = {"x": np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]]), "y": np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), "z": np.eye(3)}


class NotRead(Exception):
    """The file has a part that these small readers do not read. Tests leave such files out, with a message."""


def load(file):
    """A YAML file. All its scalars stay texts."""
    return yaml.load(pathlib.Path(file).read_text(), Loader=yaml.BaseLoader)


def floats(values):
    return [float(value) for value in values]


def is_number(text):
    try:
        return float(text) is not None
    except (TypeError, ValueError):
        return False


def rotation_of(keys):
    if "rpy" in keys:
        return rotation_of_rpy(floats(keys["rpy"]))
    if "rpy_deg" in keys:
        return rotation_of_rpy(np.radians(floats(keys["rpy_deg"])))
    return rotation_of_quaternion(floats(keys["quat_xyzw"])) if "quat_xyzw" in keys else np.eye(3)


def pose_of(keys):
    return pose(floats(keys.get("at", (0, 0, 0))), rotation_of(keys))


def shapes_of(keys, folder):
    """The shapes of an obstacle, or of one entry of a robot's `shapes`."""
    X = pose_of(keys)
    if "shapes" in keys:
        parts = [part for each in keys["shapes"] for part in shapes_of(each, folder)]
        for part in parts:
            part.X = X @ part.X
        return parts
    for kind in ("sphere", "capsule", "cylinder"):
        if kind in keys:
            size = keys[kind] if isinstance(keys[kind], dict) else {"radius": keys[kind]}
            return [Shape(kind, X, radius=float(size["radius"]), length=float(size.get("length", 0)))]
    if "box" in keys:
        return [Shape("box", X, size=floats(keys["box"]))]
    if isinstance(keys.get("convex"), list):
        return [Shape("convex", X, vertices=np.array([floats(p) for p in keys["convex"]]))]
    if "polygon" in keys:
        return [Shape("polygon", X, vertices=np.array([(*floats(p), 0.0) for p in keys["polygon"]]))]
    if "mesh" not in keys or keys.get("convex") == "true":
        raise NotRead(f"the shape {sorted(keys)}")
    vertices, triangles = read_mesh(folder / keys["mesh"])
    vertices = vertices * _UNITS[keys.get("unit", "m")] @ _UPS[keys.get("up", "z")].T
    return [Shape("mesh", X, vertices=vertices, triangles=triangles)]


def _named(values, key):
    """The value of a joint, `NAME` in radians or metres, or `NAME_deg`."""
    if key in values:
        return float(values[key])
    return math.radians(float(values[key + "_deg"])) if key + "_deg" in values else None


class Robot:
    """A robot file, or a bare URDF; in a problem, also with its name and its base."""

    def __init__(self, file, prefix="", base=None):
        file = pathlib.Path(file)
        keys = {"urdf": file.name} if file.suffix == ".urdf" else load(file)
        self.prefix, self.base, self.folder, self.keys = prefix, np.eye(4) if base is None else base, file.parent, keys
        self.name = keys.get("name") or (file.parent.name if file.name == "robot.yaml" else file.stem)
        self.rigid, self.start = keys.get("rigid"), {}
        if self.rigid:
            self._read_rigid()
            return
        packages = {name: file.parent / folder for name, folder in keys.get("packages", {}).items()}
        self.urdf = Urdf(file.parent / keys["urdf"], packages, keys.get("visuals") == "collide")
        self.srdf = Srdf(file.parent / keys["srdf"], self.urdf) if "srdf" in keys else None
        self.states = dict(self.srdf.states if self.srdf else {})
        self.states |= {name: self.values(state) for name, state in keys.get("states", {}).items()}
        self.hold = self.state(keys.get("hold", {}))
        self.choose(keys.get("group"), keys.get("joints"))
        never = keys.get("never_in_contact")
        self.never = {frozenset(pair) for pair in never["pairs"]} if never else set()

    def choose(self, group=None, joints=None):
        """Sets the joints that are planned for."""
        passive = self.srdf.passive if self.srdf else set()
        passive |= {name for name, j in self.urdf.joints.items() if j.lower == j.upper}
        self.planned = joints or ([j for j in self.srdf.group(group) if j not in passive] if group else
                                  [j for j in self.urdf.movable() if j not in self.hold and j not in passive])  # fmt: skip
        self.chosen = bool(group or joints)

    def _read_rigid(self):
        self.shapes = [shape for keys in self.keys["shapes"] for shape in shapes_of(keys, self.folder)]
        at = self.keys.get("reference", [0, 0, 0])
        if at == "centroid":
            points = []
            for shape in self.shapes:
                if shape.kind == "polygon":
                    raise NotRead("the centroid of a polygon")
                points.append(apply(shape.X, np.unique(shape.vertices[np.unique(shape.triangles)], axis=0)))
            at = np.concatenate(points).mean(0)
        at = np.array([*floats(at), 0.0][:3])
        for shape in self.shapes:
            shape.X = pose(-at) @ shape.X

    def values(self, keys):
        """The values of a state's joints: a list of numbers for each joint."""
        found = {}
        for joint in self.urdf.joints.values():
            if isinstance(keys.get(joint.name), dict):
                found[joint.name] = free_pose(keys[joint.name], joint.type == "planar")
            elif _named(keys, joint.name) is not None:
                found[joint.name] = [_named(keys, joint.name)]
        return found

    def state(self, keys):
        """A named state, or a state with values."""
        if isinstance(keys, str):
            return dict(self.states[keys])
        is_joint = "from" in self.urdf.joints and is_number(keys.get("from"))
        return (dict(self.states[keys["from"]]) if "from" in keys and not is_joint else {}) | self.values(keys)

    def held(self):
        """The values of the joints that can move, but are not planned for."""
        found = {}
        for joint in self.urdf.movable():
            if joint not in self.planned:
                found[joint] = self.hold.get(joint) or self.start.get(joint) or self.urdf.nearest_to_zero(joint)
        return found

    def numbers(self):
        """The names of the numbers of a configuration."""
        if self.rigid:
            names = ("x", "y", "yaw") if self.rigid == "SE2" else ("x", "y", "z", "qx", "qy", "qz", "qw")
            return [self.prefix + name for name in names]
        return [self.prefix + number for joint in self.planned for number in self.urdf.joints[joint].numbers()]

    def configuration(self, keys):
        """The numbers of a start or a goal."""
        if self.rigid:
            return free_pose(keys, self.rigid == "SE2")
        state = self.state(keys)
        return [value for joint in self.planned for value in state[joint]]

    def poses(self, numbers):
        """The poses of the robot's bodies, by name, from the values of all numbers by name."""
        mine = [numbers[name] for name in self.numbers()]
        if self.rigid == "SE2":
            return {self.body: pose((*mine[:2], 0), rotation_about((0, 0, 1), mine[2]))}
        if self.rigid:
            return {self.body: pose(mine[:3], rotation_of_quaternion(mine[3:]))}
        values = self.held()
        for joint in self.planned:
            values[joint] = [numbers[self.prefix + number] for number in self.urdf.joints[joint].numbers()]
        return {self.prefix + link: X for link, X in self.urdf.poses(values, self.base).items()}

    @property
    def body(self):
        return self.prefix.rstrip("/") or self.name

    def bodies(self):
        """The shapes of each body."""
        if self.rigid:
            return {self.body: self.shapes}
        return {self.prefix + link: shapes for link, shapes in self.urdf.links.items()}

    def can_part(self, a, b):
        """Whether a joint that can move, even if it is held, is between two links."""
        leaders = [self.urdf.joints[self.urdf.leader(j.name)[0]] for j in self.urdf.between(a, b) if j.type != "fixed"]
        return any(j.lower < j.upper for j in leaders)


def free_pose(keys, flat):
    """The numbers of a planar or floating joint, or of a rigid robot."""
    at = floats(keys["at"])
    if flat:
        return [*at, float(keys["yaw"]) if "yaw" in keys else math.radians(float(keys.get("yaw_deg", 0)))]
    if "quat_xyzw" in keys:
        return at + floats(keys["quat_xyzw"])
    rpy = floats(keys["rpy"]) if "rpy" in keys else [math.radians(float(v)) for v in keys.get("rpy_deg", (0, 0, 0))]
    return at + list(quaternion_of_rpy(rpy))


class Problem:
    """A problem file: robots, obstacles, start and goals, and which pairs of bodies are tested."""

    def __init__(self, file):
        file = pathlib.Path(file)
        file = file / "problem.yaml" if file.is_dir() else file
        self.keys = keys = load(file)
        folder = file.parent
        entries = keys.get("robots") or {"": {"file": keys["robot"], "base": keys.get("base", {})}}
        self.robots = {name: Robot(folder / entry["file"], f"{name}/" if name else "", pose_of(entry.get("base", {})))
                       for name, entry in entries.items()}  # fmt: skip
        self.world = {name: shapes_of(shape, folder) for name, shape in keys.get("world", {}).items()}
        self.allowed, self.margin = {frozenset(pair) for pair in keys.get("allow", [])}, float(keys.get("margin", 0))
        self.denied = set()
        self.replaces_srdf = False  # whether the pairs of a message replace those of the SRDF
        padding = keys.get("padding", {})
        self.link_padding, self.moveit_start, self.moveit_goals = {}, None, []
        if "moveit" in keys:
            self._read_moveit(folder, keys["moveit"])
        self.padding = self.link_padding | {name: float(v) for name, v in padding.get("bodies", {}).items()}
        self.pair_padding = {frozenset(p[:2]): float(p[2]) for p in padding.get("pairs", [])}
        for name, robot in self.robots.items():
            start = self._part(keys.get("start"), name)
            if not robot.rigid:
                robot.start = robot.state(start) if isinstance(start, str) or "from" in (start or {}) else {}
                robot.start = robot.start or self.moveit_start or {}

    def _read_moveit(self, folder, files):
        [robot] = self.robots.values()
        if "request" in files:
            group, self.moveit_start, self.moveit_goals = moveit.request(load(folder / files["request"]))
            if not robot.chosen:
                robot.choose(group)
        if "scene" in files:
            scene = moveit.Scene(load(folder / files["scene"]), robot.base, robot.urdf.root)
            self.world |= scene.objects
            self.allowed |= scene.allowed
            self.denied = scene.denied
            self.replaces_srdf, self.link_padding = scene.replaces, scene.padding

    def _part(self, keys, name):
        return keys[name] if name and keys is not None else keys

    def numbers(self):
        return [number for robot in self.robots.values() for number in robot.numbers()]

    def _whole(self, keys):
        return [v for name, robot in self.robots.items() for v in robot.configuration(self._part(keys, name))]

    def start(self):
        if "start" not in self.keys:
            [robot] = self.robots.values()
            return [value for joint in robot.planned for value in self.moveit_start[joint]]
        return self._whole(self.keys["start"])

    def goals(self):
        goal = self.keys.get("goal")
        if goal is None:
            [robot] = self.robots.values()
            return [[goal[joint] for joint in robot.planned] for goal in self.moveit_goals]
        goals = goal["any"] if isinstance(goal, dict) and "any" in goal else goal
        return [self._whole(each) for each in (goals if isinstance(goals, list) else [goals])]

    def bodies(self):
        """The shapes of each body that has shapes."""
        found = {name: shapes for robot in self.robots.values() for name, shapes in robot.bodies().items() if shapes}
        return found | self.world

    def poses(self, numbers):
        """The poses of all bodies in the world, from the values of all numbers by name."""
        found = {name: np.eye(4) for name in self.world}
        for robot in self.robots.values():
            found |= robot.poses(numbers)
        return found

    def required(self, a, b):
        """The distance that two bodies must keep, or None if the pair is not tested."""
        pair, of = frozenset((a, b)), {}
        for name, robot in self.robots.items():
            of |= {body: (name, robot) for body in robot.bodies()}
        if any(frozenset((x, y)) in self.allowed for x in self._spellings(a, of) for y in self._spellings(b, of)):
            return None
        if a in of and b in of and of[a][0] == of[b][0]:
            robot = of[a][1]
            x, y = (body.removeprefix(robot.prefix) for body in (a, b))
            links = frozenset((x, y))
            disabled = robot.srdf and links in robot.srdf.disabled and not self.replaces_srdf
            allowed = {frozenset(p) for p in robot.keys.get("allow", [])} - self.denied
            if disabled or links in allowed or robot.urdf.adjacent(x, y) or not robot.can_part(x, y):
                return None
            if links in robot.never:
                return None
            return self.margin
        if not self._moves(a, of) and not self._moves(b, of):
            return None
        return self.margin + self.pair_padding.get(pair, self.padding.get(a, 0.0) + self.padding.get(b, 0.0))

    def unclear(self, a, b):
        """Whether Corridor may test a pair that need not be tested: it lets a message's matrix, which replaces an SRDF,
        also replace the adjacency of the SRDF's pairs. This is safe, and its guide does not say it."""
        [first, *more] = self.robots.values()
        pair = frozenset((a, b))
        if not self.replaces_srdf or more or not first.srdf or pair not in first.srdf.disabled:
            return False
        return pair not in {frozenset(p) for p in first.keys.get("allow", [])} - self.denied

    @staticmethod
    def _spellings(body, of):
        """The names of a body: a link of the only robot may also be written with the robot's name."""
        if body in of and not of[body][1].prefix:
            return {body, f"{of[body][1].name}/{body}"}
        return {body}

    @staticmethod
    def _moves(body, of):
        if body not in of:
            return False
        robot = of[body][1]
        return bool(robot.rigid) or robot.can_part(body.removeprefix(robot.prefix), robot.urdf.root)
