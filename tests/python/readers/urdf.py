"""Reads URDF and SRDF. For tests only; written from the definitions of the formats, with no code of Corridor."""

import math
import pathlib
import xml.etree.ElementTree as xml

import numpy as np
from meshes import read_mesh
from solids import Shape
from transforms import pose, rotation_about, rotation_of_quaternion, rotation_of_rpy

SINGLE = ("revolute", "continuous", "prismatic")


def _numbers(text):
    return [float(word) for word in text.split()]


def _origin(element):
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    return pose(_numbers(origin.get("xyz", "0 0 0")), rotation_of_rpy(_numbers(origin.get("rpy", "0 0 0"))))


class Joint:
    def __init__(self, element):
        self.name, self.type = element.get("name"), element.get("type")
        self.parent, self.child = element.find("parent").get("link"), element.find("child").get("link")
        self.X = _origin(element)
        axis, limit, mimic = element.find("axis"), element.find("limit"), element.find("mimic")
        self.axis = np.array([1.0, 0, 0] if axis is None else _numbers(axis.get("xyz")))
        if self.type not in ("fixed", "floating"):
            self.axis /= np.linalg.norm(self.axis)
        self.lower, self.upper = -math.inf, math.inf
        if self.type in ("revolute", "prismatic"):
            self.lower, self.upper = (0.0 if limit is None else float(limit.get(key, 0)) for key in ("lower", "upper"))
        self.leader, self.multiplier, self.offset = None, 1.0, 0.0
        if mimic is not None:
            self.leader, self.multiplier, self.offset = (
                mimic.get("joint"), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0)))  # fmt: skip

    def motion(self, values):
        """The pose of the child in the joint's frame. `values`: one number; (x, y, yaw); or x, y, z, qx, qy, qz, qw."""
        if self.type in ("revolute", "continuous"):
            return pose(rotation=rotation_about(self.axis, values[0]))
        if self.type == "prismatic":
            return pose(self.axis * values[0])
        if self.type == "floating":
            return pose(values[:3], rotation_of_quaternion(values[3:]))
        if self.type == "planar":  # x and y are those of the frame, turned by the smallest rotation from z to the axis
            turn, z = np.cross([0, 0, 1], self.axis), np.array([0.0, 0, 1])
            if np.linalg.norm(turn) > 1e-12:
                R = rotation_about(turn, math.atan2(np.linalg.norm(turn), z @ self.axis))
            else:
                R = np.eye(3) if self.axis[2] > 0 else rotation_about((1, 0, 0), math.pi)
            return pose(R @ [values[0], values[1], 0], rotation_about(self.axis, values[2]))
        return np.eye(4)

    def numbers(self):
        """The names of the joint's numbers in a configuration."""
        parts = {"planar": ("x", "y", "yaw"), "floating": ("x", "y", "z", "qx", "qy", "qz", "qw"), "fixed": ()}
        return [f"{self.name}/{part}" for part in parts[self.type]] if self.type in parts else [self.name]


