#!/usr/bin/env python3
"""Tests that collision/COURSE.md is exactly what course.py writes from its rows and figures, and has all topics."""

import pathlib
import subprocess
import sys

COURSE = pathlib.Path(__file__).resolve().parents[1] / "benchmark" / "course.py"
sys.exit(subprocess.call([sys.executable, "-B", COURSE, "--check"]))
