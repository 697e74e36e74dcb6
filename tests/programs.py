"""
A program in, a report or a trace out: the one way by which the tests reach the package.

    report = report_of("G12.1\nG0 X40.\nG13.1\n", "fanuc-30i", "1:radius=4", changes={"limits": {"c_feed": 3600}})
    assert said(report) == [(2, "rapid-in-polar")]

The arguments of report_of, tables_of, trace_of and moves_of are the same: the machine by name (or one at hand),
tools as `--tool` takes them, changes to values of the machine, and a job as polarcheck.toml holds it. Nothing is read
from the folder.
"""

from __future__ import annotations

import functools
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from polarcheck.checking import check
from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.finding import FileReport
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, from_table, with_tool
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.examples import Example
from polarcheck.rules.rule import Rule, find, load_all
from polarcheck.rules.tables import Tables

ROOT = Path(__file__).parent.parent
SHARED = ROOT.parent / "shared"
"""Facts and real programs, which lie beside the checkout and not in it."""
CORPUS = SHARED / "corpus"

Changes = Mapping[str, Any]

_EXPECTED = re.compile(r"\(expect: ([a-z0-9, -]+)\)")
_BUILT_IN = frozenset(profiles.names())
_machines: dict[tuple[str, str], Machine] = {}


def machine_of(name: str = profiles.DEFAULT, changes: Changes | None = None) -> Machine:
    """A machine by name or file, with changes; each of the built-in ones is read once."""
    if name not in _BUILT_IN:
        return profiles.load(name, changes).machine
    key = name, repr(changes)
    if key not in _machines:
        _machines[key] = profiles.load(name, changes).machine
    return _machines[key]


def job_of(*tools: str, job: Job | Changes | None = None) -> Job:
    """A job, or the job of a table, with tools."""
    found = job if isinstance(job, Job) else from_table(job or {}, "test")
    for tool in tools:
        found = with_tool(found, tool)
    return found


def report_of(
    program: str | bytes,
    machine: str | Machine = profiles.DEFAULT,
    *tools: str,
    changes: Changes | None = None,
    job: Job | Changes | None = None,
    only: Sequence[str | Rule] = (),
    path: str = "-",
) -> FileReport:
    """What is reported of a program; only: by these rules, or those of these groups."""
    work = job_of(*tools, job=job)
    chosen = [rule for one in only for rule in ([one] if isinstance(one, Rule) else find(one, load_all()))]
    rules = chosen if only else list(load_all().values())
    return check.check_file(_bytes(program), _machine(machine, changes), work, rules, path, severities=work.severities)


def tables_of(
    program: str | bytes,
    machine: str | Machine = profiles.DEFAULT,
    *tools: str,
    changes: Changes | None = None,
    job: Job | Changes | None = None,
    path: str = "-",
) -> Tables:
    """The tables that rules compare, by name, with block skip off where that makes a difference."""
    return check.read(_bytes(program), _machine(machine, changes), job_of(*tools, job=job), path)[0][1]


def trace_of(program: str | bytes, machine: str | Machine = profiles.DEFAULT, *tools: str, **more: Any) -> Trace:
    """The executed program; the arguments are those of tables_of."""
    trace: Trace = tables_of(program, machine, *tools, **more)["trace"]
    return trace


def moves_of(program: str | bytes, machine: str | Machine = profiles.DEFAULT, *tools: str, **more: Any) -> Moves:
    """The moves of the tool center; the arguments are those of tables_of."""
    moves: Moves = tables_of(program, machine, *tools, **more)["moves"]
    return moves


def report_of_example(example: Example, only: Sequence[str | Rule] = ()) -> FileReport:
    """What is reported of an example of a manual page, on its machine, with its tools and values."""
    name, values = settings_of(example)
    return report_of(example.program, name, *example.tools, changes=values["machine"], job=values["job"], only=only)


def tables_of_example(example: Example) -> Tables:
    """The tables of an example likewise."""
    name, values = settings_of(example)
    return tables_of(example.program, name, *example.tools, changes=values["machine"], job=values["job"])


def settings_of(example: Example) -> tuple[str, dict[str, dict[str, Any]]]:
    """The machine of an example, and its values for machine and job."""
    values: dict[str, dict[str, Any]] = {"machine": {}, "job": {}}
    for setting in example.settings:
        key, _, value = setting.partition("=")
        side = "job" if key.startswith("job.") else "machine"
        *folders, last = key.removeprefix("job.").split(".")
        table = values[side]
        for folder in folders:
            table = table.setdefault(folder, {})
        table[last] = tomllib.loads(f"value = {value}")["value"]
    return example.machine or profiles.DEFAULT, values


@functools.cache
def report_of_whole_example(example: Example) -> FileReport:
    """As report_of_example by all rules, once for all tests that only look at it."""
    return report_of_example(example)


def said(report: FileReport) -> list[tuple[int, str]]:
    """The line and the rule of each finding, sorted."""
    return sorted((finding.line, finding.rule) for finding in report.findings)


def expected(text: str) -> list[tuple[int, str]]:
    """What the comments of a program expect, `(expect: rule, other-rule)`, as `said` gives it."""
    return sorted(
        (number, name.strip())
        for number, line in enumerate(text.split("\n"), 1)
        for found in _EXPECTED.finditer(line)
        for name in found[1].split(",")
    )


def without_expectations(text: str) -> str:
    """The program without these comments, behind a semicolon included."""
    return re.sub(r"[ \t]*;?[ \t]*\(expect: [^)\n]*\)", "", text)


def _bytes(program: str | bytes) -> bytes:
    return program if isinstance(program, bytes) else program.encode()


def _machine(machine: str | Machine, changes: Changes | None) -> Machine:
    assert isinstance(machine, str) or not changes, "changes are for a machine by name"
    return machine_of(machine, changes) if isinstance(machine, str) else machine
