"""The programs of a run whose report may have changed: since a commit (--diff-base), or by files (--with-callers)."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence

from polarcheck.batch.tasks import Task
from polarcheck.checking.settings import Settings
from polarcheck.errors import SourceError, TooHardError, UsageError
from polarcheck.execution.dependence import calls_one_of
from polarcheck.machines.job import FILE_NAME
from polarcheck.reading import files, git, source
from polarcheck.time_limit import seconds_for, time_limit


class Changes:
    """The programs that changed files concern: these themselves, and those that call them or are judged by them."""

    def __init__(self, paths: Collection[str], real: files.RealPaths) -> None:
        """paths: the changed files, as real.of names them; they need not be there."""
        self._real = real
        self._paths = frozenset(paths)
        self._names: dict[str, set[str]] = {}
        for path in self._paths:
            folder, name = os.path.split(path)
            self._names.setdefault(folder, set()).add(name)
        #: Folders whose job file was deleted: another one applies to the programs below them now.
        self._without_job = [
            os.path.join(folder, "")  # noqa: PTH118
            for folder, names in self._names.items()
            if FILE_NAME in names and not os.path.lexists(os.path.join(folder, FILE_NAME))  # noqa: PTH118
        ]
        self._of_settings: dict[int, bool] = {}
        self._of_folders: dict[str, set[str]] = {}

    def concern(self, task: Task, most: int = files.LARGEST) -> bool:
        """
        True if a program has changed, or its job file, machine file, offset table, or a program that it calls.

        most: largest program that is read [bytes].

        Standard input counts as changed. So does a file that cannot be read: its check says why.
        """
        if task.path == files.STANDARD_INPUT or self._has(task.path) or self._concern_settings(task.settings):
            return True
        real = self._real.of(task.path)
        return any(real.startswith(folder) for folder in self._without_job) or self._concern_called(task, most)

    def _has(self, path: str) -> bool:
        """True for a changed path; a link has changed if it or its target has."""
        folder, name = os.path.split(path)
        beside = os.path.join(self._real.folder(folder or os.curdir), name)  # noqa: PTH118
        return self._real.of(path) in self._paths or os.path.normcase(beside) in self._paths

    def _concern_settings(self, settings: Settings) -> bool:
        if id(settings) not in self._of_settings:
            self._of_settings[id(settings)] = any(self._has(str(path)) for path in settings.read)
        return self._of_settings[id(settings)]

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
        """The names of changed files in a folder of subprograms, and of links to changed files."""
        real = os.path.normcase(os.path.realpath(folder))
        if real not in self._of_folders:
            names = set(self._names.get(real, ()))
            try:
                links = [entry for entry in os.scandir(real) if entry.is_symlink()]
            except OSError:
                links = []
            names.update(entry.name for entry in links if self._real.of(entry.path) in self._paths)
            self._of_folders[real] = names
        return self._of_folders[real]


def since(ref: str, tasks: Sequence[Task], most: int = files.LARGEST) -> list[Task]:
    """
    The tasks whose report may have changed since a commit, in their order.

    Raises UsageError for a program outside of any repository, and if git fails.
    """
    real = files.RealPaths()
    repositories = git.Repositories(real)
    roots: dict[str, None] = {}
    for task in tasks:
        if task.path == files.STANDARD_INPUT:
            continue
        root = repositories.root(os.path.dirname(task.path))  # noqa: PTH120
        if root is None:
            raise UsageError(f"--diff-base {ref}: {files.shown(task.path)} lies in no git repository")
        roots[root] = None
    changes = Changes({path for root in roots for path in git.changed(root, ref)}, real)
    return [task for task in tasks if changes.concern(task, most)]


def by_files(
    names: Sequence[str], tasks: Sequence[Task], option: str, before: str, most: int = files.LARGEST
) -> list[Task]:
    """
    The tasks whose report a change of these files may change, in their order.

    In a git repository, files of the commit `before` that are gone have changed, too, and programs that the next commit
    does not hold are left out. option: for messages.

    Raises UsageError if git fails.
    """
    real = files.RealPaths()
    named = {real.of(name) for name in names}
    root = git.Repositories(real).root(os.curdir)
    in_git: set[str] | None = None
    changed = named
    if root is not None:
        ref = git.Reference(f"{option}:", before)
        changed = named | git.gone(root, ref)
        in_git = git.tracked(root, ref) | named
    if not changed:
        return []
    changes = Changes(changed, real)
    return [task for task in tasks if (in_git is None or real.of(task.path) in in_git) and changes.concern(task, most)]
