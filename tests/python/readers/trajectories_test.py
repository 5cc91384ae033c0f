"""Trajectory files, read by a small reader written independently: a ball on the curve refutes, a ball beside it does not.

The tip of an arm carries a ball; no other link has a shape. The own reader says where the tip is at each time.
"""

import json
import os
import pathlib
import tempfile
import unittest

import messages
import numpy as np
import runs
from trajectories import read_csv, read_message
from urdf import Urdf

SEED = int(os.environ.get("CORRIDOR_SEED", 1))
ROUNDS = 1000 if os.environ.get("CORRIDOR_STRESS") else 48
RADIUS = 0.02  # m, of the tip's ball; the obstacle has the same radius

ARM = """<robot name="arm"><link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
  <link name="tip"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
  <joint name="pan" type="continuous"><parent link="base"/><child link="a"/><origin xyz="0 0 0.2" rpy="0 0 0.3"/>
    <axis xyz="0 0 1"/><limit effort="1" velocity="9"/></joint>
  <joint name="lift" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.1 0 0" rpy="0.2 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="1" velocity="9"/></joint>
  <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0.3 0 0"/>
    <axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="9"/></joint>
  <joint name="wrist" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0.1 0.1 0"/>
    <axis xyz="0 1 1"/><limit lower="-9" upper="9" effort="1" velocity="9"/></joint>
  <joint name="follow" type="revolute"><parent link="d"/><child link="tip"/><origin xyz="0.2 0 0.1"/>
    <axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="9"/><mimic joint="wrist" multiplier="0.5"/></joint>
</robot>"""
PLANNED, HELD = ["pan", "lift", "slide"], 0.4
ROBOT = f"format: corridor-robot-1\nname: arm\nurdf: arm.urdf\njoints: [pan, lift, slide]\nhold: {{wrist: {HELD}}}\n"
PROBLEM = """format: corridor-problem-1
robot: robot.yaml
world: {ball: {sphere: 0.02, at: [%r, %r, %r]}}
start: {pan: 0, lift: 0, slide: 0}
goal: {pan: 0.1, lift: 0, slide: 0}
"""


def random_rows(rng, kind):
    """Times and columns of 2 to 6 rows. kind: "linear", "cubic" or "quintic"."""
    count = int(rng.integers(2, 7))
    times = [round(float(t), 3) for t in np.cumsum(rng.uniform(0.2, 1.5, count)) - rng.choice([0.0, 0.1])]
    columns = {}
    for joint in PLANNED:
        scale = 0.2 if joint == "slide" else 1.0
        steps = rng.uniform(-0.8, 0.8, count)
        columns[joint, "position"] = [scale * float(v) for v in np.cumsum(steps)]
        if kind != "linear":
            columns[joint, "velocity"] = [scale * float(v) for v in rng.uniform(-1, 1, count)]
        if kind == "quintic":
            columns[joint, "acceleration"] = [scale * float(v) for v in rng.uniform(-3, 3, count)]
    for joint in ("wrist", "follow"):
        if rng.random() < 0.5:
            columns[joint, "position"] = [HELD if joint == "wrist" else 0.5 * HELD] * count
    return times, columns


def as_csv(rng, times, columns, kind):
    """A file of rows: names in one of the forms that the guide lists, in any order, with commas or blanks."""
    forms = {"position": ["{}", "{}_position", "{}_pos", "pos_{}"],
             "velocity": ["{}_velocity", "{}_vel", "vel_{}", "{}.velocity", "{}/velocity"],
             "acceleration": ["{}_acceleration", "{}_acc", "{}_accel", "acc_{}"]}  # fmt: skip
    named = [(str(rng.choice(forms[what])).format(joint), values) for (joint, what), values in columns.items()]
    if kind != "linear" or rng.integers(2):
        named.append((str(rng.choice(["time", "t", "time_from_start"])), times))
    if rng.integers(2):
        named.append(("pan_effort", [1.5] * len(times)))
    named = [named[i] for i in rng.permutation(len(named))]
    mark = str(rng.choice([",", ", ", " "]))
    lines = [str(rng.choice(["", "# "])) + mark.join(name for name, _ in named)]
    for row in zip(*(values for _, values in named)):
        lines.append(mark.join(repr(v) for v in row))
        if rng.integers(4) == 0:
            lines.append("# a comment")
    return "\n".join(lines) + "\n"


