"""
Where the time of a check goes: its stages, each with its time, the bytes that it touched and by how much the peak grew.

Nothing of the check knows of it. What belongs to a stage is wrapped while it is asked for, by the names below, and is
as before afterwards. A stage that calls another one is not charged with it, so the stages add up to the whole, however
often a file is read and run.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import sys
import time
from collections.abc import Callable, Iterator
from types import FunctionType, ModuleType
from typing import Any

import msgspec

from polarcheck.checking import batch, tables

try:
    import resource
except ImportError:  # no such counts on Windows
    resource = None  # type: ignore[assignment]

#: In the order of the data.
STAGES = ("start", "reading", "execution", "columns", "tool path", "faces", "rules", "report")
#: What begins a stage wherever it is called. Those that are called in between are charged to the stage that calls them.
BEGINS = {
    "polarcheck.checking.tables:_maker": "start",  # loads the module of a table
    "polarcheck.reading.files:read": "reading",
    "polarcheck.reading.source:read": "reading",
    "polarcheck.reading.words:read_words": "reading",
    "polarcheck.execution.runs:runs": "execution",
    "polarcheck.checking.batch:outcome": "rules",
    "polarcheck.checking.batch:gather": "report",
}
#: From its first call on, what belongs to no stage is no longer `start` but its own.
_LAST = "polarcheck.checking.batch:gather"
#: Modules of table/ whose tables are no plain columns.
OF_TABLES = {
    "tool_center": "tool path",
    "moves": "tool path",
    "plane_moves": "tool path",
    "dynamics": "tool path",
    "feed_curve": "tool path",
    "highest_feeds": "tool path",
    "feed_ranges": "tool path",
    "travel": "tool path",
    "ramps": "tool path",
    "trial": "tool path",
    "overcuts": "faces",
    "slots": "faces",
    "uncompensated_cuts": "faces",
    "fitting": "faces",
    "finished": "faces",
    "deviations": "faces",
    "coverage": "faces",
}
_TABLES = "polarcheck.table."


class Spent(msgspec.Struct, frozen=True):
    """
    What a stage has cost. seconds: of the processor. touched: bytes of memory used for the first time, as the system
    counts pages; peak: bytes by which the most memory held at once has grown. Both are 0 where it counts neither.
    """

    seconds: float = 0.0
    touched: int = 0
    peak: int = 0

    def __add__(self, other: Spent) -> Spent:
        return Spent(self.seconds + other.seconds, self.touched + other.touched, self.peak + other.peak)

    def __sub__(self, other: Spent) -> Spent:
        return Spent(self.seconds - other.seconds, self.touched - other.touched, self.peak - other.peak)


def _spent() -> Spent:
    """What the process has cost since it began."""
    seconds = time.process_time()
    if resource is None:
        return Spent(seconds)
    used = resource.getrusage(resource.RUSAGE_SELF)
    unit = 1 if sys.platform == "darwin" else 1024
    return Spent(seconds, (used.ru_minflt + used.ru_majflt) * resource.getpagesize(), used.ru_maxrss * unit)


class Clock:
    """
    What each stage has cost up to now; all that the process did before belongs to `start`.

    files, blocks: that were checked, and that they have executed.
    """

    def __init__(self) -> None:
        self.files = self.blocks = 0
        self.spent = dict.fromkeys(STAGES, Spent())
        self._stage, self._until = "start", Spent()

    def go_on(self, stage: str) -> str:
        """Charge what was used up to now to the stage that was on, and go on with another one; the one that was on."""
        now, before = _spent(), self._stage
        self.spent[before] += now - self._until
        self._stage, self._until = stage, now
        return before

    def total(self) -> Spent:
        """The sum of the stages."""
        return sum(self.spent.values(), Spent())

    def charged(self, function: Callable[..., Any], stage: str, *, stays: bool = False) -> Callable[..., Any]:
        """The function, charged to a stage; stays: that goes on when it has returned."""

        @functools.wraps(function)
        def within(*given: Any, **named: Any) -> Any:
            if self._stage == stage:
                return function(*given, **named)
            before = self.go_on(stage)
            try:
                return function(*given, **named)
            finally:
                if not stays:
                    self.go_on(before)

        return within

    def counted(self, outcome: Callable[..., batch.Outcome]) -> Callable[..., batch.Outcome]:
        """The function that checks a file, of which the blocks are counted."""

        def counting(*given: Any, **named: Any) -> batch.Outcome:
            found = outcome(*given, **named)
            if found.report is not None:
                self.files += 1
                self.blocks += found.report.blocks
            return found

        return counting


@contextlib.contextmanager
def timed() -> Iterator[Clock]:
    """A clock that is charged with all checks of this process until the end."""
    clock = Clock()
    with contextlib.ExitStack() as undo:
        for place, stage in BEGINS.items():
            name, _, attribute = place.partition(":")
            function = getattr(importlib.import_module(name), attribute)
            _replace(function, clock.charged(function, stage, stays=place == _LAST), undo)
        _replace(batch.outcome, clock.counted(batch.outcome), undo)
        watch = _Watch(clock, undo)
        _replace(tables._maker, watch.loading(tables._maker), undo)
        undo.callback(setattr, tables.Tables, "_make", tables.Tables._make)
        tables.Tables._make = watch.making(tables.Tables._make)  # type: ignore[assignment, method-assign]
        yield clock


def _stage_of(module: str) -> str:
    return OF_TABLES.get(module.removeprefix(_TABLES), "columns")


def _replace(function: object, other: object, undo: contextlib.ExitStack) -> None:
    """Put another function in the place of one, wherever a module of the package has it by name."""
    for name, module in list(sys.modules.items()):
        if name.startswith("polarcheck"):
            for attribute, value in list(vars(module).items()):
                if value is function:
                    setattr(module, attribute, other)
                    undo.callback(setattr, module, attribute, function)


class _Watch:
    """Charges what the classes of table/ compute to their stages, those of a module as soon as it is loaded."""

    def __init__(self, clock: Clock, undo: contextlib.ExitStack) -> None:
        self._clock, self._undo = clock, undo
        self._seen: set[str] = set()
        self._look()

    def loading(self, maker: Callable[[str], Any]) -> Callable[[str], Any]:
        """The function that loads a table, which has an eye on what came with it."""

        def loaded(path: str) -> Any:
            found = maker(path)
            self._look()
            return found

        return loaded

    def making(self, make: Callable[[tables.Tables, str], Any]) -> Callable[[tables.Tables, str], Any]:
        """The function that makes a table, charged to its stage."""

        def made(own: tables.Tables, name: str) -> Any:
            module = tables.MAKERS.get(name, "").partition(":")[0]
            return self._clock.charged(make, _stage_of(module))(own, name)

        return made

    def _look(self) -> None:
        for name in [name for name in sys.modules if name.startswith(_TABLES)]:
            if name not in self._seen:
                self._seen.add(name)
                self._charge(sys.modules[name], _stage_of(name))

    def _charge(self, module: ModuleType, stage: str) -> None:
        for own in vars(module).values():
            if isinstance(own, type) and own.__module__ == module.__name__:
                for name, value in list(vars(own).items()):
                    self._charge_member(own, name, value, stage)

    def _charge_member(self, own: type, name: str, value: object, stage: str) -> None:
        if isinstance(value, functools.cached_property):
            self._undo.callback(setattr, value, "func", value.func)
            value.func = self._clock.charged(value.func, stage)
        elif isinstance(value, FunctionType) and not name.startswith("__"):
            setattr(own, name, self._clock.charged(value, stage))
            self._undo.callback(setattr, own, name, value)
