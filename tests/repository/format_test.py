#!/usr/bin/env python3
"""Tests that C++ files are formatted by clang-format 14, and that lines of Markdown prose have at most 120 characters."""

import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


def longLines():
    pages = [*ROOT.glob("*.md"), *(p for top in ("collision", "planner", "robots", "problems", "tests")
                                   for p in sorted((ROOT / top).rglob("*.md")))]
    for page in pages:
        code = False
        for number, line in enumerate(page.read_text().splitlines(), 1):
            code ^= line.startswith("```")
            free = code or line.startswith(("|", "    ", "<", "!")) or " " not in line.strip()
            if len(line) > 120 and not free:
                yield f"{page.relative_to(ROOT)}:{number}: {len(line)} characters"


def main():
    faults = list(longLines())
    print("\n".join(faults))
    formatter = shutil.which("clang-format-14")
    if not formatter:
        print("skipped: clang-format-14 is not installed")
        return 1 if faults else SKIPPED
    files = [str(f) for top in ("collision", "planner", "tests") for f in sorted((ROOT / top).rglob("*"))
             if f.suffix in (".h", ".cpp")]
    formatted = subprocess.run([formatter, "--dry-run", "-Werror", *files], capture_output=True, text=True)
    print(formatted.stderr[:4000])
    return 1 if faults or formatted.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
