"""Tests of `_native.pyi` against the compiled module, of docstrings, and of types (by mypy, if it is installed)."""

import ast
import importlib
import inspect
import os
import pathlib
import pkgutil
import shutil
import subprocess
import tempfile
import unittest

import corridor
from corridor import _native

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])
PACKAGE = SOURCE / "planner/python/corridor"


def signature(function):
    """Returns a function's arguments, read from the signature that pybind11 writes into the docstring's first line."""
    line = function.__doc__.splitlines()[0]
    inner = line[line.index("(") + 1 : line.rindex(") ->")]
    depth, words, word = 0, [], ""
    for letter in inner + ",":
        depth += (letter in "[(") - (letter in "])")
        if letter == "," and depth == 0:
            words.append(word.split(":")[0].strip())
            word = ""
        else:
            word += letter
    return [word for word in words if word]


class NativeTypes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        tree = ast.parse((PACKAGE / "_native.pyi").read_text(encoding="utf-8"))
        cls.functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        cls.classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}

    def test_names_are_those_of_the_module(self):
        names = {name for name in dir(_native) if not name.startswith("_")}
        self.assertEqual(names, {*self.functions, *self.classes})
        for name, node in self.classes.items():
            members = {each for each in dir(getattr(_native, name)) if not each.startswith("_")}
            self.assertEqual(members, {each.name for each in node.body if isinstance(each, ast.FunctionDef)}, name)

    def test_arguments_are_those_of_the_module(self):
        self.assertGreater(len(self.functions), 15)
        for name, node in self.functions.items():
            self.assertEqual([arg.arg for arg in node.args.args], signature(getattr(_native, name)), name)
            self.assertIsNotNone(node.returns)
        [edited] = [each for each in self.classes["Problem"].body if each.name == "edited"]
        self.assertEqual([arg.arg for arg in edited.args.args], signature(_native.Problem.edited))

    def test_the_package_calls_it_with_as_many_arguments(self):
        calls = 0
        for file in PACKAGE.glob("*.py"):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                    continue
                if not (isinstance(node.func.value, ast.Name) and node.func.value.id == "_native"):
                    continue
                calls += 1
                if any(isinstance(arg, ast.Starred) for arg in node.args):
                    continue
                self.assertEqual(len(node.args), len(self.functions[node.func.attr].args.args), f"{file.name}: {node.func.attr}")
        self.assertGreater(calls, 15)


class Docstrings(unittest.TestCase):
    def test_all_that_is_public_has_one(self):
        modules = [importlib.import_module(f"corridor.{each.name}") for each in pkgutil.iter_modules([str(PACKAGE)])]
        missing, seen = [], 0
        for module in [corridor, *modules]:
            if module is _native:
                continue
            if not module.__doc__:
                missing.append(module.__name__)
            for name, value in vars(module).items():
                public = inspect.isclass(value) or inspect.isfunction(value)
                if name.startswith("_") or not public or value.__module__ != module.__name__:
                    continue
                seen += 1
                # A dataclass without a docstring gets its signature as docstring.
                if not value.__doc__ or value.__doc__.startswith(name + "("):
                    missing.append(f"{module.__name__}.{name}")
                for member, each in vars(value).items() if inspect.isclass(value) else ():
                    each = getattr(each, "__func__", each)
                    if member.startswith("_") or not (inspect.isfunction(each) or isinstance(each, property)):
                        continue
                    if not each.__doc__:
                        missing.append(f"{module.__name__}.{name}.{member}")
        self.assertEqual(missing, [])
        self.assertGreater(seen, 25)

    def test_all_lists_what_is_public(self):
        for name in corridor.__all__:
            self.assertTrue(hasattr(corridor, name), name)
        imported = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
        names = {alias.asname or alias.name for node in imported.body if isinstance(node, ast.ImportFrom) for alias in node.names}
        self.assertEqual({name for name in names if not name.startswith("_")} | {"read_problem"}, set(corridor.__all__))

    def test_parameters_have_types(self):
        for name in corridor.__all__:
            value = getattr(corridor, name)
            for function in [value] if inspect.isfunction(value) else []:
                for parameter in inspect.signature(function).parameters.values():
                    self.assertNotEqual(parameter.annotation, parameter.empty, f"{name}: {parameter.name}")


USER = """
import numpy as np
import corridor
from corridor import Joint, Pose, shapes

problem: corridor.Problem = corridor.read_problem("p.yaml").edited(seed=1)
results = problem.check(np.zeros((2, 7)))
free: int = int(results.free.sum())
robot = corridor.robot({"a": shapes.sphere(1), "b": None}, [Joint("j", "continuous", "a", "b", Pose((0, 0, 1)))])
solution: corridor.Solution = corridor.solve(problem, time=1)
picture: bytes = solution.png(width=100)
proof: corridor.Certificate = problem.certificate(problem.start, problem.goals[0])
reveal_type(proof.clearance)
"""
WRONG = """
import corridor
corridor.solve(3)
corridor.read_problem()
"""


@unittest.skipUnless(shutil.which("mypy"), "needs Debian's mypy")
class Mypy(unittest.TestCase):
    def check(self, text):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder, "user.py")
            script.write_text(text)
            environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent)}
            return subprocess.run(
                [shutil.which("mypy"), "--strict", "--cache-dir", f"{folder}/cache", script],
                env=environment, capture_output=True, text=True, cwd=folder,
            )  # fmt: skip

    def test_a_users_script(self):
        done = self.check(USER)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("numpy.ndarray[Any, numpy.dtype[numpy.floating[numpy._typing._64Bit]]]", done.stdout)

    def test_a_wrong_script(self):
        done = self.check(WRONG)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, r':3: error: Argument 1 to "solve"')
        self.assertRegex(done.stdout, r":4: error: (Too few arguments|Missing positional)")


if __name__ == "__main__":
    if not shutil.which("mypy"):  # in GoogleTest's form: ./corridor test lists the reasons
        print("python.types_test: Skipped\ntests of types need Debian's mypy", flush=True)
    unittest.main()
