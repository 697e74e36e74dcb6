"""Refuses outputs that would overwrite a program, or any other file that the run reads."""

from __future__ import annotations

import os
import stat
from collections.abc import Mapping, Sequence
from pathlib import Path

from polarcheck.batch.tasks import Task
from polarcheck.errors import OutputError
from polarcheck.reading import files


class Inputs:
    """What a run reads: its programs, and the files of their settings."""

    def __init__(self, tasks: Sequence[Task]) -> None:
        inputs: dict[str, str] = {}
        self._folders: dict[str, str] = {}
        for task in tasks:
            path = task.place
            if path != files.STANDARD_INPUT:
                inputs[_real(path)] = path
            inputs |= {_real(path): str(path) for path in task.settings.read}
            self._folders |= {_real(folder): folder for folder in task.settings.job.run.subprograms}
        self._inputs = inputs
        self._same = {_identity(path): path for path in inputs.values()}

    def refuse(self, output: Path, named: str) -> None:
        """Raise OutputError for an output that would overwrite one of these files, or a called program."""
        target, shown = _real(output), files.shown(str(output))
        identity = _identity(output)
        source = self._inputs.get(target) or (self._same.get(identity) if identity else None)
        if source is not None:
            raise OutputError(f"{named}: {_beside(source, shown)}is read by this run; name another file")
        folder = self._folders.get(str(Path(target).parent))
        if folder is not None and Path(target).exists():
            raise OutputError(f"{named}: a file in {files.shown(folder)}, a folder of subprograms; name another one")


def refuse(outputs: Sequence[Path], tasks: Sequence[Task], options: Mapping[Path, str] | None = None) -> None:
    """
    Raise OutputError, before anything is checked or written, for a report that would overwrite a file of this run, a
    called program or another report, or that has the name of a program.

    options: the option that names an output, where it is not -o.
    """
    if not outputs:
        return
    from polarcheck.reading import walking

    inputs = Inputs(tasks)
    written: set[str] = set()
    for output in outputs:
        target = _real(output)
        named = f"{(options or {}).get(output, '-o')} {files.shown(str(output))}"
        inputs.refuse(output, named)
        if walking.has_name_of_program(target, walking.EXTENSIONS) or target.endswith(".toml"):
            raise OutputError(f"{named}: this is the name of a program or of a job file; give the report another")
        if target in written:
            raise OutputError(f"{named}: two reports would be written to this file")
        written.add(target)


def _beside(source: str, shown: str) -> str:
    other = files.shown(source)
    return "it " if other == shown else f"it is {other}, which "


def _real(path: str | Path) -> str:
    """Return the same path for all paths to a file; case is ignored on systems that ignore it."""
    return os.path.normcase(os.path.realpath(path))


def _identity(path: str | Path) -> tuple[int, int] | None:
    """Return the identity of a regular file, the same for all its names; None for other files or none."""
    try:
        status = Path(path).stat()
    except (OSError, ValueError):
        return None
    # Some network drives of Windows give no file numbers.
    return (status.st_dev, status.st_ino) if stat.S_ISREG(status.st_mode) and status.st_ino else None
