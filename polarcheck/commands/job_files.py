"""Job files: the polarcheck.toml, or pyproject.toml with [tool.polarcheck], that is nearest to a program."""

from __future__ import annotations

import contextlib
from pathlib import Path

import msgspec

from polarcheck.errors import JobError
from polarcheck.machines.job import Job, from_table

FILE_NAME = "polarcheck.toml"
_PROJECT = "pyproject.toml"


class JobFile(msgspec.Struct, frozen=True):
    """A job and where it was read; no path for a job that nobody wrote."""

    job: Job
    path: Path | None = None


def find(path: Path) -> Path | None:
    """
    The job file of a program or folder, the nearest from there upward; from the working folder where it lies below it.

    Raises JobError for a pyproject.toml that cannot be read.
    """
    try:
        found = _nearest(path.resolve() if path.is_dir() else path.resolve().parent)
    except (OSError, RuntimeError, ValueError):
        return None  # the folder itself cannot be entered; reading the program will say so
    with contextlib.suppress(OSError):  # the working folder may be gone
        if found is not None and found.is_relative_to(Path.cwd()):
            return found.relative_to(Path.cwd())
    return found


def _nearest(folder: Path) -> Path | None:
    for candidate in (folder, *folder.parents):
        if (candidate / FILE_NAME).is_file():
            return candidate / FILE_NAME
        if _is_job_file(candidate / _PROJECT):
            return candidate / _PROJECT
    return None


def _is_job_file(project: Path) -> bool:
    if not project.is_file():
        return False
    try:
        return "[tool.polarcheck" in project.read_text("utf-8", "replace")
    except OSError as error:
        raise JobError(f"{project}: {error}") from None


def load(path: Path) -> Job:
    """
    The job of a polarcheck.toml or pyproject.toml, with its offset table; folders in it begin where the file lies.

    Raises JobError with file and key.
    """
    import tomllib

    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise JobError(f"{path}: {error}") from None
    if path.name == _PROJECT:
        tools = table.get("tool", {})
        table = tools.get("polarcheck", {}) if isinstance(tools, dict) else {}
    job = from_table(table, str(path))
    folders = [str(path.parent / folder) for folder in job.run.subprograms]
    for written, folder in zip(job.run.subprograms, folders, strict=True):
        if not Path(folder).is_dir():
            raise JobError(f"{path}: run.subprograms: there is no folder {written!r}")
    job = msgspec.structs.replace(job, run=msgspec.structs.replace(job.run, subprograms=folders))
    if job.offsets is not None:
        from polarcheck.machines import offset_table

        listed = offset_table.read(path.parent / job.offsets, job.offsets)
        job = msgspec.structs.replace(job, tools={**listed, **job.tools})
    return job
