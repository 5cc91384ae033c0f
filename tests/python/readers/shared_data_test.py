"""Compares robots, problems and messages of the shared data, as Corridor reads them, with small readers of this folder.

Without the folder that CORRIDOR_DATA names (default: ../shared/data), the test prints a message and ends with status 77,
which ctest reports as skipped.
"""

import json
import os
import pathlib
import sys
import tempfile
import unittest

import corridor
import numpy as np
import runs
from compare import compare, compare_robot
from problems import NotRead
from transforms import rotation_of_quaternion
from urdf import Urdf

SEED = int(os.environ.get("CORRIDOR_SEED", 1))
DATA = pathlib.Path(os.environ.get("CORRIDOR_DATA", runs.SOURCE.parent / "shared/data")).resolve()
PACKAGES = {"meshes": "meshes", "example-robot-data": "robots/example-robot-data"}


class SharedData(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def robot_file(self, urdf, name="robot.yaml", more=""):
        """Writes a robot file for a URDF of the data, with its SRDF if there is one."""
        srdf = [*urdf.parent.glob(f"{urdf.stem}.srdf"), *urdf.parent.parent.glob(f"srdf/{urdf.stem}.srdf")]
        packages = {"meshes": urdf.parent / "meshes", "example-robot-data": DATA / "robots/example-robot-data"}
        found = json.dumps({name: str(folder) for name, folder in packages.items() if folder.is_dir()})
        text = f"format: corridor-robot-1\nname: robot\nurdf: {urdf}\npackages: {found}\n"
        (self.folder / name).write_text(text + (f"srdf: {srdf[0]}\n" if srdf else "") + more)
        return self.folder / name

    def test_robots(self):
        for urdf in sorted([*DATA.glob("robots/**/*.urdf"), *DATA.glob("tasks/**/*.urdf")]):
            with self.subTest(urdf.name):
                compare_robot(self, self.robot_file(urdf), np.random.default_rng(SEED))

    def test_reference_poses(self):
        """The own kinematics against those of another program: its figures have twelve digits."""
        reference = json.loads((DATA / "robots/fk_reference.json").read_text())
        for robot in reference["robots"]:
            urdf = Urdf(DATA / "robots" / robot["urdf"], {k: DATA / v for k, v in PACKAGES.items()}, shapes=False)
            for state in robot["states"]:
                values = {j: urdf.nearest_to_zero(j) for j in urdf.movable()} | {j: [v] for j, v in state["q"].items()}
                poses = urdf.poses(values)
                for link, numbers in state["links"].items():
                    np.testing.assert_allclose(poses[link][:3, 3], numbers[:3], atol=1e-9)
                    np.testing.assert_allclose(poses[link][:3, :3], rotation_of_quaternion(numbers[3:]), atol=1e-9)

    def test_messages_of_moveit(self):
        """Scenes and requests as MotionBenchMaker wrote them."""
        total = {True: 0, False: 0, None: 0}
        for scene in sorted(DATA.glob("mbm/raw/panda/*/scene*1.yaml")):
            with self.subTest(scene.parent.name):
                self.robot_file(DATA / "robots/panda/panda.urdf", "panda.yaml")
                request = scene.with_name(scene.name.replace("scene", "request"))
                problem = self.folder / "problem.yaml"
                problem.write_text("format: corridor-problem-1\nrobot: panda.yaml\n"
                                   f"moveit: {{scene: {scene}, request: {request}}}\n")  # fmt: skip
                counts = compare(self, problem, np.random.default_rng(SEED), states=5)
                total = {key: total[key] + counts[key] for key in total}
        print(f"seed {SEED}: messages of MoveIt: in contact {total[True]}, apart {total[False]}, no witness {total[None]}")
        self.assertGreater(total[True], 5)

    def test_reports(self):
        """Every problem of the reports that both can read."""
        compared = []
        for file in sorted(DATA.glob("reports/*/*.yaml")):
            if "corridor-problem-1" not in file.read_text():
                continue
            with self.subTest(str(file.relative_to(DATA))):
                try:
                    corridor.read_problem(file)
                    compare(self, file, np.random.default_rng(SEED), states=5)
                    compared.append(str(file.relative_to(DATA / "reports")))
                except (corridor.InputError, NotRead) as why:
                    print(f"{file.relative_to(DATA)}: not compared: {str(why).splitlines()[0][-160:]}")
        print("compared:", *compared)
        self.assertGreater(len(compared), 3)

    def test_trajectories_of_a_report(self):
        """Files that move a held joint, or the base, through a wall."""
        for file in ("heldvel.csv", "goal.yaml"):
            status, report = runs.report(DATA / "reports/s1", "verify", "p.yaml", file)
            self.assertTrue(status == 2 or report["verdict"] == "refuted", f"{file}: {report}")


if __name__ == "__main__":
    if not DATA.is_dir():
        # In the form of GoogleTest, so that ./corridor test lists it.
        print(f"readers.shared_data_test: Skipped\nthere is no folder {DATA}; set CORRIDOR_DATA to that of the shared data")
        sys.exit(77)
    unittest.main()
