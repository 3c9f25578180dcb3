"""The lines of a text file, with their numbers for messages."""

from __future__ import annotations

from collections.abc import Iterator


class Lines:
    """Goes through the lines that say something; what is behind a mark is a comment.

    Parameters
    ----------
    data : bytes
    comment : str
        The mark, empty if there is none.
    continuation : str
        What a line ends with that goes on in the next one, empty if there is nothing like it.
    """

    def __init__(self, data: bytes, *, comment: str = "#", continuation: str = "") -> None:
        self._lines = data.decode("utf-8", errors="replace").splitlines()
        self._comment = comment
        self._continuation = continuation
        self._at = 0

    @property
    def number(self) -> int:
        """Of the line that was read last, from 1."""
        return self._at

    def next(self) -> list[str]:
        """Return the words of the next line that has any.

        Raises
        ------
        ValueError
            If there is none.
        """
        words = self.next_or_none()
        if words is None:
            raise ValueError(f"it is truncated: more is announced than its {self._at} lines")
        return words

    def next_or_none(self) -> list[str] | None:
        """Return the words of the next line that has any, None at the end."""
        while self._at < len(self._lines):
            line = self._next_joined()
            words = (line.partition(self._comment)[0] if self._comment else line).split()
            if words:
                return words
        return None

    def _next_joined(self) -> str:
        line = self._lines[self._at]
        self._at += 1
        if not self._continuation:
            return line
        parts = []
        while line.endswith(self._continuation) and self._at < len(self._lines):
            parts.append(line.removesuffix(self._continuation))
            line = self._lines[self._at]
            self._at += 1
        return " ".join([*parts, line])

    def __iter__(self) -> Iterator[list[str]]:
        while (words := self.next_or_none()) is not None:
            yield words

    def counts(self, n: int) -> list[int]:
        """Return the numbers of things in the next line, 0 for those that it does not have."""
        return [*self.integers(self.next()), *([0] * n)][:n]

    def integers(self, words: list[str]) -> list[int]:
        """Return words as integers."""
        return [self.integer(word) for word in words]

    def integer(self, word: str) -> int:
        """Return a word as an integer."""
        try:
            return int(word)
        except ValueError:
            raise self.error(f"{word[:40]!r} in the place of an integer") from None

    def floats(self, words: list[str]) -> list[float]:
        """Return words as numbers."""
        try:
            return [float(word) for word in words]
        except ValueError:
            listed = " ".join(words)
            raise self.error(f"{listed[:60]!r} in the place of numbers") from None

    def error(self, reason: str) -> ValueError:
        """Return an error at the line that was read last."""
        return ValueError(f"line {self._at}: {reason}")
