"""Obstacles that change, clouds of points, and names and numbers that a script may pass."""

import os
import pathlib
import pickle
import shutil
import tempfile
import threading
import unittest

import numpy as np

import corridor
from corridor import shapes

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARM = ROOT / "robots/arm6/arm6.urdf"
START, GOAL = [-1, 1, 1, 0, 0, 0], [1, 1, 1, 0, 0, 0]


class Camera(unittest.TestCase):
    def arm(self, **more):
        return corridor.Problem(corridor.urdf(ARM), start=START, goals=GOAL, **more)

    def points(self, seed, count=400):
        return np.random.default_rng(seed).uniform([0.3, -0.6, 0], [0.9, 0.6, 1.2], (count, 3))

    def test_points_are_balls(self):
        """A cloud is the union of the balls about its points."""
        points = self.points(1)
        cloud = self.arm(obstacles={"cloud": shapes.points(points, 0.02)})
        balls = self.arm(obstacles={"cloud": [shapes.sphere(0.02, shapes.Pose(p)) for p in points]})
        states = np.random.default_rng(2).uniform(*cloud.bounds, (300, 6))
        self.assertTrue((cloud.check(states).verdict == balls.check(states).verdict).all())
        turned = shapes.Pose((0.1, 0.2, 0.3), (0, 0, np.pi / 2))
        moved = points @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [0.1, 0.2, 0.3]
        a = self.arm(obstacles={"cloud": shapes.points(points, 0.02, turned)})
        b = self.arm(obstacles={"cloud": shapes.points(moved, 0.02)})
        np.testing.assert_allclose(a.clearance(states[:20]), b.clearance(states[:20]), atol=1e-12)
        for wrong in ([], [[1, 2]], np.full((2, 3), np.nan)):
            with self.assertRaises(ValueError):
                self.arm(obstacles={"cloud": shapes.points(wrong, 0.02)})
        with self.assertRaisesRegex(ValueError, "radius"):
            self.arm(obstacles={"cloud": shapes.points(points, 0)})

    def test_obstacles_are_replaced(self):
        """A problem with other obstacles is the same as one that is built with them, also from a file."""
        first = self.arm(obstacles={"post": shapes.cylinder(0.05, 2, shapes.Pose((0.5, 0, 1)))}, margin=0.003)
        states = np.random.default_rng(3).uniform(*first.bounds, (200, 6))
        first.check(states)  # makes the trees
        for seed in range(3):
            world = {"cloud": shapes.points(self.points(seed), 0.03), "table": shapes.box([2, 2, 0.02], shapes.Pose((0, 0, -0.3)))}
            edited = first.edited(obstacles=world, seed=5)
            built = self.arm(obstacles=world, margin=0.003, seed=5)
            self.assertEqual(edited.bodies, built.bodies)
            self.assertEqual((edited.seed, edited.margin), (5, 0.003))
            np.testing.assert_array_equal(edited.start, built.start)
            mine, theirs = edited.check(states), built.check(states)
            np.testing.assert_array_equal(mine.verdict, theirs.verdict)
            np.testing.assert_array_equal(edited.clearance(states[:9]), built.clearance(states[:9]))
            first = edited
        shelf = corridor.read_problem(ROOT / "problems/arm_at_shelf")
        alone = shelf.edited(obstacles={})
        self.assertEqual([body for body in shelf.bodies if body in alone.bodies], alone.bodies)
        again = alone.edited(obstacles={"table": shapes.box([1, 1, 0.1], shapes.Pose((2, 0, 0)))})
        self.assertIn("table", again.bodies)
        with self.assertRaisesRegex(ValueError, "obstacles were edited"):
            corridor.solve(again.edited(time=20)).save("x.yaml")
        with self.assertRaisesRegex(TypeError, "obstacles=..."):
            first.edited(world={})

    def test_pairs_that_may_touch_still_may(self):
        world = {"table": shapes.box([2, 2, 0.02], shapes.Pose((0, 0, 0.3)))}
        problem = self.arm(obstacles=world, allow=[(name, "table") for name in self.arm().bodies])
        moved = problem.edited(obstacles={"table": shapes.box([3, 3, 0.02], shapes.Pose((0, 0, 0.3)))})
        self.assertEqual(moved.check(START).free.tolist(), problem.check(START).free.tolist())
        self.assertTrue(moved.check(START).free[0])
        other = problem.edited(obstacles={"desk": shapes.box([3, 3, 0.02], shapes.Pose((0, 0, 0.3)))})
        self.assertFalse(other.check(START).free[0])

    def test_what_a_file_says_stays(self):
        """Bounds, paddings, pairs that the files allow, and a scene's matrix: all as in a file that has the new world,
        also after a frame without its bodies."""
        table = {"table": shapes.box([0.8, 0.8, 0.1], shapes.Pose((0.8, 0, 0.1)))}
        post = {"post": shapes.box([0.1, 0.1, 2], shapes.Pose((0.5, 0.5, 0)))}
        both = "{table: {box: [0.8, 0.8, 0.1], at: [0.8, 0, 0.1]}, post: {box: [0.1, 0.1, 2], at: [0.5, 0.5, 0]}}"
        srdf = ["upper_arm", "hand"], ["base", "hand"]  # the first pair is tested again, by the matrix
        with tempfile.TemporaryDirectory() as folder:
            write = lambda name, text: (pathlib.Path(folder) / name).write_text(text)
            write("a.srdf", "<robot name='arm6'>%s</robot>" % "".join(f"<disable_collisions link1='{a}' link2='{b}' reason='User'/>" for a, b in srdf))
            write("robot.yaml", f"format: corridor-robot-1\nurdf: {ARM}\nsrdf: a.srdf\nallow: [[base, wrist2]]\n")
            write(
                "scene.yaml",
                "world: {collision_objects: []}\nallowed_collision_matrix:\n  entry_names: [upper_arm, hand, post, base]\n  entry_values: [[0, 0, 0, 0],"
                " [0, 0, 1, 1], [0, 1, 0, 0], [0, 1, 0, 0]]\n",
            )
            keys = (
                "format: corridor-problem-1\nrobot: robot.yaml\nmoveit: {scene: scene.yaml}\nbounds: {lift: [0.2, 1.4]}\n"
                "allow: [[forearm, post]]\npadding: {bodies: {table: 0.1}, pairs: [[wrist1, table, 0.03]]}\nmargin: 0.001\n"
                f"start: {{pan: -1, lift: 1, elbow: 1, wrist1: 0, wrist2: 0, wrist3: 0}}\n"
                f"goal: {{pan: 1, lift: 1, elbow: 1, wrist1: 0, wrist2: 0, wrist3: 0}}\nworld: "
            )
            write("problem.yaml", keys + both + "\n")
            problem = corridor.read_problem(folder)
            states = np.random.default_rng(5).uniform(-3.1, 3.1, (4000, 6))
            states[:, 1] = np.random.default_rng(6).uniform(0.1, 1.5, len(states))  # some beyond the bounds
            wanted = problem.check(states)
            self.assertGreater(len({int(v) for v in wanted.verdict}), 2)  # free, contact, out of bounds
            bare = problem.edited(obstacles={})
            for edited in (
                problem.edited(obstacles={**table, **post}),
                bare.edited(obstacles={**table, **post}),
                bare.edited(obstacles=post).edited(obstacles={**post, **table}, seed=3),
            ):
                np.testing.assert_array_equal(edited.bounds, problem.bounds)
                np.testing.assert_array_equal(edited.check(states).verdict, wanted.verdict)
                self.assertEqual(sorted(edited.notes), sorted(problem.notes))
                copied = pickle.loads(pickle.dumps(edited))
                np.testing.assert_array_equal(copied.check(states).verdict, wanted.verdict)
            self.assertFalse((bare.check(states).verdict == wanted.verdict).all())

    def test_threads_share_a_problem_and_its_edits(self):
        far = lambda seed: {"cloud": shapes.points(self.points(seed) + [0, 0, 1.2], 0.02)}
        problem = self.arm(obstacles=far(1))
        failures = []

        def use(seed):
            try:
                edited = problem.edited(obstacles=far(seed), margin=0.001)
                first = edited.check(START).verdict[0]
                if corridor.solve(edited.edited(time=0.2, seed=seed)) is None or edited.edited(seed=1).check(START).verdict[0] != first:
                    failures.append(seed)
            except Exception as error:  # noqa: BLE001
                failures.append(error)

        threads = [threading.Thread(target=use, args=(seed,)) for seed in range(8)]
        for thread in threads:
            thread.start()
        problem.check(START)
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_points_near_the_robot(self):
        """Against distances to single points."""
        problem = self.arm()
        points = self.points(4, 200)
        for distance in (0.0, 0.05, 0.2):
            near = problem.near_robot(points, START, distance)
            gaps = [self.arm(obstacles={"p": shapes.points([p], 1e-9)}).clearance(START)[0] for p in points[:60]]
            decided = np.abs(np.array(gaps) - distance) > 1e-6
            links = self.arm(obstacles={"p": shapes.points([[9, 9, 9]], 1e-9)}).clearance(START)[0]  # of the links themselves
            wanted = np.array(gaps) <= distance
            mask = decided & (np.array(gaps) < links - 1e-9)
            np.testing.assert_array_equal(near[:60][mask], wanted[mask])
        self.assertTrue(problem.near_robot(points, START, 0.2).any())
        self.assertFalse(problem.near_robot(points + 5, START, 0.2).any())
        for wrong in (-1, np.nan, "1"):
            with self.assertRaises(ValueError):
                problem.near_robot(points, START, wrong)


    def test_isolated_points(self):
        """Against all distances. Far and equal points, and cells with negative numbers, are among them."""
        points = np.vstack([self.points(5, 300), [[50, -50, 3], [50, -50, 3], [-1e6, 0, 0]]])
        apart = np.linalg.norm(points[:, None] - points[None], axis=2)
        for distance, neighbours in ((0.05, 1), (0.2, 1), (0.2, 4), (3.0, 200)):
            wanted = (apart <= distance).sum(axis=1) - 1 < neighbours
            np.testing.assert_array_equal(shapes.isolated(points, distance, neighbours), wanted)
        self.assertEqual(shapes.isolated(np.zeros((0, 3)), 1).shape, (0,))
        for distance, neighbours in ((0, 1), (np.inf, 1), (1e-12, 1), (0.1, 0), (0.1, 1.5)):
            with self.assertRaises((ValueError, TypeError)):
                shapes.isolated(points, distance, neighbours)


