"""
`--watch`: checks again whenever a file changes that the result depends on.

It polls times and sizes of files, since network drives send no events.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from polarcheck.commands.exit_codes import CLEAN, COULD_NOT_RUN
from polarcheck.commands.options import option
from polarcheck.commands.output import is_terminal, say
from polarcheck.foundation.ending import INTERRUPTED
from polarcheck.foundation.errors import PolarcheckError, UsageError, first_of
from polarcheck.program.reading.files import State, state

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Outcome, Task

watch = option("--watch", is_flag=True, help="Check again whenever a file changes, until Ctrl-C.")

#: The pause between two looks: at least this [s], and this multiple of the time that a look takes.
_PAUSE, _TIMES = 0.5, 10
#: A changed file must be stable between two looks this far apart [s]; the longest wait for that [s].
_SETTLING, _LONGEST = 0.1, 5.0
#: The most changed files that are named.
_NAMED = 3

Look = dict[str, State]
#: Yields the outcomes of tasks.
Check = Callable[[Sequence["Task"]], contextlib.AbstractContextManager[Generator["Outcome", None, None]]]


class Seen:
    """The state of all files that the last result depends on, and the outcome of each program."""

    def __init__(self, paths: Sequence[str], written: Iterable[Path] = ()) -> None:
        """written: files that the runs themselves write, whose changes do not count."""
        self._paths = paths
        self._written = frozenset(os.path.realpath(path) for path in written)
        self._of_programs: dict[str, tuple[Look, Outcome]] = {}
        self._look: Look = {}

    @contextlib.contextmanager
    def outcomes(self, tasks: Sequence[Task], check: Check) -> Iterator[Generator[Outcome, None, None]]:
        """Yield a generator of the outcomes, in order; only tasks with changed files are checked."""
        looks = [self._of(task) for task in tasks]
        self._look = {path: self._state(path) for path in _surroundings(self._paths)}
        for look in looks:
            self._look |= look
        keys = [f"{number}\n{task.path}" for number, task in _numbered(tasks)]
        former = [self._of_programs.get(key) for key in keys]
        are_new = [old is None or old[0] != look for old, look in zip(former, looks, strict=True)]
        self._of_programs = {key: old for key, old in zip(keys, former, strict=True) if old is not None}
        with check([task for task, is_new in zip(tasks, are_new, strict=True) if is_new]) as fresh:

            def merged() -> Generator[Outcome, None, None]:
                for key, look, is_new, old in zip(keys, looks, are_new, former, strict=True):
                    outcome = next(fresh) if is_new or old is None else old[1]
                    self._of_programs[key] = look, outcome
                    yield outcome

            yield merged()

    def _of(self, task: Task) -> Look:
        """Return the state of all files that a result depends on: the program, its settings, called programs."""
        settings = task.settings
        files = {task.path, *(path for path in settings.read if not os.path.isdir(path))}  # noqa: PTH112
        for folder in settings.job.run.subprograms:
            files |= _inside(folder)
        return {path: self._state(path) for path in sorted(files)}

    def changed(self) -> list[str]:
        """Return the files that have changed since the last run began."""
        return [path for path, state in self._look.items() if self._state(path) != state]

    def states(self, paths: Iterable[str]) -> Look:
        """Return the present state of files."""
        return {path: self._state(path) for path in paths}

    def accept(self) -> None:
        """Take the present state as seen, after a run that failed."""
        self._look = {path: self._state(path) for path in self._look}

    def _state(self, path: str) -> State:
        return state(path, self._of_folder)

    def _of_folder(self, path: str, number: int) -> State:
        """Return the state of a folder by the names in it: its time changes with each report that is written there."""
        with os.scandir(path) as entries:
            names = sorted(entry.name for entry in entries if not entry.name.startswith("."))
        written = [name for name in names if os.path.realpath(os.path.join(path, name)) not in self._written]  # noqa: PTH118
        return hash(tuple(written)), 0, number


def _numbered(tasks: Sequence[Task]) -> Iterator[tuple[int, Task]]:
    """Number the tasks of each path from 0: a path can have several tasks with different settings."""
    counts: dict[str, int] = {}
    for task in tasks:
        counts[task.path] = counts.get(task.path, -1) + 1
        yield counts[task.path], task


def _inside(folder: str) -> set[str]:
    """Return a folder and the paths in it."""
    paths = {folder}
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        paths.update(entry.path for entry in entries)
    return paths


def _surroundings(paths: Iterable[str]) -> Iterator[str]:
    """Yield the paths where programs and job files can appear: the folders, and job files in the folders above."""
    from polarcheck.program.machines.job import FILE_NAME, PROJECT

    for path in paths:
        yield path
        folder = os.path.realpath(path if os.path.isdir(path) else os.path.dirname(path))  # noqa: PTH112, PTH120
        while True:
            yield from (os.path.join(folder, name) for name in (FILE_NAME, PROJECT))  # noqa: PTH118
            folder, inner = os.path.dirname(folder), folder  # noqa: PTH120
            if folder == inner:
                break
        if os.path.isdir(path):  # noqa: PTH112
            for outer, inner_folders, _ in os.walk(path):
                yield outer
                inner_folders[:] = [name for name in inner_folders if not name.startswith(".")]


def refuse(paths: Sequence[str], options: Mapping[str, object], option: str = "--watch") -> None:
    """Raise UsageError for standard input, and for other options that exclude --watch, or another option like it."""
    if "-" in paths:
        raise UsageError(f"{option}: standard input comes once; name a file or folder")
    for name, value in options.items():
        if value:
            raise UsageError(f"{option}: not with {name}, which is for one look")


def repeatedly(
    run: Callable[[Seen], int], paths: Sequence[str], outputs: Iterable[tuple[str, Path]] = (), *, clears: bool = True
) -> int:
    """
    Run a check again after each change; Ctrl-C is the normal end, with exit code 0.

    outputs: format and file of the reports that it writes.
    clears: clear a terminal before each run.

    Raises what the first run raises.
    """
    seen = Seen(paths, [path for _, path in outputs])
    try:
        status = _run(run, seen, (), clears=clears)
        while status < INTERRUPTED:
            say("watching for changes; Ctrl-C ends")
            changed = _next_change(seen)
            try:
                status = _run(run, seen, changed, clears=clears)
            except PolarcheckError as error:  # such as a half-written job file
                say(str(error))
                seen.accept()
                status = COULD_NOT_RUN
    except KeyboardInterrupt as stop:
        from polarcheck.commands.signals import exit_status

        status, _ = exit_status(stop)
    return CLEAN if status == INTERRUPTED else status


def _run(run: Callable[[Seen], int], seen: Seen, changed: Sequence[str], *, clears: bool) -> int:
    if clears and is_terminal(sys.stdout):
        click.clear()
    if changed:
        # A job file beside the programs is seen under two paths: its own, and that of the folder.
        names = list({os.path.realpath(path): path for path in sorted(changed, key=len, reverse=True)}.values())
        names.sort()
        say(f"{first_of(names, _NAMED)} changed, {time.strftime('%H:%M:%S')}")
    return run(seen)


def _next_change(seen: Seen) -> list[str]:
    """Wait for a change, and until the changed files are stable; return them."""
    while True:
        begun = time.monotonic()
        if changed := seen.changed():
            break
        time.sleep(max(_PAUSE, _TIMES * (time.monotonic() - begun)))
    end = time.monotonic() + _LONGEST
    before: object = None
    while (now := seen.states(changed)) != before and time.monotonic() < end:
        before = now
        time.sleep(_SETTLING)
        changed = seen.changed() or changed
    return sorted(changed)
