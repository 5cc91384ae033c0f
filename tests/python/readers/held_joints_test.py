"""Trajectory files that say something of joints that the problem holds.

What is proved with a joint held may not be refuted with the same joint planned for. A file that moves a held joint may not
be proved.
"""

import os
import pathlib
import tempfile
import unittest

import numpy as np
import runs
from trajectories import read_csv
from urdf import Urdf

SEED = int(os.environ.get("CORRIDOR_SEED", 1))
ROUNDS = 500 if os.environ.get("CORRIDOR_STRESS") else 50


def link(name, length):
    box = f'<origin xyz="{length / 2} 0 0"/><geometry><box size="{length} 0.03 0.03"/></geometry>'
    return f'<link name="{name}"><collision>{box}</collision></link>'


def joint(name, parent, child, at, axis, kind="revolute", more=""):
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/>'
            f'<axis xyz="{axis}"/><limit lower="-3" upper="3" effort="1" velocity="9"/>{more}</joint>')  # fmt: skip


ARM = "\n".join([
    '<robot name="arm">', '<link name="base"/>',
    link("l1", 0.4), link("l2", 0.4), link("l3", 0.3), link("l4", 0.2), link("l5", 0.2),
    joint("j1", "base", "l1", "0 0 0.1", "0 0 1"), joint("j2", "l1", "l2", "0.4 0 0.05", "0 0.3 1"),
    joint("j3", "l2", "l3", "0.4 0 0.05", "0 1 0"), joint("j4", "l3", "l4", "0.3 0 0.05", "1 0 0", "prismatic"),
    joint("j5", "l4", "l5", "0.2 0 0.05", "0 0 1", more='<mimic joint="j3" multiplier="0.5" offset="0.1"/>'), "</robot>",
])  # fmt: skip
JOINTS = ["j1", "j2", "j3", "j4"]


def robot(planned, held):
    names = ", ".join(planned)
    values = ", ".join(f"{name}: {value!r}" for name, value in held.items())
    text = f"format: corridor-robot-1\nname: arm\nurdf: arm.urdf\njoints: [{names}]\n"
    return text + (f"hold: {{{values}}}\n" if held else "")


def problem(robot_file, world, start, goal):
    def state(values):
        return "{" + ", ".join(f"{name}: {value!r}" for name, value in values.items()) + "}"

    return f"format: corridor-problem-1\nrobot: {robot_file}\nworld:\n{world}start: {state(start)}\ngoal: {state(goal)}\n"


def ball(rng):
    at = ", ".join(f"{v:.6g}" for v in rng.uniform([-0.2, -1, -0.5], [1.3, 1, 0.7]))
    return f"{{sphere: {rng.uniform(0.02, 0.1):.6g}, at: [{at}]}}"


