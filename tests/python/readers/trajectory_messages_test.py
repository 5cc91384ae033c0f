"""Changes every field of every message that gives a trajectory, one at a time: none may be dropped in silence."""

import json
import math
import os
import pathlib
import random
import tempfile
import unittest

import messages
import runs
from perturb import at, changed, fields, maps, matches, other_value, pattern, says_nothing
from trajectories import read_message

SEED = int(os.environ.get("CORRIDOR_SEED", 1))

PROBLEM = """format: corridor-problem-1
robot: robot.yaml
world: {ball: {sphere: 0.01, at: [%r, %r, 0.2]}}
start: {j1: -0.3, j2: 0.4}
goal: {j1: 0.3, j2: 0.1}
"""
ROBOT = "format: corridor-robot-1\nname: arm\nurdf: arm.urdf\njoints: [j1, j2]\nhold: {j3: 0.25}\n"

# Values for empty lists, and for fields in which "one more" would mean little.
FILL = {
    "multi_dof_joint_state.twist": lambda: [messages.twist(1)],
    "multi_dof_joint_state.wrench": lambda: [{"force": messages.point3(1), "torque": messages.point3()}],
    "attached_collision_objects": lambda: [attached()],
    "path_tolerance": lambda: [{"name": "j1", "position": 1.0, "velocity": 0.0, "acceleration": 0.0}],
    "goal_tolerance": lambda: [{"name": "j1", "position": 1.0, "velocity": 0.0, "acceleration": 0.0}],
    "component_path_tolerance": lambda: [component_tolerance()],
    "component_goal_tolerance": lambda: [component_tolerance()],
    "error_code.val": lambda: -2,  # INVALID_MOTION_PLAN
}

# Fields that mean something only together.
TOGETHER = {
    "multi_dof_joint_trajectory": lambda: {"joint_names": ["base_joint"], "points": moving_points()},
    "multi_dof_trajectory": lambda: {"joint_names": ["base_joint"], "points": moving_points()},
    "multi_dof_joint_state": lambda: {"joint_names": ["base_joint"], "transforms": [messages.transform(0.5)]},
}
# Fields that can't matter, each with the reason.
CANNOT_MATTER = {
    "multi_dof_joint_trajectory.joint_names": "changed together with another field",
    "multi_dof_joint_trajectory.points": "as above",
    "multi_dof_trajectory.joint_names": "as above",
    "multi_dof_trajectory.points": "as above",
    "multi_dof_joint_state.joint_names": "as above",
    "multi_dof_joint_state.transforms": "as above",
    "header.seq": "a counter of messages",
    "header.stamp.secs": "when the message was made, or begins: the curve is the same",
    "header.stamp.nsecs": "as above",
    "header.stamp.sec": "as above",
    "header.stamp.nanosec": "as above",
    "joint_trajectory.header.frame_id": "values of joints have no frame",
    "joint_state.header.frame_id": "values of joints have no frame",
    "trajectory.header.frame_id": "values of joints have no frame",
    "^header.frame_id": "values of joints have no frame",
    "effort.*": "forces do not change the curve",
    "wrench": "forces do not change the curve",
    "goal_id.id": "the name of a goal",
    "goal_id.stamp.secs": "when the goal was sent",
    "goal_id.stamp.nsecs": "when the goal was sent",
    "goal_id.uuid.*": "the name of a goal",
    "planning_time": "how long the planner took",
    "group_name": "the trajectory itself names its joints",
    "model_id": "the trajectory itself names its joints",
    "goal_tolerance": "how near to its goal the controller must end",
    "component_goal_tolerance": "as above",
    "multi_dof_joint_state.twist": "the speed of bodies, and none is named",
    "error_code.message": "a comment on the result",
    "error_code.source": "a comment on the result",
    "multi_dof_joint_trajectory.header.frame_id": "the frame of poses, and there are none",
    "multi_dof_trajectory.header.frame_id": "the frame of poses, and there are none",
    "multi_dof_joint_state.header.frame_id": "the frame of poses, and there are none",
    "goal_time_tolerance.secs": "how late the controller may arrive",
    "goal_time_tolerance.nsecs": "as above",
    "goal_time_tolerance.sec": "as above",
    "goal_time_tolerance.nanosec": "as above",
}


def ball_beside(curve, time):
    """A place in the plane of the arm's tip, 0.03 m from its surface, and off the way of the tip."""
    angle, x, y = 0.0, 0.0, 0.0
    for joint in ("j1", "j2", "j3"):
        angle += curve.value(joint, time)
        x, y = x + 0.5 * math.cos(angle), y + 0.5 * math.sin(angle)
    reach = math.hypot(x, y)
    return x * (1 + 0.06 / reach), y * (1 + 0.06 / reach)


def moving_points():
    return [{"transforms": [messages.transform(0, y)], "velocities": [], "accelerations": [], "time_from_start": t}
            for t, y in ((0, 0), (1, 0.5))]  # fmt: skip


