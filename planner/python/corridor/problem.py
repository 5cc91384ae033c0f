"""Planning problems, checks of states and edges, and solutions."""

from __future__ import annotations

import copy
import difflib
import html
import os
import tempfile
import threading
import webbrowser
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native, workers
from ._arguments import _array, _file, _flag, _number, _text, _whole
from .certificates import Certificate, certificate_of
from .results import Results
from .robots import _obstacles, _pair
from .shapes import Shape

_solving = threading.Lock()  # OMPL has one generator of random numbers per process


def _renew_lock() -> None:
    """In a process that was forked while another thread solved, no thread would ever release the lock."""
    global _solving
    _solving = threading.Lock()


os.register_at_fork(after_in_child=_renew_lock)
_this_thread = threading.local()

_EDITS = (
    "start", "goals", "margin", "tube", "planner", "params", "time", "seed", "simplify", "edges", "clearance",
    "tolerance", "smooth", "rate", "deviation", "corner_deviation",
)  # fmt: skip


class Problem:
    """A planning problem. It never changes: `edited` returns another problem.

    It can be pickled. Unpickling reads its files again, and raises ValueError if they have changed.

    A configuration is an array of J numbers: radians, metres, and quaternions (qx, qy, qz, qw) of floating bodies. The
    property `numbers` is the list of their names.
    """

    _recipe: tuple[Any, ...]
    _edits: dict[str, Any]

    def __init__(
        self, robots: dict[str, Any] | Sequence[dict[str, Any]], obstacles: Mapping[str, Shape | Iterable[Shape]] | None = None,
        allow: Iterable[tuple[str, str]] = (), **edits: Any,
    ):  # fmt: skip
        """Builds a problem.

        robots: a robot, or a list of robots, made by `urdf`, `robot` or `rigid_body`.
        obstacles: shapes by name, in world coordinates.
        allow: pairs of names of bodies that may touch. edits: as for `edited`.
        """
        is_list = isinstance(robots, Iterable) and not isinstance(robots, (dict, str))
        given: list[Any] = list(robots) if is_list else [robots]
        for robot in given:
            if not isinstance(robot, dict) or "bounds" not in robot:
                hint = "; read_problem(FILE) reads a problem's file" if isinstance(robot, (str, os.PathLike)) else ""
                raise TypeError(f"robots: what `urdf`, `robot` or `rigid_body` returns is needed, not {robot!r}{hint}")
        self._set(("built", given, _obstacles(obstacles), [_pair(pair) for pair in allow]), edits)

    @classmethod
    def read(cls, file: str | os.PathLike[str]) -> Problem:
        """Reads a problem.yaml, a folder that contains a problem.yaml, an OMPL.app .cfg, or SET.json#INDEX.

        Raises InputError with all faults.
        """
        self = cls.__new__(cls)
        self._set(("file", _file("file", file)), {})
        return self

    def _set(self, recipe: tuple[Any, ...], edits: dict[str, Any]) -> None:
        self._recipe = recipe = copy.deepcopy(recipe)
        self._edit(_made(recipe), {}, edits)

    def _edit(self, base: _native.Problem, before: dict[str, Any], edits: dict[str, Any]) -> None:
        for key in edits:
            if key not in _EDITS:
                close = difflib.get_close_matches(key, _EDITS, 1)
                hint = f" (did you mean {close[0]!r}?)" if close else f"; there are {', '.join(_EDITS)}"
                if key == "world":
                    hint = "; its obstacles are replaced by edited(obstacles=...)"
                if key in ("range", "goal_bias"):
                    hint = f"; it is a parameter of planners: params={{{key!r}: ...}}"
                raise TypeError(f"a problem has no {key!r} that can be edited{hint}")
        edits = {k: _value(k, v) for k, v in edits.items()}
        if "planner" in edits:  # parameters belong to one planner: a new planner gets none of the old ones
            before = {k: v for k, v in before.items() if k != "params"}
        # The order of `_EDITS` is the order in which they are applied: the planner before its parameters.
        edits = {k: edits[k] for k in _EDITS if k in edits}
        self._edits = {k: {**before, **edits}[k] for k in _EDITS if k in before or k in edits}
        self._native: _native.Problem = base.edited(edits) if edits else base

    def edited(self, **edits: Any) -> Problem:
        """Returns a copy of the problem in which the given values are changed.

        obstacles: shapes by name, which replace all obstacles. What the problem says of pairs and bodies (pairs that
        may touch, paddings) holds for its obstacles of the same names, also after edits without them. Bounds stay. Trees
        of meshes that stay are kept: a loop that reads a camera makes each problem from the one before.
        start (J,); goals (J,), or (G, J): a path may end at any of the G goals; margin, m; tube, {"joints": rad or m,
        "slides": m, "position": m, "rotation": rad}; planner, OMPL's name; params, the planner's parameters by OMPL's
        names; time, s; seed; simplify (True, False, "ompl"); edges ("certified", "discrete", ...); clearance, m;
        tolerance, m.
        For trajectories: smooth ("time", "length", "acceleration", "corners", "none"); rate, rows per second; deviation
        and corner_deviation, rad or m. With corner_deviation only corners are rounded, whatever `smooth` is.
        Raises ValueError if a value is illegal or contradicts another one. Names of planners and of their parameters
        are checked by `solve`.
        """
        other = object.__new__(type(self))
        other._recipe, base = self._recipe, self._native
        if "obstacles" in edits:
            named = _obstacles(edits.pop("obstacles"))
            other._recipe = ("world", self._base_recipe, named)
            base = base.with_obstacles(named)
        other._edit(base, self._edits, edits)
        return other

    @property
    def _base_recipe(self) -> tuple[Any, ...]:
        base: tuple[Any, ...] = self._recipe[1] if self._recipe[0] == "world" else self._recipe
        return base

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._recipe, self._edits, self._native.fingerprint)

    def _require(self, key: str) -> None:
        if self._base_recipe[0] == "built" and key not in self._edits:
            raise ValueError(f"{key}: the problem has no {key}; set it by problem.edited({key}=...)")

    def __repr__(self) -> str:
        return f"<Problem: {self.name}, {len(self.numbers)} numbers, {len(self.bodies)} bodies>"

    @property
    def name(self) -> str:
        """The name of the problem, from its file; "problem" if it was built in Python."""
        return self._native.name

    @property
    def numbers(self) -> list[str]:
        """The names of the J numbers of a configuration."""
        return self._native.numbers

    @property
    def bodies(self) -> list[str]:
        """The names of links and obstacles."""
        return self._native.bodies

    @property
    def notes(self) -> list[str]:
        """Notes, one line each: decisions made when the files were read, which a user may want to know."""
        return self._native.notes

    @property
    def start(self) -> NDArray[np.float64]:
        """(J,): the configuration at which paths begin. Raises ValueError if the problem was built without a start."""
        self._require("start")
        return self._native.start

    @property
    def goals(self) -> NDArray[np.float64]:
        """G×J: a path may end at any of the G goals. Empty if the problem was built without goals."""
        return self._native.goals

    @property
    def bounds(self) -> NDArray[np.float64]:
        """2×J: the smallest and the largest value of each number of a configuration."""
        return self._native.bounds

    @property
    def margin(self) -> float:
        """The distance that all tested pairs must keep, m."""
        return self._native.margin

    @property
    def tube(self) -> NDArray[np.float64]:
        """(J,): proofs cover deviations from a path by at most this much, in each number of a configuration."""
        return self._native.tube

    @property
    def planner(self) -> str:
        """OMPL's name of the planner."""
        return self._native.planner

    @property
    def time(self) -> float:
        """The time limit of a solve, s."""
        return self._native.time

    @property
    def seed(self) -> int:
        """The seed of random numbers."""
        return self._native.seed

    def check(self, states: ArrayLike, threads: int = 0) -> Results:
        """Decides whether states, (J,) or (N, J), are proved free. threads: 0 means all cores."""
        return Results(self.bodies, *_native.check(self._native, _array("states", states), _whole("threads", threads, 0)))

    def certify(self, q0: ArrayLike, q1: ArrayLike, earliest: bool = False, threads: int = 0) -> Results:
        """Decides whether edges are proved free. Edge i goes from row i of q0 to row i of q1, both (N, J). A q0 or q1
        of shape (J,) is one row, which is used for all edges.

        Continuous joints and rotations go the shorter way. `time` is the time of a contact. With `earliest`, `time` is
        that of the first contact: the edge is proved free from its beginning to a time shortly before the contact. The
        unproved part between the two times is at most 1/1024 of the edge, or longer if the contact is grazing.
        `certificate` returns the end of the part that is proved free, as `free_until`.
        """
        return Results(
            self.bodies,
            *_native.certify(
                self._native, _array("q0", q0), _array("q1", q1), _flag("earliest", earliest), _whole("threads", threads, 0)
            ),
        )

    def certificate(self, q0: ArrayLike, q1: ArrayLike, earliest: bool = False) -> Certificate:
        """Decides one edge, from (J,) to (J,), and returns the proof as data.

        With `earliest`, the part of the edge before a contact is proved, too. `certificate` takes longer than
        `certify`, because it also proves pairs that are far apart all the time. The method is always "certified",
        whatever `edited(edges=...)` set.
        """
        return certificate_of(self, _array("q0", q0), _array("q1", q1), _flag("earliest", earliest))

    def poses(self, states: ArrayLike) -> NDArray[np.float64]:
        """Returns the poses of all bodies in the world, N×B×4×4, at states, (J,) or (N, J).

        The poses are rounded; the proofs take this into account. The shapes of obstacles are in world coordinates, so
        the pose of an obstacle is the identity. The only exception: obstacles of a problem file that share one mesh
        have the poses at which this mesh is placed.
        """
        return _native.poses(self._native, _array("states", states))

    def clearance(self, states: ArrayLike, threads: int = 0) -> NDArray[np.float64]:
        """Returns, for each state, the smallest distance of a tested pair minus the margin: (N,), m."""
        return _native.clearance(self._native, _array("states", states), _whole("threads", threads, 0))

    def near_robot(self, points: ArrayLike, state: ArrayLike, distance: float, threads: int = 0) -> NDArray[np.bool_]:
        """Returns which points, (N, 3), are inside a solid shape of a link at a state, (J,), or at most `distance`, m,
        from the surface of a shape: (N,).

        A camera sees the robot, too: `points[~problem.near_robot(points, state, 0.03)]` are the other points.
        """
        array, number = _array("points", points), _number("distance", distance)
        return _native.near_robot(self._native, array, _array("state", state), number, _whole("threads", threads, 0))

    def page(self) -> str:
        """Returns an HTML page that shows the scene in 3D."""
        return _native.page(self._native, None)

    def _repr_html_(self) -> str:
        return _frame(self.page())


