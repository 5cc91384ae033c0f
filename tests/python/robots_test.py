"""Tests of robots of links and joints that are described in Python."""

import math
import os
import pathlib
import pickle
import tempfile
import unittest
from dataclasses import replace

import corridor
import numpy as np
from corridor import Joint, Pose, Verdict, shapes
from urdf_reader import robot_of

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])
ROBOTS = SOURCE / "robots"

# A robot with rotations about all axes, axes that are not unit vectors, a mimic, a fixed joint, and shapes with poses.
TWISTED = """<robot name="twisted">
  <link name="base"><collision><origin xyz="0 0 0.1" rpy="0.3 -0.2 0.7"/><geometry><box size="0.3 0.2 0.1"/></geometry>
    </collision></link>
  <link name="upper"><collision><origin xyz="0 0 0.25" rpy="0.1 0.2 0.3"/><geometry><cylinder radius="0.05" length="0.4"/>
    </geometry></collision><collision><origin xyz="0.1 0 0.1"/><geometry><sphere radius="0.07"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.2 0 0" rpy="0 1.5707963267948966 0"/><geometry>
    <cylinder radius="0.04" length="0.4"/></geometry></collision></link>
  <link name="flange"/>
  <link name="finger"><collision><origin xyz="0.05 0 0" rpy="1 2 3"/><geometry><box size="0.1 0.02 0.03"/></geometry>
    </collision></link>
  <link name="thumb"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.03"/></geometry></collision></link>
  <joint name="thumb_slide" type="prismatic"><parent link="flange"/><child link="thumb"/><origin xyz="0.02 -0.04 0"
    rpy="0 0 0.1"/><axis xyz="0 -3 0.1"/><limit lower="0" upper="0.1" effort="1" velocity="1"/>
    <mimic joint="finger_slide" multiplier="0.9" offset="0.001"/></joint>
  <joint name="lift" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0.01 0.2" rpy="0.2 0.4 -0.6"/>
    <axis xyz="0.3 2 0.1"/><limit lower="-2" upper="1.9" effort="10" velocity="2"/></joint>
  <joint name="turn" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.5" rpy="0 -0.7 0"/>
    <axis xyz="0 0 0.01"/></joint>
  <joint name="flange_mount" type="fixed"><parent link="lower"/><child link="flange"/><origin xyz="0.45 0 0" rpy="0.5 0 0"/>
    </joint>
  <joint name="finger_slide" type="prismatic"><parent link="flange"/><child link="finger"/><origin xyz="0.02 0.04 0"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.1" effort="1" velocity="0.5"/></joint>
</robot>"""


def obstacles():
    return {
        "post": shapes.cylinder(0.05, 2, Pose((0.5, 0, 1))),
        "shelf": shapes.box([0.4, 0.6, 0.03], Pose((-0.4, 0.1, 0.9), (0.1, 0.2, 0.3))),
    }


