#!/usr/bin/env python3
"""Tests T = N_v·C_v + N_p·C_p in the scenes of scenes.py and in parallel close proximity. Prints CSV: predicted over
measured time, with the costs C_v and C_p that are measured test by test (*alone*), and with a term for the traversal
that was fitted in the scene before (*elsewhere*).

    tests/benchmark/time_model.py | tests/benchmark/results.py --store time_model --command tests/benchmark/time_model.py
"""
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import course_inputs  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = {
    "piano among walls": ("problems/piano/walls.obj", "robots/piano/piano.obj"),
    "bug in a bottle": ("problems/bug_trap/bottle.obj", "robots/bug/bug.stl"),
    "cart at walls": ("problems/rover_door/walls.obj", "robots/rover/cart.stl"),
    "upper arm at a shelf": ("problems/arm_at_shelf/shelf.stl", "robots/arm6/upper_arm.stl"),
    "hook in a maze": ("problems/hook_maze/walls.obj", "robots/hook/hook.obj"),
    "two forearms": ("robots/arm6/forearm.stl", "robots/arm6/forearm.stl"),
    "two wrinkled tori": ("a.obj", "b.obj"),
    "spheres, gap 0.02": ("inner.obj", "outer.obj"),
}
VOLUMES = ("obb-binary", "aabb", "sphere", "rss", "kdop14", "kdop18", "kdop26", "ellipsoid", "hull")


def rows_of(files, poses):
    done = subprocess.run([ROOT / "build/release/corridor", "inspect", files[0], "--against", files[1], *poses], check=True,
                          capture_output=True, text=True)
    contacts = int(re.search(r"poses: .*?(\d+) contacts", done.stdout)[1])
    rows = {}
    for line in done.stdout.splitlines():
        words = line.replace(",", "").split()
        if words and words[0] in VOLUMES:
            rows[words[0]] = [0 if word == "-" else float(word) for word in words[1:9]]
    return contacts, rows


print("scene,contacts,volume,N_v,N_p,alone,elsewhere")
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    course_inputs.make_inputs(folder)
    course_inputs.write_mesh(folder / "inner.obj", *course_inputs.sphere(100, 1))
    course_inputs.write_mesh(folder / "outer.obj", *course_inputs.sphere(100, 1.02))
    before = {}
    for scene, meshes in SCENES.items():
        files = [str(folder / name if "/" not in name else ROOT / name) for name in meshes]
        poses = folder / "turns.txt"
        if not scene.startswith("spheres"):
            poses = folder / "grid.txt"
            subprocess.run([ROOT / "build/release/corridor", "query", *files, "--grid", "6x6x6", "--rotations", "2",
                            "--save-poses", str(poses)], check=True, capture_output=True)
        contacts, rows = rows_of(files, ["--poses", str(poses)])
        for volume, (n_v, n_p, _, c_v, c_p, traversal, _, measured) in rows.items():
            alone = (n_v * c_v + n_p * c_p) / measured
            elsewhere = (n_v * (c_v + before[volume]) + n_p * c_p) / measured if volume in before else None
            print(f"{scene},{contacts},{volume},{n_v:.4g},{n_p:.4g},{alone:.2f},"
                  f"{'' if elsewhere is None else format(elsewhere, '.2f')}", flush=True)
            before[volume] = traversal