def _made(recipe: tuple[Any, ...]) -> _native.Problem:
    """Makes a problem without edits."""
    if recipe[0] == "world":
        return _made(recipe[1]).with_obstacles(recipe[2])
    return _native.read_problem(os.fsencode(recipe[1])) if recipe[0] == "file" else _native.build_problem(*recipe[1:])


def _value(key: str, value: Any) -> Any:
    """Returns a copy of an edit's value, in the form that the native module takes."""
    if key in ("start", "goals"):
        return _array(key, value)
    if key == "simplify" and isinstance(value, bool):
        return "true" if value else "false"
    if key == "params" and isinstance(value, Mapping):
        return {str(name): str(each) for name, each in value.items()}
    return copy.deepcopy(value)


def _restored(recipe: tuple[Any, ...], edits: dict[str, Any], fingerprint: str) -> Problem:
    problem = object.__new__(Problem)
    problem._set(recipe, edits)
    if problem._native.fingerprint != fingerprint:
        raise ValueError(f"{problem.name}: its files have changed since it was pickled, so its proofs are no longer about it")
    return problem


def _frame(page: str) -> str:
    return f'<iframe srcdoc="{html.escape(page)}" style="width: 100%; height: 600px; border: 0"></iframe>'


class _NoTrajectory(dict[str, Any]):
    """The empty `trajectory` of a solution. Its KeyError says why it is empty."""

    def __init__(self, why: str = 'pass trajectory="csv" to solve'):
        super().__init__()
        self.why = why

    def __missing__(self, key: str) -> Any:
        raise KeyError(f"{key}: there is no trajectory; {self.why}")


