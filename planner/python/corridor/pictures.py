"""Pictures as PNG, drawn by rsvg-convert."""

from __future__ import annotations

import shutil
import subprocess

_PROGRAM = "rsvg-convert"


def can_draw() -> bool:
    """Returns whether rsvg-convert is installed."""
    return shutil.which(_PROGRAM) is not None


def png_of(svg: str, width: int) -> bytes:
    """Converts an SVG document to PNG, `width` pixels wide. Returns the bytes of the PNG file."""
    if isinstance(width, bool) or not isinstance(width, int) or not 1 <= width <= 20_000:
        raise ValueError(f"width: a whole number from 1 to 20000 is needed, not {width!r}")
    program = shutil.which(_PROGRAM)
    if program is None:
        raise RuntimeError("a PNG needs the program rsvg-convert; install Debian's package librsvg2-bin")
    done = subprocess.run(
        [program, "--keep-aspect-ratio", f"--width={width}", "--background-color=white"],
        input=svg.encode(), capture_output=True, check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise RuntimeError(f"rsvg-convert can't draw the picture: {done.stderr.decode(errors='replace').strip()}")
    return done.stdout
