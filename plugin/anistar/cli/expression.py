"""Functions of the coordinates given as text, without the dangers of `eval`."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from ..base.arrays import Floats

_NAMES = ("x", "y", "z")
_CONSTANTS = {"pi": np.pi, "e": np.e}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    name: getattr(np, name)
    for name in ("sin", "cos", "tan", "tanh", "sinh", "cosh", "exp", "log", "sqrt", "arctan")
}
_FUNCTIONS |= {"abs": np.abs, "minimum": np.minimum, "maximum": np.maximum}
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def function_of_position(text: str) -> Callable[[Floats], Floats]:
    """Return the function of (q, d) points that the text describes.

    Parameters
    ----------
    text : str
        Python arithmetic in ``x``, ``y``, ``z``, ``pi``, ``e`` and the usual functions, for
        instance ``"tanh(20 * (x - 0.5))"``.

    Raises
    ------
    ValueError
        If the text is anything else; the message names the part.
    """
    try:
        tree = ast.parse(text, mode="eval").body
    except SyntaxError as error:
        raise ValueError(f"cannot understand {text!r}: {error.msg}") from error

    def evaluated(points: Floats) -> Floats:
        places = dict(zip(_NAMES, np.moveaxis(points, -1, 0), strict=False))
        # Whoever gets the values looks for NaN and infinity, and can say where they are.
        with np.errstate(all="ignore"):
            value = np.asarray(_value(tree, places), dtype=np.float64)
        return np.broadcast_to(value, points.shape[:-1])

    evaluated(np.full((1, 3), 0.5))
    return evaluated


def _value(node: ast.expr, places: dict[str, Floats]) -> Any:
    match node:
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.Name(id=name) if name in places:
            return places[name]
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return _BINARY[type(op)](_value(left, places), _value(right, places))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, places)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*(_value(arg, places) for arg in args))
    raise ValueError(f"{ast.unparse(node)!r} is not allowed in an expression")
