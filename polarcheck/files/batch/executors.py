"""
Many files checked by several workers: processes of this machine, or a cluster (`cluster.py`).

The workers stand behind an executor of concurrent.futures. The outcomes are those of one process, in the order of the
files, and only a few files for each worker are submitted ahead. Where a worker dies, the files that were submitted are
checked once more, one at a time; a file that kills its worker then is reported as the cause.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import multiprocessing
import os
import queue
import signal
import sys
import threading
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import connection
from typing import Any, Protocol

import msgspec

from polarcheck.files.batch.tasks import Outcome, Task, forget, outcome, unreadable
from polarcheck.foundation.errors import ClusterError
from polarcheck.foundation.memory import keep_within_memory
from polarcheck.program.reading import files
from polarcheck.rules import tables

#: Submissions in flight per worker: while one is checked, the next ones wait in its queue.
_AHEAD = 3
#: Outcomes that wait for an earlier file; beyond this nothing more is submitted [files].
_MOST_WAITING = 2000
#: Files above this size are checked one at a time: each takes 40 times its size of memory, or more [bytes].
_LARGE = 8_000_000
#: Windows cannot wait for more handles at once [processes].
_MOST_ON_WINDOWS = 61
#: Interval at which a worker looks whether its parent process lives, where the system does not report it [s].
_PARENT_INTERVAL = 2.0


class Workers(Protocol):
    """
    The workers that check files, behind an executor.

    count: number of workers.
    most_files, most_bytes: limits of one submission.
    large: size above which files are checked one at a time [bytes].
    patience: seconds without an outcome after which `verify` is called.
    death: exceptions of a future whose worker has died, or has no memory left to send its result.
    """

    count: int
    most_files: int
    most_bytes: int
    large: float
    patience: float
    death: tuple[type[Exception], ...]

    def submit(self, numbers: list[int], alone: bool) -> Future[Any]:
        """
        Have these tasks checked; alone: by a worker that has the machine to itself.

        Raises NoProcessError where no worker can be started, ClusterError where the cluster takes no more.
        """

    def outcomes(self, future: Future[Any], numbers: list[int]) -> list[Outcome] | None:
        """
        The outcomes of a submission that is done; None where it must be submitted again.

        Raises what the executor raises where the worker has died, ClusterError where no worker can go on.
        """

    def verify(self) -> None:
        """Raises BrokenProcessPool or ClusterError where no outcome will come any more."""

    def close(self) -> None:
        """Stop all work at once."""


class NoProcessError(Exception):
    """No worker process can be started."""


# ---- the order of the files ----


def outcomes(tasks: Sequence[Task], workers: Workers, most: int = files.LARGEST) -> Generator[Outcome, None, None]:
    """
    The outcome of each task, in order, as soon as those of all tasks before it are known.

    most: bytes of a file. On an interrupt the finished outcomes are yielded before KeyboardInterrupt is raised again,
    and likewise ClusterError where a cluster cannot go on. The workers are closed at the end in any case.
    """
    schedule = _Schedule(tasks, workers, most)
    try:
        try:
            yield from schedule.in_order()
        except NoProcessError:
            yield from schedule.in_this_process()
    except (KeyboardInterrupt, ClusterError) as stop:
        with contextlib.suppress(ClusterError):
            schedule.take_finished()
        workers.close()
        yield from schedule.rest()
        if isinstance(stop, ClusterError):
            raise ClusterError(f"{stop}; {schedule.count} of {len(tasks)} files were checked") from None
        raise stop from None
    finally:
        workers.close()


class _Schedule:
    """
    Which tasks are submitted next, and which outcomes wait for their turn. Tasks are known by their numbers.

    count: outcomes yielded so far.
    """

    def __init__(self, tasks: Sequence[Task], workers: Workers, most: int) -> None:
        self._tasks, self._workers, self._most = tasks, workers, most
        self._here = {number for number, task in enumerate(tasks) if _is_read_here(task.path)}
        self._left = deque(number for number in range(len(tasks)) if number not in self._here)
        self._again = deque[int]()
        self._futures: dict[Future[Any], tuple[list[int], bool]] = {}
        self._finished = queue.SimpleQueue[Future[Any]]()
        self._large: Future[Any] | None = None
        self._outcomes: dict[int, Outcome] = {}
        self._next = 0
        self.count = 0

    def in_order(self) -> Iterator[Outcome]:
        """The outcomes by the workers. Raises NoProcessError and ClusterError."""
        while self._next < len(self._tasks):
            self._submit()
            if self._next in self._here:
                self._check_here()
            elif self._next not in self._outcomes:
                self._wait()
            yield from self._ready()

    def in_this_process(self) -> Iterator[Outcome]:
        """The remaining outcomes if no process can be started; a file that may have killed one is not checked again."""
        while self._futures:
            self._wait()
        for number in self._again:
            self._outcomes[number] = self._lost(number)
        while self._next < len(self._tasks):
            if self._next not in self._outcomes:
                self._check_here()
            yield from self._ready()

    def take_finished(self) -> None:
        """Take the outcomes that have come, without waiting."""
        with contextlib.suppress(queue.Empty):
            while True:
                self._take(self._finished.get_nowait())

    def rest(self) -> Iterator[Outcome]:
        """The outcomes that have come, in order; those missing between them are skipped."""
        for number in sorted(self._outcomes):
            self.count += 1
            yield self._outcomes.pop(number)

    def _ready(self) -> Iterator[Outcome]:
        while self._next in self._outcomes:
            self._next += 1
            self.count += 1
            yield self._outcomes.pop(self._next - 1)

    def _check_here(self) -> None:
        self._outcomes[self._next] = outcome(self._tasks[self._next], self._most)
        forget()

    def _submit(self) -> None:
        """Submit what the workers can take. Files to be repeated come first, each when nothing else is in flight."""
        if self._again:
            if not self._futures:
                self._send([self._again.popleft()], True)
            return
        while self._left and self._left[0] - self._next <= _MOST_WAITING:
            is_full = len(self._futures) >= _AHEAD * self._workers.count
            is_large = files.size(self._tasks[self._left[0]].path) > self._workers.large
            if is_full or (is_large and self._large in self._futures):
                return
            future = self._send(self._chunk(), False)
            if is_large:
                self._large = future

    def _chunk(self) -> list[int]:
        """The next tasks for one submission. It shrinks towards the end, so that all workers are busy until then."""
        most = min(self._workers.most_files, 1 + len(self._left) // (4 * self._workers.count))
        numbers, size = list[int](), 0
        while self._left and len(numbers) < most and size < self._workers.most_bytes:
            numbers.append(self._left.popleft())
            size += files.size(self._tasks[numbers[-1]].path) if most > 1 else 0
        return numbers

    def _send(self, numbers: list[int], alone: bool) -> Future[Any]:
        try:
            future = self._workers.submit(numbers, alone)
        except NoProcessError:
            (self._again if alone else self._left).extendleft(reversed(numbers))
            raise
        self._futures[future] = numbers, alone
        future.add_done_callback(self._finished.put)
        return future

    def _wait(self) -> None:
        """Wait until some outcomes have come, or the workers turn out to be lost."""
        try:
            self._take(self._finished.get(timeout=self._workers.patience))
        except queue.Empty:
            try:
                self._workers.verify()
            except BrokenProcessPool:
                for numbers, alone in self._futures.values():
                    self._note(numbers, [None] * len(numbers), alone)
                self._futures.clear()
        self.take_finished()

    def _take(self, future: Future[Any]) -> None:
        if future not in self._futures:  # given up before
            return
        numbers, alone = self._futures.pop(future)
        try:
            outcomes: Sequence[Outcome | None] | None = self._workers.outcomes(future, numbers)
        except ClusterError:
            raise
        except self._workers.death:
            outcomes = [None] * len(numbers)
        if outcomes is None:
            (self._again if alone else self._left).extendleft(reversed(numbers))
        else:
            self._note(numbers, outcomes, alone)

    def _note(self, numbers: list[int], outcomes: Sequence[Outcome | None], alone: bool) -> None:
        """Note outcomes; a file that was lost, or was short of memory beside others, is repeated alone."""
        for number, result in zip(numbers, outcomes, strict=True):
            if not alone and (result is None or result.short_of_memory):
                self._again.append(number)
            else:
                self._outcomes[number] = result or self._lost(number)

    def _lost(self, number: int) -> Outcome:
        task = self._tasks[number]
        return unreadable(task, f"{task.title}: could not be checked: its process ended")


def _is_read_here(path: str) -> bool:
    """Tells whether only this process can read a file: standard input, or a pipe of the shell."""
    return path == files.STANDARD_INPUT or path.startswith(("/dev/fd/", "/dev/stdin", "/proc/"))


# ---- outcomes of other processes ----


class FromWorkerError(Exception):
    """The traceback of a bug in another process, as the cause of that bug."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