class Urdf:
    """Links with their shapes (unless `shapes` is false), and joints. `packages`: folders by the names of packages."""

    def __init__(self, file, packages=None, visuals=False, shapes=True):
        self.file, self.packages = pathlib.Path(file), packages or {}
        root = xml.parse(file).getroot()
        self.joints = {e.get("name"): Joint(e) for e in root.findall("joint")}
        self.links, self.unread = {}, []
        for link in root.findall("link"):
            parts = (link.findall("collision") or (link.findall("visual") if visuals else [])) if shapes else []
            self.links[link.get("name")] = [self._shape(part) for part in parts if part.find("geometry") is not None]
        self.parent = {joint.child: joint for joint in self.joints.values()}
        [self.root] = [link for link in self.links if link not in self.parent]

    def _shape(self, part):
        X = _origin(part)
        [shape] = part.find("geometry")
        if shape.tag == "box":
            return Shape("box", X, size=_numbers(shape.get("size")))
        if shape.tag == "sphere":
            return Shape("sphere", X, radius=float(shape.get("radius")))
        if shape.tag in ("cylinder", "capsule"):
            return Shape(shape.tag, X, radius=float(shape.get("radius")), length=float(shape.get("length")))
        file = self.mesh_file(shape.get("filename"))
        if file.suffix == ".dae":  # not read here: a point stands for it
            self.unread.append(file.name)
            return Shape("mesh", X, vertices=np.zeros((1, 3)), triangles=np.zeros((0, 3), int))
        vertices, triangles = read_mesh(file)
        return Shape("mesh", X, vertices=vertices * _numbers(shape.get("scale", "1 1 1")), triangles=triangles)

    def mesh_file(self, name):
        folder = self.file.parent
        if not name.startswith("package://"):
            return folder / name
        package, _, rest = name.removeprefix("package://").partition("/")
        return pathlib.Path(self.packages.get(package, folder / package)) / rest

    def leader(self, joint):
        """The joint that moves a joint, with multiplier and offset; chains of mimics are followed. The joint itself if it
        mimics none, or one that can't lead."""
        multiplier, offset, now = 1.0, 0.0, self.joints[joint]
        while now.leader in self.joints and self.joints[now.leader].type in SINGLE:
            offset += multiplier * now.offset
            multiplier *= now.multiplier
            now = self.joints[now.leader]
        return now.name, multiplier, offset

    def movable(self):
        """The joints that can move by themselves, in the order of the file."""
        return [name for name, j in self.joints.items() if j.type != "fixed" and self.leader(name)[0] == name]

    def nearest_to_zero(self, joint):
        j = self.joints[joint]
        if j.type == "planar":
            return [0.0] * 3
        return [0.0] * 6 + [1.0] if j.type == "floating" else [min(max(0.0, j.lower), j.upper)]

    def poses(self, values, base=None):
        """The poses of all links. `values`: a list of numbers for each joint that can move by itself."""
        found = {self.root: np.eye(4) if base is None else base}

        def of(link):
            if link not in found:
                joint = self.parent[link]
                moved = []
                if joint.type != "fixed":
                    leader, multiplier, offset = self.leader(joint.name)
                    moved = values[leader]
                    if leader != joint.name:
                        moved = [multiplier * moved[0] + offset]
                found[link] = of(joint.parent) @ joint.X @ joint.motion(moved)
            return found[link]

        for link in self.links:
            of(link)
        return found

    def way_up(self, link):
        """The joints from a link to the root."""
        while link != self.root:
            yield self.parent[link]
            link = self.parent[link].parent

    def between(self, a, b):
        """The joints between two links."""
        up_a, up_b = list(self.way_up(a)), list(self.way_up(b))
        while up_a and up_b and up_a[-1] is up_b[-1]:
            up_a.pop(), up_b.pop()
        return up_a + up_b

    def adjacent(self, a, b):
        """Whether one link is an ancestor of the other, no link with shapes is between the two, and at most one joint
        between the two is not fixed; that joint is neither planar nor floating."""
        for low, high in ((a, b), (b, a)):
            moving = []
            for joint in self.way_up(low):
                moving += [joint] if joint.type != "fixed" else []
                if joint.parent == high:
                    return len(moving) <= 1 and all(j.type in SINGLE for j in moving)
                if self.links[joint.parent]:
                    break
        return False


class Srdf:
    """Groups (sets of joints), states (values by joint), and pairs of links that may touch."""

    def __init__(self, file, urdf):
        self.urdf, root = urdf, xml.parse(file).getroot()
        self._groups = {g.get("name"): g for g in root.findall("group")}
        self.states = {}
        for state in root.findall("group_state"):
            values = {j.get("name"): [float(w) for w in j.get("value").split()] for j in state.findall("joint")}
            self.states[state.get("name")] = {k: v for k, v in values.items() if k in urdf.joints}

        def pairs(tag):
            return {frozenset((e.get("link1"), e.get("link2"))) for e in root.findall(tag)}

        self.disabled, enabled = pairs("disable_collisions"), pairs("enable_collisions")
        for e in root.findall("disable_default_collisions"):
            self.disabled |= {frozenset((e.get("link"), other)) for other in urdf.links} - enabled
        self.passive = {e.get("name") for e in root.findall("passive_joint")}

    def groups(self):
        """All joints of each group, also those that can't move by themselves."""
        return {name: set(self._members(group)) & self.urdf.joints.keys() for name, group in self._groups.items()}

    def group(self, name):
        """The joints of a group that can move by themselves, in the order of the URDF."""
        found = set(self._members(self._groups[name]))
        return [joint for joint in self.urdf.movable() if joint in found]

    def _members(self, group):
        for e in group:
            if e.tag == "joint":
                yield e.get("name")
            elif e.tag == "link" and e.get("name") in self.urdf.parent:
                yield self.urdf.parent[e.get("name")].name
            elif e.tag == "chain":
                yield from (joint.name for joint in self.urdf.between(e.get("base_link"), e.get("tip_link")))
            elif e.tag == "group":
                yield from self._members(self._groups[e.get("name")])
