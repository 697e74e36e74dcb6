"""The machines, tools and jobs with which inputs of the fuzzing are run: SETUPS; and what is raised where one fails."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any, NamedTuple

from programs import job_of, machine_of

from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job


class BrokenError(AssertionError):
    """What must hold does not. kind: in a few words, the same for the same fault; the message says more."""

    def __init__(self, kind: str, more: object = "") -> None:
        super().__init__(f"{kind}: {more}" if more else kind)
        self.kind = kind


class Setup(NamedTuple):
    """On which machine, with which tools and job a program is checked."""

    machine: str
    tools: tuple[str, ...]
    job: Job


def _setups() -> Iterator[Setup]:
    tools = (
        ("1:radius=5", "2:radius=3,nose=0", "8:radius=9.525"),
        (),
        ("1:radius=0", "8:radius=0"),
        ("1:radius=0.4,nose=3", "2:radius=-0.1", "8:radius=1000"),
    )
    jobs = (
        {},
        {"run": {"variables": {"1": 5.0, "100": 1e300}}, "stock": {"diameter": 60.0}},
        {"units": "mm", "program_units": "inch", "radius_from_comments": True, "work_offsets": {"G54": {"x": 1.5}}},
    )
    # Bounds that a small program reaches, and that keep an input from taking long.
    run = {"max_blocks": 3000, "max_statements": 2000, "max_seconds": 5.0}
    for number, name in enumerate(sorted(profiles.names())):
        for more in (0, 1):
            asked: dict[str, Any] = dict(jobs[(number + more) % len(jobs)])
            asked["run"] = {**run, **asked.get("run", {})}
            if "work_offsets" in asked and not machine_of(name).codes("work_offset"):
                del asked["work_offsets"]
            yield Setup(name, tools[(number + 2 * more) % len(tools)], job_of(job=asked))


SETUPS = tuple(_setups())


@functools.cache
def job_of_setup(number: int) -> Job:
    """The job of a setup, with its tools."""
    return job_of(*SETUPS[number].tools, job=SETUPS[number].job)


def expect(holds: bool, kind: str, more: object = "") -> None:
    """Raise BrokenError where it does not hold."""
    if not holds:
        raise BrokenError(kind, more)
