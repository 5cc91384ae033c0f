"""Tests of the certificates that the Python package returns as arrays, and of checking them."""

import dataclasses
import math
import os
import pathlib
import unittest

import corridor
import numpy as np
from corridor import Joint, Pose, Verdict, shapes

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])
HAND, BALL, CENTRE = 0.08, 0.15, (0.9, 0.5, 0.0)


def planar_arm(**edits):
    """Returns a problem: an arm of two links of 0.6 m in a plane, with a ball as hand, and a ball to avoid."""
    arm = corridor.robot(
        {"base": None, "upper": None, "lower": None, "hand": shapes.sphere(HAND)},
        [
            Joint("shoulder", "revolute", "base", "upper", axis=(0, 0, 1), limits=(-3, 3)),
            Joint("elbow", "revolute", "upper", "lower", Pose((0.6, 0, 0)), axis=(0, 0, 1), limits=(-3, 3)),
            Joint("mount", "fixed", "lower", "hand", Pose((0.6, 0, 0))),
        ],
    )
    return corridor.Problem(arm, {"ball": shapes.sphere(BALL, Pose(CENTRE))}, **edits)


def distance(q):
    """Returns the distances of hand and ball at N states, an array N×2, by a formula independent of Corridor."""
    a, b = q[:, 0], q[:, 0] + q[:, 1]
    x, y = 0.6 * np.cos(a) + 0.6 * np.cos(b), 0.6 * np.sin(a) + 0.6 * np.sin(b)
    return np.hypot(x - CENTRE[0], y - CENTRE[1]) - HAND - BALL


class Arm(unittest.TestCase):
    def test_intervals_hold_at_samples(self):
        """Random edges, seed 2: at all samples, the distance is at least what the intervals claim."""
        problem = planar_arm(margin=0.01)
        rng = np.random.default_rng(2)
        free = contact = samples = 0
        closest = math.inf
        for _ in range(300):
            q0, q1 = rng.uniform(-2.5, 2.5, (2, 2))
            proof = problem.certificate(q0, q1, earliest=True)
            self.assertEqual(proof.shapes, [("ball", "hand")])
            self.assertEqual(proof.pairs.tolist(), [[problem.bodies.index("ball"), problem.bodies.index("hand")]])
            self.assertEqual(proof.margins.tolist(), [0.01])
            free += proof.verdict == Verdict.FREE
            contact += proof.verdict == Verdict.CONTACT
            self.assertGreaterEqual(proof.covered()[0], proof.free_until)
            for t0, t1, clearance in zip(proof.t0, proof.t1, proof.clearance):
                self.assertGreaterEqual(clearance, 0.01)
                t = np.linspace(t0, t1, 33)[:, None]
                found = distance((1 - t) * q0 + t * q1)
                # The rounding error of the formula: fewer than 40 operations on numbers below 2, each with an error of
                # at most 2^-52.
                self.assertGreaterEqual(found.min(), clearance - 40 * 2**-51)
                closest = min(closest, found.min() - clearance)
                samples += len(found)
        self.assertGreater(free, 50)
        self.assertGreater(contact, 50)
        self.assertGreater(samples, 10_000)
        # The claims are not far too small: at some sample, the true distance exceeds the claimed distance by less than
        # 0.05 m.
        self.assertLess(closest, 0.05)

    def test_contacts_have_a_point(self):
        problem = planar_arm()
        proof = problem.certificate([-0.5, 0.0], [1.5, 0.0], earliest=True)
        self.assertEqual(proof.verdict, Verdict.CONTACT)
        q = (1 - proof.time) * proof.q0 + proof.time * proof.q1
        # The first contact is found within the time tolerance: the balls touch or overlap at `time`, and are apart at
        # `free_until`.
        self.assertLessEqual(distance(q[None])[0], 0)
        self.assertLessEqual(proof.free_until, proof.time)
        self.assertGreater(distance(((1 - proof.free_until) * proof.q0 + proof.free_until * proof.q1)[None])[0], 0)
        a, b = proof.contact
        self.assertEqual({problem.bodies[a], problem.bodies[b]}, {"hand", "ball"})
        point = (problem.poses(q)[0, a] @ [*proof.point, 1])[:3]
        # The point of contact is on both balls, up to the depth to which they overlap at the reported time.
        hand = problem.poses(q)[0, problem.bodies.index("hand"), :3, 3]
        overlap = -distance(q[None])[0] + 1e-9
        self.assertLessEqual(abs(np.linalg.norm(point - hand) - HAND), overlap)
        self.assertLessEqual(abs(np.linalg.norm(point - CENTRE) - BALL), overlap)

    def test_check_accepts_and_refuses(self):
        problem = planar_arm(margin=0.01)
        proof = problem.certificate([-1.5, 0.4], [-0.2, -0.3])
        self.assertEqual(proof.verdict, Verdict.FREE)
        self.assertEqual(proof.free_until, 1)
        self.assertIsNone(proof.check())
        self.assertEqual(repr(proof), f"<Certificate: free, 1 pairs, {len(proof.pair)} intervals>")
        # Certificates with a gap, with a claim that is too large, and with senseless values must be refused.
        claims = proof.clearance.copy()
        proof.clearance = claims + 10
        self.assertEqual(proof.check().kind, "refuted")
        for bad in np.full_like(claims, math.nan), -claims:
            proof.clearance = bad
            self.assertEqual(proof.check().kind, "malformed")
        proof.clearance = claims
        proof.pair = proof.pair - 1
        self.assertEqual(proof.check().kind, "malformed")
        proof.pair = proof.pair + 1
        later = proof.t0 > 0
        for name in "pair", "t0", "t1", "clearance":
            setattr(proof, name, getattr(proof, name)[later])
        self.assertEqual(proof.check(), corridor.CertificateFault("gap", 0, 0.0))
        self.assertEqual(proof.covered().tolist(), [0])
        proof.t0 = np.zeros(99)
        with self.assertRaisesRegex(ValueError, "certificate: pair, t0, t1 and clearance must be arrays of one length"):
            proof.check()

    def test_forged_certificates_are_refused(self):
        """A certificate is never accepted for another edge if this edge has a contact. Seed 3."""
        problem = planar_arm()
        rng = np.random.default_rng(3)
        forged = 0
        while forged < 100:
            q0, q1 = rng.uniform(-2.5, 2.5, (2, 2))
            other = rng.uniform(-2.5, 2.5, 2)
            proof = problem.certificate(q0, q1)
            t = np.linspace(0, 1, 500)[:, None]
            if proof.verdict != Verdict.FREE or distance((1 - t) * q0 + t * other).min() > 0:
                continue
            proof.q1 = other
            self.assertIsNotNone(proof.check())
            forged += 1

    def test_bad_arrays(self):
        problem = planar_arm()
        for q0, text in (
            (np.zeros((2, 2)), r"q0: one configuration is needed, not \(2, 2\)"),
            (np.zeros(3), r"q0: an array of shape \(2,\) or \(N, 2\) is needed, not \(3,\)"),
            ([0, math.nan], "q0: the numbers must be finite"),
        ):
            with self.assertRaisesRegex(ValueError, text):
                problem.certificate(q0, [0, 0])
        with self.assertRaisesRegex(ValueError, "states: an array of shape"):
            problem.poses(np.zeros(3))


