"""Changes every field of MoveIt's PlanningScene and MotionPlanRequest, one at a time: none may be dropped in silence."""

import json
import os
import pathlib
import re
import tempfile
import unittest

import corridor
import messages
import numpy as np
import runs
from corridor import _native
from perturb import at, changed, fields, maps, matches, other_value, pattern, says_nothing

SEED = int(os.environ.get("CORRIDOR_SEED", 1))

ROBOT = "format: corridor-robot-1\nname: arm\nurdf: arm.urdf\nsrdf: arm.srdf\n"
FILES = {
    "arm.urdf": messages.ARM,
    "arm.srdf": messages.SRDF,
    "free.yaml": ROBOT,
    "held.yaml": ROBOT + "joints: [j1, j2]\nhold: {j3: 0.25}\n",
    "scene_problem.yaml": "format: corridor-problem-1\nrobot: held.yaml\nmoveit: {scene: scene.yaml}\n"
    "start: {j1: -0.3, j2: 0.4}\ngoal: {j1: 0.3, j2: 0.1}\n",
    "request_problem.yaml": "format: corridor-problem-1\nrobot: free.yaml\nmoveit: {request: request.yaml}\n"
    "world: {post: {cylinder: {radius: 0.05, length: 1}, at: [1.2, -0.9, 0.2]}}\n",
}


def attached():
    box = messages.collision_object(
        1, "held_box", primitives=[messages.primitive(1, [0.3, 0.3, 0.3], 1)], primitive_poses=[messages.pose()]
    )
    return {"link_name": "tip", "object": box, "touch_links": [], "detach_posture": {}, "weight": 0.0}


def position_constraint():
    return {"link_name": "tip", "target_point_offset": messages.point3(), "weight": 1.0,
            "constraint_region": {"primitives": [messages.primitive(2, [0.1], 1)],
                                  "primitive_poses": [messages.pose(1, 1, 0)]}}  # fmt: skip


def orientation_constraint():
    return {"link_name": "tip", "orientation": {**messages.point3(), "w": 1.0}, "absolute_x_axis_tolerance": 0.1,
            "absolute_y_axis_tolerance": 0.1, "absolute_z_axis_tolerance": 0.1, "weight": 1.0}  # fmt: skip


def constraints_on_j1():
    return {**messages.constraints(), "joint_constraints": [messages.joint_constraint("j1", 0.0)]}


def of_one_body(path):
    """Whether a field says that a body may touch itself. Bodies are never tested against themselves."""
    return path[-2:-1] == ("enabled",) and path[-1] == path[-3]


FILL = {
    "multi_dof_joint_state.twist": lambda: [messages.twist(1)],
    "multi_dof_joint_state.wrench": lambda: [{"force": messages.point3(1), "torque": messages.point3()}],
    "attached_collision_objects": lambda: [attached()],
    "fixed_frame_transforms": lambda: [{"header": messages.header(1, "base"), "child_frame_id": "world",
                                        "transform": messages.transform(1)}],
    "octomap.octomap.data.*": lambda: 8,  # the second of eight parts is occupied
    "object_colors": lambda: [{"id": "crate", "color": {"r": 1.0, "g": 0.0, "b": 0.0, "a": 1.0}}],
    "polygon.points": lambda: [messages.point3(), messages.point3(1), messages.point3(0, 1)],
    "collision_objects.*.primitives": lambda: [messages.primitive(1, [0.2, 0.2, 0.2], 1)],
    "collision_objects.*.primitive_poses": lambda: [messages.pose(1.4, -0.5, 0.2)],
    "collision_objects.*.meshes": lambda: [messages.mesh()],
    "collision_objects.*.mesh_poses": lambda: [messages.pose(1.4, -0.5, 0.2)],
    "collision_objects.*.planes": lambda: [{"coef": [0.0, 0.0, 1.0, 0.0]}],
    "collision_objects.*.plane_poses": lambda: [messages.pose()],
    "subframe_names": lambda: ["handle"],
    "subframe_poses": lambda: [messages.pose(0.1)],
    "position_constraints": lambda: [position_constraint()],
    "orientation_constraints": lambda: [orientation_constraint()],
    "visibility_constraints": lambda: [{"target_radius": 1.0}],
    "joint_constraints": lambda: [messages.joint_constraint("j1", 0.0)],
    "trajectory_constraints.constraints": lambda: [constraints_on_j1()],
    "reference_trajectories": lambda: [{"joint_trajectory": [messages.joint_trajectory(1)], "cartesian_trajectory": []}],
    "max_velocity_scaling_factor": lambda: 0.125,
    "max_acceleration_scaling_factor": lambda: 0.125,
}  # fmt: skip

