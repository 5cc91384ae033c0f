#!/usr/bin/env python3
"""Tests that tests/benchmark/PAPER.md is exactly what paper.py writes from the CSV files in tests/benchmark/paper/."""

import pathlib
import subprocess
import sys

PAPER = pathlib.Path(__file__).resolve().parents[1] / "benchmark" / "paper.py"
sys.exit(subprocess.call([sys.executable, "-B", PAPER, "--check"]))