def component_tolerance():
    return {"joint_name": "base_joint", "component": 1, "position": 1.0, "velocity": 0.0, "acceleration": 0.0}


def attached():
    box = messages.collision_object(
        1, "held_box", primitives=[messages.primitive(1, [0.3, 0.3, 0.3], 1)], primitive_poses=[messages.pose()]
    )
    return {"link_name": "tip", "object": box, "touch_links": [], "detach_posture": {}, "weight": 0.0}


def expected_silence(name):
    return any(matches(name, rule) for rule in CANNOT_MATTER)


class TrajectoryMessages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        curve = read_message(messages.joint_trajectory(1))
        problems = [(f"problem{i}.yaml", PROBLEM % ball_beside(curve, time)) for i, time in enumerate((0.5, 1.75))]
        for name, text in (*problems, ("robot.yaml", ROBOT), ("arm.urdf", messages.ARM)):
            (cls.folder / name).write_text(text)

    def answer(self, message, problem=0):
        """All that the program says about a message, or the text of a file, except how much work it took. The status
        comes first."""
        text = message if isinstance(message, str) else json.dumps(message)
        status, report = runs.report(self.folder, "verify", f"problem{problem}.yaml", "-", text=text)
        if isinstance(report, dict):
            report = {key: value for key, value in report.items() if key not in ("distance_queries", "problem")}
        return status, report

    def silent(self, kind, message, changes):
        """The names of those changes after which the program says the same as before."""
        before = [self.answer(message, problem) for problem in (0, 1)]
        for status, report in before:
            self.assertEqual((status, report["verdict"]), (0, "proved"), f"{kind}: {report}")

        def same(change):
            return all(self.answer(change[1], problem) == before[problem] for problem in (0, 1))

        return [name for (name, _), silent in zip(changes, runs.many(same, changes)) if silent]

    def test_every_field(self):
        rng = random.Random(SEED)
        dropped = []
        for kind, message in messages.trajectory_messages().items():
            found = {}
            for path, value in fields(message):
                found.setdefault(pattern(path), []).append((path, value))
            changes = []
            for name, places in found.items():
                for path, value in places if kind.startswith("JointT") else [rng.choice(places)]:
                    if not expected_silence(name):
                        where = ".".join(map(str, path))
                        changes.append((f"{kind}: {where}", changed(message, path, other_value(name, value, FILL))))
            for path in maps(message):
                for rule, make in TOGETHER.items():
                    if matches(pattern(path), rule):
                        changes.append((f"{kind}: {pattern(path)}", changed(message, path, {**at(message, path), **make()})))
            dropped += self.silent(kind, message, changes)
        if dropped:
            self.fail(f"seed {SEED}: fields of which nothing is said:\n" + "\n".join(dropped))

    def test_every_cell_of_a_table(self):
        """A file of rows, with columns of planned, held, mimicking and fixed joints."""
        points = messages.joint_trajectory(1)["points"]
        columns = {"time": [0.0, 1.0, 2.5]}
        for kind, key in (("", "positions"), ("_velocity", "velocities"), ("_acceleration", "accelerations"),
                          ("_effort", "effort")):  # fmt: skip
            columns |= {joint + kind: [point[key][i] for point in points] for i, joint in enumerate(messages.JOINTS)}
            columns["mount" + kind] = [0.0] * 3

        def text(columns):
            return "\n".join([" ".join(columns)] + [" ".join(map(repr, row)) for row in zip(*columns.values())]) + "\n"

        changes = []
        for name, values in columns.items():
            for row in range(3):
                if not name.endswith("_effort"):  # efforts move nothing
                    other = [value + (i == row) for i, value in enumerate(values)]
                    changes.append((f"{name}, row {row}", text(columns | {name: other})))
        dropped = self.silent("table", text(columns), changes)
        if dropped:
            self.fail("cells of which nothing is said:\n" + "\n".join(dropped))

    def test_fields_that_cannot_matter(self):
        """Each of them is read, and the curve is still proved: otherwise it does not belong on the list."""
        for kind, message in messages.trajectory_messages().items():
            places = {pattern(path): (path, value) for path, value in fields(message)
                      if expected_silence(pattern(path)) and value != []}  # fmt: skip
            changes = [(name, changed(message, path, other_value(name, value, FILL))) for name, (path, value) in places.items()]
            for (name, _), (status, report) in zip(changes, runs.many(lambda change: self.answer(change[1]), changes)):
                self.assertEqual(status, 0, f"{kind}: {name}: {report}")

    def test_unknown_keys(self):
        dropped = []
        for kind, message in messages.trajectory_messages().items():
            places = {pattern(path): path for path in maps(message) if not says_nothing(pattern(path))}
            changes = [(f"{kind}: {name or 'the message'}", changed(message, (*path, "zzz_other"), 1))
                       for name, path in places.items()]  # fmt: skip
            dropped += self.silent(kind, message, changes)
        if dropped:
            self.fail("maps with an unknown key of which nothing is said:\n" + "\n".join(dropped))


if __name__ == "__main__":
    unittest.main()
