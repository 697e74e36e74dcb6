"""
Many files checked by others: processes of this machine, or a cluster. What comes of it is that of one process.

A crew takes work and gives back what came of each file, in any order. Here the order is that of the tasks again, what
was lost with a worker is given out once more, and a file that takes its worker with it twice is told as such.
"""

from __future__ import annotations

import contextlib
import sys
from collections import Counter, deque
from collections.abc import Generator, Iterable, Sequence
from enum import Enum
from typing import Protocol

import msgspec

from polarcheck.checking.batch import Outcome, Task, forget, outcome
from polarcheck.errors import CrewError
from polarcheck.reading import files

#: Results that wait for one before them: then no more is begun [files].
_MOST_WAITING = 2000
#: How often a file may take its worker with it.
_TRIES = 2


class Lost(Enum):
    """Why nothing came of a file."""

    UNTOUCHED = "another file took the worker with it"
    ENDED = "its worker ended while it was checked, or with others"


class Work(msgspec.Struct, frozen=True):
    """Files by their numbers among the tasks. alone: nothing else is to be lost with them."""

    numbers: list[int]
    alone: bool = False


Result = tuple[int, Outcome | Lost]


class Crew(Protocol):
    """
    Those who check, so many of them. most, most_bytes: of the files that are given to one of them at once. is_here:
    whether this process could do the same, where they cannot.
    """

    jobs: int
    is_here: bool
    most: int
    most_bytes: int

    def has_room(self, alone: bool) -> bool:
        """Whether work should be given now."""

    def give(self, work: Work) -> None:
        """Hand over work."""

    def results(self) -> Iterable[Result]:
        """What has come since the last time; waits until something has."""

    def finished(self) -> Iterable[Result]:
        """What has come, without waiting: asked where the check is interrupted."""

    def close(self) -> None:
        """Let nobody go on."""


