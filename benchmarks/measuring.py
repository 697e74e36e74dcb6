"""Whole processes in turn, by what the operating system says of them; tables of Markdown."""

from __future__ import annotations

import math
import os
import statistics
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parent.parent
#: Code of Python is compiled once, as at a user's, output has one width, and polarcheck takes no results of earlier
#: runs. All have one thread for linear algebra, which none of them needs: starting more takes a fifth of the import of
#: NumPy.
_ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"} | {
    "COLUMNS": "200",
    "OPENBLAS_NUM_THREADS": "1",
    "POLARCHECK_NO_CACHE": "1",
}
#: What takes longer on the clock [s] varies less, and runs less often.
SLOW = 10
SLOW_ROUNDS = 3


class Taken(NamedTuple):
    """
    What a process has taken: time of the processor and on the clock [s], peak memory [bytes], and its exit code.

    runs: of how many these are the median. cpus, clocks: the times of each of them.
    """

    cpu: float
    clock: float
    peak: int
    status: int
    runs: int = 1
    cpus: tuple[float, ...] = ()
    clocks: tuple[float, ...] = ()


def run(command: Sequence[str]) -> Taken:
    """Run a process to its end. Its peak is that of what starts it at least, which loads little for that reason."""
    began = time.perf_counter()
    running = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=ROOT, env=_ENVIRONMENT
    )
    _, status, used = os.wait4(running.pid, 0)
    running.returncode = os.waitstatus_to_exitcode(status)
    return Taken(used.ru_utime + used.ru_stime, time.perf_counter() - began, used.ru_maxrss * 1024, running.returncode)


def measured(commands: Mapping[str, Sequence[str]], rounds: int) -> dict[str, Taken]:
    """The median of each figure over the rounds; in a round each command runs once, a slow one in the first few."""
    taken: dict[str, list[Taken]] = {name: [] for name in commands}
    for finished in range(rounds):
        for name, command in commands.items():
            if finished < SLOW_ROUNDS or taken[name][0].clock < SLOW:
                taken[name].append(run(command))
    return {name: _middle(runs) for name, runs in taken.items()}


def _middle(runs: Sequence[Taken]) -> Taken:
    cpus, clocks, peaks, statuses, *_ = zip(*runs, strict=True)
    peak, status = (int(statistics.median(column)) for column in (peaks, statuses))
    return Taken(statistics.median(cpus), statistics.median(clocks), peak, status, len(runs), cpus, clocks)


def ratio(times: Sequence[float], others: Sequence[float]) -> float:
    """The median of the ratios of each round: a machine whose speed drifts is as fast for both of a round."""
    return statistics.median(one / other for one, other in zip(times, others, strict=False))


def apart(function: Callable[..., Any], *arguments: Any) -> Any:
    """
    The result of a function that runs in a process of its own.

    A process inherits the peak of what starts it: what measures others must never have held much itself.
    """
    with ProcessPoolExecutor(1) as other:
        return other.submit(function, *arguments).result()


def output(command: Sequence[str]) -> tuple[int, str]:
    """The exit code and all that a process says."""
    done = subprocess.run(command, capture_output=True, check=False, cwd=ROOT, env=_ENVIRONMENT)
    return done.returncode, (done.stdout + done.stderr).decode("utf-8", "replace")


def table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table of Markdown; all columns but the first are figures."""
    lines = [heads, ["---", *["---:"] * (len(heads) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def exponent(sizes: Sequence[float], values: Sequence[float]) -> float:
    """How a value grows with the size, by its logarithms: 1 where twice the size takes twice as much."""
    found = statistics.linear_regression([*map(math.log, sizes)], [*map(math.log, values)])
    return found.slope
