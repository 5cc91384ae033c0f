"""Compares the model that Corridor read from a problem with that of the readers of this folder. For tests only."""

import itertools
import re

import corridor
import numpy as np
import runs
from problems import Problem, Robot
from solids import closer_than
from transforms import pose, rotation_of_quaternion
from urdf import SINGLE

SLACK = 0.002  # m: verdicts are compared where shapes are apart, or overlap, by more than this


def compare(test, file, rng, states=40, slack=SLACK):
    """Compares numbers, start, goals, poses, pairs and contacts. Returns how many verdicts were compared, by kind."""
    own, theirs = Problem(file), corridor.read_problem(file)
    names = theirs.numbers
    test.assertCountEqual(names, own.numbers())
    order = [own.numbers().index(name) for name in names]
    lower, upper = theirs.bounds
    # Values beyond a limit by at most 1e-5 are replaced by the limit, and angles may differ by a full turn.
    for mine, yours in [(own.start(), theirs.start), *zip(own.goals(), theirs.goals, strict=True)]:
        difference = np.array(mine)[order] - yours
        turns = np.array([bool(re.search(r"yaw$", name)) or upper[i] - lower[i] > 6.28 for i, name in enumerate(names)])
        difference[turns] = (difference[turns] + np.pi) % (2 * np.pi) - np.pi
        np.testing.assert_allclose(difference, 0, atol=2e-5)

    q = rng.uniform(lower, upper, (states, len(names)))
    for i in [i for i, name in enumerate(names) if name.endswith("qx")]:
        turns = rng.normal(size=(states, 4))
        q[:, i : i + 4] = turns / np.linalg.norm(turns, axis=1, keepdims=True)
    q[0] = theirs.start
    poses = [own.poses(dict(zip(names, row))) for row in q]
    compare_poses(test, theirs, q, poses)

    status, report = runs.report(runs.SOURCE, "inspect", file)
    test.assertIn(status, (0, 1), report)  # 1: the start is not free
    bodies = own.bodies()
    test.assertCountEqual([body["name"] for body in report["bodies"] if body["shapes"]], bodies)
    compare_shapes(test, own, bodies, report)
    required = {frozenset(p): own.required(*p) for p in itertools.combinations(bodies, 2)}
    tested = {frozenset((p["a"], p["b"])) for p in report["pair_list"]
              if not p["skipped"] or p["skipped"].endswith("tested once")}  # fmt: skip
    unclear = {p for p in required if own.unclear(*p)}
    test.assertEqual({p for p, distance in required.items() if distance is not None} - unclear, tested - unclear)
    required = {p: distance for p, distance in required.items() if p not in unclear}
    return compare_contacts(test, file, bodies, required, q, poses, rng, slack)


