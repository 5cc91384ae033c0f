"""Shapes, and witnesses that two shapes are clearly apart or clearly closer than a distance. For tests only.

A witness proves its answer up to rounding: a plane between the two shapes, a point that both have in common, or an edge
of one mesh that passes through a triangle of the other. If no witness is found, the answer is None.
"""

import functools
import itertools

import numpy as np
from transforms import apply


class Shape:
    """A shape in the frame `X` of its body. Lengths are metres.

    kind: "box" (size: three edge lengths), "sphere" (radius), "capsule" and "cylinder" (radius and length, along z),
    "mesh" (vertices and triangles, in the frame X; a surface), "convex" (vertices), "polygon" (vertices, in order).
    """

    def __init__(self, kind, X, size=None, radius=0.0, length=0.0, vertices=None, triangles=None):
        self.kind, self.X, self.radius, self.length = kind, X, radius, length
        self.half = None if size is None else np.array(size, float) / 2
        self.vertices, self.triangles = vertices, triangles
        if kind == "box":
            grid = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
            self.corners = grid * self.half
        elif vertices is not None:
            self.corners = np.unique(vertices, axis=0)
        else:
            z = length / 2 if kind != "sphere" else 0.0
            self.corners = np.array([[0, 0, -z], [0, 0, z]])
        self.rounding = radius if kind in ("sphere", "capsule") else 0.0  # of the hull of `corners`
        self.ball = self._ball()

    def _ball(self):
        """Centre and radius of a ball around the shape, in its own frame."""
        low, high = self.corners.min(0), self.corners.max(0)
        centre = (low + high) / 2
        return centre, np.linalg.norm(self.corners - centre, axis=1).max() + self.radius

    def farthest(self, d):
        """The point of the shape that is the farthest along a direction of its own frame."""
        p = self.corners[np.argmax(self.corners @ d)]
        if self.kind == "cylinder":
            across = np.array([d[0], d[1], 0.0])
            return p + across * (self.radius / max(np.linalg.norm(across), 1e-300))
        return p + d * (self.rounding / np.linalg.norm(d))

    def signed_distance(self, points):
        """The distances of points (own frame) from a solid; inside, minus the depth."""
        p = np.asarray(points)
        if self.kind == "convex":
            values = (p @ self._planes[:, :3].T - self._planes[:, 3]).max(1)
            return np.where(values > 0, np.inf, values)  # outside, the planes give no upper bound
        if self.kind == "polygon":
            return self._polygon_distance(p[:, :2])
        if self.kind == "box":
            q = np.abs(p) - self.half
        elif self.kind == "cylinder":
            q = np.stack([np.hypot(p[:, 0], p[:, 1]) - self.radius, np.abs(p[:, 2]) - self.length / 2], 1)
        else:
            z = np.clip(p[:, 2], self.corners[0, 2], self.corners[1, 2])
            return np.linalg.norm(p - np.stack([0 * z, 0 * z, z], 1), axis=1) - self.radius
        return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(1), 0)

    @functools.cached_property
    def _planes(self):
        """The planes of the sides of a convex hull, (n, d) with n·p ≤ d, by trying all triples of its few corners."""
        planes = []
        for a, b, c in itertools.combinations(self.corners, 3):
            n = np.cross(b - a, c - a)
            if np.linalg.norm(n) > 1e-9:
                n /= np.linalg.norm(n)
                planes += [(*s, s @ a) for s in (n, -n) if (self.corners @ s <= s @ a + 1e-9).all()]
        return np.array(planes)

    def _polygon_distance(self, p):
        a = self.vertices[:, :2]
        b = np.roll(a, -1, 0)
        t = np.clip(((p[:, None] - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1), 0, 1)
        distance = np.linalg.norm(p[:, None] - a - t[..., None] * (b - a), axis=-1).min(1)
        with np.errstate(all="ignore"):
            above = (a[:, 1] > p[:, None, 1]) != (b[:, 1] > p[:, None, 1])
            crossed = p[:, None, 0] < a[:, 0] + (p[:, None, 1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        return np.where((above & crossed).sum(1) % 2 == 1, -distance, distance)

    def samples(self):
        """Points of the shape, in its own frame."""
        if not hasattr(self, "_samples"):
            if self.kind == "mesh":
                t = self.vertices[self.triangles]
                self._samples = np.concatenate([self.corners, t.mean(1), (t[:, 0] + t[:, 1]) / 2])
            else:
                grid = np.array(np.meshgrid(*[np.linspace(-1, 1, 9)] * 3)).reshape(3, -1).T
                if self.kind == "box":
                    self._samples = grid * self.half
                elif self.kind in ("convex", "polygon"):
                    low, high = self.corners.min(0), self.corners.max(0)
                    points = np.concatenate([self.corners, (low + high) / 2 + grid * (high - low) / 2])
                    self._samples = points[self.signed_distance(points) <= 0]
                else:  # scaled from a cube around the shape; kept if inside
                    r, z = self.radius, self.length / 2 + (self.radius if self.kind != "cylinder" else 0)
                    if self.kind == "sphere":
                        z = r
                    points = grid * [r, r, z]
                    axis = np.linspace(-1, 1, 41)[:, None] * [0, 0, z]
                    points = np.concatenate([points, axis])
                    self._samples = points[self.signed_distance(points) <= 0]
        return self._samples


def _apart(a, X_a, b, X_b, gap):
    """Whether a plane with more than `gap` between the shapes is found (Frank and Wolfe's method on their difference)."""
    R_a, R_b = X_a[:3, :3], X_b[:3, :3]
    v = X_a @ (*a.ball[0], 1) - X_b @ (*b.ball[0], 1)
    v = v[:3]
    for _ in range(60):
        norm = np.linalg.norm(v)
        if norm < 1e-9:
            return False
        p = R_a @ a.farthest(-v @ R_a) + X_a[:3, 3]
        q = R_b @ b.farthest(v @ R_b) + X_b[:3, 3]
        w = p - q
        if v @ w > gap * norm:
            return True
        step = v - w
        if step @ step < 1e-24:
            return False
        v = v - np.clip(v @ step / (step @ step), 0, 1) * step
    return False


def _edges_through(a, X_a, b, X_b, rng):
    """Whether an edge of mesh a passes through the inside of a triangle of mesh b, at least a tenth of its size."""
    A, B = apply(X_a, a.vertices)[a.triangles], apply(X_b, b.vertices)[b.triangles]
    low, high = np.maximum(A.min((0, 1)), B.min((0, 1))), np.minimum(A.max((0, 1)), B.max((0, 1)))
    if (low > high).any():
        return False
    A, B = (T[((T.max(1) >= low) & (T.min(1) <= high)).all(1)] for T in (A, B))
    if not len(A) or not len(B):
        return False
    if len(A) > 500:
        A = A[rng.choice(len(A), 500, False)]
    if len(B) > 500:
        B = B[rng.choice(len(B), 500, False)]
    p, d = A.reshape(-1, 3), (np.roll(A, -1, 1) - A).reshape(-1, 3)
    e1, e2 = B[:, 1] - B[:, 0], B[:, 2] - B[:, 0]
    # Solves p + t·d = B0 + u·e1 + v·e2 for every edge and triangle (Möller and Trumbore).
    h = np.cross(d[:, None], e2[None])
    det = (h * e1).sum(-1)
    with np.errstate(all="ignore"):
        s = p[:, None] - B[None, :, 0]
        u = (s * h).sum(-1) / det
        q = np.cross(s, e1[None])
        v = (q * d[:, None]).sum(-1) / det
        t = (q * e2[None]).sum(-1) / det
        return bool(((u > 0.1) & (v > 0.1) & (u + v < 0.9) & (t > 0.1) & (t < 0.9) & (np.abs(det) > 1e-15)).any())


def closer_than(a, X_a, b, X_b, distance, slack, rng):
    """Whether two shapes are closer than a distance (0: in contact). `X_a` and `X_b` are the poses of the two bodies.

    True: surely, and by more than `slack`. False: surely not, by more than `slack`. None: no witness was found.
    """
    X_a, X_b = X_a @ a.X, X_b @ b.X
    centre_a, centre_b = X_a @ (*a.ball[0], 1), X_b @ (*b.ball[0], 1)
    if np.linalg.norm(centre_a - centre_b) > a.ball[1] + b.ball[1] + distance + slack:
        return False
    if _apart(a, X_a, b, X_b, distance + slack):
        return False
    for one, X, other, Y in ((a, X_a, b, X_b), (b, X_b, a, X_a)):
        if other.kind != "mesh":
            points = apply(np.linalg.inv(Y) @ X, one.samples())
            if other.signed_distance(points).min() < distance - slack:
                return True
    if a.kind == b.kind == "mesh" and (_edges_through(a, X_a, b, X_b, rng) or _edges_through(b, X_b, a, X_a, rng)):
        return True
    return None
