"""Motion planning with proved paths, and exact collision queries.

>>> import corridor
>>> problem = corridor.read_problem("problems/arm_at_shelf")
>>> solution = corridor.solve(problem)
>>> solution.path            # N×J configurations
>>> solution.verify()["verdict"]
'proved'

Lengths are metres, angles radians, poses 4×4 matrices.
"""

from . import _load  # first: explains a compiled part that can't be loaded
from . import shapes
from ._errors import Fault, InputError
from .bodies import Body, Contacts, Distances, FirstContact, closer_than, contacts, distance, first_contact, touch
from .certificates import Certificate, CertificateFault
from .problem import Problem, Solution, solve, solve_many
from .results import Results, Verdict
from .robots import Joint, rigid_body, robot, urdf
from .shapes import Pose

read_problem = Problem.read

__all__ = [
    "Body", "Certificate", "CertificateFault", "Contacts", "Distances", "Fault", "FirstContact", "InputError", "Joint",
    "Pose", "Problem", "Results", "Solution", "Verdict", "closer_than", "contacts", "distance", "first_contact",
    "read_problem", "rigid_body", "robot", "shapes", "solve", "solve_many", "touch", "urdf",
]
