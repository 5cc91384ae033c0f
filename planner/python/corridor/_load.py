"""Loads the compiled part of the package."""

import pathlib
import sys


def _explained(error: ImportError) -> ImportError:
    folder = pathlib.Path(__file__).parent
    built = sorted(file.name.split(".")[1] for file in folder.glob("_native.*.so"))
    here = f"Python {sys.version_info.major}.{sys.version_info.minor} ({sys.implementation.cache_tag})"
    if not built:
        return ImportError(f"{folder} has no compiled part, _native.*.so; build the target corridor_python: {error}")
    if not any(tag.startswith(f"{sys.implementation.cache_tag}-") for tag in built):
        return ImportError(
            f"the compiled part of corridor was built for {', '.join(built)}, and this is {here}; run the script by "
            f"./corridor python SCRIPT, or by the Python that it was built for"
        )
    return ImportError(f"the compiled part of corridor can't be loaded: {error}")


try:
    from . import _native  # noqa: F401
except ImportError as error:
    raise _explained(error) from error