def as_message(rng, times, columns):
    """A JointTrajectory in one of its wrappers, as JSON; and the message. Times are whole milliseconds."""
    joints = [joint for joint in ("follow", "wrist", "slide", "lift", "pan") if (joint, "position") in columns]
    ros = int(rng.integers(1, 3))
    fill = {"follow": 0.0, "wrist": 0.0}

    def values(what, i):
        if (PLANNED[0], what) not in columns:
            return []
        return [columns[joint, what][i] if (joint, what) in columns else fill[joint] for joint in joints]

    points = [{"positions": values("position", i), "velocities": values("velocity", i),
               "accelerations": values("acceleration", i), "effort": [], "time_from_start": messages.duration(ros, time)}
              for i, time in enumerate(times)]  # fmt: skip
    trajectory = {"header": messages.header(ros), "joint_names": joints, "points": points}
    whole = {"joint_trajectory": trajectory, "multi_dof_joint_trajectory": messages.multi_dof_trajectory(ros)}
    wrapped = [trajectory, whole, {"trajectory": whole}, {"trajectory": [whole]}, {"planned_trajectory": whole},
               {"goal": {"trajectory": trajectory}}, {"trajectory": trajectory}, {"goal": {"trajectory": whole}}]  # fmt: skip
    message = wrapped[rng.integers(len(wrapped))]
    return json.dumps(message), message


class Trajectories(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "arm.urdf").write_text(ARM)
        (cls.folder / "robot.yaml").write_text(ROBOT)
        cls.urdf = Urdf(cls.folder / "arm.urdf")

    def tip(self, trajectory, time):
        values = {joint: [trajectory.value(joint, time)] for joint in PLANNED}
        return self.urdf.poses(values | {"wrist": [HELD]})["tip"][:3, 3]

    def verify(self, name, at, text):
        (self.folder / f"{name}.yaml").write_text(PROBLEM % tuple(map(float, at)))
        return runs.report(self.folder, "verify", f"{name}.yaml", "-", text=text)

    def one(self, i):
        """Tests one random file; returns what it was, or a text that says what failed."""
        rng = np.random.default_rng([SEED, i])
        kind = str(rng.choice(["linear", "cubic", "quintic"]))
        times, columns = random_rows(rng, kind)
        if rng.integers(2):
            text = as_csv(rng, times, columns, kind)
            own = read_csv(text, [*PLANNED, "wrist", "follow"])
        else:
            text, message = as_message(rng, times, columns)
            own = read_message(message)
        place = f"seed {SEED}, file {i}:\n{text}\n"
        assert own.between == kind, place
        first, last = (own.times[0], own.times[-1]) if own.times else (0, len(times) - 1)
        at = np.linspace(first, last, 600)
        way = np.array([self.tip(own, t) for t in at])
        # Between two samples the tip is off their chord by less than its sag, and that by less than the longest chord.
        chord = np.linalg.norm(np.diff(way, axis=0), axis=1).max()

        hit = float(rng.uniform(first, last))
        status, report = self.verify(f"hit{i}", self.tip(own, hit) + rng.normal(size=3) * 0.002, text)
        if status != 1 or report["verdict"] != "refuted":
            return f"{place}a ball on the curve at {hit}: status {status}, {report}"
        ends = [report["begin_s"], report["end_s"]]
        if report["between"] != own.between or (own.times and not np.allclose(ends, [first, last])):
            return f"{place}another curve: {report}"
        finding = next(f for f in report["findings"] if f["verdict"] == "refuted")
        time = finding["time_s"] if own.times else finding["edge"] + finding["t"]
        state = [own.value(joint, time) for joint in PLANNED]
        # Both evaluate a polynomial of degree 5 in doubles, with values below 10: their rounding is far below 1e-9.
        if not np.allclose(state, finding["state"], rtol=0, atol=1e-9):
            return f"{place}at {time} the own state is {state}, Corridor's {finding['state']}"

        for _ in range(200):  # a place clear of the curve by 0.01 m
            aside = way[rng.integers(len(way))] + rng.normal(size=3) * 0.06
            gap = np.linalg.norm(way - aside, axis=1).min() - 2 * RADIUS - chord
            if 0.01 < gap < 0.05:
                break
        else:
            return f"{place}no clear place was found"
        status, report = self.verify(f"clear{i}", aside, text)
        if status != 0 or report["verdict"] != "proved":
            return f"{place}a ball at {aside}, {gap} m beside the curve: status {status}, {report}"
        return kind

    def test_balls_on_the_curve_and_beside_it(self):
        answers = runs.many(self.one, range(ROUNDS))
        wrong = [answer for answer in answers if answer not in ("linear", "cubic", "quintic")]
        self.assertFalse(wrong, "\n".join(wrong[:3]))
        print(f"seed {SEED}: files by their curves:", {kind: answers.count(kind) for kind in ("linear", "cubic", "quintic")})


if __name__ == "__main__":
    unittest.main()