class AsTheUrdf(unittest.TestCase):
    """A robot described by links and joints equals the robot of a URDF with the same numbers, to the last bit."""

    def assertSame(self, urdf, built, seed=3):
        self.assertEqual(urdf.numbers, built.numbers)
        self.assertEqual(urdf.bodies, built.bodies)
        np.testing.assert_array_equal(urdf.bounds, built.bounds)
        lower, upper = urdf.bounds
        states = np.random.default_rng(seed).uniform(lower, upper, (400, len(lower)))
        np.testing.assert_array_equal(urdf.poses(states), built.poses(states))
        np.testing.assert_array_equal(urdf.clearance(states), built.clearance(states))
        a, b = urdf.check(states), built.check(states)
        c, d = urdf.certify(states[:-1], states[1:], earliest=True), built.certify(states[:-1], states[1:], earliest=True)
        for one, other in (a, b), (c, d):
            for name in "verdict", "time", "gap", "pairs":
                np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)
        self.assertGreater(a.free.sum(), 10)
        self.assertGreater((a.verdict == Verdict.CONTACT).sum(), 10)
        return states[a.free]

    def test_arm6(self):
        file = ROBOTS / "arm6/arm6.urdf"
        problems = [corridor.Problem(robot, obstacles(), seed=5) for robot in (corridor.urdf(file), robot_of(file))]
        free = self.assertSame(*problems)
        paths = [corridor.solve(problem.edited(start=free[0], goals=free[1])).path for problem in problems]
        self.assertGreater(len(paths[0]), 1)
        np.testing.assert_array_equal(*paths)
        # Pickling does not change a robot.
        copy = pickle.loads(pickle.dumps(problems[1]))
        np.testing.assert_array_equal(copy.clearance(free), problems[0].clearance(free))

    def test_twisted(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "twisted.urdf")
            file.write_text(TWISTED)
            base = Pose((0.1, -0.2, 0.05), (0.01, 0.02, 0.9))
            problems = [
                corridor.Problem(robot, obstacles(), seed=5)
                for robot in (corridor.urdf(file, base=base), robot_of(file, base=base))
            ]
            self.assertSame(*problems)
            # Two such robots with names, of which only some joints are planned.
            two = [
                corridor.Problem(
                    [make(file, base=Pose((0, y, 0)), name=name, **{key: ["turn", "lift"]}) for name, y in (("a", 0.7), ("b", -0.7))],
                    obstacles(),
                )
                for make, key in ((corridor.urdf, "joints"), (robot_of, "planned"))
            ]
            self.assertEqual(two[1].numbers, ["a/turn", "a/lift", "b/turn", "b/lift"])
            self.assertSame(*two)

    def test_gantry(self):
        file = ROBOTS / "gantry/gantry.urdf"
        self.assertSame(*[corridor.Problem(robot, {"ball": shapes.sphere(0.4, Pose((0.3, 0, 0.8)))})
                          for robot in (corridor.urdf(file), robot_of(file))])  # fmt: skip

    def test_rover(self):
        file, bounds = ROBOTS / "rover/rover.urdf", {"drive": [[-2, -2, 0], [2, 2, 0]]}
        self.assertSame(*[corridor.Problem(robot, {"ball": shapes.sphere(1, Pose((0.3, 0, 0.8)))})
                          for robot in (corridor.urdf(file, bounds=bounds), robot_of(file, bounds=bounds))])  # fmt: skip


