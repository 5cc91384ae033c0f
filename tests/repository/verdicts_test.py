#!/usr/bin/env python3
"""Tests the rules of tests/benchmark/verdicts.py: for each there are figures by which a claim holds, and others by which
it must not."""

import math
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "benchmark"))
import verdicts as v  # noqa: E402

SIZES = [10**k for k in range(3, 7)]


def curve(call):
    return [(n, call(n)) for n in SIZES]


class Verdicts(unittest.TestCase):
    def test_ratios_of_times(self):
        self.assertEqual(v.at_least(7.0, 6), v.HOLDS)
        self.assertEqual(v.at_least(6.19, 6), v.OPEN)  # the next run may have 5.4
        self.assertEqual(v.at_least(5.5, 6), v.OPEN)
        self.assertEqual(v.at_least(4.12, 26), v.LESS)
        self.assertEqual(v.at_least(1.05, 6), v.OPEN)
        self.assertEqual(v.at_least(0.7, 6), v.FAILS)
        self.assertEqual(v.all_at_least([5.5, 4.5], 3.6), v.HOLDS)
        self.assertEqual(v.all_at_least([5.5, 1.6], 3.6), v.DEPENDS)
        self.assertEqual(v.all_at_least([5.5, 3.6], 3.6), v.OPEN)
        self.assertEqual(v.all_at_least([0.5, 1.0], 3.6), v.FAILS)

    def test_counts(self):
        self.assertEqual(v.below(10, 100, 199, 200), v.HOLDS)
        self.assertEqual(v.below(10, 100, 200, 200), v.DEPENDS)
        self.assertEqual(v.below(10, 200, 300, 200), v.FAILS)

    def test_model(self):
        self.assertEqual(v.model([0.9, 1.2]), v.HOLDS)
        self.assertEqual(v.model([0.55, 1.0]), v.DEPENDS)
        self.assertEqual(v.model([0.55, 1.3, 1.0]), v.FAILS)

    def test_slopes(self):
        self.assertEqual(v.flatter(1.0, [2.0, 2.1]), v.HOLDS)
        self.assertEqual(v.flatter(1.0, [1.05, 2.1]), v.DEPENDS)
        self.assertEqual(v.flatter(2.0, [2.05, 2.0]), v.FAILS)

    def test_growth(self):
        self.assertAlmostEqual(v.exponent(curve(lambda n: 7 * n**1.5)), 1.5)
        self.assertEqual(v.n_log_n(curve(lambda n: n * math.log(n))), v.HOLDS)
        self.assertEqual(v.n_log_n(curve(lambda n: n * math.log(n) ** 2)), v.OPEN)
        self.assertEqual(v.n_log_n(curve(lambda n: n**1.5)), v.FAILS)

    def test_factor_log_n(self):
        less = curve(lambda n: n * math.log(n))
        self.assertEqual(v.log_factor(curve(lambda n: n * math.log(n) ** 2), less), v.HOLDS)
        self.assertEqual(v.log_factor(less, less), "not seen up to n = 1,000,000")
        self.assertEqual(v.log_factor(curve(lambda n: n**1.01 * math.log(n)), less), "not seen up to n = 1,000,000")
        self.assertEqual(v.log_factor(curve(lambda n: n), less), "not seen up to n = 1,000,000")
        self.assertEqual(v.log_factor(curve(lambda n: n**2), less), v.FAILS)

    def test_misleads(self):
        self.assertEqual(v.misleads(2, [1.5, 1.3]), v.HOLDS)
        self.assertEqual(v.misleads(2, [1.5, 1.04]), v.DEPENDS)
        self.assertEqual(v.misleads(1.1, [1.2, 1.04]), v.FAILS)


if __name__ == "__main__":
    unittest.main()
