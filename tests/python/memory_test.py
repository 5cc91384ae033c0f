"""Tests that the package leaks neither memory nor references. CORRIDOR_STRESS=1: a million calls of each query."""

import ctypes
import gc
import mmap
import os
import pathlib
import pickle
import sys
import tempfile
import unittest

import corridor
import numpy as np
from corridor import Body, Joint, Pose, shapes

SANITIZED = "libasan" in os.environ.get("LD_PRELOAD", "")
CALLS = 1_000_000 if os.environ.get("CORRIDOR_STRESS") else 2_000 if SANITIZED else 5_000


def mapped():
    """Returns the bytes of the private mappings that this process can write to, and of its stack.

    The resident memory is less suitable: the kernel evicts and loads pages at any time, and its count of resident pages
    is not exact.
    """
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[5])
    return pages * os.sysconf("SC_PAGE_SIZE")


class _Mallinfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in
                ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")]  # fmt: skip


def allocated():
    """Returns the bytes that malloc has handed out, in all heaps."""
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = _Mallinfo
    info = mallinfo2()
    return info.uordblks + info.hblkhd


def arm(**edits):
    robot = corridor.robot(
        {"base": shapes.cylinder(0.1, 0.1), "upper": shapes.capsule(0.05, 0.6, Pose((0, 0, 0.3)))},
        [Joint("turn", "revolute", "base", "upper", Pose((0, 0, 0.1)), axis=(1, 0, 0), limits=(-2, 2))],
    )
    return corridor.Problem(robot, {"ball": shapes.sphere(0.1, Pose((0.3, 0.8, 0.2)))}, start=[-1], goals=[1], **edits)