class Arguments(unittest.TestCase):
    def test_names_of_files_where_problems_are_meant(self):
        solution = corridor.solve(ROOT / "problems/two_arms", seed=1)
        self.assertTrue(solution and solution.verify()["verdict"] == "proved")
        self.assertTrue(corridor.solve(str(ROOT / "problems/two_arms"), seed=1))
        with self.assertRaises(corridor.InputError):
            corridor.solve("no such file")

    def test_names_with_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            place = os.fsencode(folder) + b"/T\xfcr"
            shutil.copytree(ROOT / "robots/arm6", os.fsdecode(place))
            arm = corridor.Problem(corridor.urdf(os.fsdecode(place + b"/arm6.urdf")), start=START, goals=GOAL)
            self.assertEqual(arm.numbers, corridor.Problem(corridor.urdf(ARM)).numbers)
            file = os.fsdecode(place + b"/p\xff.yaml")
            with open(file, "w", encoding="utf-8") as out:
                out.write("format: corridor-problem-1\nrobot: arm6.urdf\nworld: {}\nstart: {}\n")
            with self.assertRaisesRegex(corridor.InputError, r"T\?r/p\?\.yaml"):
                corridor.read_problem(file)
            with self.assertRaisesRegex(corridor.InputError, "no such file"):
                corridor.Body(shapes.mesh_file(os.fsdecode(place + b"/none.obj")))

    def test_texts_are_no_numbers(self):
        arm = corridor.Problem(corridor.urdf(ARM), start=START, goals=GOAL)
        for wrong in (["0"] * 6, ["0", 1, 2, 3, 4, 5], np.array([b"1"] * 6), np.array(["1"] * 6, dtype=object)):
            with self.assertRaisesRegex(ValueError, "start: an array of numbers is needed, not of texts"):
                arm.edited(start=wrong)

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    def test_a_process_that_is_forked_while_a_thread_solves(self):
        slow = corridor.read_problem(ROOT / "problems/cubicles").edited(planner="PRMstar", time=3)
        begun = threading.Event()
        thread = threading.Thread(target=lambda: corridor.solve(slow, progress=lambda *_: begun.set()))
        thread.start()
        begun.wait(30)
        child = os.fork()
        if child == 0:
            free = corridor.problem._solving.acquire(timeout=5)  # the lock of `solve`, which another thread holds
            os._exit(0 if free else 1)
        _, status = os.waitpid(child, 0)
        thread.join()
        self.assertEqual(os.waitstatus_to_exitcode(status), 0)


if __name__ == "__main__":
    unittest.main()
