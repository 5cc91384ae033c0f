"""Tests of the exceptions that explain why the compiled module can't be loaded."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import corridor

PACKAGE = pathlib.Path(corridor.__file__).parent


class Loading(unittest.TestCase):
    def imported(self, prepare):
        """Imports a copy of the package, changed by `prepare`, in a new process. Returns its last line on stderr."""
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder, "corridor")
            copy.mkdir()
            for file in PACKAGE.glob("*.py"):
                shutil.copy(file, copy)
            [native] = PACKAGE.glob("_native.*.so")
            prepare(copy, native)
            done = subprocess.run(
                [sys.executable, "-B", "-c", "import corridor"], env={**os.environ, "PYTHONPATH": folder},
                capture_output=True, text=True,
            )  # fmt: skip
        self.assertEqual(done.returncode, 1)
        return done.stderr.splitlines()[-1]

    def test_another_python(self):
        def prepare(copy, native):
            tag = sys.implementation.cache_tag
            (copy / native.name.replace(tag, "cpython-399")).symlink_to(native)

        self.assertRegex(
            self.imported(prepare),
            r"^ImportError: the compiled part of corridor was built for cpython-399-x86_64-linux-gnu, and this is Python "
            rf"3\.\d+ \({sys.implementation.cache_tag}\); run the script by ./corridor python SCRIPT, or by the Python",
        )

    def test_no_module(self):
        self.assertRegex(
            self.imported(lambda copy, native: None),
            r"^ImportError: .*/corridor has no compiled part, _native.\*.so; build the target corridor_python",
        )

    def test_a_broken_module(self):
        def prepare(copy, native):
            (copy / native.name).write_text("no library")

        self.assertRegex(self.imported(prepare), "^ImportError: the compiled part of corridor can't be loaded: .*")


if __name__ == "__main__":
    unittest.main()