class Growth(unittest.TestCase):
    def assertNoGrowth(self, call, calls=CALLS):
        """Calls `call` many times, in rounds, and measures what Python, malloc and the kernel have handed out.

        If each call leaks an object, Python's blocks grow by at least `calls` in every round. If each call leaks a
        block of malloc, the bytes of malloc grow by at least 32·`calls` in every round: malloc's smallest block has 32
        bytes. If each call leaks a private mapping that can be written to, such as the stack of a thread, the mapped
        memory grows by at least a page of 4,096 bytes per call in every round. Caches and lists of free blocks grow,
        too, but less and less. So for each of the three measures, one round must grow by less than half of this.

        Under AddressSanitizer, which keeps freed memory for a while, growth is not tested; the calls must only cause no
        error.
        """
        calls = max(calls, 10)
        for _ in range(max(20, calls // 10)):
            call()
        gc.collect()
        if SANITIZED:
            return
        limits, rounds = [calls / 2, 16 * calls, 2048 * calls], []
        for _ in range(6):
            before = sys.getallocatedblocks(), allocated(), mapped()
            for _ in range(calls):
                call()
            gc.collect()
            after = sys.getallocatedblocks(), allocated(), mapped()
            rounds.append([y - x for x, y in zip(before, after)])
            if np.all(np.min(rounds, axis=0) < limits):
                return
        self.fail(
            f"blocks of Python, bytes of malloc and mapped bytes grow by {rounds} in 6 rounds of {calls} calls; in "
            f"some round, each must grow by less than {limits}"
        )

    def test_states_and_edges(self):
        problem = arm()
        states, one = np.array([[0.1], [0.9], [1.5]]), np.array([0.3])
        self.assertNoGrowth(lambda: problem.check(states))
        self.assertNoGrowth(lambda: problem.check([0.3]))
        self.assertNoGrowth(lambda: problem.certify(states, one, earliest=True))
        self.assertNoGrowth(lambda: problem.clearance(states))
        self.assertNoGrowth(lambda: problem.poses(states))

    def test_many_rows(self):
        problem = arm()
        states = np.random.default_rng(1).uniform(-2, 2, (1000, 1))
        self.assertNoGrowth(lambda: problem.check(states), CALLS // 100)
        self.assertNoGrowth(lambda: problem.certify(states[:-1], states[1:]), CALLS // 100)

    def test_certificates(self):
        problem = arm()
        self.assertNoGrowth(lambda: problem.certificate([-1], [1], earliest=True).check(), CALLS // 4)

    def test_bodies(self):
        box, ball = Body(shapes.box([1, 1, 1])), Body(shapes.sphere(0.5))
        square = Body(shapes.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
        near, far = np.eye(4), np.asarray(Pose((3, 0, 0)))
        poses = np.stack([near, far])
        self.assertNoGrowth(lambda: corridor.touch(box, ball, pose_b=poses))
        self.assertNoGrowth(lambda: corridor.distance(box, ball, pose_b=poses))
        self.assertNoGrowth(lambda: corridor.closer_than(box, ball, 0.1, pose_b=poses))
        self.assertNoGrowth(lambda: corridor.contacts(square, square))
        self.assertNoGrowth(lambda: corridor.first_contact(ball, box, far, near), CALLS // 4)

    def test_made_and_dropped(self):
        problem = arm()
        self.assertNoGrowth(lambda: Body(shapes.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])), CALLS // 4)
        self.assertNoGrowth(lambda: arm().check([0.1]), CALLS // 20)
        self.assertNoGrowth(lambda: problem.edited(margin=0.01), CALLS // 4)
        self.assertNoGrowth(lambda: pickle.loads(pickle.dumps(problem)), CALLS // 20)
        self.assertNoGrowth(lambda: (problem.start, problem.goals, problem.bounds, problem.bodies), CALLS // 4)

    def test_exceptions(self):
        problem = arm()

        def refused(call):
            try:
                call()
            except ValueError:
                return
            raise AssertionError("nothing was raised")

        self.assertNoGrowth(lambda: refused(lambda: problem.check(np.zeros(3))))
        self.assertNoGrowth(lambda: refused(lambda: problem.edited(margin=-1)), CALLS // 4)
        self.assertNoGrowth(lambda: refused(lambda: corridor.read_problem("none.yaml")), CALLS // 4)
        bad = corridor.robot({"a": None}, [Joint("j", "revolute", "a", "b")])
        self.assertNoGrowth(lambda: refused(lambda: corridor.Problem(bad)), CALLS // 4)

    def test_solutions(self):
        problem = arm()
        solution = corridor.solve(problem)
        self.assertNoGrowth(lambda: corridor.solve(problem), CALLS // 1000)
        self.assertNoGrowth(lambda: corridor.solve(problem, progress=lambda *_: None, trajectory="csv"), CALLS // 1000)
        self.assertNoGrowth(solution.verify, CALLS // 100)
        self.assertNoGrowth(solution.svg, CALLS // 1000)
        self.assertNoGrowth(solution.page, CALLS // 1000)

    @unittest.skipIf(SANITIZED, "AddressSanitizer's run looks for errors, not for leaks")
    def test_the_test_finds_leaks(self):
        kept = []
        malloc, map_pages = ctypes.CDLL(None).malloc, ctypes.CDLL(None).mmap
        malloc.restype = map_pages.restype = ctypes.c_void_p
        flags = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS
        for leak in (
            lambda: kept.append(object()),
            lambda: malloc(1),
            lambda: map_pages(None, ctypes.c_size_t(1), mmap.PROT_READ | mmap.PROT_WRITE, flags, -1, ctypes.c_long(0)),
        ):
            with self.assertRaisesRegex(AssertionError, "grow by"):
                self.assertNoGrowth(leak, 1000)


class References(unittest.TestCase):
    def test_arrays_that_are_passed(self):
        problem, body = arm(), Body(shapes.sphere(1))
        states, pose, text = np.zeros((5, 1)), np.eye(4), "not an array"
        for array, calls in (
            (states, (problem.check, problem.clearance, problem.poses, lambda q: problem.certify(q, q))),
            (states[0], (lambda q: problem.certificate(q, q), lambda q: problem.edited(start=q))),
            (pose, (lambda X: corridor.touch(body, body, X, X), lambda X: corridor.distance(body, body, X),
                    lambda X: corridor.first_contact(body, body, X, X), lambda X: shapes.sphere(1, X))),
            (np.zeros((5, 3)), (lambda q: self.assertRaises(ValueError, problem.check, q),)),
            (text, (lambda q: self.assertRaises(ValueError, problem.check, q),)),
        ):  # fmt: skip
            for call in calls:
                before = sys.getrefcount(array)
                for _ in range(10):
                    call(array)
                gc.collect()
                self.assertEqual(sys.getrefcount(array), before)

    def test_arrays_that_are_passed_do_not_change(self):
        problem = arm()
        states = np.random.default_rng(1).uniform(-2, 2, (50, 1))
        states.flags.writeable = False
        before = states.copy()
        problem.check(states)
        problem.certify(states, states[0])
        np.testing.assert_array_equal(states, before)

    def test_results_own_their_memory(self):
        problem = arm()
        results = problem.check(np.zeros((5, 1)))
        arrays = [results.verdict, results.time, results.gap, results.pairs, problem.start, problem.goals, problem.bounds,
                  problem.tube, problem.clearance([0]), problem.poses([0]), problem.certificate([0], [1]).clearance]  # fmt: skip
        start = problem.start
        del results
        for array in arrays:
            self.assertTrue(array.flags.owndata or array.base is not None)
            self.assertTrue(array.flags.writeable)
            self.assertLessEqual(sys.getrefcount(array), 3)
            array.fill(0)
        np.testing.assert_array_equal(problem.start, start)  # the problem did not change

    def test_objects_live_as_long_as_they_are_used(self):
        problem = arm()
        other = problem.edited(seed=3)
        proof = problem.certificate([-1], [1])
        del problem
        gc.collect()
        self.assertTrue(other.check([1]))
        self.assertIsNone(proof.check())

    def test_callbacks_are_released(self):
        def callback(*_):
            pass

        before = sys.getrefcount(callback)
        corridor.solve(arm(), progress=callback)
        gc.collect()
        self.assertEqual(sys.getrefcount(callback), before)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        unittest.main()
