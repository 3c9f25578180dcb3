"""A loop on disk: every finished step, so that a loop that was killed can go on."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..base.errors import FormatError
from ..base.report import as_builtin, write_json
from ..formats import read, write
from ..judging.cell_arrays import without_certificate
from ..loops.loop import Loop, Step
from .file_solver import FILE_KINDS, exchanged_files
from .lock import locked
from .own_files import OwnFiles
from .series import item_of, member, write_index

SERIES = "series.pvd"
REPORT = "report.json"
RUNNING = "running"

# Stands for a setting that only one of two versions has.
ABSENT = "no setting"

# Regular expressions of the names of the files that every loop writes.
LOOP_FILES = (re.escape(REPORT), re.escape(SERIES), r"series_\d{3,}\.vtu")


@dataclass(frozen=True)
class RecordedReport:
    """What a report said when it was written."""

    content: Mapping[str, Any]

    def as_dict(self) -> dict[str, Any]:
        """Return JSON builtins only."""
        return dict(self.content)


class RunFolder:
    """The folder of a loop: meshes and fields as VTU, and a report that lists what is finished.

    A step is written to a file of its own first and listed in the report afterwards, each under
    a temporary name that is then moved. So the report never names what is not there, whenever
    the process is killed.

    Parameters
    ----------
    folder : path
        Is made if it does not exist.
    settings : mapping
        What the loop depends on, JSON builtins; a loop that goes on must have the same. Where
        it has a `format`, the files that a `FileSolver` of that kind exchanges belong to the
        run as well.

    Attributes
    ----------
    steps : list of Step
        Those that are saved.
    """

    def __init__(self, folder: str | Path, settings: Mapping[str, Any]) -> None:
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.settings = as_builtin(settings)
        self.steps: list[Step] = []

    def locked(self) -> AbstractContextManager[None]:
        """Keep other runs out of the folder, see `anistar.runs.lock`."""
        return locked(self.folder)

    def begin(self, *, force: bool = False, keep: Iterable[str | Path] = ()) -> int:
        """Start a new run, which has no step of an earlier one.

        Parameters
        ----------
        force : bool
            Remove the files of an earlier run. Files that no run writes always stay.
        keep : iterable of path
            Files that must not be removed, such as the first mesh.

        Returns
        -------
        int
            How many files were removed.

        Raises
        ------
        FormatError
            If the folder holds files that the run would write, and not `force`, or one of them
            is in `keep`.
        """
        own, removed = self._own_files(self.settings), 0
        own.remove_leftovers()
        if force:
            removed = self._own_files(self.settings, self._earlier_settings()).remove(keep)
        else:
            own.require_none("--resume goes on with it, --force replaces it")
        # before any other file, so that what has none was left by something else
        self._report(Loop((), RUNNING))
        return removed

    def _own_files(self, *settings: Mapping[str, Any]) -> OwnFiles:
        given = [entry.get("format") for entry in settings]
        kinds = [kind for kind in FILE_KINDS if kind in given]
        exchanged = [pattern for kind in kinds for pattern in exchanged_files(kind)]
        return OwnFiles(self.folder, [*LOOP_FILES, *exchanged])

    def _earlier_settings(self) -> Mapping[str, Any]:
        """Return the settings of the run that is replaced, nothing where its report is damaged."""
        path = self.folder / REPORT
        try:
            with _understood(path):
                return dict(json.loads(path.read_text(encoding="utf-8"))["settings"])
        except (OSError, FormatError):
            return {}

    def save(self, step: Step) -> None:
        """Add a finished step."""
        number = len(self.steps)
        write(member(self.folder / SERIES, number), *item_of(step))
        self.steps.append(step)
        write_index(self.folder / SERIES, range(len(self.steps)))
        self._report(Loop(tuple(self.steps), RUNNING))

    def close(self, loop: Loop) -> None:
        """Record why the loop stopped; a step that could not be saved is not one of it."""
        self._report(Loop(tuple(self.steps), loop.stop_reason))

    def load(self) -> list[Step]:
        """Return the finished steps of an earlier run in this folder, or begin one.

        Raises
        ------
        ValueError
            If that run had other settings, or was made by another version that had no such
            setting; names the first that differs.
        FormatError
            If its files are damaged, or there are some, but no report.
        """
        path = self.folder / REPORT
        own = self._own_files(self.settings)
        own.remove_leftovers()
        if not path.is_file():
            own.require_none(f"there is no {REPORT} to resume from, --force replaces it")
            self._report(Loop((), RUNNING))
            return []
        with _understood(path):
            report = json.loads(path.read_text(encoding="utf-8"))
            recorded, settings = list(report["steps"]), dict(report["settings"])
        self._require_same(settings)
        with _understood(path):
            self.steps = [self._step(number, said) for number, said in enumerate(recorded)]
        return list(self.steps)

    def _require_same(self, settings: Mapping[str, Any]) -> None:
        for name, before, now in _differences(settings, self.settings):
            if ABSENT in (before, now):
                raise ValueError(
                    f"the run in {self.folder} is of another version of anistar: {name} was "
                    f"{before} then and is {now} now; turn it off, or choose another folder"
                )
            raise ValueError(
                f"the run in {self.folder} has {name} = {before!r}, not {now!r}: "
                "resume with the same, or choose another folder"
            )

    def _step(self, number: int, said: Mapping[str, Any]) -> Step:
        mesh, fields = read(member(self.folder / SERIES, number))
        return Step(
            iteration=said["iteration"],
            complexity=said["complexity"],
            mesh=mesh,
            fields=without_certificate(fields),
            metric=None,
            report=None if said["report"] is None else RecordedReport(said["report"]),
            qoi=said["qoi"],
            error=said["error"],
            seconds=said["seconds"],
            settled=said.get("settled", False),  # which earlier versions did not know
        )

    def _report(self, loop: Loop) -> None:
        write_json(self.folder / REPORT, {"settings": self.settings, **loop.as_dict()})


def _differences(before: Any, now: Any, name: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Give the name of each setting that differs, as ``options.metric.p``, and both values."""
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        for key in sorted(before.keys() | now.keys()):
            inner = f"{name}.{key}" if name else key
            yield from _differences(before.get(key, ABSENT), now.get(key, ABSENT), inner)
    elif before != now and not (before in (ABSENT, None) and now in (ABSENT, None)):
        yield name, before, now


@contextmanager
def _understood(path: Path) -> Iterator[None]:
    """Name the report in what goes wrong when it is read."""
    try:
        yield
    except FormatError:  # of a mesh, which it names
        raise
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        reason = f"it lacks {error}" if isinstance(error, KeyError) else str(error)
        raise FormatError(f"{path} is no report of a loop: {reason}") from error
