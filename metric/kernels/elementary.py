"""Elementary functions whose last bit does not depend on the CPU."""

from __future__ import annotations

from typing import overload

import numpy as np
from numpy.typing import NDArray

from . import compiled

Array = NDArray[np.float64]


@overload
def exp(x: Array) -> Array: ...
@overload
def exp(x: float) -> float: ...
def exp(x: Array | float) -> Array | float:
    """Exponential of a number, or of each number of an array."""
    if compiled.core is None:
        return _as_given(np.exp(x), x)
    return _as_given(compiled.core.exp(_flat(x)), x)


@overload
def log(x: Array) -> Array: ...
@overload
def log(x: float) -> float: ...
def log(x: Array | float) -> Array | float:
    """Natural logarithm of a number, or of each number of an array; NaN of negative ones."""
    if compiled.core is None:
        with np.errstate(divide="ignore", invalid="ignore"):
            return _as_given(np.log(x), x)
    return _as_given(compiled.core.log(_flat(x)), x)


@overload
def power(x: Array, exponent: float) -> Array: ...
@overload
def power(x: float, exponent: float) -> float: ...
def power(x: Array | float, exponent: float) -> Array | float:
    """Raise a number, or each number of an array, none of them negative, to one exponent.

    Exponents 0, +-1/2, +-1 and +-2 are taken by arithmetic, the others as
    ``exp(exponent * log(x))``.
    """
    if compiled.core is None:
        with np.errstate(divide="ignore"):
            return _as_given(np.power(x, float(exponent)), x)
    return _as_given(compiled.core.power(_flat(x), float(exponent)), x)


@overload
def cosine(angle: Array) -> Array: ...
@overload
def cosine(angle: float) -> float: ...
def cosine(angle: Array | float) -> Array | float:
    """Cosine of an angle in radians, or of each angle of an array."""
    if compiled.core is None:
        return _as_given(np.cos(angle), angle)
    return _as_given(compiled.core.cosine(_flat(angle)), angle)


def angle_of(y: Array, x: Array) -> Array:
    """Angles in [-pi, pi] of vectors with the components `x` and `y`, arrays of one shape."""
    if compiled.core is None:
        return np.asarray(np.arctan2(y, x))
    return np.asarray(compiled.core.angle_of(_flat(y), _flat(x))).reshape(np.shape(x))


def _flat(x: Array | float) -> Array:
    return np.ascontiguousarray(x, dtype=np.float64).reshape(-1)


def _as_given(values: Array, x: Array | float) -> Array | float:
    """Return an array of the shape of `x`, or a float if that is a number."""
    if np.ndim(x) == 0:
        return float(np.reshape(values, ()))
    return np.asarray(values).reshape(np.shape(x))
