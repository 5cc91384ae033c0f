"""Conversions of arguments, which raise a ValueError that names the argument."""

from __future__ import annotations

import operator
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray


def _has_text(array: NDArray[Any]) -> bool:
    return array.dtype.kind in "SU" or (array.dtype.kind == "O" and any(isinstance(x, (str, bytes)) for x in array.flat))


def _file(name: str, value: Any) -> str:
    """Returns the absolute name of a file. Names may have any bytes: those that are not UTF-8 are surrogates in it."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError(f"{name}: the name of a file is needed, not {value!r}")
    return os.path.abspath(os.fsdecode(value))


def _array(name: str, value: Any) -> NDArray[np.float64]:
    """Returns a copy as doubles. Other numbers are rounded to the nearest double; proofs are about the doubles."""
    try:
        given = np.asarray(value)
        real = not isinstance(value, np.ma.MaskedArray) and given.dtype.kind != "c"
        has_text = _has_text(given)
        array = np.array(given, dtype=float) if real and not has_text else np.zeros(0)
    except (TypeError, ValueError, OverflowError) as error:
        rows = "inhomogeneous" in str(error) or "sequence" in str(error)
        why = ", with rows of equal length" if rows else f": {error}"
        raise ValueError(f"{name}: an array of numbers is needed{why}") from None
    if has_text:
        raise ValueError(f"{name}: an array of numbers is needed, not of texts")
    if not real:
        raise ValueError(f"{name}: an array of real numbers without a mask is needed")
    return array


def _number(name: str, value: Any) -> float:
    try:
        if not isinstance(value, (str, bytes)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"{name}: a number is needed, not {value!r}")


def _whole(name: str, value: Any, least: int) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if number < least:
        raise ValueError(f"{name}: a whole number of {least} or more is needed, not {value!r}")
    return number


def _flag(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name}: True or False is needed, not {value!r}")
    return bool(value)


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{name}: a name is needed, not {value!r}")
    return value