@dataclass(repr=False, eq=False)
class Solution:
    """The result of `solve`. It can be pickled. `bool(solution)` is True if the problem is solved."""

    problem: Problem
    outcome: str  #: "solved", "not found", "approximate only"
    why: str  #: why the problem is not solved, one line; empty if solved
    path: NDArray[np.float64]  #: N×J states; empty unless solved
    certified: bool  #: every edge of `path` is proved, for all pairs except `left_out`
    #: times, lengths and counts, by their names in the report of `corridor solve --json`. `proved_clearance_m` is at
    #: most the preferred clearance; `verify` may prove more. `closest_found_m`: the smallest distance that was found.
    #: `share_on_target`: the fraction of the path's length on which every pair keeps its target; `why_off_target`: why
    #: it is below 1: "detour", "not found" or "time"
    figures: dict[str, Any] = field(default_factory=dict)
    #: `text`, `duration_s`, `proved`, `keeps_limits`, `proved_clearance_m`, `share_on_target`, `time_lost_s` (what
    #: the clearance costs), `why_none`. Empty if `solve` was called without `trajectory`, or if the problem is not
    #: solved
    trajectory: dict[str, Any] = field(default_factory=_NoTrajectory)
    #: pairs that no proof covers: names of the two bodies, and "touch at rest", "within the margin at rest", "allow" or
    #: "allowed_collision_matrix". At least one body of each pair is an obstacle, or they belong to two robots
    left_out: list[tuple[str, str, str]] = field(default_factory=list)
    _text: str = ""
    _except: str = ""

    def __bool__(self) -> bool:
        return self.outcome == "solved"

    def __repr__(self) -> str:
        certified = f"certified{self._except}" if self.certified else "not certified"
        states = f", {len(self.path)} states, {certified}" if self else ""
        return f"<Solution: {self.outcome}{states}{'; ' + self.why if self.why else ''}>"

    def _require_path(self) -> None:
        if not self:
            raise ValueError(f"there is no path: {self.why or self.outcome}")

    def verify(self) -> dict[str, Any]:
        """Verifies the path by the independent verifier. Returns `verdict`, `findings`, `proved_clearance_m`,
        `closest_found_m`, `left_out` (as `Solution.left_out`), `not_tested` (the number of pairs that are not tested, by
        reason), ..."""
        self._require_path()
        return _native.verify_path(self.problem._native, self.path, self.figures.get("proved_clearance_m") or 0.0)

    def verify_trajectory(self) -> dict[str, Any]:
        """Verifies the text of the trajectory by the independent verifier. Returns `verdict`, `keeps_limits`, ..."""
        if not self.trajectory.get("text"):
            why = self.trajectory.get("why_none") or getattr(self.trajectory, "why", "")
            raise ValueError(f"there is no trajectory; {why}")
        return _native.verify_trajectory(self.problem._native, self.trajectory["text"])

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes a solution file, which `corridor verify` reads with the problem's file.

        The problem must have been read from files that still exist, and its start, goals, margin and tube must not have
        been edited.
        """
        self._require_path()
        edited = [k for k in ("start", "goals", "margin", "tube") if k in self.problem._edits]
        edited += ["obstacles"] if self.problem._recipe[0] == "world" else []
        if edited and self._text:
            verb = "were" if edited[0] in ("goals", "obstacles") else "was"
            raise ValueError(f"a solution file is for the problem's file, and {edited[0]} {verb} edited")
        if not self._text:
            raise ValueError("a solution file names the problem's file, and there is none")
        with open(os.fspath(file), "w", encoding="utf-8") as out:
            out.write(self._text)

    def page(self) -> str:
        """Returns an HTML page that plays the path in 3D. The page loads no other file."""
        self._require_path()
        return _native.page(self.problem._native, self.path)

    def _require_view(self, seen_from: str | None) -> None:
        self._require_path()
        if seen_from is not None and not isinstance(seen_from, str):
            raise ValueError(f'seen_from: a text is needed, such as "front" or "-60,38", not {seen_from!r}')

    def svg(self, seen_from: str | None = None) -> str:
        """Returns a picture of the scene and the path: an SVG document.

        `seen_from` is where the viewer stands: "front" (at +x), "back", "left" (at +y), "right", "top", "bottom", or
        "AZIMUTH,ELEVATION" in degrees, such as "-60,38". Without it, the scene is seen from above at an angle.
        """
        self._require_view(seen_from)
        return _native.picture(self.problem._native, self.path, seen_from)

    def png(self, width: int = 1200, seen_from: str | None = None) -> bytes:
        """Returns the picture of `svg` as the bytes of a PNG file.

        `width` is the number of pixels of the longer side, which is the width for most scenes: 1 to 8000.
        """
        self._require_view(seen_from)
        if isinstance(width, bool) or not isinstance(width, int) or not 1 <= width <= 8000:
            raise ValueError(f"width: a whole number from 1 to 8000 is needed, not {width!r}")
        return _native.png(self.problem._native, self.path, seen_from, width)

    def view(self, file: str | os.PathLike[str] | None = None) -> str:
        """Writes the page to a file; without `file`, opens it in a browser. Returns the name of the file."""
        page, opens = self.page(), file is None
        if file is not None:
            file = os.fspath(file)
        else:
            handle, file = tempfile.mkstemp(suffix=".html")
            os.close(handle)
        with open(file, "w", encoding="utf-8") as out:
            out.write(page)
        if opens:
            webbrowser.open("file://" + os.path.abspath(file))
        return os.fspath(file)

    def _repr_html_(self) -> str:
        return _frame(self.page()) if self else f"<p>{html.escape(repr(self))}</p>"

    def _repr_png_(self) -> bytes | None:
        return self.png() if self else None


def solve(
    problem: Problem | str | os.PathLike[str], planner: str | None = None, time: float | None = None, seed: int | None = None,
    trajectory: str | None = None, progress: Callable[[float, int], None] | None = None,
) -> Solution:  # fmt: skip
    """Solves a problem, or the problem in a file, and proves every edge of the path.

    trajectory: "csv" (rows of numbers) or "yaml" (a JointTrajectory of ROS 2) makes a trajectory, too.
    progress: called ten times a second with the seconds and the number of edges tested. Ctrl-C ends the solve.
    With most planners, the same problem and seed give the same path. A process solves one problem at a time: a second
    call waits. `solve_many` uses several processes.
    """
    problem = _planned(_problem_of(problem), planner=planner, time=time, seed=seed)
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: a function of seconds and edges is needed, not {progress!r}")
    if trajectory not in (None, "csv", "yaml"):
        raise ValueError(f'trajectory: "csv" or "yaml" is needed, not {trajectory!r}')
    problem._require("start")
    problem._require("goals")
    if getattr(_this_thread, "solves", False):
        raise RuntimeError("solve can't be called by the progress callback of a solve")
    _this_thread.solves = True
    try:
        result = _solve_alone(problem, trajectory, progress)
    finally:
        _this_thread.solves = False
    take = result.pop
    none = _NoTrajectory() if trajectory is None else _NoTrajectory("the problem is not solved")
    return Solution(
        problem, take("outcome"), take("why"), take("path"), take("certified"), trajectory=take("trajectory", none),
        left_out=take("left_out"), _text=take("text", ""), _except=take("except"), figures=result,
    )  # fmt: skip


def _planned(problem: Problem, **options: Any) -> Problem:
    edits = {k: options[k] for k in ("planner", "time", "seed") if options.get(k) is not None}
    return problem.edited(**edits) if edits else problem


def _require_options(options: dict[str, Any]) -> None:
    known = ("planner", "time", "seed", "trajectory")
    for name in options:
        if name not in known:
            raise TypeError(f"solve_many has no option {name!r}; there are {', '.join(known)}")


def _problem_of(problem: object) -> Problem:
    """Returns a problem, which is read if it is the name of a file."""
    if isinstance(problem, (str, bytes, os.PathLike)):
        return Problem.read(os.fsdecode(problem))
    if not isinstance(problem, Problem):
        raise TypeError(f"a Problem or the name of its file is needed, not {problem!r}")
    return problem


def _solve_alone(problem: Problem, trajectory: str | None, progress: Callable[[float, int], None] | None) -> dict[str, Any]:
    with _solving:
        return _native.solve(problem._native, trajectory, progress)


def _solve_one(arguments: tuple[Problem, dict[str, Any]]) -> Solution:
    problem, options = arguments
    solution = solve(problem, **options)
    solution.problem = None  # type: ignore[assignment]  # the caller has it
    return solution


def solve_many(problems: Iterable[Problem | str | os.PathLike[str]], processes: int | None = None, **options: Any) -> Iterator[Solution]:
    """Solves several problems, and yields their solutions in the same order.

    processes: the number of processes; default: the number of cores. options: those of `solve`, except progress. The
    arguments are tested, and the first problem is begun, only when the first solution is requested. As always when
    Python starts processes, a script must call `solve_many` under `if __name__ == "__main__":`. Ctrl-C ends all of the
    processes.
    """
    if isinstance(problems, (Problem, str, bytes, os.PathLike)):
        raise TypeError("problems: a list of problems is needed, not one problem")
    read = [_problem_of(problem) for problem in problems]
    _require_options(options)
    solutions = workers.in_order(_solve_one, [(problem, options) for problem in read], processes)
    for each, solution in zip(read, solutions):
        solution.problem = _planned(each, **options)
        yield solution
