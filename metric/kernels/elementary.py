"""Elementary functions whose last bit does not depend on the CPU."""

from __future__ import annotations

from typing import overload

import numpy as np

from ..base.arrays import Floats
from . import compiled


@overload
def exp(x: Floats) -> Floats: ...
@overload
def exp(x: float) -> float: ...
def exp(x: Floats | float) -> Floats | float:
    """Exponential of a number, or of each number of an array."""
    if compiled.core is None:
        return _as_given(np.exp(x), x)
    return _as_given(compiled.core.exp(_flat(x)), x)


@overload
def log(x: Floats) -> Floats: ...
@overload
def log(x: float) -> float: ...
def log(x: Floats | float) -> Floats | float:
    """Natural logarithm of a number, or of each number of an array; NaN of negative ones."""
    if compiled.core is None:
        with np.errstate(divide="ignore", invalid="ignore"):
            return _as_given(np.log(x), x)
    return _as_given(compiled.core.log(_flat(x)), x)


@overload
def power(x: Floats, exponent: float) -> Floats: ...
@overload
def power(x: float, exponent: float) -> float: ...
def power(x: Floats | float, exponent: float) -> Floats | float:
    """Raise a number, or each number of an array, none of them negative, to one exponent.

    Exponents 0, +-1/2, +-1 and +-2 are taken by arithmetic, the others as
    ``exp(exponent * log(x))``.
    """
    if compiled.core is None:
        with np.errstate(divide="ignore"):
            return _as_given(np.power(x, float(exponent)), x)
    return _as_given(compiled.core.power(_flat(x), float(exponent)), x)


@overload
def cosine(angle: Floats) -> Floats: ...
@overload
def cosine(angle: float) -> float: ...
def cosine(angle: Floats | float) -> Floats | float:
    """Cosine of an angle in radians, or of each angle of an array."""
    if compiled.core is None:
        return _as_given(np.cos(angle), angle)
    return _as_given(compiled.core.cosine(_flat(angle)), angle)


def angle_of(y: Floats, x: Floats) -> Floats:
    """Angles in [-pi, pi] of vectors with the components `x` and `y`, arrays of one shape."""
    if compiled.core is None:
        return np.asarray(np.arctan2(y, x))
    return np.asarray(compiled.core.angle_of(_flat(y), _flat(x))).reshape(np.shape(x))


def _flat(x: Floats | float) -> Floats:
    return np.ascontiguousarray(x, dtype=np.float64).reshape(-1)


def _as_given(values: Floats, x: Floats | float) -> Floats | float:
    """Return an array of the shape of `x`, or a float if that is a number."""
    if np.ndim(x) == 0:
        return float(np.reshape(values, ()))
    return np.asarray(values).reshape(np.shape(x))
