#!/usr/bin/env python3
"""Tests T = N_v·C_v + N_p·C_p in the scenes of scenes.py and in parallel close proximity. Prints CSV: predicted over
measured time, with the costs C_v and C_p that are measured test by test (*alone*), and with two terms more: the fixed
cost of a query, measured with the meshes far apart, and the traversal's share of a volume test, fitted in the scene
before (*elsewhere*). N_v and N_p are those of the poses whose times are predicted.

    tests/benchmark/time_model.py | tests/benchmark/results.py --store time_model --command tests/benchmark/time_model.py
"""
import csv
import json
import pathlib
import random
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import course_inputs  # noqa: E402

SCENES = course_inputs.SCENES | {"spheres at gap 0.02": ("inner.obj", "outer.obj")}
VOLUMES = ("obb-binary", "aabb", "sphere", "rss", "kdop14", "kdop18", "kdop26", "ellipsoid", "hull")


def corridor(*words):
    return subprocess.run([course_inputs.PROGRAM, *words], check=True, capture_output=True, text=True).stdout


def counts_of(files, poses, volume):
    """Returns N_v and N_p at each pose."""
    rows = csv.DictReader(corridor("query", *files, "--poses", poses, "--volume", volume).splitlines())
    return [(int(row["bv_tests"]), int(row["triangle_tests"])) for row in rows]


print("scene,contacts,volume,N_v,N_p,alone,elsewhere")
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    course_inputs.make_inputs(folder)
    course_inputs.write_mesh(folder / "inner.obj", *course_inputs.sphere(100, 1))
    course_inputs.write_mesh(folder / "outer.obj", *course_inputs.sphere(100, 1.02))
    source = random.Random(1)
    (folder / "turns.txt").write_text(
        "".join(course_inputs.line(course_inputs.rotation(source) + [0, 0, 0]) for _ in range(60)))
    before = {}
    for scene, meshes in SCENES.items():
        files = course_inputs.files_of(meshes, folder)
        poses = folder / "turns.txt"
        if not scene.startswith("spheres"):
            poses = folder / "grid.txt"
            corridor("query", *files, "--grid", "6x6x6", "--rotations", "2", "--save-poses", poses)
        # `inspect` leaves out poses at which the root boxes are apart, and predicts every second one of the others.
        roots = counts_of(files, poses, "obb-binary")
        predicted = [i for i, (n_v, n_p) in enumerate(roots) if n_v > 1 or n_p > 0][1::2]
        found = json.loads(corridor("inspect", files[0], "--against", files[1], "--poses", poses, "--json"))
        for row in found["volumes"]:
            volume = row["volume"]
            if volume not in VOLUMES:
                continue
            counts = counts_of(files, poses, volume)
            n_v, n_p = (sum(counts[i][k] for i in predicted) / len(predicted) for k in (0, 1))
            tests = n_v * row["bv_test_ns"] + n_p * (row["triangle_test_ns"] or 0)
            alone = f"{tests / row['measured_ns']:.2f}"
            elsewhere = ""
            if volume in before:
                elsewhere = f"{(row['call_ns'] + tests + n_v * before[volume]) / row['measured_ns']:.2f}"
            print(f"{scene},{found['hits']},{volume},{n_v:.4g},{n_p:.4g},{alone},{elsewhere}", flush=True)
            before[volume] = row["traversal_ns"]