class InPython(unittest.TestCase):
    def test_poses_against_numpy(self):
        """The pose of each link equals the product of the joints' matrices, computed by NumPy."""
        rng = np.random.default_rng(11)

        def turn(axis, angle):
            x, y, z = np.asarray(axis) / np.linalg.norm(axis)
            K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            X = np.eye(4)
            X[:3, :3] += np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K)
            return X

        origins = [turn(rng.normal(size=3), 1.0) for _ in range(4)]
        for origin in origins:
            origin[:3, 3] = rng.normal(size=3)
        axes = rng.normal(size=(4, 3))
        arm = corridor.robot(
            {f"link{i}": shapes.sphere(0.01) for i in range(5)},
            [Joint(f"joint{i}", "continuous", f"link{i}", f"link{i + 1}", origins[i], axes[i]) for i in range(4)],
        )
        problem = corridor.Problem(arm, {"far": shapes.sphere(0.1, Pose((100, 0, 0)))})
        states = rng.uniform(-3, 3, (20, 4))
        poses = problem.poses(states)
        self.assertEqual(poses.shape, (20, 6, 4, 4))
        for q, row in zip(states, poses):
            X = np.eye(4)
            for i in range(4):
                X = X @ origins[i] @ turn(axes[i], q[i])
                # The rounding of 4 products of matrices with entries below 10 is about 1e-14, far below 1e-12.
                np.testing.assert_allclose(row[i + 1], X, atol=1e-12)
            np.testing.assert_array_equal(row[5], np.eye(4))

    def test_pose_is_a_matrix(self):
        quarter = np.asarray(Pose((1, 2, 3), (0, 0, math.pi / 2)))
        np.testing.assert_array_equal(quarter, [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
        roll, pitch, yaw = 0.3, -0.4, 2.0
        c, s = np.cos, np.sin
        Rx = np.array([[1, 0, 0], [0, c(roll), -s(roll)], [0, s(roll), c(roll)]])
        Ry = np.array([[c(pitch), 0, s(pitch)], [0, 1, 0], [-s(pitch), 0, c(pitch)]])
        Rz = np.array([[c(yaw), -s(yaw), 0], [s(yaw), c(yaw), 0], [0, 0, 1]])
        np.testing.assert_allclose(np.array(Pose(rpy=(roll, pitch, yaw)))[:3, :3], Rz @ Ry @ Rx, atol=1e-15)

    def test_allowed_pairs(self):
        def arm(**options):
            ball = shapes.sphere(0.2)
            joints = [Joint("a", "revolute", "base", "first", limits=(-1, 1)),
                      Joint("b", "revolute", "first", "second", limits=(-1, 1))]  # fmt: skip
            robot = corridor.robot({"base": ball, "first": None, "second": ball}, joints, **options)
            return corridor.Problem(robot, {"far": shapes.sphere(0.1, Pose((9, 0, 0)))})

        self.assertEqual(arm().check([0, 0]).pair(0), ("base", "second"))
        self.assertTrue(arm(allow=[("second", "base")]).check([0, 0]))

    def test_other_values_stay_at_the_value_nearest_to_0(self):
        robot = corridor.robot(
            {"base": None, "arm": shapes.sphere(0.1), "hand": shapes.sphere(0.1)},
            [Joint("slide", "prismatic", "base", "arm", axis=(0, 0, 1), limits=(0.5, 2)),
             Joint("turn", "continuous", "arm", "hand", Pose((1, 0, 0)), axis=(0, 0, 1))],
            planned=["turn"],
        )  # fmt: skip
        problem = corridor.Problem(robot, {"far": shapes.sphere(0.1, Pose((9, 0, 0)))})
        self.assertEqual(problem.numbers, ["turn"])
        np.testing.assert_allclose(problem.poses([0])[0, problem.bodies.index("hand"), :3, 3], [1, 0, 0.5])


LINK = shapes.sphere(0.1)


def faults_of(links=("a", "b", "c"), joints=(), obstacles=None, **options):
    """Returns the texts of the faults for which a robot is refused."""
    named = links if isinstance(links, dict) else [(link, LINK) for link in links]
    try:
        corridor.Problem(corridor.robot(named, joints, **options), obstacles)
    except corridor.InputError as error:
        return [fault.text for fault in error.faults]
    return []


def revolute(name="j", parent="a", child="b", limits=(-1, 1), **more):
    return Joint(name, "revolute", parent, child, limits=limits, **more)


class BadRobots(unittest.TestCase):
    def test_links_that_are_no_tree(self):
        both = [revolute(), revolute("k", "b", "c")]
        self.assertEqual(faults_of(joints=both), [])
        for joints, fault in (
            ([revolute(), revolute("k", "a", "b"), revolute("l", "a", "c")],
             'joint "k": its child "b" is already the child of joint "j"; a link can have only one parent'),
            ([*both, revolute("l", "c", "a")], "the links a, b, c, a form a cycle; a tree is needed"),
            ([revolute()], 'link "c" is not a child of any joint, and neither is "a"; a robot can have only one root'),
            ([revolute(parent="a", child="a"), both[1]], 'joint "j": its parent and its child are the same link "a"'),
            ([revolute(parent="bse"), both[1]], 'joint "j": its parent "bse" is not a link of this robot'),
            ([*both, revolute("j", "a", "c")], 'joint "j" is already defined; names must be unique'),
            ([revolute(name=""), both[1]], "joint number 0 has no name"),
            ([revolute(parent=""), both[1]], 'joint "j" has no parent'),
        ):  # fmt: skip
            with self.subTest(fault):
                self.assertIn(fault, faults_of(joints=joints))
        self.assertEqual(
            faults_of(["base", "hand"], [revolute(parent="bsae", child="hand")])[0],
            'joint "j": its parent "bsae" is not a link of this robot (did you mean "base"?)',
        )

    def test_bad_links(self):
        self.assertEqual(faults_of([]), ["it has no link; at least one is needed"])
        self.assertIn('link "a" is already defined; names must be unique', faults_of(["a", "a"]))
        self.assertIn("link number 0 has no name", faults_of([""]))
        self.assertEqual(faults_of({"a": shapes.sphere(-1)}), ["a: a sphere's radius must be positive and finite, not -1"])
        self.assertEqual(faults_of({"a": shapes.sphere(0.1, Pose((math.nan, 0, 0)))}), ["a: pose: the numbers must be finite"])
        self.assertEqual(faults_of({"a": shapes.mesh_file("none.stl")}), ["no such file"])
        open_mesh = shapes.mesh(np.eye(3), [[0, 1, 2]], solid=True)
        self.assertRegex(faults_of({"a": open_mesh})[0], "^a: a solid mesh must be watertight: ")

    def test_bad_joints(self):
        for joint, fault in (
            (revolute(axis=(0, 0, 0)), 'joint "j": its axis is zero; a direction is needed, such as (0, 0, 1)'),
            (revolute(axis=(0, math.nan, 0)), 'joint "j": the numbers of its axis must be finite'),
            (revolute(origin=Pose((0, math.inf, 0))), 'joint "j": origin: the numbers must be finite'),
            (revolute(origin=np.full((4, 4), math.nan)), 'joint "j": origin: the numbers must be finite'),
            (revolute(origin=np.ones((3, 3))),
             'joint "j": origin: an array of shape (4, 4) or (N, 4, 4) is needed, not (3, 3)'),
            (revolute(origin=np.diag([2, 1, 1, 1])), 'joint "j": origin: the upper left 3×3 matrix must be a rotation'),
            (revolute(limits=(1, -1)), 'joint "j": the lower limit 1 is above the upper limit -1'),
            (revolute(limits=(math.nan, 1)),
             'joint "j": its limits must be finite; a joint without limits is of type continuous'),
            (revolute(limits=None),
             'joint "j": a lower and an upper limit are needed; a joint without limits is of type continuous'),
            (Joint("j", "continuous", "a", "b", limits=(0, 1)),
             'joint "j" is continuous; only revolute and prismatic joints have limits'),
            (revolute(velocity=0), 'joint "j": its velocity must be a finite number above 0'),
            (revolute(mimic=("j", 1, 0)), 'joint "j" mimics itself'),
            (revolute(mimic=("k", 1, 0)), 'joint "j" mimics "k", which is not a joint of this robot'),
            (revolute(mimic=("m", 1, 0)), 'joint "j" mimics "m", which is fixed, not a joint of one variable'),
            (revolute(mimic=("m", math.nan, 0)), 'joint "j": the numbers of its mimic must be finite'),
            (Joint("j", "revolut", "a", "b"),
             'joint "j": type: one of fixed, revolute, continuous, prismatic, planar, floating is needed, not "revolut" '
             '(did you mean "revolute"?)'),
        ):  # fmt: skip
            with self.subTest(fault):
                self.assertEqual(faults_of(joints=[joint, Joint("m", "fixed", "a", "c")]), [fault])
        circle = [revolute(mimic=("k", 1, 0)), revolute("k", "b", "c", mimic=("j", 1, 0))]
        self.assertEqual(faults_of(joints=circle), ["the joints j, k, j mimic each other in a cycle"])

    def test_all_faults_at_once(self):
        faults = faults_of(joints=[revolute(axis=(0, 0, 0), limits=(1, -1)), revolute("k", "b", "d")], allow=[("a", "x")])
        self.assertEqual(len(faults), 4, faults)

    def test_other_faults(self):
        joints = [revolute(), revolute("k", "b", "c")]
        self.assertEqual(faults_of(joints=joints, allow=[("a", "d")]), ['allow: "d" is not a link of this robot'])
        self.assertEqual(faults_of(joints=joints, allow=[("a", "a")]), ['allow: two links are needed, not "a" twice'])
        self.assertRegex(faults_of(joints=joints, planned=["x"])[0], '^"x" is no joint of robot that can be planned for')
        self.assertRegex(faults_of(["a"])[0], "^has no joint that can be planned for")
        floating = [Joint("free", "floating", "a", "b"), revolute("k", "b", "c")]
        self.assertEqual(faults_of(joints=floating), ['"free" needs bounds, since it has no limits'])
        self.assertEqual(faults_of(joints=floating, bounds={"free": [[-1, -1, -1], [1, 1, 1]]}), [])
        two = [corridor.robot({"a": LINK, "b": LINK}, [revolute()], name="r") for _ in range(2)]
        with self.assertRaisesRegex(corridor.InputError, 'two robots have the name "r"'):
            corridor.Problem(two)

    def test_values_of_the_wrong_type(self):
        for make, text in (
            (lambda: corridor.robot({"a": LINK}, ["j"]), "joints: a corridor.Joint is needed, not 'j'"),
            (lambda: corridor.robot({1: LINK}, []), "links: a name is needed, not 1"),
            (lambda: corridor.robot({"a": LINK}, [], allow=["ab"]), "allow: two names are needed, not 'ab'"),
            (lambda: corridor.robot({}, [revolute(axis=(1, 0))]),
             r'joint "j": axis: 3 numbers are needed, not an array of shape \(2,\)'),
            (lambda: corridor.robot({}, [revolute(limits=1)]),
             r'joint "j": limits: 2 numbers are needed, not an array of shape \(\)'),
            (lambda: corridor.robot({}, [revolute(mimic="k")]),
             r'joint "j": mimic: \(joint, multiplier, offset\) is needed, not \'k\''),
            (lambda: corridor.robot({}, [revolute(origin="here")]), 'joint "j": origin: an array of numbers is needed'),
        ):  # fmt: skip
            with self.assertRaisesRegex(ValueError, text):
                make()

    def test_random_robots_are_refused_or_work(self):
        """Chains with odd values at random positions either are refused by InputError, or answer queries. Seed 1."""
        rng = np.random.default_rng(1)
        names, types = ["a", "b", "c", ""], ["fixed", "revolute", "continuous", "prismatic", "planar", "floating", "x"]
        numbers = [0, 1, -1, 1e300, math.nan, math.inf, 1e-320]
        accepted = refused = 0
        for _ in range(1500):

            def maybe(value, make):
                return make() if rng.random() < 0.08 else value

            def wild(count):
                return [numbers[i] for i in rng.integers(len(numbers), size=count)]

            def one(values):
                return values[rng.integers(len(values))]

            joints = [
                Joint(
                    maybe(name, lambda: one("jk")), maybe(one(types[1:4]), lambda: one(types)),
                    maybe(parent, lambda: one(names)), maybe(child, lambda: one(names)),
                    Pose(maybe([0.1, 0, 0], lambda: wild(3)), maybe([1, 2, 3], lambda: wild(3))),
                    maybe(rng.normal(size=3), lambda: wild(3)), velocity=maybe(None, lambda: wild(1)[0]),
                    mimic=maybe(None, lambda: (one("jk"), *wild(2))),
                )
                for name, parent, child in (("j", "a", "b"), ("k", "b", "c"))
            ]  # fmt: skip
            joints = [
                replace(joint, limits=maybe((-1, 2) if joint.type in ("revolute", "prismatic") else None, lambda: wild(2)))
                for joint in joints
            ]
            links = dict.fromkeys(maybe(["a", "b", "c"], lambda: [one(names), "b", "c"]), LINK)
            try:
                problem = corridor.Problem(
                    corridor.robot(links, joints), {"far": shapes.sphere(0.1, Pose((9, 0, 0)))}
                )
            except corridor.InputError as error:
                self.assertTrue(error.faults)
                refused += 1
                continue
            accepted += 1
            self.assertEqual(len(problem.check(np.zeros(len(problem.numbers)))), 1)
        self.assertGreater(accepted, 200)
        self.assertGreater(refused, 200)


if __name__ == "__main__":
    unittest.main()
