"""Run the code of pages, and put what it prints and draws into them.

The blocks of Python of a page form one script. What one of them prints stands right below it in a
block of text, and a picture that the page shows is one that the script leaves. Run it in the
folder of the repository::

    python docs/run_pages.py docs/tutorial.md docs/cad.md
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

COLOURS, PIXELS = 128, 800
MARK = "\x1e"
# What Python prints; libraries in C have words of their own, which go to the process's output.
RUN = (
    "import runpy, sys; sys.stdout = open('printed.txt', 'w'); "
    "runpy.run_path('script.py'); sys.stdout.close()"
)
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL)


def shown(page: Path) -> list[str]:
    """Return what a page says that each of its blocks prints."""
    return [block[2] or "" for block in BLOCK.finditer(page.read_text())]


def printed(page: Path, folder: Path) -> list[str]:
    """Run the blocks of a page in a folder, warnings being errors, and return what each prints.

    Raises
    ------
    RuntimeError
        If the script fails; the message is what it left on stderr.
    """
    codes = [block[1] for block in BLOCK.finditer(page.read_text())]
    (folder / "script.py").write_text(f"\nprint({MARK!r}, end='')\n".join(codes))
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", RUN],
        cwd=folder,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"{page}: {done.stderr}")
    return (folder / "printed.txt").read_text().split(MARK)


def filled(text: str, outputs: list[str]) -> str:
    """Return the text of a page with what its blocks print in the blocks below them."""
    remaining = iter(outputs)

    def with_output(block: re.Match[str]) -> str:
        code, output = f"```python\n{block[1]}```\n", next(remaining)
        return f"{code}\n```text\n{output}```\n" if output else code

    return BLOCK.sub(with_output, text)


def pictures(page: Path) -> list[str]:
    """Return the names of the pictures that a page shows."""
    return re.findall(r"images/([\w-]+\.png)", page.read_text())


def keep_pictures(page: Path, folder: Path) -> None:
    """Put the pictures that a page shows and its script has drawn beside those of the pages."""
    for name in pictures(page):
        if (folder / name).exists():
            with Image.open(folder / name) as drawn:
                drawn.thumbnail((PIXELS, PIXELS))
                drawn.convert("RGB").quantize(COLOURS).save(
                    page.parent / "images" / name, optimize=True
                )


def main(pages: list[str]) -> None:
    """Run each page, and write it anew."""
    for page in map(Path, pages):
        with tempfile.TemporaryDirectory() as folder:
            page.write_text(filled(page.read_text(), printed(page, Path(folder))))
            keep_pictures(page, Path(folder))


if __name__ == "__main__":
    main(sys.argv[1:])
