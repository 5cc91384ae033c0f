"""Motion planning with proved paths, and exact collision queries.

>>> import corridor
>>> problem = corridor.read_problem("problems/arm_at_shelf")
>>> solution = corridor.solve(problem)
>>> solution.path            # N×J configurations
>>> solution.verify()["verdict"]
'proved'

Lengths are metres, angles radians, poses 4×4 matrices.
"""

from . import shapes
from ._errors import Fault, InputError
from .bodies import Body, Contacts, Distances, FirstContact, closer_than, contacts, distance, first_contact, touch
from .problem import Problem, Results, Solution, Verdict, rigid_body, solve, solve_many, urdf

read_problem = Problem.read

__all__ = [
    "Body", "Contacts", "Distances", "Fault", "FirstContact", "InputError", "Problem", "Results", "Solution",
    "Verdict", "closer_than", "contacts", "distance", "first_contact", "read_problem", "rigid_body", "shapes",
    "solve", "solve_many", "touch", "urdf",
]
