#!/usr/bin/env python3
"""Holds what the commands print with --json against planner/app/json_output.schema.json.

Every key of the output must be in the schema, with its type, and every required key of the schema must be in the
output. All outputs together must have every key of the schema, so that it describes no key that does not exist.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("CORRIDOR_PROGRAM", str(ROOT / "build/release/corridor"))
SCHEMA = ROOT / "planner/app/json_output.schema.json"
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None), "integer": int,
         "number": (int, float)}
WORDS = {"$ref", "description", "type", "const", "enum", "anyOf", "properties", "required", "additionalProperties",
         "items", "minItems", "maxItems"}


def isOfType(value, name):
    return isinstance(value, TYPES[name]) and (name == "boolean" or not isinstance(value, bool))


class Schema:
    """The part of JSON Schema, draft 7, that the file uses. `seen` has the names and parents of all keys met."""

    def __init__(self):
        self.root = json.loads(SCHEMA.read_text())
        self.seen = set()

    def at(self, reference):
        return self.root["definitions"][reference.removeprefix("#/definitions/")]

    def ofFormat(self, name):
        formats = [self.at(each["$ref"]) for each in self.root["oneOf"]]
        return next((each for each in formats if each["properties"]["format"]["const"] == name), None)

    def faults(self, value, schema, where):
        """Yields the differences of a value from a schema."""
        if unknown := schema.keys() - WORDS:
            yield f"{SCHEMA.name}: this test does not know {sorted(unknown)}"
        if "$ref" in schema:
            yield from self.faults(value, self.at(schema["$ref"]), where)
            return
        if "anyOf" in schema:
            tried = [list(self.faults(value, each, where)) for each in schema["anyOf"]]
            if all(tried):
                yield from tried[0]
            return
        names = schema.get("type", [])
        names = names if isinstance(names, list) else [names]
        if names and not any(isOfType(value, name) for name in names):
            yield f"{where}: {value!r} is not of type {' or '.join(names)}"
        elif "const" in schema and value != schema["const"]:
            yield f"{where}: {value!r} is not {schema['const']!r}"
        elif "enum" in schema and value not in schema["enum"]:
            yield f"{where}: {value!r} is not one of {schema['enum']}"
        elif isinstance(value, dict):
            yield from self.faultsOfObject(value, schema, where)
        elif isinstance(value, list):
            if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
                yield f"{where}: it has {len(value)} items"
            for i, item in enumerate(value):
                yield from self.faults(item, schema["items"], f"{where}[{i}]")

    def faultsOfObject(self, value, schema, where):
        properties = schema.get("properties", {})
        for key in schema.get("required", []):
            if key not in value:
                yield f"{where}.{key} is missing"
        for key, item in value.items():
            if key in properties:
                self.seen.add(id(properties[key]))
                yield from self.faults(item, properties[key], f"{where}.{key}")
            elif schema.get("additionalProperties", True) is False:
                yield f"{where}.{key} is not in {SCHEMA.name}"
            elif isinstance(schema.get("additionalProperties"), dict):
                yield from self.faults(item, schema["additionalProperties"], f"{where}.{key}")

    def neverSeen(self, schema, where):
        """Yields the names of properties that no output had, and faults of the schema itself."""
        properties = schema.get("properties", {})
        for key in schema.get("required", []):
            if key not in properties and "additionalProperties" not in schema:
                yield f"{where} requires {key}, and does not describe it"
        for key, each in properties.items():
            if id(each) not in self.seen:
                yield f"{where}.{key}"
        for key, each in schema.items():
            if isinstance(each, dict) and key not in ("$ref", "enum", "const"):
                parts = each.items() if key in ("properties", "definitions") else [(None, each)]
                for name, part in parts:
                    yield from self.neverSeen(part, f"{where}.{name}" if name else where)


CUBE = """v -.1 -.1 -.1\nv .1 -.1 -.1\nv .1 .1 -.1\nv -.1 .1 -.1\nv -.1 -.1 .1\nv .1 -.1 .1\nv .1 .1 .1\nv -.1 .1 .1
f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\nf 2 3 7\nf 2 7 6\nf 1 5 8\nf 1 8 4\n"""


def link(name, size):
    return f"""<link name="{name}"><collision><origin xyz="0.5 0 0"/><geometry><box size="{size}"/></geometry>
