"""The programs of a run whose report may have changed: since a commit (--diff-base), or by files (--with-callers)."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Sequence

from polarcheck.checking.settings import Settings
from polarcheck.files import git
from polarcheck.files.batch.tasks import Task
from polarcheck.foundation import bounded
from polarcheck.foundation.errors import SourceError, TooHardError, UsageError
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.execution.dependence import calls_one_of
from polarcheck.program.machines import toml_text
from polarcheck.program.machines.job import FILE_NAME, PROJECT
from polarcheck.program.reading import files, source, walking

#: Returns what the job files of a program were looked for by (OfPrograms.looked_for).
LookedFor = Callable[[str], Iterable[str]]


class Changes:
    """
    The programs that changed files concern.

    A program is concerned if anything has changed that finding, resolving and checking it reads, lists or looks for, or
    a link on the path to that: where nothing has, the state before would have given the same report.
    """

    def __init__(self, difference: git.Difference, ref: git.Reference, looked_for: LookedFor) -> None:
        """difference: the changed files. ref: the commit that it is a difference to."""
        self._difference, self._ref, self._looked_for = difference, ref, looked_for
        self._names: dict[str, set[str]] = {}
        for path in difference.paths:
            folder, name = os.path.split(path)
            self._names.setdefault(folder, set()).add(name)
        self._of_paths: dict[str, bool] = {}
        self._below: dict[str, bool] = {}
        self._of_settings: dict[int, bool] = {}
        self._of_folders: dict[str, set[str]] = {}

    def concerned(self, tasks: Sequence[Task], most: int) -> list[Task]:
        """
        Return the concerned ones of the programs of a run, in their order.

        most: largest program that is read [bytes].
        """
        if not self._difference.paths:
            return [task for task in tasks if task.path == files.STANDARD_INPUT]
        return [task for task in tasks if self._concern(task, most) or self._uncover(task, tasks)]

    def _concern(self, task: Task, most: int) -> bool:
        """Return True for a concerned program; standard input, and a file that cannot be read, count as changed."""
        return (
            task.path == files.STANDARD_INPUT
            or self._touch(task.path)
            or self._concern_settings(task.settings)
            or any(map(self._touch, self._looked_for(task.place)))
            or self._concern_called(task, most)
        )

    def _uncover(self, task: Task, tasks: Sequence[Task]) -> bool:
        """
        Return True for a file that is a program by its look, where it may have been an offset table of any job before.
        """
        return walking.is_by_look(task.path) and (
            any(self._concern_settings(candidate.settings) for candidate in tasks)
            or not all(map(os.path.lexists, self._difference.paths))
            or any(map(self._was_job_file, self._difference.paths))
        )

    def _was_job_file(self, path: str) -> bool:
        """Return True for a changed file that may have been a job file before."""
        is_new = not self._difference.former.get(path, ("", "?"))[1].strip("0")
        return os.path.basename(path) in (FILE_NAME, PROJECT) and not is_new and not self._is_no_job_file(path)  # noqa: PTH119

    def _concern_settings(self, settings: Settings) -> bool:
        if id(settings) not in self._of_settings:
            self._of_settings[id(settings)] = any(map(self._touch, settings.read))
        return self._of_settings[id(settings)]

    def _touch(self, path: str) -> bool:
        """Return True if a file or folder has changed, or a link on the path to it."""
        if path not in self._of_paths:
            *links, real = files.trail(path)
            self._of_paths[path] = any(map(self._is_changed, links)) or (
                self._is_changed(real) and not self._is_no_job_file(real)
            )
        return self._of_paths[path]

    def _is_changed(self, path: str) -> bool:
        """Return True for a changed path, and below one: what is a folder now may have been a link or a submodule."""
        return path in self._difference.paths or self._is_below_changed(os.path.dirname(path))  # noqa: PTH120

    def _is_below_changed(self, folder: str) -> bool:
        if folder not in self._below:
            outer = os.path.dirname(folder)  # noqa: PTH120
            is_below = outer != folder and self._is_below_changed(outer)
            self._below[folder] = is_below or folder in self._difference.paths
        return self._below[folder]

    def _is_no_job_file(self, path: str) -> bool:
        """Return True for a pyproject.toml that has nothing for polarcheck, and had nothing before."""
        if os.path.basename(path) != PROJECT or path not in self._difference.former:  # noqa: PTH119
            return False
        before = git.content(*self._difference.former[path], self._ref)
        try:
            now = bounded.read_file(path, toml_text.LARGEST, "")
        except OSError:
            return False
        return before is not None and not any(b"polarcheck" in text.replace(b"\0", b"") for text in (before, now))

    def _concern_called(self, task: Task, most: int) -> bool:
        settings = task.settings
        folders = settings.job.run.subprograms
        names = set().union(*(self._in_folder(folder) for folder in folders))
        if not names:
            return False
        try:
            data = files.read_program(task.path, most)
            with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
                text = source.read_source(data, task.path, settings.encoding)
                return calls_one_of(text, settings.machine, folders, names)
        except (SourceError, TooHardError, MemoryError):
            return True

    def _in_folder(self, folder: str) -> set[str]:
        """Return the names of changed files in a folder of subprograms, and of links that lead to changed files."""
        real = os.path.normcase(os.path.realpath(folder))
        if real not in self._of_folders:
            names = set(self._names.get(real, ()))
            try:
                links = [entry for entry in os.scandir(real) if entry.is_symlink()]
            except OSError:
                links = []
            names.update(entry.name for entry in links if self._touch(entry.path))
            self._of_folders[real] = names
        return self._of_folders[real]


def since(name: str, tasks: Sequence[Task], looked_for: LookedFor, most: int = files.LARGEST) -> list[Task]:
    """
    Return the tasks whose report may have changed since a commit, in their order.

    Raises UsageError for a program outside of any repository, and if git fails.
    """
    ref = git.Reference("--diff-base", name)
    repositories = git.Repositories(files.RealPaths())
    roots: set[str] = set()
    for task in tasks:
        if task.path == files.STANDARD_INPUT:
            continue
        root = repositories.root(os.path.dirname(task.path))  # noqa: PTH120
        if root is None:
            raise UsageError(f"{ref}: {files.display_path(task.path)} lies in no git repository")
        roots.add(root)
    difference = git.none()
    for root in sorted({*roots, *_around(roots, repositories, ref)}, key=len):
        if os.path.normcase(root) not in difference.repositories:
            difference.add(git.changed(root, name, [os.path.normcase(inner) for inner in roots]))
    return Changes(difference, ref, looked_for).concerned(tasks, most)


def _around(roots: Collection[str], repositories: git.Repositories, ref: git.Reference) -> list[str]:
    """Return the repository of the working folder, if one of these is a submodule of it: the commit is one of it."""
    here = repositories.root(os.curdir)
    if here is None or here in roots:
        return []
    inside = [root for root in roots if root.startswith(os.path.join(here, ""))]  # noqa: PTH118
    return [here] if any(git.holds_submodule(here, root, ref) for root in inside) else []


def by_files(
    names: Sequence[str],
    tasks: Sequence[Task],
    looked_for: LookedFor,
    option: str,
    before: str,
    most: int = files.LARGEST,
) -> list[Task]:
    """
    Return the tasks whose report a change of these files may change, in their order.

    In a git repository, all that the next commit changes against the commit `before` counts, whether it is named or
    not, and programs that the next commit does not hold are left out. option: for messages.

    Raises UsageError if git fails.
    """
    real = files.RealPaths()
    ref = git.Reference(f"{option}:", before)
    named = {real.of(name) for name in names}
    root = git.Repositories(real).root(os.curdir)
    difference, in_git = git.none(), None
    if root is not None:
        difference = git.staged(root, ref)
        in_git = git.tracked(root, ref) | named
    difference.paths.update(named, *(files.trail(name) for name in names))
    concerned = Changes(difference, ref, looked_for).concerned(tasks, most)
    return [task for task in concerned if in_git is None or real.of(task.path) in in_git]
