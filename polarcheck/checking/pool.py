"""
A crew of processes of this machine.

Each has a pipe of its own and tells of each file as soon as it is done: who ends is known, and what was lost by it.
They end with the pipe, and so with the process that has started them, however that ends.
"""

from __future__ import annotations

import contextlib
import os
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from multiprocessing import connection, get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

from polarcheck.checking import crews
from polarcheck.checking.batch import Task, forget, outcome
from polarcheck.checking.crews import Lost, Result, Sent, Work
from polarcheck.checking.settings import Settings
from polarcheck.errors import CrewError

#: Given to a process at once: it tells of each file by itself, so that little is enough [files, bytes].
_MOST, _MOST_BYTES = 8, 100_000
#: A process that has no more left than this is given more, so that it never waits [files].
_FEW = 2

#: A file by its number, its path, and the number of its settings.
Item = tuple[int, str, int]
#: What a process does before it checks the first file, and whether it does so alone.
Prepare = Callable[[bool], None]


class Pool:
    """
    So many processes. prepare: what each does first, given whether it is for one file alone.

    Raises CrewError where no process can be started.
    """

    most, most_bytes, is_here = _MOST, _MOST_BYTES, True

    def __init__(self, tasks: Sequence[Task], jobs: int, most: int, prepare: Prepare, method: str = "") -> None:
        self.jobs = jobs
        self._context: Any = get_context(method or crews.start_method())
        self._most, self._prepare = most, prepare
        numbers: dict[int, int] = {}
        self._settings: list[Settings] = []
        self._items: list[Item] = []
        for number, task in enumerate(tasks):
            known = numbers.setdefault(id(task.settings), len(self._settings))
            if known == len(self._settings):
                self._settings.append(task.settings)
            self._items.append((number, task.path, known))
        self._workers: list[_Worker] = []

    def has_room(self, alone: bool) -> bool:
        """Whether one of them has hardly anything left to do, or can be started."""
        if alone:
            return not any(worker.is_alone for worker in self._workers)
        return self._free() is not None or self._usual() < self.jobs

    def _usual(self) -> int:
        return sum(not worker.is_alone for worker in self._workers)

    def _free(self) -> _Worker | None:
        free = [one for one in self._workers if not one.is_alone and len(one.left) < _FEW]
        return min(free, key=lambda worker: len(worker.left), default=None)

    def give(self, work: Work) -> None:
        """To the one with the least to do, or to a new one."""
        items = [self._items[number] for number in work.numbers]
        free = None if work.alone else self._free()
        if free is None or (free.left and self._usual() < self.jobs):
            free = self._started(work.alone) or free
        if free is None:
            raise CrewError("no process can be started to check files; --jobs 1 does without")
        free.give(items)

    def _started(self, alone: bool) -> _Worker | None:
        held = [worker.pipe for worker in self._workers]
        try:
            worker = _Worker(self._context, held, self._settings, self._most, self._prepare, alone)
        except OSError:  # the system gives no more
            if not alone:
                self.jobs = max(1, self._usual())
            return None
        self._workers.append(worker)
        return worker

    def results(self) -> Iterable[Result]:
        """What they have told; who has ended has lost the file that it was at."""
        if not self._workers:
            raise CrewError("no process is there to check files; --jobs 1 does without")
        ready = connection.wait([worker.pipe for worker in self._workers])
        yield from self._told([worker for worker in self._workers if worker.pipe in ready])

    def finished(self) -> Iterable[Result]:
        """What they have told and nobody has read."""
        yield from self._told([worker for worker in self._workers if worker.has_told()])

    def _told(self, workers: Iterable[_Worker]) -> Iterator[Result]:
        for worker in workers:
            while worker.has_told():
                try:
                    with _without_signals():  # half a message read would make nonsense of the next
                        number, found = worker.pipe.recv()
                except (EOFError, OSError):  # it has ended, perhaps in the middle of a word
                    yield from self._ended(worker)
                    break
                worker.left.popleft()
                yield number, found.unpacked()
                if worker.is_alone:
                    worker.end()
                    self._workers.remove(worker)
                    break

    def _ended(self, worker: _Worker) -> Iterator[Result]:
        worker.end()
        self._workers.remove(worker)
        if not worker.has_begun:
            raise CrewError("a process that should check files ended before the first; --jobs 1 does without")
        for place, number in enumerate(worker.left):
            yield number, Lost.UNTOUCHED if place else Lost.ENDED

    def close(self) -> None:
        """End all of them, whatever they are at."""
        while self._workers:
            self._workers.pop().end()


class _Worker:
    """A process, this end of its pipe, and the files that it has still to tell of, in their order."""

    def __init__(
        self,
        context: Any,
        held: Sequence[Connection],
        settings: Sequence[Settings],
        most: int,
        prepare: Prepare,
        alone: bool,
    ) -> None:
        self.is_alone = alone
        self.left: deque[int] = deque()
        self._begun = False
        self.pipe, other = context.Pipe()
        # What is open here is open in a process that is forked, too: closed there, the pipes end when this one does.
        ends = (self.pipe, *held) if context.get_start_method() == "fork" else ()
        given = (other, ends, settings, most, prepare, alone)
        with _without_signals():
            self._process: BaseProcess = context.Process(target=work, args=given, daemon=True)
            try:
                self._process.start()
            except BaseException:
                self.pipe.close()
                raise
            finally:
                other.close()

    @property
    def has_begun(self) -> bool:
        """Whether it has come to its first file, or told of one."""
        return self._begun

    def give(self, items: Sequence[Item]) -> None:
        """Hand over files; where it has ended, reading will tell."""
        self.left.extend(number for number, _, _ in items)
        with contextlib.suppress(OSError):
            self.pipe.send(items)

    def has_told(self) -> bool:
        """Whether there is something to read, or it has ended."""
        try:
            while self.pipe.poll():
                if self._begun:
                    return True
                with _without_signals():
                    self._begun = self.pipe.recv() is None
        except (EOFError, OSError):
            return True
        return False

    def end(self) -> None:
        """End it at once: it writes no files, and holds nothing that must be given back."""
        self._process.kill()
        self._process.join()
        self._process.close()
        self.pipe.close()


@contextlib.contextmanager
def _without_signals() -> Iterator[None]:
    """Signals of this process wait: one that came in a process just begun would be told by a traceback."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def work(
    pipe: Connection, ends: Sequence[Connection], settings: Sequence[Settings], most: int, prepare: Prepare, alone: bool
) -> None:
    """What a process does: check the files that come through the pipe, and tell of each, until the pipe ends."""
    # Ctrl-C reaches all processes of a terminal. Whoever has started this one ends it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT, signal.SIGTERM))
    for end in ends:
        end.close()
    _be_silent()
    prepare(alone)
    with contextlib.suppress(EOFError, OSError):
        pipe.send(None)
        while True:
            for told in told_of(pipe.recv(), settings, most):
                pipe.send(told)


def _be_silent() -> None:
    """Whoever reads what the first process writes must not wait for this one."""
    with contextlib.suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for descriptor in (1, 2):
            os.dup2(nowhere, descriptor)


def told_of(items: Iterable[Item], settings: Sequence[Settings], most: int) -> Iterator[tuple[int, Sent]]:
    """What comes of some files, one after the other."""
    for number, path, known in items:
        yield number, crews.sent(outcome(Task(path, settings[known]), most))
        forget()
