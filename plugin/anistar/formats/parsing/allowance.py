"""How much memory a file may take by what it says, rather than by what it holds."""

from __future__ import annotations

# Constant fields shrink a thousandfold when they are compressed, but the points and cells beside
# them hardly tenfold; data on a few elements are spread over all of them.
LARGEST_EXPANSION = 100
_ALWAYS = 64 * 2**20


class Allowance:
    """Counts the bytes of arrays that are longer than their part of the file.

    Parameters
    ----------
    n_bytes : int
        Length of the file. Arrays may take `LARGEST_EXPANSION` times as much, or 64 MiB.
    """

    def __init__(self, n_bytes: int) -> None:
        self._left = max(_ALWAYS, LARGEST_EXPANSION * n_bytes)

    def spend(self, n_bytes: int) -> None:
        """Count an array before it is made.

        Raises
        ------
        ValueError
            If it is too much for the file.
        """
        self._left -= n_bytes
        if self._left < 0 or n_bytes < 0:
            raise ValueError(f"its arrays take more than {LARGEST_EXPANSION} times its length")