class Sent(msgspec.Struct, frozen=True):
    """
    An outcome on its way from another process.

    outcome: the outcome; pickling its exception loses the traceback.
    traceback: the traceback as text.
    """

    outcome: Outcome
    traceback: str = ""

    def unpacked(self) -> Outcome:
        """The outcome, with the traceback as the cause of its exception."""
        if self.outcome.bug is not None:
            self.outcome.bug.__cause__ = FromWorkerError(self.traceback)
        return self.outcome


def packed(result: Outcome) -> Sent:
    """An outcome that can be pickled, whatever exception it holds."""
    bug = result.bug
    if bug is None:
        return Sent(result)
    import pickle
    import traceback

    lines = "".join(traceback.format_exception(bug))
    try:
        pickle.loads(pickle.dumps(bug))  # noqa: S301  written in this line
    except Exception:  # some exceptions cannot be unpickled
        plain = RuntimeError(f"{type(bug).__name__}: {bug}")
        for note in getattr(bug, "__notes__", ()):
            plain.add_note(note)
        bug = plain
    return Sent(msgspec.structs.replace(result, bug=bug), lines)


# ---- processes of this machine ----


def start_method() -> str:
    """How processes are started: fork where that is safe, since a forked process has its libraries loaded already."""
    return "fork" if sys.platform == "linux" else "spawn"


