"""Rotations and poses as NumPy matrices. For tests only; no code of Corridor is used."""

import math

import numpy as np


def rotation_about(axis, angle):
    """The 3×3 matrix of a rotation by `angle` (rad) about an axis of any length (Rodrigues' formula)."""
    x, y, z = np.asarray(axis, float) / math.hypot(*axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * (K @ K)


def rotation_of_rpy(rpy):
    """Roll, pitch and yaw about the fixed axes x, then y, then z, as in URDF."""
    roll, pitch, yaw = rpy
    return rotation_about((0, 0, 1), yaw) @ rotation_about((0, 1, 0), pitch) @ rotation_about((1, 0, 0), roll)


def rotation_of_quaternion(xyzw):
    """The rotation of a quaternion of any norm except 0; the scalar part is the last number."""
    x, y, z, w = np.asarray(xyzw, float) / math.sqrt(sum(v * v for v in xyzw))
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def quaternion_of_rpy(rpy):
    """The quaternion (x, y, z, w) of roll, pitch and yaw, as the product of three quaternions."""

    def times(p, q):
        a, b = np.array(p[:3]), np.array(q[:3])
        return (*(p[3] * b + q[3] * a + np.cross(a, b)), p[3] * q[3] - a @ b)

    x, y, z = ((math.sin(v / 2) * e).tolist() + [math.cos(v / 2)] for v, e in zip(rpy, np.eye(3)))
    return times(times(z, y), x)


def pose(xyz=(0, 0, 0), rotation=None):
    """A 4×4 matrix."""
    X = np.eye(4)
    X[:3, 3] = xyz
    if rotation is not None:
        X[:3, :3] = rotation
    return X


def apply(X, points):
    """The points (N×3) moved by a pose."""
    return np.asarray(points, float) @ X[:3, :3].T + X[:3, 3]
