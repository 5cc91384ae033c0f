"""Tests of the Python package. They need the environment variables PYTHONPATH and CORRIDOR_SOURCE_DIR."""

import math
import os
import pathlib
import pickle
import signal
import tempfile
import threading
import time
import unittest

import corridor
import numpy as np
from corridor import Body, Verdict, shapes

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])
ARM = SOURCE / "problems/arm_at_shelf"


def at(x, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def cube_in_room(**edits):
    """Returns a problem: a cube of 0.2 m, and a wall that the cube must go around."""
    edits = {"start": [-1, 0, 0, 0, 0, 0, 1], "goals": [1, 0, 0, 0, 0, 0, 1], **edits}
    return corridor.Problem(
        corridor.rigid_body(shapes.box([0.2, 0.2, 0.2]), [[-2, -2, -2], [2, 2, 2]], name="cube"),
        {"wall": shapes.box([0.1, 2, 2])},
        **edits,
    )


class Checks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.problem = corridor.read_problem(ARM)
        lower, upper = cls.problem.bounds
        cls.states = np.random.default_rng(7).uniform(lower, upper, (2000, len(lower)))

    def test_threads_change_nothing(self):
        one = self.problem.check(self.states, threads=1)
        for threads in 0, 2, 5:
            several = self.problem.check(self.states, threads=threads)
            np.testing.assert_array_equal(one.verdict, several.verdict)
        self.assertGreater((one.verdict == Verdict.CONTACT).sum(), 20)
        self.assertGreater(one.free.sum(), 20)
        self.assertEqual(len(one), 2000)
        self.assertFalse(one)

    def test_clearance_agrees_with_verdicts(self):
        verdicts = self.problem.check(self.states)
        clearance = self.problem.clearance(self.states)
        self.assertTrue((clearance[verdicts.free] > 0).all())
        self.assertTrue((clearance[verdicts.verdict == Verdict.CONTACT] <= 1e-6).all())

    def test_pairs_have_names(self):
        results = self.problem.check(self.states)
        i = int(np.argmax(results.verdict == Verdict.CONTACT))
        a, b = results.pair(i)
        self.assertIn(a, self.problem.bodies)
        self.assertIn(b, self.problem.bodies)
        self.assertIsNone(results.pair(int(np.argmax(results.free))))

    def test_edges(self):
        q0, q1 = self.states[:300], self.states[300:600]
        results = self.problem.certify(q0, q1, earliest=True)
        back = self.problem.certify(q1, q0)
        np.testing.assert_array_equal(results.free, back.free)
        contacts = results.verdict == Verdict.CONTACT
        self.assertGreater(contacts.sum(), 20)
        self.assertTrue(((results.time[contacts] >= 0) & (results.time[contacts] <= 1)).all())
        self.assertTrue(np.isnan(results.time[results.free]).all())
        # An array of one row is used with all rows of the other array.
        fan = self.problem.certify(self.problem.start, q1)
        self.assertEqual(len(fan), 300)
        # All states on a free edge are free.
        for i in np.flatnonzero(results.free)[:20]:
            t = np.linspace(0, 1, 50)[:, None]
            self.assertTrue(self.problem.check((1 - t) * q0[i] + t * q1[i]))

    def test_arrays_of_other_layouts_are_copied(self):
        expected = self.problem.check(self.states).verdict
        for other in (
            np.asfortranarray(self.states),
            np.repeat(self.states, 2, axis=1)[:, ::2],
            self.states.tolist(),
        ):
            np.testing.assert_array_equal(self.problem.check(other).verdict, expected)
        self.assertEqual(len(self.problem.check(self.states.astype(np.float32))), 2000)

    def test_out_of_bounds(self):
        lower, upper = self.problem.bounds
        bounded = int(np.argmin(upper - lower))
        state = self.problem.start
        state[bounded] = upper[bounded] + 0.1
        self.assertEqual(self.problem.check(state).verdict[0], Verdict.OUT_OF_BOUNDS)

    def test_bad_arrays(self):
        for states, text in (
            (np.zeros(3), r"states: an array of shape \(7,\) or \(N, 7\) is needed, not \(3,\)"),
            (np.zeros((2, 2, 7)), r"states: .* not \(2, 2, 7\)"),
            (np.full(7, math.nan), "states: the numbers must be finite"),
            ([["a"] * 7], "states: an array of numbers is needed"),
            ([[0.0] * 7, [0.0]], "states: an array of numbers is needed, with rows of equal length"),
        ):
            with self.assertRaisesRegex(ValueError, text):
                self.problem.check(states)
        with self.assertRaisesRegex(ValueError, "q1: as many rows as in q0 are needed, 3, not 2"):
            self.problem.certify(self.states[:3], self.states[:2])
        self.assertEqual(len(self.problem.check(np.zeros((0, 7)))), 0)


class Problems(unittest.TestCase):
    def test_file_that_is_missing(self):
        with self.assertRaises(corridor.InputError) as caught:
            corridor.read_problem("nowhere.yaml")
        [fault] = caught.exception.faults
        self.assertEqual(fault.text, "no such file")
        self.assertTrue(fault.file.endswith("nowhere.yaml"))
        self.assertIsInstance(caught.exception, ValueError)

    def test_all_faults_of_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "problem.yaml")
            file.write_text("format: corridor-problem-1\nrobt: x.yaml\nseed: -1\n")
            with self.assertRaises(corridor.InputError) as caught:
                corridor.read_problem(file)
        faults = caught.exception.faults
        self.assertGreaterEqual(len(faults), 2)
        self.assertIn(2, [fault.line for fault in faults])

    def test_edits(self):
        problem = corridor.read_problem(ARM)
        problem.edited(simplify=False, params={"range": 0.2}, rate=100, deviation=1e-3, corner_deviation=0.01)
        other = problem.edited(margin=0.01, seed=5, time=3, planner="RRT", tube={"joints": 0.001})
        self.assertEqual((other.margin, other.seed, other.time, other.planner), (0.01, 5, 3, "RRT"))
        self.assertEqual(other.tube[0], 0.001)
        self.assertEqual(problem.margin, 0)
        self.assertEqual(other.edited(seed=6).margin, 0.01)

    def test_contradictory_edits(self):
        problem = corridor.read_problem(ARM)
        for edits, error, text in (
            ({"start": problem.start + 100}, ValueError, "start: .* is not in"),
            ({"goals": np.zeros((0, 7))}, ValueError, "goals: at least one goal is needed"),
            ({"margin": -1}, ValueError, "margin: a finite number of 0 or more is needed"),
            ({"time": 0}, ValueError, "time: a finite number above 0 is needed"),
            ({"tube": {"elbow": 1}}, ValueError, "tube: the keys are joints, slides, position and rotation"),
            ({"rate": 0}, ValueError, "rate: a number from 1 to 10000 is needed, not 0"),
            ({"simplify": "yes"}, ValueError, 'simplify: one of true, false, ompl is needed, not "yes"'),
            ({"margin": 0.1, "clearance": 0.1}, ValueError, "clearance: can't be used if every pair has a margin"),
            ({"colour": 1}, TypeError, "a problem has no 'colour' that can be edited"),
        ):
            with self.assertRaisesRegex(error, text):
                problem.edited(**edits)

    def test_edits_of_the_wrong_type(self):
        problem = corridor.read_problem(ARM)
        for key, value, text in (
            ("seed", -1, "seed: a whole number from 0 to .* is needed, not -1"),
            ("seed", 1.5, "seed: a whole number from 0 to .* is needed, not 1.5"),
            ("margin", "1mm", "margin: a number is needed, not '1mm'"),
            ("planner", 3, "planner: a text is needed, not 3"),
            ("time", None, "time: a number is needed, not None"),
            ("tube", 0.1, "tube: a dictionary such as .* is needed, not 0.1"),
        ):
            with self.assertRaisesRegex(ValueError, text):
                problem.edited(**{key: value})

    def test_objects_of_the_wrong_type(self):
        ball, problem = shapes.sphere(1), corridor.read_problem(ARM)
        for text, call in (
            ("robots: what `urdf`, .* is needed, not 'x.urdf'; read_problem", lambda: corridor.Problem("x.urdf")),
            ("obstacles: shapes by name are needed", lambda: corridor.Problem([], [ball])),
            ("a Problem or the name of its file is needed, not None", lambda: corridor.solve(None)),
            ("a Problem or the name of its file is needed, not 3", lambda: list(corridor.solve_many([problem, 3]))),
            ("b: a Body is needed, not .*; Body", lambda: corridor.touch(Body(ball), ball)),
            ("a shape of corridor.shapes is needed", lambda: Body("ball.stl")),
        ):
            with self.assertRaisesRegex(TypeError, text):
                call()

    def test_faults_of_edited_ends_name_no_line_of_the_file(self):
        problem = corridor.read_problem(ARM)
        with self.assertRaisesRegex(ValueError, r"^start: .* = .* is not in \["):
            problem.edited(start=problem.bounds[1] + 1)
        states = np.random.default_rng(1).uniform(*problem.bounds, (200, len(problem.numbers)))
        touching = states[problem.check(states).verdict == Verdict.CONTACT][0]
        with self.assertRaises(corridor.InputError) as caught:
            corridor.solve(problem.edited(start=touching))
        self.assertEqual(caught.exception.faults[0][:2], ("", 0))
        self.assertRegex(str(caught.exception), "^start: in contact")
        with self.assertRaisesRegex(corridor.InputError, "^goal: in contact"):
            corridor.solve(problem.edited(goals=touching))

    def test_faults_of_built_problems_name_the_class(self):
        body = corridor.rigid_body(shapes.box([0.2, 0.2, 0.2]), [[-2, -1, -1], [2, 1, 1]])
        with self.assertRaises(corridor.InputError) as caught:
            corridor.Problem([body, body])
        self.assertEqual({fault.file for fault in caught.exception.faults}, {"Problem"})

    def test_parameters_of_planners_are_no_edits(self):
        with self.assertRaisesRegex(TypeError, r"it is a parameter of planners: params=\{'range': \.\.\.\}"):
            corridor.read_problem(ARM).edited(range=0.5)

    def test_values_of_the_wrong_type(self):
        problem, body, q = corridor.read_problem(ARM), Body(shapes.sphere(1)), corridor.read_problem(ARM).start
        for text, call in (
            ("metres_per_unit: a number is needed, not 'mm'", lambda: shapes.mesh_file("a.obj", "mm")),
            ("radius: a number is needed, not '1'", lambda: shapes.sphere("1")),
            ("threads: a whole number of 0 or more is needed, not -1", lambda: problem.check(q, threads=-1)),
            ("threads: .*, not '2'", lambda: problem.clearance(q, threads="2")),
            ("earliest: True or False is needed, not 'no'", lambda: problem.certificate(q, q, earliest="no")),
            ("distance: a number is needed, not 'x'", lambda: corridor.closer_than(body, body, "x")),
            ("tolerance: a number is needed, not 'x'", lambda: corridor.first_contact(body, body, at(3), at(2), "x")),
            ("joints: a list of names is needed, not 'pan'", lambda: corridor.urdf("a.urdf", joints="pan")),
            ("name: a name is needed, not 3", lambda: corridor.urdf("a.urdf", name=3)),
            ("bounds: corners by the names of joints", lambda: corridor.urdf("a.urdf", bounds=[[0], [1]])),
            ("obstacles: a name is needed, not 3", lambda: corridor.Problem([], {3: shapes.sphere(1)})),
            ("states: an array of real numbers", lambda: problem.check(q + 1j)),
            ("states: an array of real numbers", lambda: problem.check(np.ma.masked_array(q, False))),
            ("in degrees. Radians are needed", lambda: problem.edited(start=problem.bounds[1] * 180 / math.pi * 0.9)),
        ):
            with self.assertRaisesRegex(ValueError, text):
                call()
        with self.assertRaisesRegex(TypeError, "did you mean 'goals'"):
            problem.edited(goal=q)
        with self.assertRaisesRegex(TypeError, "progress: a function"):
            corridor.solve(problem, progress=3)

    def test_files_that_have_changed_since_pickling(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh, file = pathlib.Path(folder, "wall.obj"), pathlib.Path(folder, "problem.yaml")
            wall = "v 0 -1 -1\nv 0 1 -1\nv 0 0 {}\nf 1 2 3\n"
            mesh.write_text(wall.format(1))
            (pathlib.Path(folder) / "robot.yaml").write_text(
                "format: corridor-robot-1\nname: cube\nrigid: SE3\nshapes: [{box: [0.2, 0.2, 0.2]}]\n"
            )
            file.write_text(
                "format: corridor-problem-1\nrobot: robot.yaml\nworld: {wall: {mesh: wall.obj}}\n"
                "start: {at: [-1, 0, 0]}\ngoal: {at: [1, 0, 0]}\nbounds: {at: [[-2, -2, -2], [2, 2, 2]]}\n"
            )
            read = corridor.read_problem(file)
            built = corridor.Problem(
                corridor.rigid_body(shapes.sphere(0.1), [[-2] * 3, [2] * 3]), {"wall": shapes.mesh_file(mesh)}
            )
            kept = [pickle.dumps(each) for each in (read, built, Body(shapes.mesh_file(mesh)))]
            for each in kept:
                pickle.loads(each)
            text = file.read_text()
            for old, new in (("[1, 0, 0]}", "[1, 0.5, 0]}"), ("bounds:", "margin: 0.01\nbounds:"), ("bounds:", "tube: {position: 0.01}\nbounds:")):
                file.write_text(text.replace(old, new, 1))
                with self.assertRaisesRegex(ValueError, "changed since"):
                    pickle.loads(kept[0])
            file.write_text(text)
            pickle.loads(kept[0])
            mesh.write_text(wall.format(1.0000001))
            for each in kept:
                with self.assertRaisesRegex(ValueError, "changed since"):
                    pickle.loads(each)

    def test_matrices_near_a_rotation(self):
        turned = at(0.5)
        turned[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        ball = Body(shapes.sphere(0.25))
        for off, accepted in ((3e-7, True), (1e-6, False)):
            pose = turned.copy()
            pose[:3, :3] *= 1 + off
            if accepted:
                corridor.first_contact(ball, ball, pose, pose)
            else:
                with self.assertRaisesRegex(ValueError, "start: the upper left 3×3 matrix must be a rotation"):
                    corridor.first_contact(ball, ball, pose, pose)

    def test_figures_say_where_targets_are_kept(self):
        problem = corridor.read_problem(ARM)
        kept = corridor.solve(problem, trajectory="csv")
        self.assertEqual(kept.figures["share_on_target"], 1)
        self.assertEqual(kept.figures["why_off_target"], "")
        self.assertGreater(kept.trajectory["proved_clearance_m"], 0)
        missed = corridor.solve(corridor.read_problem(ARM.parent / "snake_posts").edited(clearance=0.1))
        self.assertLess(missed.figures["share_on_target"], 1)
        self.assertIn(missed.figures["why_off_target"], ("detour", "not found", "time"))

    def test_the_order_of_edits_does_not_matter(self):
        problem = corridor.read_problem(ARM)
        for edits in (
            {"params": {"nonsense": "1"}, "planner": "RRTConnect"},
            {"planner": "RRTConnect", "params": {"nonsense": "1"}},
        ):
            with self.assertRaisesRegex(corridor.InputError, "nonsense"):
                corridor.solve(problem.edited(**edits))
        # If the planner is replaced, the parameters of the old planner are dropped, here and after pickling.
        other = problem.edited(planner="RRTConnect", params={"range": "0.5"}).edited(planner="PRM")
        self.assertIn("PRM", corridor.solve(pickle.loads(pickle.dumps(other)), time=0.2).figures["planner"])

    def test_notes_on_mesh_files(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = pathlib.Path(folder, "mm.obj")
            mesh.write_text("# units: mm\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n")
            problem = corridor.Problem(
                corridor.rigid_body(shapes.sphere(0.1), [[-2] * 3, [2] * 3]), {"wall": shapes.mesh_file(str(mesh))}
            )
        notes = "\n".join(problem.notes)
        self.assertIn('line 1 says "units: mm"', notes)
        self.assertIn("lines and points have no volume", notes)

    def test_callers_may_change_what_they_passed(self):
        base = at(0, 0, 0)
        robot = corridor.urdf(SOURCE / "robots/arm6/arm6.urdf", base=base)
        problem = corridor.Problem(robot, {"post": shapes.cylinder(0.05, 2, at(0.5, 0, 1))})
        before = problem.clearance([-1, 1, 1, 0, 0, 0])
        robot["base"][0, 3] = 0.3
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(problem)).clearance([-1, 1, 1, 0, 0, 0]), before)

    def test_a_wide_tube_or_margin_tests_pairs_again(self):
        # robot.yaml says: block and arm are never in contact. This was proved up to 0.01 rad beyond the limits, by
        # corridor new robot, which wrote the digest.
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "arm.urdf").write_text(
                '<robot name="r"><link name="base"/><link name="block"><collision><origin xyz="0 0.6 0"/><geometry>'
                '<box size="0.2 0.2 0.2"/></geometry></collision></link><joint name="mount" type="fixed"><parent '
                'link="base"/><child link="block"/></joint><link name="arm"><collision><origin xyz="0.5 0 0"/><geometry>'
                '<box size="0.4 0.05 0.05"/></geometry></collision></link><joint name="turn" type="revolute">'
                '<parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" '
                'velocity="1"/></joint></robot>'
            )
            (folder / "robot.yaml").write_text(
                "format: corridor-robot-1\nurdf: arm.urdf\nnever_in_contact: {margin: 0.01, beyond_limits: 0.01, "
                "digest: 849e2a30826ee5e34019f72043a08d7446f4be58219e13aa50f346f86c11b3c1, pairs: [[arm, block]]}\n"
            )
            text = "format: corridor-problem-1\nrobot: robot.yaml\nstart: {turn: -0.9}\ngoal: {turn: 0.98}\n"
            (folder / "plain.yaml").write_text(text)
            (folder / "tube.yaml").write_text(text + "tube: {joints: 0.4}\n")
            plain, tube = (corridor.read_problem(folder / f"{name}.yaml") for name in ("plain", "tube"))
            edited = plain.edited(tube={"joints": 0.4})
            near = plain.edited(margin=0.2)
        state = [0.98]
        self.assertFalse(any("digest" in note for note in plain.notes))
        self.assertFalse(near.check(state))
        self.assertNotEqual(plain.certify([0], [1.5]).verdict[0], corridor.Verdict.FREE)
        self.assertTrue(plain.check(state))
        self.assertFalse(tube.check(state))
        self.assertEqual(edited.check(state).verdict[0], tube.check(state).verdict[0])

    def test_problem_built_of_arrays(self):
        vertices = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        triangles = [
            [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
            [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
        ]  # fmt: skip
        problem = corridor.Problem(
            corridor.rigid_body(shapes.sphere(0.1), [[-3, -3, -3], [3, 3, 3]], name="ball"),
            {"cube": shapes.mesh(vertices, triangles, solid=True), "post": shapes.cylinder(0.1, 2, at(-1, -1))},
        )
        self.assertEqual(problem.bodies, ["ball", "cube", "post"])
        points = np.array([[-0.11, 0.5, 0.5], [-0.09, 0.5, 0.5], [0.5, 0.5, 0.5], [-1, -0.85, 0], [-1, -0.75, 0]])
        states = np.hstack([points, np.tile([0.0, 0, 0, 1], (5, 1))])
        np.testing.assert_array_equal(problem.check(states).free, [True, False, False, False, True])

    def test_urdf_with_obstacle(self):
        problem = corridor.Problem(
            corridor.urdf(SOURCE / "robots/arm6/arm6.urdf"), {"post": shapes.cylinder(0.05, 2, at(0.5, 0, 1))}
        )
        self.assertEqual(len(problem.numbers), 6)
        self.assertTrue(problem.check([-1, 1, 1, 0, 0, 0]))

    def test_bad_parts(self):
        body = corridor.rigid_body(shapes.sphere(0.1), [[-1, -1, -1], [1, 1, 1]])
        with self.assertRaisesRegex(ValueError, "triangles: index 9 of row 0 is not below the number of vertices, 3"):
            corridor.Problem(body, {"m": shapes.mesh(np.eye(3), [[0, 1, 9]])})
        with self.assertRaisesRegex(ValueError, "size: three numbers are needed"):
            shapes.box(2)
        with self.assertRaisesRegex(ValueError, "pose: the upper left 3×3 matrix must be a rotation"):
            corridor.Problem(body, {"b": shapes.box([1, 1, 1], np.diag([2, 1, 1, 1]))})
        with self.assertRaisesRegex(ValueError, "m: "):
            corridor.Problem(body, {"m": shapes.sphere(-1)})
        with self.assertRaisesRegex(ValueError, "start: the problem has no start"):
            corridor.solve(corridor.Problem(body, {"b": shapes.sphere(0.1)}, goals=[1, 0, 0, 0, 0, 0, 1]))

    def test_pickle(self):
        for problem in corridor.read_problem(ARM).edited(seed=9), cube_in_room(seed=9):
            copy = pickle.loads(pickle.dumps(problem))
            self.assertEqual(copy.bodies, problem.bodies)
            self.assertEqual(copy.seed, 9)
            np.testing.assert_array_equal(copy.goals, problem.goals)


def crane_over_floor(winch, keys=""):
    """A crane that turns, with a hook on a held winch: its ball is at z = 1 - winch. The floor's face is at z = 0, and
    touches the foot of the mast."""
    link = '<link name="{}"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>'
    limits = '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "crane.urdf").write_text(
            '<robot name="crane">' + "".join(link.format(name) for name in ("mast", "hook", "lamp"))
            + '<joint name="turn" type="revolute"><parent link="mast"/><child link="lamp"/><origin xyz="0 1 1"/>'
            + '<axis xyz="0 0 1"/>' + limits + '<joint name="winch" type="prismatic"><parent link="mast"/>'
            + '<child link="hook"/><origin xyz="1 0 1"/><axis xyz="0 0 -1"/>' + limits + "</robot>"
        )  # fmt: skip
        (folder / "robot.yaml").write_text(
            f"format: corridor-robot-1\nurdf: crane.urdf\njoints: [turn]\nhold: {{winch: {winch}}}\n"
        )
        (folder / "p.yaml").write_text(
            "format: corridor-problem-1\nrobot: robot.yaml\nworld: {floor: {box: [6, 6, 0.2], at: [0, 0, -0.1]}}\n"
            "start: {turn: 0}\ngoal: {turn: 1}\n" + keys
        )
        return corridor.read_problem(folder / "p.yaml")


class Solve(unittest.TestCase):
    def test_held_links_that_touch(self):
        problem = crane_over_floor(1)
        with self.assertRaisesRegex(corridor.InputError, "start: in contact in every state: \"hook\" and \"floor\" touch"):
            corridor.solve(problem)
        results = problem.check([[0], [1]])
        np.testing.assert_array_equal(results.verdict, [corridor.Verdict.CONTACT] * 2)
        self.assertEqual(sorted(results.pair(1)), ["floor", "hook"])
        self.assertEqual(problem.certify([0], [1]).verdict[0], corridor.Verdict.CONTACT)

    def test_what_the_proof_leaves_out(self):
        solution = corridor.solve(crane_over_floor(1, "allow: [[hook, floor]]\n"))
        left_out = [("mast", "floor", "touch at rest"), ("hook", "floor", "allow")]
        self.assertEqual(solution.left_out, left_out)
        self.assertRegex(
            repr(solution),
            "certified, except 2 pairs that touch at rest or are allowed to: mast ~ floor, hook ~ floor>$",
        )
        report = solution.verify()
        self.assertEqual(report["verdict"], "proved")
        self.assertEqual(report["left_out"], left_out)
        self.assertEqual(report["not_tested"], {"adjacent": 2, "allow": 1, "never move relative to each other": 1})

    def test_solution(self):
        calls = []
        solution = corridor.solve(cube_in_room(), time=20, progress=lambda *a: calls.append(a))
        self.assertTrue(solution)
        self.assertTrue(solution.certified)
        self.assertEqual(solution.verify()["verdict"], "proved")
        np.testing.assert_array_equal(solution.path[0], solution.problem.start)
        self.assertIn("<!DOCTYPE html>", solution.page()[:200])
        self.assertIn("iframe", solution._repr_html_())
        copy = pickle.loads(pickle.dumps(solution))
        np.testing.assert_array_equal(copy.path, solution.path)
        with self.assertRaisesRegex(ValueError, "names the problem's file, and there is none"):
            solution.save("x.yaml")

    def test_repeats(self):
        problem = cube_in_room(seed=3)
        paths = [corridor.solve(problem).path for _ in range(2)]
        np.testing.assert_array_equal(*paths)
        self.assertFalse(np.array_equal(paths[0], corridor.solve(problem, seed=4).path))

    def test_solves_at_the_same_time_wait_for_each_other(self):
        problem = cube_in_room(seed=3)
        expected = corridor.solve(problem).path
        results = [None] * 3

        def run(i):
            results[i] = corridor.solve(problem).path

        threads = [threading.Thread(target=run, args=(i,)) for i in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for path in results:
            np.testing.assert_array_equal(path, expected)

    def test_trajectory_and_file(self):
        solution = corridor.solve(corridor.read_problem(ARM), trajectory="csv")
        self.assertTrue(solution.trajectory["proved"])
        report = solution.verify_trajectory()
        self.assertEqual(report["verdict"], "proved")
        self.assertTrue(report["keeps_limits"])
        with tempfile.TemporaryDirectory() as folder:
            solution.save(pathlib.Path(folder, "s.yaml"))
            self.assertIn("corridor-solution-1", pathlib.Path(folder, "s.yaml").read_text())
            page = solution.view(pathlib.Path(folder, "s.html"))
            self.assertGreater(os.path.getsize(page), 10_000)

    def test_solutions_without_a_trajectory_say_so(self):
        solution = pickle.loads(pickle.dumps(corridor.solve(cube_in_room())))
        self.assertEqual(solution.trajectory, {})
        for act in (lambda: solution.trajectory["text"], solution.verify_trajectory):
            with self.assertRaisesRegex((KeyError, ValueError), 'there is no trajectory; pass trajectory="csv" to solve'):
                act()

    def test_path_that_touches_is_refuted(self):
        solution = corridor.solve(cube_in_room())
        solution.path = np.array([solution.path[0], solution.path[-1]])  # a path through the wall
        report = solution.verify()
        self.assertEqual(report["verdict"], "refuted")
        self.assertEqual(set(report["findings"][0]["bodies"]), {"cube", "wall"})
        self.assertEqual(report["findings"][0]["required_m"], 0)

    def test_no_path(self):
        closed = corridor.Problem(
            corridor.rigid_body(shapes.box([0.2, 0.2, 0.2]), [[-2, -1, -1], [2, 1, 1]]),
            {"wall": shapes.box([0.1, 4, 4])},
            start=[-1, 0, 0, 0, 0, 0, 1],
            goals=[1, 0, 0, 0, 0, 0, 1],
        )
        solution = corridor.solve(closed, time=0.3, trajectory="csv")
        self.assertFalse(solution)
        for act in (lambda: solution.trajectory["text"], solution.verify_trajectory):
            with self.assertRaisesRegex((KeyError, ValueError), "there is no trajectory; the problem is not solved"):
                act()
        self.assertEqual(solution.path.shape, (0, 7))
        with self.assertRaisesRegex(ValueError, "there is no path"):
            solution.verify()

    def test_unknown_planner_and_start_in_contact(self):
        with self.assertRaisesRegex(corridor.InputError, '^planner: unknown planner "RTT"'):
            corridor.solve(cube_in_room(), planner="RTT")
        with self.assertRaises(corridor.InputError):
            corridor.solve(cube_in_room(start=[0, 0, 0, 0, 0, 0, 1]))

    def test_interrupt(self):
        closed = cube_in_room(planner="RRTstar", time=60)
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            corridor.solve(closed)
        self.assertLess(time.monotonic() - begin, 30)

    def test_callback_that_raises_ends_the_solve(self):
        def fail(seconds, edges):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            corridor.solve(cube_in_room(planner="RRTstar", time=60), progress=fail)


class Queries(unittest.TestCase):
    def test_box_and_sphere(self):
        box, ball = Body(shapes.box([1, 1, 1])), Body(shapes.sphere(0.5))
        x = np.linspace(0, 3, 31)
        poses = np.array([at(v) for v in x])
        d = corridor.distance(box, ball, pose_b=poses)
        np.testing.assert_allclose(d.distance, np.maximum(x - 1, 0), atol=1e-12)
        away = x > 1.05
        np.testing.assert_allclose(d.on_a[away], np.tile([0.5, 0, 0], (away.sum(), 1)), atol=1e-9)
        np.testing.assert_array_equal(corridor.touch(box, ball, pose_b=poses), x <= 1 + 1e-12)
        np.testing.assert_array_equal(corridor.closer_than(box, ball, 0.55, pose_b=poses), x < 1.55)

    def test_first_contact(self):
        result = corridor.first_contact(Body(shapes.sphere(0.5)), Body(shapes.box([1, 1, 1])), at(3), at(-1))
        self.assertEqual(result.verdict, Verdict.CONTACT)
        self.assertAlmostEqual(result.time, 0.5, places=5)
        self.assertLessEqual(result.free_until, 0.5)
        self.assertEqual(
            corridor.first_contact(Body(shapes.sphere(0.5)), Body(shapes.box([1, 1, 1])), at(3), at(3, 9)).verdict, Verdict.FREE
        )

    def test_contacts(self):
        square = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
        floor = Body(shapes.mesh(square, [[0, 1, 2], [0, 2, 3]]))
        wall = Body(shapes.mesh(np.array(square)[:, [0, 2, 1]], [[0, 1, 2]]))
        result = corridor.contacts(floor, wall)
        self.assertEqual(result.segments.shape[1:], (2, 3))
        self.assertGreaterEqual(len(result.pairs), 1)
        np.testing.assert_allclose(result.segments[:, :, 1:], 0, atol=1e-12)

    def test_bad_poses(self):
        a = Body(shapes.sphere(1))
        with self.assertRaisesRegex(ValueError, r"pose_b: an array of shape \(4, 4\) or \(N, 4, 4\) is needed"):
            corridor.touch(a, a, pose_b=np.eye(3))
        with self.assertRaisesRegex(ValueError, "pose_a: the last row of a 4×4 matrix must be 0, 0, 0, 1"):
            corridor.touch(a, a, np.ones((4, 4)))
        with self.assertRaisesRegex(ValueError, "pose_b: 3 poses as in pose_a, or 1, are needed, not 2"):
            corridor.touch(a, a, np.tile(np.eye(4), (3, 1, 1)), np.tile(np.eye(4), (2, 1, 1)))
        with self.assertRaisesRegex(ValueError, "distance: a finite number of 0 or more is needed"):
            corridor.closer_than(a, a, -1)


if __name__ == "__main__":
    unittest.main()
