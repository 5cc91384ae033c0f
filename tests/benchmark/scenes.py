#!/usr/bin/env python3
"""Measures interference queries with each bounding volume in seven scenes of this project's own meshes, at the poses of
a lattice. Prints two tables in CSV: the mean N_v, N_p and time (µs) of a pose; and the least and the most of ratios
over the scenes.

    tests/benchmark/scenes.py > scenes.csv
    tests/benchmark/results.py --store scenes --command tests/benchmark/scenes.py < scenes.csv
    tests/benchmark/results.py --store scenes_ratios --command tests/benchmark/scenes.py --table 2 < scenes.csv
"""
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from course_inputs import PROGRAM, SCENES, files_of, make_inputs  # noqa: E402

VOLUMES = ("obb-binary", "aabb", "sphere", "rss", "kdop18")

print("scene,volume,building,N_v,N_p,us")
counts, times = {}, {}
with tempfile.TemporaryDirectory() as folder:
    make_inputs(pathlib.Path(folder))
    for scene, meshes in SCENES.items():
        files = files_of(meshes, pathlib.Path(folder))
        for volume in VOLUMES:
            for building in ("top-down", "bottom-up"):
                done = subprocess.run([PROGRAM, "query", *files, "--grid", "8x8x8", "--rotations",
                                       "2", "--repeat", "3", "--volume", volume, "--build", building], check=True,
                                      capture_output=True, text=True)
                found = dict(re.findall(r"^(\w+)=(\S+)$", done.stderr, re.MULTILINE))
                counts[scene, volume, building] = float(found["bv_tests"])
                times[scene, volume, building] = float(found["mean_ns"])
                print(f"{scene},{volume},{building},{float(found['bv_tests']):.4g},{float(found['triangle_tests']):.4g},"
                      f"{float(found['mean_ns']) / 1000:.4g}", flush=True)

print("\nratio,least,most")


def report(name, ratios):
    print(f"{name},{min(ratios):.3g},{max(ratios):.3g}")


for volume in VOLUMES:
    report(f"N_v: {volume}; bottom-up over top-down",
           [counts[scene, volume, "bottom-up"] / counts[scene, volume, "top-down"] for scene in SCENES])
for what, values in (("N_v", counts), ("time", times)):
    report(f"{what}: aabb over obb-binary; top-down",
           [values[scene, "aabb", "top-down"] / values[scene, "obb-binary", "top-down"] for scene in SCENES])
