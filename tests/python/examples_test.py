"""Runs the examples of planner/python/README.md, as one script."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])


class Examples(unittest.TestCase):
    def test_readme(self):
        text = (SOURCE / "planner/python/README.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreaterEqual(len(blocks), 6)
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder, "examples.py")
            script.write_text("".join(blocks), encoding="utf-8")
            done = subprocess.run([sys.executable, script], cwd=SOURCE, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"<Solution: solved, \d+ states, certified>")
        self.assertIn("proved\n", done.stdout)
        self.assertRegex(done.stdout, r"(?m)^0\.(5|49999)\d*$")  # of the first contact


if __name__ == "__main__":
    unittest.main()