class ManyPairs(unittest.TestCase):
    def test_agrees_with_certify(self):
        problem = corridor.read_problem(SOURCE / "problems/two_arms")
        lower, upper = problem.bounds
        rng = np.random.default_rng(5)
        q0 = rng.uniform(lower, upper, (60, len(lower)))
        q1 = q0 + rng.normal(size=q0.shape) * 0.1
        q1 = np.clip(q1, lower, upper)
        expected = problem.certify(q0, q1)
        proofs = [problem.certificate(a, b) for a, b in zip(q0, q1)]
        self.assertEqual([proof.verdict for proof in proofs], expected.verdict.tolist())
        free = [proof for proof in proofs if proof.verdict == Verdict.FREE]
        self.assertGreater(len(free), 10)
        accepted = 0
        for proof in free:
            self.assertTrue((proof.covered() == 1).all())
            self.assertTrue((proof.clearance > 0).all())
            fault = proof.check()
            accepted += fault is None
            self.assertNotEqual(fault and fault.kind, "refuted")
        self.assertGreaterEqual(accepted, 0.9 * len(free))
        # At the ends of the edge, the distances are at least those that the intervals with these ends claim.
        for proof in free[:5]:
            least = proof.clearance[proof.t0 == 0].min()
            self.assertGreaterEqual(problem.clearance(proof.q0)[0], least * (1 - 2**-40) if least < 1 else 0)

    def test_inside_a_solid(self):
        """A small ball inside a solid cube is in contact, and the certificate has no intervals."""
        corners = [[x, y, z] for x in (0, 4) for y in (0, 4) for z in (0, 4)]
        faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                 [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]  # fmt: skip
        problem = corridor.Problem(
            corridor.rigid_body(shapes.sphere(0.1), [[0, 0, 0], [4, 4, 4]]),
            {"cube": shapes.mesh(corners, faces, solid=True)},
        )
        proof = problem.certificate([1, 1, 1, 0, 0, 0, 1], [2, 1, 1, 0, 0, 0, 1])
        self.assertEqual(proof.verdict, Verdict.CONTACT)
        self.assertEqual((len(proof.pair), proof.free_until), (0, 0))


class Tampering(unittest.TestCase):
    """A certificate is not accepted if it claims more than its intervals do, or has other pairs than the problem."""

    def test_claims(self):
        problem = corridor.read_problem(pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"]) / "problems/arm_at_shelf")
        states = np.random.default_rng(1).uniform(*problem.bounds, (50, len(problem.numbers)))
        ends = states + 0.01
        free = int(np.argmax(problem.certify(states, ends).free))
        proof = problem.certificate(states[free], ends[free])
        self.assertEqual((proof.verdict, proof.check()), (Verdict.FREE, None))
        none = np.array([], float)
        for kind, changes in (
            ("gap", {"free_until": 0.0, "pair": none.astype(int), "t0": none, "t1": none, "clearance": none}),
            ("malformed", {"margins": proof.margins + 5}),
            ("malformed", {"pairs": proof.pairs[::-1]}),
            ("malformed", {"shapes": proof.shapes[1:]}),
            ("malformed", {"pair": proof.pair + 0.5}),
        ):
            fault = dataclasses.replace(proof, **changes).check()
            self.assertEqual(fault and fault.kind, kind, changes)
        negative = dataclasses.replace(proof, pair=np.full_like(proof.pair, -1))
        self.assertFalse(negative.covered().any())


if __name__ == "__main__":
    unittest.main()
