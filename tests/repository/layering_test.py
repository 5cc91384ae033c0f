#!/usr/bin/env python3
"""Enforces the layers of planner/ARCHITECTURE.md: a file includes headers only from its own folder or from folders of
lower layers."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# From low to high.
LAYERS = [
    "collision/core", "collision/predicates", "collision/geometry", "collision/convex", "collision/volumes",
    "collision/hierarchy", "collision/queries", "collision/motion", "collision/world", "collision/course",
    "collision/collision.h",  # only for programs of users: Corridor's own files include the headers that they need
    "planner/robot", "planner/model", "planner/problem", "planner/import", "planner/checker", "planner/verify",
    "planner/trajectory", "planner/solve", "planner/view", "planner/jobs", "planner/benchmark", "planner/app",
    "planner/query", "planner/python",
]

# `problem` and `import` are one layer: a problem file may name messages of MoveIt, and `readProblem` reads foreign
# files by their importers, which use the readers of the format.
SAME_LAYER = {"planner/problem": "planner/import"}

# The verifier shares only plain data and the test of the floating-point mode with the checker. So the headers that it
# may include are listed one by one.
VERIFIER = {
    "collision/core/floating_point.h",
    "collision/core/rigid_pose.h",
    "collision/core/transform.h",
    "collision/geometry/convex_part.h",
    "collision/geometry/triangle_mesh.h",
    "planner/robot/curve.h",
    "planner/robot/kinematic_tree.h",
}


# Those who make paths, curves and pages must not use the arithmetic of the verifier: a mistake in it would be made and
# judged alike. `solve` calls the verifier, and `view` shows its results.
RESULTS = {"planner/verify/verify_path.h"}


def includesOf(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if found := re.match(r'\s*#\s*include\s+"([^"]+)"', line):
            yield number, found[1]


def faultsOf(path):
    name = path.relative_to(ROOT).as_posix()
    own = "/".join(name.split("/")[:2])
    if own not in LAYERS:
        yield f"{name}: the folder {own} has no place among the layers"
        return
    for number, included in includesOf(path):
        folder = "/".join(included.split("/")[:2])
        if folder not in LAYERS:
            if (ROOT / included).exists():
                yield f"{name}:{number}: {included} is in no layer"
        elif included == "collision/collision.h":
            yield f"{name}:{number}: only programs of users include collision.h"
        elif LAYERS.index(folder) > LAYERS.index(own) and SAME_LAYER.get(own) != folder:
            yield f"{name}:{number}: {included} is in a higher layer"
        elif own == "planner/verify" and folder != own and included not in VERIFIER:
            yield f"{name}:{number}: the verifier must not include {included}"
        elif folder == "planner/verify" and own not in (folder, "planner/solve") and included not in RESULTS:
            yield f"{name}:{number}: only solve includes the verifier's {included}"


def main():
    files = [f for top in ("collision", "planner") for f in sorted((ROOT / top).rglob("*"))
             if f.suffix in (".h", ".cpp")]
    faults = [fault for f in files for fault in faultsOf(f)]
    print("\n".join(faults))
    print(f"{len(files)} files, {len(faults)} faults")
    return 1 if faults or len(files) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