</collision></link>"""


def joint(name, parent, child, kind, at, more):
    return f"""<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
<origin xyz="{at} 0 0"/><axis xyz="0 0 1"/>{more}</joint>"""


LIMIT = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
ARM = "<robot name='arm'><link name='base'/>" + link("upper", "0.8 0.1 0.1") + link("lower", "0.8 0.1 0.1") + link(
    "finger", "0.1 0.1 0.1") + "<link name='palm'/>" + "<link name='cart'/>" + link("lid", "0.2 0.1 0.1") + joint(
    "drive", "base", "cart", "planar", 0, "") + joint("shoulder", "cart", "upper", "revolute", 0, LIMIT) + joint(
    "elbow", "upper", "lower", "revolute", 1, LIMIT) + joint("grip", "lower", "palm", "prismatic", 1, LIMIT) + joint(
    "follow", "palm", "finger", "prismatic", 0, LIMIT + '<mimic joint="grip" multiplier="0.5" offset="0.1"/>') + joint(
    "lid", "cart", "lid", "revolute", -6, LIMIT) + "</robot>"
SRDF = """<robot name="arm"><group name="all"><joint name="elbow"/></group>
<group name="lost"><joint name="none"/></group>
<group_state name="straight" group="all"><joint name="elbow" value="0"/></group_state>
<group_state name="odd" group="all"><joint name="elbow" value="99"/></group_state></robot>"""
FILES = {
    "cube.obj": CUBE,
    "wall.obj": "v 0 -5 -5\nv 0 2 -5\nv 0 2 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\nf 1 2 3\n",
    "cloud.xyz": "5 5 5\n5 5 5.1\n",
    "map.bt": "# Octomap OcTree binary file\nid OcTree\nsize 2\nres 1e-5\ndata\n\0\x80",  # one cube
    "noted.ply": """ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z
element face 1\nproperty list uchar int vertex_indices\nproperty list uchar int more\nend_header
0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 7\n""",
    "rigid.yaml": "format: corridor-robot-1\nname: cube\nrigid: SE3\nshapes: [{mesh: cube.obj, unit: m}]\n",
    "problem.yaml": """format: corridor-problem-1
robot: rigid.yaml
world:
  wall: {mesh: wall.obj, unit: m}
  noted: {mesh: noted.ply, at: [0, 0, 9]}
  cloud: {points: {file: cloud.xyz, radius: 0.1}}
  map: {octomap: {file: map.bt}, at: [6, 6, 6]}
start: {at: [-2, 0, 0]}
goal: {at: [2, 0, 0]}
bounds: {at: [[-4, -4, -4], [4, 4, 4]]}
""",
    "hopeless.yaml": """format: corridor-problem-1
robot: rigid.yaml
world: {wall: {box: [0.1, 8, 8], at: [0, 0, 0]}}
start: {at: [-2, 0, 0]}
goal: [{at: [2, 0, 0]}, {at: [0, 0, 0]}]
bounds: {at: [[-3, -3, -3], [3, 3, 3]]}
planner: {time: 0.2}
""",
    "stuck.yaml": """format: corridor-problem-1
robot: robot.yaml
world: {post: {sphere: 0.1, at: [0, 1.5, 0]}}
start: {shoulder: 0, elbow: 0}
goal: {shoulder: 0.5, elbow: 0}
limits: {default: {velocity: 1.0e-300, acceleration: 1.0e-300}}
""",
    "faulty.yaml": "format: corridor-problem-1\nrobot: none.yaml\n",
    "arm.urdf": ARM,
    "arm.srdf": SRDF,
    "robot.yaml": """format: corridor-robot-1
urdf: arm.urdf
srdf: arm.srdf
hold: {drive: {at: [0, 0], yaw: 0}, grip: 0, lid: 0}
""",
    "arm.yaml": """format: corridor-problem-1
robot: robot.yaml
world: {post: {sphere: 0.1, at: [0, 1.5, 0]}, table: {box: [0.2, 0.2, 0.1], at: [-5.5, 0, 0.11]}}
start: {shoulder: 0, elbow: 0}
goal: {shoulder: 2.8, elbow: 0.5}
padding: {bodies: {post: 0.001}, pairs: [[upper, table, 0.002]]}
allow: [[lid, table]]
limits: {}
""",
    "margins.yaml": """format: corridor-problem-1