# Fields that mean something only together.
TOGETHER = {
    "multi_dof_joint_state": {"joint_names": ["base_joint"], "transforms": [messages.transform(0.5)]},
}
# Fields that can't matter, each with the reason.
CANNOT_MATTER = {
    **{f"{rule}.{key}": "changed together with another field" for rule, keys in TOGETHER.items() for key in keys},
    "multi_dof_joint_state.header.frame_id": "the frame of poses, and there are none",
    "header.seq": "a counter of messages",
    "header.stamp.secs": "when the message was made",
    "header.stamp.nsecs": "as above",
    "header.stamp.sec": "as above",
    "header.stamp.nanosec": "as above",
    "joint_state.header.frame_id": "values of joints have no frame",
    "effort.*": "forces move nothing",
    "wrench": "forces move nothing",
    "^name": "the name of the scene",
    "object_colors": "colours are only drawn",
    "default_entry_names": "defaults can only leave out pairs; without them, more pairs are tested",
    "default_entry_values": "as above",
    "octomap.octomap.header.frame_id": "the header of the map with its pose names the frame",
    "type.key": "the name of the object's type in a database",
    "type.db": "as above",
    "subframe_names": "names of places on an object, and nothing refers to them",
    "subframe_poses": "as above",
    "polygon.points": "only prisms have a polygon",
    "link_scale.*.link_name": "a scale of 1 changes nothing",
    "weight": "the share of a constraint in a sampler",
    "path_constraints.name": "the name of a constraint",
    "multi_dof_joint_state.twist": "the speed of bodies, and none is named",
    "workspace_parameters.header.frame_id": "bounds of bases that move, and this robot has none",
    **{f"{corner}_corner.{axis}": "as above" for corner in ("min", "max") for axis in "xyz"},
    "goal_constraints.*.name": "the name of a constraint",
    "tolerance_above": "the goal is the given value itself, which is within every tolerance",
    "tolerance_below": "as above",
    "planner_id": "how a path is searched for",
    "pipeline_id": "how a path is searched for",
    "num_planning_attempts": "how a path is searched for",
    "allowed_planning_time": "how a path is searched for",
    "^reference_trajectories": "how a path is searched for",
}


NOTES = 2  # where `answer` has the notes


class Messages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        for name, text in FILES.items():
            (cls.folder / name).write_text(text)

    def answer(self, kind, message, deep=False):
        """What was read from a message: the model at many states, and all notes; or the faults."""
        (self.folder / f"{kind}.yaml").write_text(json.dumps(message))
        try:
            problem = corridor.read_problem(self.folder / f"{kind}_problem.yaml")
        except corridor.InputError as error:
            return str(error)
        states = np.random.default_rng(SEED).uniform(*problem.bounds, (150, len(problem.numbers)))
        answers = problem.check(states)
        found = [problem.numbers, problem.bodies, problem.notes, problem._native.limit_notes, problem.margin, problem.planner,
                 problem.time, problem.seed]  # fmt: skip
        found += [array.tolist() for array in
                  (problem.start, problem.goals, problem.bounds, problem.tube, problem.poses(states), problem.clearance(states),
                   answers.verdict, answers.pairs)]  # fmt: skip
        found.append({key: np.asarray(value).tolist() for key, value in _native.certificate_pairs(problem._native).items()})
        if deep:  # limits show in a trajectory, sizes of meshes in a description
            try:
                solution = corridor.solve(problem, trajectory="csv", seed=1)
                found += [solution.path.tolist(), solution.trajectory.get("text")]
            except corridor.InputError as error:
                found.append(str(error))
            status, description = runs.report(self.folder, "inspect", f"{kind}_problem.yaml")
            found += [status, description["bodies"], description["pair_list"]]
        return found

    def silent(self, kind, message, changes):
        """The names of those changes after which the program says the same as before. A field of which a note says that it
        is not used, whatever its value, does not count."""
        before, deep = self.answer(kind, message), self.answer(kind, message, True)
        self.assertIsInstance(before, list, before)
        self.assertIsInstance(deep[-4], str, "the problem must be solved")
        unused = " ".join(note for note in before[NOTES] if "not used:" in note)
        return [name for name, other in changes
                if self.answer(kind, other) == before and self.answer(kind, other, True) == deep
                and not f" {re.split('[. ]', name)[-1]} (" in unused]  # fmt: skip

    def perturb(self, kind, make):
        for ros in (1, 2):
            message, what, changes = make(ros), f"{kind} of ROS {ros}", []
            for path, value in fields(message):
                name = pattern(path)
                if not any(matches(name, rule) for rule in CANNOT_MATTER) and not of_one_body(path):
                    where = ".".join(map(str, path))
                    changes.append((f"{what}: {where}", changed(message, path, other_value(name, value, FILL))))
            for path in maps(message):
                for rule, keys in TOGETHER.items():
                    if matches(pattern(path), rule):
                        whole = {**at(message, path), **keys}
                        changes.append((f"{what}: {pattern(path)}: {', '.join(keys)}", changed(message, path, whole)))
            yield from self.silent(kind, message, changes)

    def unknown_keys(self, kind, make):
        for ros in (1, 2):
            message = make(ros)
            places = {pattern(path): path for path in maps(message) if not says_nothing(pattern(path))}
            changes = [(f"{kind} of ROS {ros}: {name or 'the message'}", changed(message, (*path, "zzz_other"), 1))
                       for name, path in places.items()]  # fmt: skip
            yield from self.silent(kind, message, changes)

    def expect_none(self, what, dropped):
        dropped = list(dropped)
        if dropped:
            self.fail(f"seed {SEED}: {what}, of which nothing is said:\n" + "\n".join(dropped))

    def test_every_field_of_a_scene(self):
        self.expect_none("fields", self.perturb("scene", messages.planning_scene))

    def test_every_field_of_a_request(self):
        self.expect_none("fields", self.perturb("request", messages.motion_plan_request))

    def test_unknown_keys_of_a_scene(self):
        self.expect_none("maps with an unknown key", self.unknown_keys("scene", messages.planning_scene))

    def test_unknown_keys_of_a_request(self):
        self.expect_none("maps with an unknown key", self.unknown_keys("request", messages.motion_plan_request))


if __name__ == "__main__":
    unittest.main()
