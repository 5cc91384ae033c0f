#!/usr/bin/env python3
"""Tests that tests/benchmark/RESULTS.md is what results.py writes from the CSV files in tests/benchmark/results/."""

import pathlib
import subprocess
import sys

RESULTS = pathlib.Path(__file__).resolve().parents[1] / "benchmark" / "results.py"
sys.exit(subprocess.call([sys.executable, "-B", RESULTS, "--check"]))
