"""Compares the problems and robots of this repository, as Corridor reads them, with small readers written independently."""

import os
import pathlib
import tempfile
import unittest

import numpy as np
import runs
from compare import compare, compare_robot
from problems import NotRead
from random_models import write_problem

SEED = int(os.environ.get("CORRIDOR_SEED", 1))
ROUNDS = 1000 if os.environ.get("CORRIDOR_STRESS") else 28
SOURCE = runs.SOURCE


class Repository(unittest.TestCase):
    def test_robots(self):
        for file in sorted(SOURCE.glob("robots/*/robot.yaml")):
            if "\nurdf:" in file.read_text():
                with self.subTest(file.parent.name):
                    compare_robot(self, file, np.random.default_rng(SEED))

    def test_problems(self):
        print(f"seed {SEED}")
        for file in sorted(SOURCE.glob("problems/*/problem.yaml")):
            with self.subTest(file.parent.name):
                try:
                    counts = compare(self, file, np.random.default_rng(SEED), states=8)
                except NotRead as what:
                    self.skipTest(f"not read here: {what}")
                print(f"{file.parent.name}: in contact {counts[True]}, apart {counts[False]}, no witness {counts[None]}")


class Random(unittest.TestCase):
    def test_problems(self):
        total = {True: 0, False: 0, None: 0}
        for i in range(ROUNDS):
            with self.subTest(f"seed {SEED + i}"), tempfile.TemporaryDirectory() as folder:
                rng, folder = np.random.default_rng(SEED + i), pathlib.Path(folder)
                counts = compare(self, write_problem(rng, folder), rng, states=12)
                for file in (*folder.glob("robot.yaml"), *folder.glob("left.yaml"), *folder.glob("right.yaml")):
                    compare_robot(self, file, rng, states=1)
                total = {key: total[key] + counts[key] for key in total}
        print(f"random problems from seed {SEED}: in contact {total[True]}, apart {total[False]}, no witness {total[None]}")
        self.assertGreater(total[True], 200)
        self.assertGreater(total[False], 500)
        self.assertLess(total[None], 0.1 * total[False])


if __name__ == "__main__":
    unittest.main()