class HeldJoints(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "arm.urdf").write_text(ARM)

    def verdict(self, name, robot_text, problem_text, rows):
        """"proved", "refuted" or "undecided"; "refused" with the faults if the file is a fault."""
        (self.folder / f"{name}_robot.yaml").write_text(robot_text)
        (self.folder / f"{name}.yaml").write_text(problem_text)
        status, report = runs.report(self.folder, "verify", f"{name}.yaml", "-", text=rows)
        if status == 2:
            return "refused", report
        assert status == (report["verdict"] != "proved"), report
        return report["verdict"], report

    def rows_of(self, rng, held):
        """Rows of random joint values; held joints have their values in all rows. Returns the columns, and the text."""
        count = int(rng.integers(2, 5))
        columns = {"time": [float(t) for t in np.cumsum(rng.uniform(0.5, 1, count))]}
        for name in JOINTS:
            scale = 0.15 if name == "j4" else 1.0
            columns[name] = [held[name]] * count if name in held else [scale * float(v) for v in rng.uniform(-1.2, 1.2, count)]
        if rng.integers(2):
            for name in JOINTS:
                speeds = [float(v) for v in rng.uniform(-0.3, 0.3, count)]
                columns[f"{name}_velocity"] = [0.0] * count if name in held else speeds
        return columns

    @staticmethod
    def text(columns):
        return "\n".join([",".join(columns)] + [",".join(map(repr, row)) for row in zip(*columns.values())]) + "\n"

    def both(self, i):
        """Verifies a random file with joints held, and with all joints planned for."""
        rng = np.random.default_rng([SEED, i])
        names = [str(n) for n in rng.permutation(JOINTS)[: rng.integers(1, 4)]]
        held = {name: float(np.round(rng.uniform(-0.2, 0.2) if name == "j4" else rng.uniform(-1, 1), 6)) for name in names}
        columns = self.rows_of(rng, held)
        world = "".join(f"  ball{k}: {ball(rng)}\n" for k in range(rng.integers(3, 9)))
        ends = [{name: columns[name][row] for name in JOINTS} for row in (0, -1)]
        planned = [name for name in JOINTS if name not in held]
        parts = [{name: end[name] for name in planned} for end in ends]
        rows = self.text(columns)
        one, report_one = self.verdict(f"held{i}", robot(planned, held), problem(f"held{i}_robot.yaml", world, *parts), rows)
        two, report_two = self.verdict(f"all{i}", robot(JOINTS, {}), problem(f"all{i}_robot.yaml", world, *ends), rows)
        return one, two, f"seed {SEED}, file {i}: held: {report_one}\nplanned: {report_two}"

    def test_held_and_planned(self):
        answers = runs.many(self.both, range(ROUNDS))
        counts = {}
        for one, two, _ in answers:
            counts[one, two] = counts.get((one, two), 0) + 1
        print(f"seed {SEED}: verdicts with joints held and with all planned:", counts)
        for one, two, text in answers:
            self.assertFalse(one == "proved" and two == "refuted", text)
            self.assertNotIn("refused", (one, two), text)
        self.assertGreater(counts.get(("proved", "proved"), 0), ROUNDS // 10)
        self.assertGreater(counts.get(("refuted", "refuted"), 0), ROUNDS // 10)

    def moved(self, ball_at, changes):
        """Verifies a file in which only j1 is planned for, and `changes` are other columns. A ball is at `ball_at`."""
        held = {"j2": 0.0, "j3": 0.0, "j4": 0.0}
        world = "  ball: {sphere: 0.01, at: [%r, %r, %r]}\n" % tuple(map(float, ball_at))
        text = problem("moved_robot.yaml", world, {"j1": 0.0}, {"j1": 0.1})
        return self.verdict("moved", robot(["j1"], held), text, self.text(self.columns(changes)))

    @staticmethod
    def columns(changes):
        columns = {"time": [0.0, 1.0], "j1": [0.0, 0.1], "j2": [0.0, 0.0], "j3": [0.0, 0.0], "j4": [0.0, 0.0], "j5": [0.1, 0.1]}
        return columns | {f"{name}_velocity": [0.1 if name == "j1" else 0.0] * 2 for name in (*JOINTS, "j5")} | changes

    def where(self, changes, link_name, point, time):
        """Where a point of a link is at a time, if the held joints move as the file says."""
        trajectory = read_csv(self.text(self.columns(changes)), [*JOINTS, "j5"])
        urdf = Urdf(self.folder / "arm.urdf")
        return urdf.poses({name: [trajectory.value(name, time)] for name in JOINTS})[link_name] @ (*point, 1)

    def test_a_file_that_moves_a_held_joint(self):
        end, back = ("l5", (0.2, 0, 0)), ("l4", (0, 0, 0))
        at_rest = {f"{name}_acceleration": [0.0] * 2 for name in (*JOINTS, "j5")}
        for changes, (link_name, point), time in (
            ({"j2_velocity": [1.0, -1.0]}, end, 0.5),  # swings by T/8·|Δv|
            ({"j3_velocity": [0.0, -1.0]}, end, 0.6),
            ({"j4_velocity": [-1.0, 0.0]}, back, 0.3),
            ({"j2": [0.0, 0.5]}, end, 0.9),
            ({"j3": [0.5, 0.5]}, end, 0.2),
            ({**at_rest, "j2_acceleration": [20.0, 0.0]}, end, 0.4),
            ({"j2_velocity": [1.0, -1.0], "j3": [1e-6, 0.0]}, end, 0.5),
        ):
            with self.subTest(str(changes)):
                at = self.where(changes, link_name, point, time)[:3]
                verdict, report = self.moved(at, {})
                self.assertEqual(verdict, "proved", report)
                verdict, report = self.moved(at, changes)
                self.assertIn(verdict, ("refuted", "refused"), report)
        # Too small to hit the ball, but the file says something else than the problem.
        for changes in ({"j2": [1e-6, 0.0]}, {"j4": [9e-6, 9e-6]}, {"j3_velocity": [1e-4, 0.0]}):
            with self.subTest(str(changes)):
                verdict, report = self.moved((0, -1.3, 0.3), changes)
                self.assertEqual(verdict, "refused", report)

    def test_a_file_that_moves_a_mimic_joint_otherwise(self):
        """The joint follows its leader; a note names it, or the file is refused."""
        for changes in ({"j5_velocity": [1.0, -1.0]}, {"j5": [0.1, 0.6]}, {"j5": [0.6, 0.6]}):
            with self.subTest(str(changes)):
                _, before = self.moved((0, -1.3, 0.3), {})
                verdict, report = self.moved((0, -1.3, 0.3), changes)
                if verdict != "refused":
                    notes = set(report["notes"]) - set(before["notes"])
                    self.assertTrue(any("j5" in note for note in notes), report)


if __name__ == "__main__":
    unittest.main()
