"""Who checks the files: this process, several of this machine, or a cluster."""

from __future__ import annotations

import contextlib
import importlib
import os
import time
from collections.abc import Generator, Iterator, Sequence
from typing import TYPE_CHECKING

import click

from polarcheck.commands.memory import keep_within_memory
from polarcheck.commands.options import option

if TYPE_CHECKING:
    from polarcheck.checking.batch import Outcome, Task
    from polarcheck.commands.watching import Seen

#: This process begins alone. Others are started once it is known that they save more than they cost [s]: to fork costs
#: hardly anything, elsewhere each loads the libraries anew.
_COST = {"fork": 0.1, "spawn": 1.5}
#: A file of this size is a reason by itself not to let the others wait [bytes].
_LARGE = 200_000


#: Nobody has more cores, and a typing error starts no thousands of processes.
_MOST = 1024


def _number(ctx: click.Context, parameter: click.Parameter, value: str) -> int:
    text = value.strip().lower()
    if text == "auto":
        return 0
    if text.isascii() and text.isdecimal() and int(text) <= _MOST:
        return int(text)
    raise click.BadParameter(f"{value!r}: expected a number of processes up to {_MOST}, or auto")


jobs = option(
    "-j", "--jobs", "workers", callback=_number, default="auto", show_default="all cores where it pays", metavar="N",
    help="Processes that check; 1 for this one alone.",
)  # fmt: skip
cluster = option("--cluster", metavar="tcp://HOST:PORT", help="Let a cluster of dask.distributed check.")


def cores() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


@contextlib.contextmanager
def outcomes(
    tasks: Sequence[Task], most: int, workers: int = 1, address: str | None = None, seen: Seen | None = None
) -> Iterator[Generator[Outcome, None, None]]:
    """
    What comes of each file, in the order of the tasks, whoever checks it; at the end nobody is left who checks.

    most: bytes of a file. workers: processes, 0 for as many as pay. address: of the scheduler of a cluster. seen: what
    is known of an earlier run, and not checked again. Raises CrewError where the cluster cannot be used.
    """
    if seen is not None:
        with seen.outcomes(tasks, lambda changed: outcomes(changed, most, workers, address)) as found:
            yield found
        return
    from polarcheck.checking.batch import one_by_one

    with contextlib.ExitStack() as stack:
        if address is not None and tasks:
            from polarcheck.checking import crews
            from polarcheck.commands import cluster as of_cluster

            crew = stack.enter_context(of_cluster.crew(address, tasks, most))
            found = crews.outcomes(tasks, crew, most)
        elif workers == 1 or len(tasks) <= 1:
            found = one_by_one(tasks, most)
        elif workers:
            found = _by_pool(tasks, most, workers)
        else:
            found = _as_it_pays(tasks, most, cores())
        yield stack.enter_context(contextlib.closing(found))


def _as_it_pays(tasks: Sequence[Task], most: int, workers: int) -> Generator[Outcome, None, None]:
    from polarcheck.checking.batch import forget, outcome

    begun = time.monotonic()
    for number, task in enumerate(tasks):
        if workers > 1 and _pays(tasks[number:], number, time.monotonic() - begun, workers):
            yield from _by_pool(tasks[number:], most, workers)
            return
        if number:
            forget()
        yield outcome(task, most)


def _pays(left: Sequence[Task], done: int, seconds: float, workers: int) -> bool:
    """Whether others should be started; seconds: that those that are done took."""
    if len(left) == 1:
        return False
    from polarcheck.checking import crews
    from polarcheck.reading import files

    # The first file counts twice: what it loads and compiles the others find there.
    saved = seconds / (done + 1) * len(left) * (1 - 1 / min(workers, len(left)))
    return saved > _COST[crews.start_method()] or files.size(left[0].path) >= _LARGE


def _by_pool(tasks: Sequence[Task], most: int, workers: int) -> Generator[Outcome, None, None]:
    from polarcheck.checking import crews, pool, tables

    if crews.start_method() == "fork":
        # What is loaded here need not be loaded by each of them.
        for maker in tables.MAKERS.values():
            importlib.import_module(maker.partition(":")[0])
    crew = pool.Pool(tasks, min(workers, len(tasks)), most, Preparation(workers))
    return crews.outcomes(tasks, crew, most)


class Preparation:
    """What a process does before it checks the first file; it is sent there. workers: that share the memory."""

    def __init__(self, workers: int) -> None:
        self.workers = workers

    def __call__(self, is_alone: bool) -> None:
        """Bound its memory; a file that was lost for want of it is tried with all of it."""
        import gc

        gc.disable()  # as in the first process (commands.run)
        keep_within_memory(1 if is_alone else self.workers)