robot: robot.yaml
world: {post: {sphere: 0.1, at: [0, 1.5, 0]}}
start: {shoulder: 0, elbow: 0}
goal: {shoulder: 0.5, elbow: 0}
margin: {self: 0, world: 0.01, pairs: [[upper, post, 0.02]]}
""",
    "short.yaml": """format: corridor-problem-1
robot: robot.yaml
world: {post: {sphere: 0.1, at: [0, 1.5, 0]}}
start: {shoulder: 0, elbow: 0}
goal: {shoulder: 2.8, elbow: 0.5}
prefer: {clearance: 0.3, detour: 0}
""",
    "through.csv": "time, shoulder, elbow\n0, 0, 0\n1, 2.8, 0\n",
    "states.txt": "0 0\n9 0\n1.5707 0\n",
    "turned.txt": "-2.2 0.8 1e17 0 -0.7 2.2 -0.5 -1.57 0\n",
    "edges.txt": "0 0 0.1 0\n0 0 2.8 0\n0 0 9 0\n",
}


def outputs(folder):
    """Yields command lines and the objects that they print."""
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="latin-1")

    def run(*arguments, statuses=(0, 1)):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=600)
        if done.returncode not in statuses:
            sys.exit(f"corridor {' '.join(map(str, arguments))}: exit status {done.returncode}\n{done.stderr}")
        return done.stdout

    def report(*arguments, statuses=(0, 1)):
        return " ".join(map(str, arguments)), json.loads(run(*arguments, "--json", statuses=statuses))

    yield report("solve", "problem.yaml", "-o", "cube.solution.yaml")
    yield report("solve", "arm.yaml", "--trajectory", "arm.csv", "-o", "arm.solution.yaml")
    yield report("solve", ROOT / "problems/two_arms")
    yield report("solve", "short.yaml")
    yield report("solve", "hopeless.yaml")
    yield report("solve", "stuck.yaml", "--trajectory", "none.csv")
    yield report("solve", "problem.yaml", "faulty.yaml", statuses=(2,))
    yield report("verify", "problem.yaml", "cube.solution.yaml")
    yield report("verify", "hopeless.yaml", "cube.solution.yaml")
    yield report("verify", "hopeless.yaml", "cube.solution.yaml", "--ignore-digest")
    yield report("verify", "arm.yaml", "arm.csv")
    yield report("verify", "arm.yaml", "through.csv")
    yield report("check", "arm.yaml")
    yield report("check", "hopeless.yaml")
    yield report("check", "arm.yaml", "--states", "states.txt")
    yield report("check", ROOT / "problems/rover_door", "--states", "turned.txt")
    yield report("check", "arm.yaml", "--edges", "edges.txt")
    yield report("inspect", "wall.obj", "--unit", "mm", "--up", "y", "--self-intersections")
    yield report("inspect", "cube.obj")
    yield report("inspect", "noted.ply")
    yield report("inspect", "cube.obj", "--against", "cube.obj")
    yield report("inspect", "arm.urdf")
    yield report("inspect", "robot.yaml")
    run("new", "robot", "arm.urdf", "-o", "proved.yaml")
    yield report("inspect", "proved.yaml")
    yield report("inspect", "problem.yaml")
    yield report("inspect", "hopeless.yaml")
    yield report("inspect", "arm.yaml")
    yield report("inspect", "margins.yaml")
    yield report("inspect", ROOT / "problems/polygon_maze")
    yield report("pose", "robot.yaml")
    yield report("benchmark", "arm.yaml", "--variants", "certified,discrete:0.1", "--runs", 1, "--trajectories",
              "blends,stop")


def main():
    if not pathlib.Path(PROGRAM).exists():
        print(f"skipped: {PROGRAM} is not built")
        return 77
    schema, faults = Schema(), []
    with tempfile.TemporaryDirectory() as folder:
        for line, output in outputs(pathlib.Path(folder)):
            definition = schema.ofFormat(output.get("format"))
            if definition is None:
                faults.append(f"corridor {line} --json: {SCHEMA.name} has no format {output.get('format')!r}")
            else:
                faults += [f"corridor {line} --json: {fault}" for fault in schema.faults(output, definition, "")]
    faults += [f"no output of this test has {key}" for key in schema.neverSeen(schema.root, "")]
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
