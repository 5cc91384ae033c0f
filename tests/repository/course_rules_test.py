#!/usr/bin/env python3
"""Tests the rules of tests/benchmark/course.py: for each kind of rule, and for each rule of course/rows.toml, there are
figures by which its claim must not hold."""

import json
import pathlib
import sys
import tomllib
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "benchmark"))
import course  # noqa: E402


def holds(rule, **figures):
    return course.holds({"topic": "a topic", "rule": rule}, {f"a.{name}": value for name, value in figures.items()})


class Rules(unittest.TestCase):
    def test_bounds(self):
        self.assertTrue(holds("10 <= a.steps and a.steps <= 100", steps=10))
        self.assertFalse(holds("10 <= a.steps and a.steps <= 100", steps=9.9))
        self.assertFalse(holds("10 <= a.steps and a.steps <= 100", steps=101))
        self.assertFalse(holds("0 < a.hits and a.hits < a.poses", hits=0, poses=300))
        self.assertFalse(holds("0 < a.hits and a.hits < a.poses", hits=300, poses=300))

    def test_equal_counts(self):
        self.assertTrue(holds("a.hits == a.others and a.hits > 0", hits=215, others=215))
        self.assertFalse(holds("a.hits == a.others and a.hits > 0", hits=215, others=214))
        self.assertFalse(holds("a.hits == a.others and a.hits > 0", hits=0, others=0))

    def test_ratios(self):
        self.assertTrue(holds("10 * a.ns < a.every_pair_ns", ns=9, every_pair_ns=91))
        self.assertFalse(holds("10 * a.ns < a.every_pair_ns", ns=9.2, every_pair_ns=91))
        self.assertFalse(holds("a.most > 1 / 0.85", most=1.17))
        self.assertFalse(holds("a.rest < 0.01 * 4800 * 4800", rest=230_400))

    def test_differences(self):
        rule = "a.one - a.two < 1e-9 and a.two - a.one < 1e-9"
        self.assertTrue(holds(rule, one=0.1, two=0.1 + 1e-12))
        self.assertFalse(holds(rule, one=0.1, two=0.1 + 1e-8))
        self.assertFalse(holds(rule, one=0.1 + 1e-8, two=0.1))

    def test_least_and_most(self):
        self.assertTrue(holds("max(a.one, a.two) < 1 and min(a.one, a.two) > 0", one=0.2, two=0.9))
        self.assertFalse(holds("max(a.one, a.two) < 1 and min(a.one, a.two) > 0", one=0.2, two=1))
        self.assertFalse(holds("max(a.one, a.two) < 1 and min(a.one, a.two) > 0", one=-0.1, two=0.9))

    def test_figures_may_be_small_or_negative(self):
        self.assertTrue(holds("a.one < 1e-300", one=5e-324))
        self.assertFalse(holds("a.one > 0", one=-1e-9))

    def test_unknown_figures_raise(self):
        with self.assertRaises(KeyError):
            holds("a.hits > 0", steps=1)
        with self.assertRaises(KeyError):
            holds("a.hits > 0 or b.hits > 0", hits=1)

    def test_times_within_the_noise_decide_nothing(self):
        row = {"topic": "a topic", "rule": "a.median_ns <= 100 * b.median_ns"}
        for ratio, verdict in ((80, course.HOLDS), (90, course.OPEN), (110, course.OPEN), (120, course.FAILS)):
            self.assertEqual(course.verdict(row, {"a.median_ns": ratio, "b.median_ns": 1}), verdict)
        for steps, verdict in ((66, course.HOLDS), (67, course.FAILS)):
            self.assertEqual(course.verdict({"topic": "", "rule": "a.steps <= 66"}, {"a.steps": steps}), verdict)

    def test_columns_of_answers(self):
        output = "pose,hit,ns\n0,1,20\n1,0,40\n2,1,90\nns=7\noverlap=sat\n"
        times = {"median ": 40, "largest ": 90, "least ": 20, "count ": 3, "": 90}
        for word, figure in times.items():
            self.assertEqual(course.matched(word + r"^\d+,.,(\d+)$", output), figure, word)
        self.assertEqual(course.matched(r"median ^\d+,1,(\d+)$", output), 55)
        self.assertEqual(course.matched(r"^overlap=(sat)$", output), 1)
        self.assertIsNone(course.matched(r"^overlap=(lp)$", output))

    def test_other_text_raises(self):
        for rule in ("hits > 0", "a.hits > 0 or True", "print(a.hits)", "a.hits > 0 # always", "a.hits.real > 0",
                     "[a.hits][0] > 0", "a.hits if a.hits else 1", "a.hits > 0; 1", "a.hits > '0'", "().__class__"):
            with self.assertRaises((ValueError, SyntaxError), msg=rule):
                holds(rule, hits=1)


class Rows(unittest.TestCase):
    def test_each_figure_can_fail_its_rule(self):
        """If a claim holds, there is for each figure in its rule another value by which the claim does not hold."""
        stored = json.loads(course.FIGURES.read_text())
        for row in tomllib.loads(course.ROWS.read_text())["row"]:
            figures = stored.get(row["topic"], {})
            self.assertLessEqual(course.names_of(row), figures.keys(), f"{row['topic']}: figures are missing")
            if not course.holds(row, figures):
                continue
            for name, value in figures.items():
                others = (0, value + 1, value - 1, 1e6 * value, 1e-6 * value, -1)
                verdicts = [course.holds(row, {**figures, name: other}) for other in others]
                self.assertFalse(all(verdicts), f"{row['topic']}: {row['rule']}: {name} cannot fail it")


if __name__ == "__main__":
    unittest.main()
