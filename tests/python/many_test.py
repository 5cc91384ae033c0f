"""Tests of solve_many: its processes, and how they end."""

import contextlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import corridor
import numpy as np
from package_test import ARM, cube_in_room


class Many(unittest.TestCase):
    def test_many(self):
        problems = [cube_in_room(seed=seed) for seed in (1, 2, 3)]
        many = list(corridor.solve_many(problems, processes=2, time=10))
        for problem, solution in zip(problems, many):
            np.testing.assert_array_equal(solution.path, corridor.solve(problem).path)
            self.assertEqual((solution.problem.seed, solution.problem.time), (problem.seed, 10))
            self.assertEqual(solution.verify()["verdict"], "proved")

    def test_many_with_a_fault(self):
        solutions = corridor.solve_many([cube_in_room(seed=1), cube_in_room(params={"rnage": 1}), cube_in_room(seed=2)])
        self.assertTrue(next(solutions))
        with self.assertRaisesRegex(corridor.InputError, "rnage"):
            next(solutions)

    def script(self, text):
        """Starts a script in a new session, so that its processes form a group."""
        with tempfile.NamedTemporaryFile("w", suffix=".py", delete=False) as file:
            file.write(text)
        self.addCleanup(os.remove, file.name)
        process = subprocess.Popen(
            [sys.executable, "-B", file.name], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            start_new_session=True,
        )  # fmt: skip
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()

    @staticmethod
    def workers_of(process):
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        return [int(c) for c in children if "spawn_main" in pathlib.Path(f"/proc/{c}/cmdline").read_text()]

    MANY = """
import corridor
if __name__ == "__main__":
    walled = corridor.read_problem(%r).edited(time=600)
    room = corridor.shapes.box([0.1, 9, 9])
    cube = corridor.rigid_body(corridor.shapes.box([0.2] * 3), [[-2] * 3, [2] * 3])
    closed = corridor.Problem(cube, {"wall": room}, start=[-1, 0, 0, 0, 0, 0, 1], goals=[1, 0, 0, 0, 0, 0, 1], time=600)
    many = corridor.solve_many([walled] + [closed] * 6, processes=2)
    next(many)
    print("begun", flush=True)
    next(many)
""" % str(ARM)

    def test_interrupts_end_all_processes(self):
        for interrupts in (1, 2):
            process = self.script(self.MANY)
            self.assertEqual(process.stdout.readline(), "begun\n")
            for _ in range(interrupts):
                os.killpg(process.pid, signal.SIGINT)
                time.sleep(0.1)
            _, err = process.communicate(timeout=300)  # waits for all processes: each holds the pipes open
            self.assertEqual(process.returncode, -signal.SIGINT, err)
            self.assertLessEqual(err.count("Traceback"), interrupts, err)  # none of the processes prints a traceback

    def test_a_killed_process(self):
        process = self.script(self.MANY)
        self.assertEqual(process.stdout.readline(), "begun\n")
        solving = self.workers_of(process)
        self.assertEqual(len(solving), 2)
        for worker in solving:  # Ctrl-C must not reach the workers: they block SIGINT
            blocked = re.search(r"(?m)^SigBlk:\s*(\w+)", pathlib.Path(f"/proc/{worker}/status").read_text())
            self.assertTrue(int(blocked[1], 16) & 1 << signal.SIGINT - 1)
            os.kill(worker, signal.SIGKILL)
        _, err = process.communicate(timeout=300)
        self.assertRegex(err, r"RuntimeError: a process of solve_many was ended by signal 9 while it solved problems\[\d\]")

    def test_the_end_of_the_parent_ends_all_processes(self):
        process = self.script(self.MANY)
        self.assertEqual(process.stdout.readline(), "begun\n")
        process.kill()
        process.communicate(timeout=300)  # waits for all processes: each holds the pipes open

    def test_bad_options_of_many(self):
        problem = cube_in_room()
        for error, text, call in (
            (ValueError, "processes: a whole number of 1 or more is needed, not -1", lambda: corridor.solve_many([problem], -1)),
            (TypeError, "solve_many has no option 'progress'", lambda: corridor.solve_many([problem], progress=print)),
        ):
            with self.assertRaisesRegex(error, text):
                list(call())
        self.assertEqual(list(corridor.solve_many([])), [])

    def test_a_script_without_a_guard(self):
        process = self.script(self.MANY.replace('if __name__ == "__main__":', "if True:"))
        out, err = process.communicate(timeout=300)
        self.assertEqual((process.returncode, out), (1, ""))
        self.assertIn("corridor: a script must be a file, and must call solve_many under", err)
        self.assertIn("RuntimeError: a process of solve_many ended with status 1 before it began", err)
        self.assertEqual(err.count("Traceback"), 1, err)


if __name__ == "__main__":
    unittest.main()
