"""A report never takes the place of a program, nor of anything else that was read for it."""

from __future__ import annotations

import os
import stat
from collections.abc import Sequence
from pathlib import Path

from polarcheck.batch.tasks import Task
from polarcheck.errors import OutputError
from polarcheck.reading import files


def refuse(outputs: Sequence[Path], tasks: Sequence[Task]) -> None:
    """
    Raises OutputError, before anything is checked or written, for a report that would take the place of a file of this
    run, of a called program or of another report, or that has the name of a program.
    """
    if not outputs:
        return
    read: dict[str, str] = {}
    folders: dict[str, str] = {}
    for task in tasks:
        path = task.place
        if path != files.STANDARD_INPUT:
            read[_real(path)] = path
        read |= {_real(path): str(path) for path in task.settings.read}
        folders |= {_real(folder): folder for folder in task.settings.job.run.subprograms}
    same = {_identity(path): path for path in read.values()}
    written: set[str] = set()
    for output in outputs:
        target, shown = _real(output), files.shown(str(output))
        identity = _identity(output)
        found = read.get(target) or (same.get(identity) if identity else None)
        if found is not None:
            raise OutputError(f"-o {shown}: {_beside(found, shown)}is read by this run; name another file")
        folder = folders.get(str(Path(target).parent))
        if folder is not None and Path(target).exists():
            raise OutputError(f"-o {shown}: a file in {files.shown(folder)}, a folder of subprograms; name another one")
        if files.has_name_of_program(target, files.EXTENSIONS) or target.endswith(".toml"):
            raise OutputError(f"-o {shown}: this is the name of a program or of a job file; give the report another")
        if target in written:
            raise OutputError(f"-o {shown}: two reports would be written to this file")
        written.add(target)


def _beside(found: str, shown: str) -> str:
    other = files.shown(found)
    return "it " if other == shown else f"it is {other}, which "


def _real(path: str | Path) -> str:
    """One path for all that lead to a file, in any case where case tells no files apart."""
    return os.path.normcase(os.path.realpath(path))


def _identity(path: str | Path) -> tuple[int, int] | None:
    """Return device and inode of a file; None if it does not exist, or is a device, which cannot be overwritten."""
    try:
        status = Path(path).stat()
    except (OSError, ValueError):
        return None
    # Some network drives of Windows number nothing.
    return (status.st_dev, status.st_ino) if stat.S_ISREG(status.st_mode) and status.st_ino else None