class FromWorkerError(Exception):
    """Where a bug happened in another process: its traceback."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


class Sent(msgspec.Struct, frozen=True):
    """An outcome as it comes from another process; exceptions lose their traceback on the way."""

    outcome: Outcome
    traceback: str = ""

    def unpacked(self) -> Outcome:
        """The outcome itself."""
        if self.outcome.bug is not None:
            self.outcome.bug.__cause__ = FromWorkerError(self.traceback)
        return self.outcome


def sent(found: Outcome) -> Sent:
    """An outcome that can be sent to another process."""
    bug = found.bug
    if bug is None:
        return Sent(found)
    import pickle
    import traceback

    told = "".join(traceback.format_exception(bug))
    try:
        pickle.loads(pickle.dumps(bug))  # noqa: S301  written in this line
    except Exception:  # whatever it was made of cannot be made again
        other = RuntimeError(f"{type(bug).__name__}: {bug}")
        for note in getattr(bug, "__notes__", ()):
            other.add_note(note)
        bug = other
    return Sent(msgspec.structs.replace(found, bug=bug), told)


def start_method() -> str:
    """How processes are started: fork where it is safe. It costs little, and what is loaded is not loaded again."""
    return "fork" if sys.platform == "linux" else "spawn"


def is_sent_for(path: str) -> bool:
    """Whether only this process can read it: standard input, or a pipe that a shell has made for it."""
    return path == files.STANDARD_INPUT or path.startswith(("/dev/fd/", "/dev/stdin", "/proc/"))


def outcomes(tasks: Sequence[Task], crew: Crew, most: int = files.LARGEST) -> Generator[Outcome, None, None]:
    """
    What comes of each file, in the order of the tasks, as soon as that of all before it is known.

    most: bytes of a file. Where the check is interrupted, what is finished comes before the KeyboardInterrupt is raised
    again. The crew is closed at the end, whatever that is. Raises CrewError, likewise, where a crew cannot go on that
    does what this process cannot.
    """
    ledger = _Ledger(tasks, crew)
    try:
        try:
            yield from _by_crew(ledger, tasks, crew, most)
        except CrewError:
            if not crew.is_here:
                raise
            crew.close()
            yield from _here(ledger, tasks, most)
    except (KeyboardInterrupt, CrewError) as stop:
        with contextlib.suppress(CrewError):
            ledger.take(crew.finished())
        crew.close()
        yield from ledger.rest()
        if isinstance(stop, CrewError):
            raise CrewError(f"{stop}; {ledger.done} of {len(tasks)} files were checked") from None
        raise stop from None
    finally:
        crew.close()


def _by_crew(ledger: _Ledger, tasks: Sequence[Task], crew: Crew, most: int) -> Generator[Outcome, None, None]:
    while ledger.next < len(tasks):
        while work := ledger.work():
            crew.give(work)
        own = ledger.own()
        if own is not None:
            ledger.take([(own, outcome(tasks[own], most))])
        elif ledger.next not in ledger.found:
            ledger.take(crew.results())
        yield from ledger.ready()


def _here(ledger: _Ledger, tasks: Sequence[Task], most: int) -> Generator[Outcome, None, None]:
    """The rest, by this process; what has ended another one is left alone."""
    while ledger.next < len(tasks):
        if ledger.next not in ledger.found:
            was_lost = ledger.was_lost(ledger.next)
            ledger.take([(ledger.next, Lost.ENDED if was_lost else outcome(tasks[ledger.next], most))])
            forget()
        yield from ledger.ready()


class _Ledger:
    """Which files are still to be given out, and what has come of the others and waits for its turn."""

    def __init__(self, tasks: Sequence[Task], crew: Crew) -> None:
        self._tasks, self._crew = tasks, crew
        self._own = deque(number for number, task in enumerate(tasks) if is_sent_for(task.path))
        own = set(self._own)
        self._left = deque(number for number in range(len(tasks)) if number not in own)
        self._again: deque[int] = deque()
        self._tries = Counter[int]()
        self.found: dict[int, Outcome] = {}
        self.next = 0
        self.done = 0

    def own(self) -> int | None:
        """A file that only this process can read, once it is its turn."""
        return self._own.popleft() if self._own and self._own[0] <= self.next else None

    def work(self) -> Work | None:
        """What is to be given out now."""
        if self._again and self._crew.has_room(True):
            return Work([self._again.popleft()], True)
        if not self._left or self._left[0] - self.next > _MOST_WAITING or not self._crew.has_room(False):
            return None
        # Towards the end less and less is given at once, so that all have something to do until then.
        count = min(self._crew.most, 1 + len(self._left) // (4 * self._crew.jobs))
        numbers, size = list[int](), 0
        while self._left and len(numbers) < count and size < self._crew.most_bytes:
            numbers.append(self._left.popleft())
            size += files.size(self._tasks[numbers[-1]].path)
        return Work(numbers)

    def take(self, results: Iterable[Result]) -> None:
        """Note what has come; what is lost is given out again."""
        untouched = []
        for number, found in results:
            if found is Lost.UNTOUCHED:
                untouched.append(number)
                continue
            if found is Lost.ENDED or (isinstance(found, Outcome) and found.short_of_memory):
                self._tries[number] += 1
                if self._tries[number] < _TRIES:
                    self._again.append(number)
                    continue
            path = self._tasks[number].title
            ended = Outcome(failure=f"{path}: could not be checked: its process ended")
            self.found[number] = found if isinstance(found, Outcome) else ended
        if untouched:
            self._left = deque(sorted([*untouched, *self._left]))

    def was_lost(self, number: int) -> bool:
        """Whether a file has taken a worker with it."""
        return self._tries[number] > 0

    def ready(self) -> Generator[Outcome, None, None]:
        """What has come of the files whose turn it is."""
        while self.next in self.found:
            self.next += 1
            self.done += 1
            yield self.found.pop(self.next - 1)

    def rest(self) -> Generator[Outcome, None, None]:
        """All that has come, in order, though files are missing between."""
        for number in sorted(self.found):
            self.done += 1
            yield self.found.pop(number)
