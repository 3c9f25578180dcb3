"""A loop on disk: every finished step, so that a loop that was killed can go on."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import FormatError
from .formats import read, write
from .formats.atomic import remove_leftovers
from .loop import Loop, Step
from .report import as_builtin, write_json
from .series import member, write_index

SERIES = "series.pvd"
REPORT = "report.json"
RUNNING = "running"


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
        What the loop depends on, JSON builtins; a loop that goes on must have the same.

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

    def begin(self) -> None:
        """Forget an earlier run in this folder: none of its steps is one of this run."""
        (self.folder / REPORT).unlink(missing_ok=True)
        remove_leftovers(self.folder)

    def save(self, step: Step) -> None:
        """Add a finished step."""
        number = len(self.steps)
        write(member(self.folder / SERIES, number), step.mesh, step.fields)
        self.steps.append(step)
        write_index(self.folder / SERIES, range(len(self.steps)))
        self._report(Loop(tuple(self.steps), RUNNING))

    def close(self, loop: Loop) -> None:
        """Record why the loop stopped; a step that could not be saved is not one of it."""
        self._report(Loop(tuple(self.steps), loop.stop_reason))

    def load(self) -> list[Step]:
        """Return the finished steps of an earlier run in this folder, none if there was none.

        Raises
        ------
        ValueError
            If that run had other settings; names the first that differs.
        FormatError
            If its files are damaged.
        """
        path = self.folder / REPORT
        remove_leftovers(self.folder)
        if not path.is_file():
            return []
        try:
            report = json.loads(path.read_text(encoding="utf-8"))
            recorded, settings = report["steps"], report["settings"]
        except (ValueError, KeyError, TypeError) as error:
            raise FormatError(f"{path} is no report of a loop: {error}") from error
        self._require_same(settings)
        self.steps = [self._step(number, said) for number, said in enumerate(recorded)]
        return list(self.steps)

    def _require_same(self, settings: Mapping[str, Any]) -> None:
        for name in sorted(settings.keys() | self.settings.keys()):
            before, now = settings.get(name), self.settings.get(name)
            if before != now:
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
            fields=dict(fields),
            metric=None,
            report=None if said["report"] is None else RecordedReport(said["report"]),
            qoi=said["qoi"],
            error=said["error"],
            seconds=said["seconds"],
        )

    def _report(self, loop: Loop) -> None:
        write_json(self.folder / REPORT, {"settings": self.settings, **loop.as_dict()})
