"""Job files: the polarcheck.toml, or pyproject.toml with [tool.polarcheck], that is nearest to a program."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

import msgspec

from polarcheck import bounded
from polarcheck.errors import JobError
from polarcheck.machines import toml_text
from polarcheck.machines.fitting import shown
from polarcheck.machines.job import Job, from_table
from polarcheck.reading.files import RealPaths

FILE_NAME = "polarcheck.toml"
_PROJECT = "pyproject.toml"


class JobFile(msgspec.Struct, frozen=True):
    """A job and where it was read; no path for a job that nobody wrote."""

    job: Job
    path: Path | None = None


class Nearest:
    """
    The job files of many programs and folders, the nearest from there upward; from the working folder where it lies
    below it. Each folder is looked into once, however deep it lies.
    """

    def __init__(self) -> None:
        self._real = RealPaths()
        self._known: dict[str, Path | None] = {}

    def of(self, path: Path) -> Path | None:
        """The job file of a program or folder. Raises JobError for a pyproject.toml that cannot be read."""
        try:
            found = self._from(self._real.folder(str(path if path.is_dir() else path.parent)))
        except (OSError, RuntimeError, ValueError):
            return None  # the folder itself cannot be entered; reading the program will say so
        return _from_here(found) if found is not None else None

    def _from(self, folder: str) -> Path | None:
        passed: list[str] = []
        while folder not in self._known:
            passed.append(folder)
            found, outer = _own(Path(folder)), os.path.dirname(folder)  # noqa: PTH120  long paths of pathlib are slow
            if found is not None or outer == folder:
                self._known[folder] = found
            else:
                folder = outer
        self._known.update(dict.fromkeys(passed, self._known[folder]))
        return self._known[folder]


def _from_here(path: Path) -> Path:
    """From the working folder where it lies below it."""
    with contextlib.suppress(OSError):  # the working folder may be gone
        if path.is_relative_to(Path.cwd()):
            return path.relative_to(Path.cwd())
    return path


def _own(folder: Path) -> Path | None:
    """The job file that lies in a folder."""
    if not bounded.may_read(folder):
        return None
    # A link that leads nowhere, a folder or a pipe of this name is told when it is read, and not passed over.
    if os.path.lexists(folder / FILE_NAME):
        return folder / FILE_NAME
    return folder / _PROJECT if _is_job_file(folder / _PROJECT) else None


def _is_job_file(project: Path) -> bool:
    if not project.is_file():
        return False
    try:
        text = bounded.read(project, toml_text.LARGEST, "no job file is")
    except OSError as error:
        raise JobError(f"{_from_here(project)}: {error.strerror}") from None
    if b"polarcheck" not in text:
        return False
    try:
        tools = toml_text.parsed(text.decode("utf-8").replace("\r\n", "\n")).get("tool")
    except ValueError:  # somebody else's fault, unless it is meant for us: reading it will say so
        return b"[tool.polarcheck" in text
    return isinstance(tools, dict) and "polarcheck" in tools


def load(path: Path, *, pipes: bool = False) -> Job:
    """
    The job of a polarcheck.toml or pyproject.toml, with its offset table; folders in it begin where the file lies.

    pipes: whether it may be a pipe, as a shell hands over `<(...)`. Raises JobError with file and key.
    """
    try:
        table: Any = toml_text.read(path, "job file", pipes=pipes)
    except ValueError as error:
        raise JobError(f"{path}: {error}") from None
    if path.name == _PROJECT:
        tools = table.get("tool", {})
        table = tools.get("polarcheck", {}) if isinstance(tools, dict) else {}
        if not isinstance(table, dict):
            raise JobError(f"{path}: tool.polarcheck: expected a table, found {shown(table)}")
    job = from_table(table, str(path))
    folders = [str(path.parent / folder) for folder in job.run.subprograms]
    for written, folder in zip(job.run.subprograms, folders, strict=True):
        _check_folder(folder, written, path)
    job = msgspec.structs.replace(job, run=msgspec.structs.replace(job.run, subprograms=folders))
    if job.offsets is not None:
        from polarcheck.machines import offset_table

        listed = offset_table.read(path.parent / job.offsets, f"{path}: offsets: {job.offsets}")
        job = msgspec.structs.replace(job, tools={**listed, **job.tools})
    return job


def _check_folder(folder: str, written: str, path: Path) -> None:
    try:
        os.scandir(folder).close()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        raise JobError(f"{path}: run.subprograms: there is no folder {shown(written)}") from None
    except OSError as error:
        raise JobError(f"{path}: run.subprograms: {shown(written)}: {error.strerror}") from None
