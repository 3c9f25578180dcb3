"""A terminal in memory, with what the bars ask of one."""

import re

_WORDS = re.compile(r"\x1b\[[\d;]*([A-Za-z])|\x1b([78D])|(\r)|(\n)|([^\x1b\r\n]+)")


class Terminal:
    """Shows what is written to it, `lines`, and keeps what is scrolled out of them, `gone`."""

    def __init__(self, height=6):
        self.lines, self.gone = [""] * height, []
        self.row = self.column = 0
        self.kept = (0, 0)
        self.encoding = "utf-8"

    @property
    def text(self):
        """All that stands there, without the empty lines at the end."""
        return "\n".join(line.rstrip() for line in [*self.gone, *self.lines]).rstrip("\n")

    def isatty(self):
        return True

    def flush(self):
        pass

    def write(self, text):
        for moved, escaped, back, down, written in _WORDS.findall(text):
            if written:
                line = self.lines[self.row].ljust(self.column)
                rest = line[self.column + len(written) :]
                self.lines[self.row] = line[: self.column] + written + rest
                self.column += len(written)
            elif back:
                self.column = 0
            elif down:
                self.column = 0
                self._scroll()
            else:
                self._do(moved or escaped)

    def _do(self, word):
        if word == "A":
            self.row -= 1
        elif word == "J":
            self.lines[self.row] = self.lines[self.row][: self.column]
            self.lines[self.row + 1 :] = [""] * (len(self.lines) - self.row - 1)
        elif word == "7":
            self.kept = self.row, self.column
        elif word == "8":
            self.row, self.column = self.kept
        elif word == "D":
            self._scroll()
        else:
            assert word == "m", f"this terminal does not know {word}"

    def _scroll(self):
        if self.row + 1 < len(self.lines):
            self.row += 1
        else:
            self.gone.append(self.lines.pop(0))
            self.lines.append("")
