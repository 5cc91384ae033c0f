#!/usr/bin/env python3
"""Tests that Doxygen makes the API pages of the collision library, at least 50 of them, without a warning."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    if not shutil.which("doxygen"):
        print("skipped: doxygen is not installed")
        return 77
    settings = (ROOT / "Doxyfile").read_text()
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["doxygen", "-"], input=f"{settings}\nOUTPUT_DIRECTORY = {folder}\n", cwd=ROOT, text=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        pages = list(pathlib.Path(folder).glob("html/*.html"))
    print(done.stderr, end="")
    if done.returncode or done.stderr.strip():
        print("Doxygen has warnings")
        return 1
    if len(pages) < 50:
        print(f"Doxygen made only {len(pages)} pages")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
