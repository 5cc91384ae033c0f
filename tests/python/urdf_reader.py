"""For tests: makes a robot by corridor.robot from the links, joints and shapes of a URDF, with the same numbers."""

import pathlib
import xml.etree.ElementTree

import corridor
from corridor import Joint, Pose, shapes


def _floats(text):
    return tuple(float(word) for word in text.split())


def _pose(element):
    origin = element.find("origin")
    if origin is None:
        return Pose()
    return Pose(_floats(origin.get("xyz", "0 0 0")), _floats(origin.get("rpy", "0 0 0")))


def _shape(collision, folder):
    [shape] = collision.find("geometry")
    pose = _pose(collision)
    if shape.tag == "box":
        return shapes.box(_floats(shape.get("size")), pose)
    if shape.tag == "sphere":
        return shapes.sphere(float(shape.get("radius")), pose)
    if shape.tag == "cylinder":
        return shapes.cylinder(float(shape.get("radius")), float(shape.get("length")), pose)
    scale = _floats(shape.get("scale", "1 1 1"))
    assert scale.count(scale[0]) == 3, "only equal scales are read here"
    file = folder.parent / shape.get("filename").removeprefix("package://")
    return shapes.mesh_file(file, metres_per_unit=scale[0], pose=pose)


def _joint(element):
    limit, axis, mimic = element.find("limit"), element.find("axis"), element.find("mimic")
    ranged = element.get("type") in ("revolute", "prismatic")
    velocity = 0.0 if limit is None else float(limit.get("velocity", 0))
    return Joint(
        element.get("name"), element.get("type"), element.find("parent").get("link"), element.find("child").get("link"),
        _pose(element), axis=(1, 0, 0) if axis is None else _floats(axis.get("xyz")),
        limits=(float(limit.get("lower", 0)), float(limit.get("upper", 0))) if ranged else None,
        velocity=velocity or None,
        mimic=None if mimic is None else
        (mimic.get("joint"), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))),
    )  # fmt: skip


def robot_of(file, **options):
    """Builds the robot of a URDF by corridor.robot, and returns the robot. `options` are those of corridor.robot."""
    file = pathlib.Path(file)
    root = xml.etree.ElementTree.parse(file).getroot()
    links = {
        link.get("name"): [_shape(collision, file.parent) for collision in link.findall("collision")]
        for link in root.findall("link")
    }
    return corridor.robot(links, [_joint(joint) for joint in root.findall("joint")], **options)
