"""
A loop over mutated inputs that is guided by what they reach: an input that runs a line of polarcheck for the first
time, or is told something new of, is kept and mutated again. What fails is made small.

Each input gets so much time of the processor; a fault in one of them, a hang included, ends nothing.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from random import Random
from types import CodeType, FrameType
from typing import Any, NamedTuple

from fuzz_mutations import mutated
from fuzz_setups import SETUPS, BrokenError
from fuzz_targets import TARGETS, drawn, fits_schema, seeds

import polarcheck

_FOLDER = os.path.dirname(polarcheck.__file__) + os.sep  # noqa: PTH120  compared with what code objects hold
#: A function that has shown no new line in so many calls is looked at only now and then.
_TIRED, _NOW_AND_THEN = 40, 150
#: Every so many inputs the schema, which is slow.
_SCHEMA_EVERY = 40
#: For making one input small.
_MOST_TRIES, _MOST_SECONDS = 2000, 60


class HangError(BaseException):
    """An input takes too long; no `except Exception` keeps it."""


class Failure(NamedTuple):
    """
    An input of which something does not hold.

    kind: exception and innermost place in polarcheck, or what is broken. reason: in one line.
    """

    target: str
    setup: int
    kind: str
    reason: str
    data: bytes


class Lines:
    """The lines of polarcheck that were run: `with lines: ...`, then lines.new, how many for the first time."""

    def __init__(self) -> None:
        self.new = 0
        self._before: Any = None
        self._left: dict[CodeType, set[int]] = {}
        self._calls: dict[CodeType, int] = {}

    def __enter__(self) -> None:
        self.new = 0
        self._before = sys.gettrace()  # that of coverage.py, in tests
        sys.settrace(self._on_call)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self._before)

    def _on_call(self, frame: FrameType, event: str, argument: Any) -> Any:
        code = frame.f_code
        left = self._left.get(code)
        if left is None:
            left = self._left[code] = self._of(code)
        if not left:
            return None
        calls = self._calls[code] = self._calls.get(code, 0) + 1
        if calls > _TIRED and calls % _NOW_AND_THEN:
            return None

        def on_line(frame: FrameType, event: str, argument: Any) -> Any:
            if event == "line" and frame.f_lineno in left:
                left.discard(frame.f_lineno)
                self.new += 1
                self._calls[code] = 0
            return on_line if left else None

        return on_line

    @staticmethod
    def _of(code: CodeType) -> set[int]:
        if not code.co_filename.startswith(_FOLDER):
            return set()
        return {line for *_, line in code.co_lines() if line is not None and line != code.co_firstlineno}


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raises HangError after so many seconds of the processor, if Python gets to run at all."""

    def hang(number: int, frame: FrameType | None) -> None:
        raise HangError(f"over {seconds:g} s")

    before = signal.signal(signal.SIGPROF, hang)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def told_of(target: str, data: bytes, setup: int, seconds: float) -> Iterable[str] | Failure:
    """What a target tells of an input, or the failure."""
    try:
        with limited(seconds):
            return tuple(TARGETS[target](data, setup))
    except (Exception, HangError) as error:
        return Failure(target, setup, kind_of(error), _reason(error), data)


def kind_of(error: BaseException) -> str:
    """The same for the same fault: what is broken, or the exception and the innermost place in polarcheck."""
    if isinstance(error, BrokenError):
        return error.kind
    frames = traceback.extract_tb(error.__traceback__)
    inside = [frame for frame in frames if frame.filename.startswith(_FOLDER)]
    # Where a hang is met is a matter of chance; which part hangs is none.
    at = (inside[:3] if isinstance(error, HangError) else inside)[-1:] or frames[-1:]
    place = "".join(f"{Path(frame.filename).stem}.{frame.name}" for frame in at)
    return f"{type(error).__name__} in {place}"


def _reason(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:300]