class Processes:
    """Worker processes in a ProcessPoolExecutor; each submission is one file."""

    most_files, most_bytes, patience = 1, 1, 0.5
    large: float = _LARGE
    death: tuple[type[Exception], ...] = (BrokenProcessPool, MemoryError)

    def __init__(self, tasks: Sequence[Task], count: int, most: int = files.LARGEST, method: str = "") -> None:
        """count: processes. most: bytes of a file. method: how processes are started."""
        self.count = min(count, _MOST_ON_WINDOWS) if sys.platform == "win32" else count
        self._tasks, self._most, self._method = tasks, most, method or start_method()
        self._executor: ProcessPoolExecutor | None = None
        self._is_alone = False
        self._others: set[Any] = set()
        self._processes: set[Any] = set()

    def submit(self, numbers: list[int], alone: bool) -> Future[list[Sent]]:
        """Have tasks checked; where a pool of the other kind is running, or it is broken, start a new one."""
        if self._executor is None or alone != self._is_alone:
            self._start(alone)
        try:
            return self._submitted(_check, numbers)
        except BrokenProcessPool:
            self._start(alone)
            return self._submitted(_check, numbers)

    def _submitted(self, function: Any, *arguments: Any) -> Future[Any]:
        assert self._executor is not None
        with _signals_blocked():
            return self._executor.submit(function, *arguments)

    def _start(self, alone: bool) -> None:
        """Start a pool and wait for a first answer; halve the number of processes while the system refuses them."""
        count = 1 if alone else self.count
        while True:
            self.close()
            self._is_alone, self._others, self._processes = alone, set(multiprocessing.active_children()), set()
            arguments = (self._tasks, self._most, count)
            self._executor = ProcessPoolExecutor(count, multiprocessing.get_context(self._method), _begin, arguments)
            try:
                self._submitted(os.getpid).result()
                self._look_for_processes()
                return
            except (OSError, BrokenProcessPool):
                if count == 1:
                    raise NoProcessError from None
                count //= 2
                self.count = count

    def outcomes(self, future: Future[list[Sent]], numbers: list[int]) -> list[Outcome]:
        """The outcomes of a submission. Raises BrokenProcessPool where a process has died."""
        return [sent.unpacked() for sent in future.result()]

    def verify(self) -> None:
        """Raises BrokenProcessPool where a process has died unnoticed: its pool waits for the rest of a result."""
        if not all(process.is_alive() for process in self._processes):
            self.close()
            raise BrokenProcessPool
        self._look_for_processes()

    def _look_for_processes(self) -> None:
        """Note the processes of the pool; spawned ones are started as they are needed."""
        self._processes |= set(multiprocessing.active_children()) - self._others

    def close(self) -> None:
        """Kill all processes: they write no files, and hold nothing that must be released."""
        executor = self._executor
        if executor is None:
            return
        with _signals_blocked():
            self._look_for_processes()
            for process in self._processes:
                process.kill()
            for process in self._processes:
                process.join()
            self._executor = None
        # The thread of the pool may wait for the rest of a result: with the last writer its pipe ends.
        with contextlib.suppress(AttributeError, OSError):
            executor._result_queue._writer.close()  # type: ignore[attr-defined]
        executor.shutdown()


@contextlib.contextmanager
def _signals_blocked() -> Iterator[None]:
    """Delay signals: one that reaches a forked process before it ignores them would print a traceback."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


#: The tasks of a worker process, and the most bytes of a file.
_given: tuple[Sequence[Task], int] = ((), 0)


def _begin(tasks: Sequence[Task], most: int, sharing: int) -> None:
    """Prepare a worker process; sharing: processes that share the memory."""
    global _given
    _given = tasks, most
    # Ctrl-C reaches all processes of a terminal; the parent process handles it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT, signal.SIGTERM))
    threading.Thread(target=_end_with_parent, daemon=True).start()
    # Whoever reads the output of the parent process must not wait for this one.
    with contextlib.suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for descriptor in (1, 2):
            os.dup2(nowhere, descriptor)
    gc.disable()  # as in the parent process (commands.run)
    keep_within_memory(sharing)


def _end_with_parent() -> None:
    """End this process when its parent is gone; the executor would leave it waiting for work."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    # Forked processes hold each other's sentinels open, but where there is fork, getppid changes with the parent.
    number = os.getppid()
    while os.getppid() == number and not connection.wait([parent.sentinel], _PARENT_INTERVAL):
        pass
    os._exit(1)


def _check(numbers: list[int]) -> list[Sent]:
    """Check tasks in a worker process."""
    tasks, most = _given
    results = []
    for number in numbers:
        results.append(packed(outcome(tasks[number], most)))
        forget()
    return results


def by_processes(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    """The outcomes of `count` worker processes, in the order of the tasks."""
    if start_method() == "fork":
        # Loaded before the fork, a module need not be loaded by each process.
        for maker in tables.TABLES.values():
            importlib.import_module(maker.module)
    return outcomes(tasks, Processes(tasks, min(count, len(tasks)), most), most)
