"""What functions with options have in common."""

from __future__ import annotations


def require(kind: type, **given: object) -> None:
    """Raise if a value is not of the class of options it should be.

    Raises
    ------
    TypeError
        Names the argument and what it is.
    """
    for name, value in given.items():
        if not isinstance(value, kind):
            hint = ""
            if isinstance(value, dict) and hasattr(kind, "from_dict"):
                hint = f": {kind.__name__}.from_dict takes a dict"
            raise TypeError(f"{name} must be {kind.__name__}, not {type(value).__name__}{hint}")