def compare_robot(test, file, rng, states=3):
    """Compares joints, links, groups, states and allowed pairs of a robot file, and the poses of links at some states."""
    own = Robot(file)
    urdf = own.urdf
    status, report = runs.report(runs.SOURCE, "inspect", file)
    test.assertEqual(status, 0, report)
    test.assertEqual(report["root"], urdf.root)
    joints = {j["name"]: (j["type"], j["parent"], j["child"], j.get("lower", -np.inf), j.get("upper", np.inf))
              for j in report["joints"]}  # fmt: skip
    test.assertEqual(joints, {j.name: (j.type, j.parent, j.child, j.lower, j.upper) for j in urdf.joints.values()})
    test.assertEqual({link["name"] for link in report["links"]}, set(urdf.links))
    if not urdf.unread:
        compare_shapes(test, own, urdf.links, report, "links")
    if own.srdf:
        groups = {name: joints for name, joints in own.srdf.groups().items() if joints}
        test.assertEqual({name: set(joints) for name, joints in report["groups"].items()}, groups)
    named = {name: {number: value for joint, values in state.items()
                    for number, value in zip(urdf.joints[joint].numbers(), values)}
             for name, state in own.states.items()}  # fmt: skip
    test.assertEqual(report["states"].keys(), named.keys())
    for name, state in named.items():
        np.testing.assert_allclose([report["states"][name][n] for n in state], list(state.values()), atol=1e-12)
    # Two links that only fixed joints connect are one body, so no such pair is reported.
    shaped = {name for name, shapes in urdf.links.items() if shapes}
    pairs = {frozenset(p) for p in itertools.combinations(shaped, 2) if any(j.type != "fixed" for j in urdf.between(*p))}
    reported = {frozenset((p["a"], p["b"])) for p in report["allowed"]} & pairs
    listed = {frozenset(p) for p in own.keys.get("allow", [])} | (own.srdf.disabled if own.srdf else set())
    test.assertLessEqual(pairs & listed, reported)
    test.assertLessEqual(reported, listed | {pair for pair in pairs if urdf.adjacent(*pair)})
    for _ in range(states):
        values = {j: own.hold.get(j) or urdf.nearest_to_zero(j) for j in urdf.movable()}
        values |= {j: [float(rng.uniform(max(urdf.joints[j].lower, -3), min(urdf.joints[j].upper, 3)))]
                   for j in values if urdf.joints[j].type in SINGLE}  # fmt: skip
        text = ", ".join(f'"{joint}": {value[0]!r}' for joint, value in values.items() if urdf.joints[joint].type in SINGLE)
        status, report = runs.report(runs.SOURCE, "pose", file, *(["--state", text] if text else []))
        test.assertEqual(status, 0, report)
        mine = urdf.poses(values)
        for link in report["links"]:
            X = pose(link["position"], rotation_of_quaternion(link["quat_xyzw"]))
            np.testing.assert_allclose(X, mine[link["name"]], atol=1e-9, err_msg=link["name"])


def compare_poses(test, theirs, q, poses):
    """Compares the poses of links. The rounding of products of some twenty matrices, and of rpy, is far below 1e-9."""
    for row, X in zip(theirs.poses(q), poses):
        for body, mine in X.items():
            if body in theirs.bodies and not np.array_equal(mine, np.eye(4)):
                np.testing.assert_allclose(row[theirs.bodies.index(body)], mine, atol=1e-9, err_msg=body)


def compare_shapes(test, own, bodies, report, key="bodies"):
    """Compares the kinds of all shapes, and the boxes around meshes."""
    for body in report[key]:
        mine = bodies.get(body["name"], [])
        kinds = [shape.get("primitive", "mesh") for shape in body["shapes"]]
        if any(shape.kind in ("convex", "polygon") for shape in mine):
            continue  # Corridor cuts polygons into parts, and has another name for convex hulls
        test.assertCountEqual(kinds, [shape.kind for shape in mine], body["name"])
        for shape, reported in zip(mine, body["shapes"]):
            if "min" in reported and shape.kind == "mesh":
                points = shape.vertices @ shape.X[:3, :3].T + shape.X[:3, 3]
                np.testing.assert_allclose([reported["min"], reported["max"]], [points.min(0), points.max(0)], atol=1e-9,
                                           err_msg=body["name"])  # fmt: skip


def compare_contacts(test, file, bodies, required, q, poses, rng, slack):
    """Compares which pairs of bodies Corridor reports at each state with the witnesses of contact and distance."""
    text = "\n".join(" ".join(repr(float(v)) for v in row) for row in q)
    status, report = runs.report(runs.SOURCE, "check", file, "--states", "-", text=text)
    test.assertIn(status, (0, 1), report)
    counts = {True: 0, False: 0, None: 0}
    for i, (X, answer) in enumerate(zip(poses, report["states"], strict=True)):
        found = {frozenset(pair.split("~") if isinstance(pair, str) else pair) for pair in answer["pairs"]}
        for pair, distance in required.items():
            if distance is None:
                test.assertNotIn(pair, found)
                continue
            a, b = pair
            parts = [closer_than(s, X[a], t, X[b], distance, slack, rng) for s in bodies[a] for t in bodies[b]]
            close = True if True in parts else None if None in parts else False
            counts[close] += 1
            if close is not None:
                test.assertEqual(pair in found, close, f"{file}: {sorted(pair)} at {q[i].tolist()}")
    return counts
