"""A program in pieces far smaller than a check makes them, beside the same program as one table."""

from __future__ import annotations

import re
from collections.abc import Iterator
from unittest.mock import patch

from programs import job_of, machine_of

from polarcheck.checking import pieces, piecewise
from polarcheck.checking.examples import examples
from polarcheck.checking.rule import Rule, load_all
from polarcheck.errors import IsOneError
from polarcheck.finding import FileReport
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading import source

#: What ends a program, or makes it one that no piece can be cut from.
_LEFT_OUT = re.compile(r"^\s*(?:%|[O:]\d)|M30|M0?2\b|M99|POLARCHECK|#|GOTO|\bM98")
#: Ends an operation as posts do.
_RETURN = "G28 U0 W0"


def in_pieces(
    data: bytes, machine: Machine | str, *tools: str, job: Job | None = None, size: int = 300, near: int = 6
) -> FileReport | None:
    """
    The report of a program in pieces of about `size` characters; None where it is one table, or a single piece.

    near: how many blocks before a piece are kept as they stand.
    """
    count = 0

    def counted(*given: object) -> Iterator[pieces.Piece]:
        nonlocal count
        for piece in cut(*given):  # type: ignore[arg-type]
            count += 1
            yield piece

    cut = pieces.in_pieces
    of = machine_of(machine) if isinstance(machine, str) else machine
    with (
        patch.object(pieces, "NEAR", near),
        patch.object(pieces, "SIZE", size),
        patch.object(piecewise, "in_pieces", counted),
    ):
        try:
            rules = list(load_all().values())
            report, _ = piecewise.check_in_pieces(source.read(data), of, job_of(*tools, job=job), rules, None)
        except IsOneError:
            return None
    return report if count > 1 else None


def several(rule: Rule) -> Iterator[str]:
    """Programs with an example of a rule twice, among sound operations: those of the default machine."""
    for example in examples(rule.page):
        if example.machine not in ("", "fanuc-30i") or example.settings:
            continue
        own = _blocks(example.program)
        if len(own) > 3:
            yield "\n".join(["%", "O0001", *own, _RETURN, *SOUND, *own, "G0 X200. Z50.", *SOUND, "M30", "%", ""])


def _blocks(program: str) -> list[str]:
    return [line for line in program.splitlines() if line.strip() and not _LEFT_OUT.search(line)]


#: A hexagon, a slot and a turned shoulder, each called and left as posts do.
SOUND = """\
T0101 (TURN)
G18 G99 G97 S800 M3
G0 X52. Z2.
G1 Z-10. F0.2
G1 X56.
G0 Z2.
M5
G28 U0 W0
T0202 (END MILL D8.)
M35 G28 H0
G98 G97 S2000 M33
G0 X60. Z2.
G0 C0.
G12.1
G1 G42 X40. F400.
G1 Z-2. F100.
C11.547 F200.
X0. C23.094
X-40. C11.547
C-11.547
X0. C-23.094
X40. C-11.547
C1.
G1 G40 X60. F400.
G1 Z2.
G13.1
M34
G28 U0 W0""".splitlines()
