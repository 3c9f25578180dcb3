"""Scales that make fields of different units comparable."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..base.arrays import Floats
from ..recovery import Samples

Scale = str | float | Mapping[str, str | float]

SCALES = ("complexity", "range", "std", "none")


def check_scale(scale: Scale) -> None:
    """Raise ValueError if a scale of fields is unknown or not positive."""
    if isinstance(scale, Mapping):
        for name, one in scale.items():
            if one == "complexity":
                raise ValueError(f"scale of field '{name}': 'complexity' is for all fields or none")
            check_scale(one)
    elif isinstance(scale, str):
        if scale not in SCALES:
            raise ValueError(f"scale must be a number or one of {', '.join(SCALES)}, got {scale!r}")
    elif not (np.isfinite(scale) and scale > 0.0):
        raise ValueError(f"scale must be positive, got {scale}")


def scales_of(fields: Mapping[str, Samples], scale: Scale) -> dict[str, float]:
    """Return by what each field is divided; 1 for a constant field and "complexity".

    Raises
    ------
    ValueError
        If a dict of scales misses a field or names an unknown one.
    """
    if isinstance(scale, Mapping):
        wrong = set(scale) ^ set(fields)
        if wrong:
            raise ValueError(f"scale must have a value for each field: see {sorted(wrong)}")
        return {name: scale_of(one.columns, scale[name]) for name, one in fields.items()}
    return {name: scale_of(one.columns, scale) for name, one in fields.items()}


def scale_of(values: Floats, scale: str | float) -> float:
    """Return by what values (n,) or (n, k) are divided; 1 for constant ones and "complexity"."""
    if not isinstance(scale, str):
        return float(scale)
    if scale == "range":
        found = float(np.ptp(values, axis=0).max())
    elif scale == "std":
        found = float(values.std(axis=0).max())
    else:
        return 1.0
    return found if found > 0.0 else 1.0
