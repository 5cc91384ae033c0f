"""Reads trajectories: rows of numbers (CSV), and messages of ROS and MoveIt. For tests only.

Written from planner/trajectory/README.md and from the definitions of the messages. It shares no code with Corridor.
"""

import re

_SUFFIXES = {
    "position": ("", "position", "pos"),
    "velocity": ("velocity", "vel"),
    "acceleration": ("acceleration", "acc", "accel"),
    "effort": ("effort", "torque"),
}
_TIMES = ("time", "t", "time_from_start")


class Trajectory:
    """Rows of a trajectory: `times` (s, or None), and for each joint its positions, velocities and accelerations."""

    def __init__(self, times, positions, velocities=None, accelerations=None):
        self.times, self.positions = times, positions
        self.velocities, self.accelerations = velocities or {}, accelerations or {}

    @property
    def between(self):
        """The default curve between two rows."""
        return "quintic" if self.accelerations else "cubic" if self.velocities else "linear"

    def value(self, joint, time, between=None):
        """The value of a joint at a time (s), by the Hermite polynomial between two rows. Without times, rows are 1 s apart."""
        times = self.times or [float(i) for i in range(len(self.positions[joint]))]
        between = between or self.between
        i = max(k for k in range(len(times) - 1) if k == 0 or times[k] <= time)
        T, s = times[i + 1] - times[i], (time - times[i]) / (times[i + 1] - times[i])
        p0, p1 = self.positions[joint][i : i + 2]
        v0, v1 = (T * self._of(self.velocities, joint, k) for k in (i, i + 1))
        a0, a1 = (T * T * self._of(self.accelerations, joint, k) for k in (i, i + 1))
        if between == "linear":
            return p0 + (p1 - p0) * s
        if between == "cubic":  # the four cubic Hermite polynomials
            return (
                p0 * (1 + 2 * s) * (1 - s) ** 2 + v0 * s * (1 - s) ** 2 + p1 * s * s * (3 - 2 * s) + v1 * s * s * (s - 1)
            )
        # p0 + v0 s + a0/2 s² + c s³ + d s⁴ + e s⁵; c, d and e follow from position, velocity and acceleration at s = 1.
        P, V, A = p1 - p0 - v0 - a0 / 2, v1 - v0 - a0, a1 - a0
        c, d, e = 10 * P - 4 * V + A / 2, -15 * P + 7 * V - A, 6 * P - 3 * V + A / 2
        return p0 + s * (v0 + s * (a0 / 2 + s * (c + s * (d + s * e))))

    @staticmethod
    def _of(columns, joint, row):
        return columns[joint][row] if joint in columns else 0.0


def _column(name, joints):
    """Returns ("time", None), or the kind of a column and its joint."""
    if name in _TIMES:
        return "time", None
    for kind, suffixes in _SUFFIXES.items():
        for joint in joints:
            for suffix in suffixes:
                forms = {joint} if not suffix else {joint + mark + suffix for mark in "_./"} | {f"{suffix}_{joint}"}
                if name in forms:
                    return kind, joint
    raise ValueError(f"unknown column {name}")


def read_csv(text, joints):
    """Reads rows of numbers. `joints` are the names of all joints of the robot, those of the problem first and in order."""
    words = [re.split(r"[,\s]+", line.strip()) for line in text.splitlines() if line.strip(" #\t")]
    if words[0][0] == "#":
        words[0] = words[0][1:]
    words[0][0] = words[0][0].lstrip("#")
    header = list(joints)
    if not re.fullmatch(r"[-+.\d].*", words[0][0]):
        header = words.pop(0)
    rows = [[float(word) for word in row] for row in words if not row[0].startswith("#")]
    columns = {"time": {}, "position": {}, "velocity": {}, "acceleration": {}, "effort": {}}
    for i, name in enumerate(header):
        kind, joint = _column(name, joints)
        columns[kind][joint] = [row[i] for row in rows]
    return Trajectory(columns["time"].get(None), columns["position"], columns["velocity"], columns["acceleration"])


def seconds(duration):
    """A duration of ROS 1 or ROS 2, or a number of seconds."""
    if not isinstance(duration, dict):
        return float(duration)
    return duration.get("sec", duration.get("secs", 0)) + 1e-9 * duration.get("nanosec", duration.get("nsecs", 0))


def _joint_trajectory(message):
    """Finds the JointTrajectory in a message."""
    if "points" in message:
        return message
    for key in ("joint_trajectory", "trajectory", "planned_trajectory", "goal"):
        if key in message:
            inner = message[key]
            return _joint_trajectory(inner[0] if isinstance(inner, list) else inner)
    raise ValueError("there is no JointTrajectory")


def read_message(message):
    """Reads a message: the dictionary of its fields."""
    message = _joint_trajectory(message)
    names, points = message["joint_names"], message["points"]

    def columns(key):
        if not points[0].get(key):
            return {}
        return {name: [float(point[key][i]) for point in points] for i, name in enumerate(names)}

    times = [seconds(point["time_from_start"]) for point in points]
    moves = columns("velocities")
    return Trajectory(times if any(times) or moves else None, columns("positions"), moves, columns("accelerations"))
