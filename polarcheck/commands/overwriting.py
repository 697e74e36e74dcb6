"""Refuses outputs that would overwrite a program, or any other file that the run has read or is going to read."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from polarcheck.files.batch.tasks import Task
from polarcheck.foundation.errors import OutputError
from polarcheck.program.reading import files


def folders_of(tasks: Sequence[Task]) -> dict[str, str]:
    """Return the folders of subprograms of the programs, by their real paths."""
    of_jobs = {id(task.settings): task.settings.job.run.subprograms for task in tasks}
    return {_real(folder): folder for folders in of_jobs.values() for folder in folders}


def refuse_input(output: Path, named: str, folders: Mapping[str, str]) -> None:
    """
    Raise OutputError for an output that would overwrite a file of the run, or a subprogram.

    named: the option and the output. folders: those of subprograms (folders_of).
    """
    if reason := files.read_by_this_run(output):
        raise OutputError(f"{named}: {reason}")
    target = Path(_real(output))
    folder = folders.get(str(target.parent))
    if folder is not None and target.exists():
        raise OutputError(f"{named}: a file in {files.display_path(folder)}, a folder of subprograms; name another one")


def refuse_name(output: str | Path, named: str) -> None:
    """Raise OutputError for an output with the name of a program, or of a job or machine file."""
    from polarcheck.program.reading import walking

    if walking.has_name_of_program(str(output), walking.EXTENSIONS) or str(output).endswith(".toml"):
        raise OutputError(f"{named}: this is the name of a program or of a job file; give the report another")


def refuse(outputs: Sequence[Path], tasks: Sequence[Task], options: Mapping[Path, str] | None = None) -> None:
    """
    Raise OutputError, before anything is checked or written, for a report that would overwrite a file of this run, a
    called program or another report, or that has the name of a program.

    What only the checks read is not known yet: `files.write` refuses that.

    options: the option that names an output, where it is not -o.
    """
    if not outputs:
        return
    folders = folders_of(tasks)
    places = {_real(task.place) for task in tasks}
    written: set[str] = set()
    for output in outputs:
        target = _real(output)
        named = f"{(options or {}).get(output, '-o')} {files.display_path(output)}"
        refuse_input(output, named, folders)
        if target in places:  # standard input is judged as a file that need not be there
            raise OutputError(f"{named}: it is read by this run; name another file")
        refuse_name(target, named)
        if target in written:
            raise OutputError(f"{named}: two reports would be written to this file")
        written.add(target)


def _real(path: str | Path) -> str:
    """Return the same path for all paths to a file; case is ignored on systems that ignore it."""
    return os.path.normcase(os.path.realpath(path))
