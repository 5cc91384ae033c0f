"""Runs the program `corridor`, several at a time. For tests only."""

import json
import os
import pathlib
import subprocess
from concurrent.futures import ThreadPoolExecutor

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])
PROGRAM = os.environ["CORRIDOR_PROGRAM"]


def run(folder, *arguments, text=None):
    """Runs a command in a folder, with `text` as its standard input; returns its status, stdout and stderr."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, input=text, capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def report(folder, *arguments, text=None):
    """Runs a command with --json. Returns its status, and its report, or the text of its faults."""
    status, out, err = run(folder, *arguments, "--json", text=text)
    return status, json.loads(out) if out else err


def many(function, items):
    """Calls a function for all items, in several threads, and returns the results in order."""
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        return list(pool.map(function, items))