class Loop:
    """
    Mutated inputs of one seed, over some targets in turn.

    seconds: of the processor for each input. stderr_grew: tells what libraries wrote on standard error, if anything.
    inputs, kept: how many were run, and are kept to mutate. failures: the first of each kind.
    """

    def __init__(
        self, seed: int, targets: Iterable[str], seconds: float, stderr_grew: Callable[[], str] = lambda: ""
    ) -> None:
        self.random = Random(seed)  # noqa: S311
        self.targets = list(targets)
        self.seconds = seconds
        self.stderr_grew = stderr_grew
        self.inputs = 0
        self.failures: dict[str, Failure] = {}
        self._lines = Lines()
        self._told: set[str] = set()
        #: With the setup in which an input showed something new; None for one that has run in none.
        self._corpus: dict[str, list[tuple[bytes, int | None]]] = {
            target: [(data, None) for data in seeds(target)] for target in self.targets
        }
        self._begun = {target: len(found) for target, found in self._corpus.items()}
        self._first = [(target, data) for target in self.targets for data, _ in self._corpus[target]]

    @property
    def kept(self) -> int:
        """Inputs that reached something new."""
        return sum(len(found) - self._begun[target] for target, found in self._corpus.items())

    def run(self, until: float, tell: Callable[[str, int, bytes], None] = lambda *_: None) -> Iterator[Failure]:
        """
        Go on until a time (time.monotonic); gives the first failure of each kind, made small.

        tell is told of each input before it runs, so that somebody knows it if it takes this process with it.
        """
        while time.monotonic() < until:
            target, data, setup = self._next()
            tell(target, setup, data)
            failure = self.one(target, data, setup)
            if failure is not None and failure.kind not in self.failures:
                self.failures[failure.kind] = failure
                yield self._small(failure)

    def one(self, target: str, data: bytes, setup: int) -> Failure | None:
        """Run one input; it is kept if it shows anything new."""
        self.inputs += 1
        with self._lines:
            told = told_of(target, data, setup, self.seconds)
        if isinstance(told, Failure):
            return told
        written = self.stderr_grew()
        if written:
            return Failure(target, setup, "something on standard error", written[:300], data)
        new = {f"{target} {one}" for one in told} - self._told
        if self._lines.new or new:
            self._told |= new
            self._corpus[target].append((data, setup))
        if target == "whole" and self.inputs % _SCHEMA_EVERY == 0:
            try:
                fits_schema(data, setup)
            except Exception as error:
                return Failure(target, setup, kind_of(error), _reason(error), data)
        return None

    def _next(self) -> tuple[str, bytes, int]:
        """
        The seeds as they are, inputs by grammar, and mutated ones; of the latest kept ones more often.

        A mutated one runs in the setup of the one that it was made from, or in any.
        """
        setup = self.random.randrange(len(SETUPS))
        if self._first and self.random.random() < 0.3:
            return *self._first.pop(self.random.randrange(len(self._first))), setup
        target = self.random.choice(self.targets)
        corpus = self._corpus[target]
        new = drawn(target, self.random)
        while new is None and not corpus:
            new = drawn(target, self.random)
        if new is not None:
            return target, *new
        chosen, own = corpus[-1 - int(len(corpus) * self.random.random() ** 2)]
        if own is not None and self.random.random() < 0.8:
            setup = own
        return target, mutated(chosen, self.random, [data for data, _ in corpus]), setup

    def _small(self, failure: Failure) -> Failure:
        def fails(data: bytes) -> bool:
            found = told_of(failure.target, data, failure.setup, self.seconds)
            return isinstance(found, Failure) and found.kind == failure.kind

        return failure._replace(data=smallest(failure.data, fails))


def smallest(data: bytes, fails: Callable[[bytes], bool]) -> bytes:
    """The input without the blocks, then without the characters, that it fails without."""
    until, tries = time.monotonic() + _MOST_SECONDS, _MOST_TRIES
    for split in (lambda found: found.splitlines(keepends=True), lambda found: [bytes([byte]) for byte in found]):
        pieces = split(data)
        size = max(len(pieces) // 2, 1)
        while True:
            at = 0
            while at < len(pieces):
                if time.monotonic() > until or not tries:
                    return b"".join(pieces)
                tries -= 1
                without = pieces[:at] + pieces[at + size :]
                if fails(b"".join(without)):
                    pieces = without
                else:
                    at += size
            if size == 1:
                break
            size //= 2
        data = b"".join(pieces)
    return data
