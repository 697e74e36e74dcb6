"""
docs/one_block.md: one block of a program at every stage, from its bytes to the line on the screen.

All values on the page are computed here, so a test can compare the page with what the program does today.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from polarcheck.checking import check
from polarcheck.checking.engine import Engine
from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, Tool
from polarcheck.program.reading import source
from polarcheck.reports.concise import lines as concise_lines
from polarcheck.rules import places
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

#: A flat at 1 mm from the center, compensated, with an F that is too high there; cutter radius 4 mm.
PROGRAM = b"""O1 (FLAT)
G21 G40 G97 G98 G18
T0101
G0 X60. Z2. C-30.
G12.1
G1 Z-5. F300
G42 X-6. C-20. F1000
C20. F2000
G40 X60. C40.
G13.1
M30
"""
LINE = 8
CHANGES = {"limits": {"c_feed": 3600}}
RULE = "c-feed-above-limit"


def page() -> str:
    """The page in Markdown."""
    machine = profiles.load("fanuc", CHANGES).machine
    job = Job(tools={"1": Tool(radius=4.0)})
    ((_, tables),) = check.read(PROGRAM, machine, job, "flat.nc")
    trace: Trace = tables["trace"]
    row = int(np.flatnonzero(trace.blocks.line == LINE)[0])
    return "\n".join(
        [
            *_beginning(),
            *_bytes_and_words(),
            *_row(trace, row),
            *_columns(trace, row),
            *_moves(tables, row),
            *_rule(tables),
            *_report(tables, row),
            *_where_to_look(),
            "",
        ]
    )


def _beginning() -> Iterator[str]:
    yield "# One block through the program"
    yield ""
    yield from _wrapped(
        "This page follows one block from its bytes to the line on the screen, with the values at each "
        "stage. It is made by `python docs/make.py`, and a test compares it "
        "with what the program computes today."
    )
    yield ""
    yield from _wrapped(
        "The program cuts a flat beside the center of the C axis. The cutter has a radius of 4 mm, the C "
        f"axis of this lathe may turn at {CHANGES['limits']['c_feed']} deg/min (`limits.c_feed`). Line "
        f"{LINE} asks for more:"
    )
    yield ""
    yield from (f"    {number:2}  {line}" for number, line in enumerate(PROGRAM.decode().splitlines(), 1))


def _bytes_and_words() -> Iterator[str]:
    text = source_text()
    block = int(np.flatnonzero(text.blocks.line == LINE)[0])
    start, end = int(text.blocks.start[block]), int(text.blocks.end[block])
    yield from _heading("Bytes to words", "program/reading/")
    yield from _wrapped(
        "`source.read_source` finds the encoding and the lines. `words.read_words` finds all words of the file "
        "at once, as a table with one element per word; nothing is raised, a word that cannot be read is "
        "marked."
    )
    yield ""
    yield from _wrapped(
        f"Line {LINE} is block {block}, characters {start} to {end} (exclusive): `{PROGRAM[start:end].decode()}`"
    )
    yield ""
    words = np.flatnonzero(text.words.block == block)
    yield from _table(
        ("word", "`address`", "`value`", "`decimals`", "`has_point`", "`start`"),
        [
            (
                str(index),
                chr(text.words.address[index]),
                f"{text.words.value[index]:g}",
                str(text.words.decimals[index]),
                str(bool(text.words.has_point[index])),
                str(text.words.start[index]),
            )
            for index in words.tolist()
        ],
    )


def source_text() -> Any:
    """The text of the program, as the reader has it."""
    from polarcheck.program.reading.words import read_words

    return read_words(source.read_source(PROGRAM, "flat.nc"))


def _row(trace: Trace, row: int) -> Iterator[str]:
    yield from _heading("Block to row", "program/execution/")
    yield from _wrapped(
        "`runs.runs` puts the blocks into the order in which the control executes them: one row per "
        "executed block. A block in a loop has several rows, a block that is skipped none. This program "
        "has no macro statement and no call, so its rows are its blocks that have words."
    )
    yield ""
    yield from _wrapped(
        f"Row {row} of {len(trace)} executes block {int(trace.run.block[row])}; calls around it: "
        f"{int(trace.run.depth[row])}."
    )


def _columns(trace: Trace, row: int) -> Iterator[str]:
    yield from _heading("Row to columns", "columns/")
    yield from _wrapped(
        "Each state and position is a column: a NumPy array with one element per row, computed when it "
        "is first read. Lengths are in mm, X is a radius, points on the polar plane are complex numbers "
        "x + j c, unknown is NaN."
    )
    yield ""
    point = _point
    shown = [
        ("`blocks.line`", str(int(trace.blocks.line[row])), "line in the file"),
        ("`axes.motion`", Motion(int(trace.axes.motion[row])).name, "G1 of line 6 is still in force"),
        ("`mode.in_polar`", str(bool(trace.mode.in_polar[row])), "between G12.1 and G13.1"),
        ("`mode.section`", str(int(trace.mode.section[row])), "number of the polar section"),
        ("`path.start`", point(trace.path.start[row]), "X-6. is a diameter: -3 mm as a radius"),
        ("`path.end`", point(trace.path.end[row]), "C is a length in the mode"),
        ("`path.length`", f"{trace.path.length[row]:g} mm", ""),
        ("`compensation.side`", Side(int(trace.compensation.side[row])).name, "G42 of line 7"),
        ("`compensation.radius`", f"{trace.compensation.radius[row]:g} mm", "offset 1 of T0101, from the job"),
        ("`feedrate.feed_mode`", FeedMode(int(trace.feedrate.feed_mode[row])).name, "G98"),
        ("`feedrate.feed`", f"{trace.feedrate.feed[row]:g} mm/min", "F of this block"),
    ]
    yield from _table(("column", "value", "because"), shown)


def _moves(tables: Tables, row: int) -> Iterator[str]:
    moves: Moves = tables["moves"]
    (index,) = np.flatnonzero(moves.row == row).tolist()
    trace: Trace = tables["trace"]
    aside = moves.start[index] - trace.path.start[row]
    yield from _heading("Row to move of the tool center", "columns/path/, geometry/")
    yield from _wrapped(
        "Cutter compensation moves the path to the right of the programmed one, by the radius. "
        "`columns/path/tool_center.py` passes the columns of the section to `geometry/cutter_compensation/`, which "
        "knows arrays only; `columns/path/moves.py` holds the result, one element per move of the tool center. "
        "`geometry/polar.py` and `geometry/rates.py` compute the distance from the center and the rate "
        "of C."
    )
    yield ""
    shown = [
        ("`start`", _point(moves.start[index]), f"{abs(aside):g} mm beside the programmed path"),
        ("`end`", _point(moves.end[index]), ""),
        ("`nearest`", f"{moves.nearest[index]:.4g} mm", "L, smallest distance from the center of C"),
        ("`c_feed`", f"{moves.c_feed[index]:.0f} deg/min", "F / L * 180 / pi"),
    ]
    yield from _table(("column", "value", "meaning"), shown)
    yield ""
    rate = float(np.degrees(trace.feedrate.feed[row] / moves.nearest[index]))
    yield from _wrapped(
        f"By hand: {trace.feedrate.feed[row]:g} / {moves.nearest[index]:.4g} * 180 / pi = {rate:.0f} deg/min."
    )


def _rule(tables: Tables) -> Iterator[str]:
    rule = load_all()[RULE]
    hits = rule.hits(tables)
    yield from _heading("Columns to hits", "rules/")
    yield from _wrapped(
        "A rule is one function in a file of its own name, here "
        f"`rules/{rule.group}/{RULE.replace('-', '_')}.py`. Its parameters name the tables that it "
        f"compares ({', '.join(f'`{name}`' for name in rule.parameters)}); it returns a mask, or `Hits` "
        "with a severity."
    )
    yield ""
    lines = tables["blocks"].line
    rows = [f"row {index} (line {lines[index]})" for index in np.flatnonzero(hits.mask).tolist()]
    yield f"It hits {', '.join(rows)}."


def _report(tables: Tables, row: int) -> Iterator[str]:
    rules = list(load_all().values())
    engine = Engine(tables, {}, [load_all()[RULE]])
    (finding,) = engine.findings()
    place = places.of_row(tables, row)
    yield from _heading("Hit to finding", "rules/, checking/")
    yield from _wrapped(
        "`places` finds the words at fault, `message` fills the text of the rule with its "
        "details, `engine` merges what has one cause (here all blocks under one F word) and lists under "
        "it what follows from it."
    )
    yield ""
    shown: Sequence[tuple[str, str]] = [
        ("place", f"block {place.block}, row {place.row}"),
        ("`line`, `column`", f"{finding.line}, {finding.column} to {finding.end_column}"),
        ("`severity`", finding.severity),
        ("`message`", finding.message),
        ("`values`", ", ".join(f"{name} = {_value(value)}" for name, value in finding.values.items())),
        ("`alarm`", str(finding.alarm)),
        ("`section_line`", str(finding.section_line)),
        ("`fix`", finding.fix.title if finding.fix else "none"),
    ]
    yield from _table(("field", "value"), shown)
    report = check.check_runs([("", tables)], rules)
    yield from _heading("Finding to line", "reports/, commands/")
    yield from _wrapped(
        "`checking/check.py` sorts the findings and gives the verdict. A module of `reports/` makes text "
        "of the report, and `commands/check.py` prints it and chooses the exit code. With `--format "
        "concise` the screen shows:"
    )
    yield ""
    yield from (f"    {line}" for line in _concise(report))


def _concise(report: Any) -> list[str]:
    return list(concise_lines(report, silenced=False))


def _where_to_look() -> Iterator[str]:
    yield from _heading("Where to add something", "")
    yield from _wrapped(
        "- A column: in the table of `columns/` that it belongs to. [architecture.md](architecture.md) "
        "lists the tables."
    )
    yield from _wrapped(
        "- A table: a class in `columns/` whose arguments name the tables that it needs, and its line in "
        "`rules/tables.py`."
    )
    yield from _wrapped("- A rule: one file under `rules/`, see [adding_a_rule.md](adding_a_rule.md).")
    yield from _wrapped("- A report: a module in `reports/` with a function of its own name.")


# ---- Markdown ----


def _heading(title: str, room: str) -> Iterator[str]:
    yield ""
    yield f"## {title}" + (f" (`{'`, `'.join(room.split(', '))}`)" if room else "")
    yield ""


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, 118, break_long_words=False, break_on_hyphens=False)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield f"|{'---|' * len(head)}"
    for cells in rows:
        yield f"| {' | '.join(cells)} |"


def _point(value: complex) -> str:
    return f"{value.real:g} {'-' if value.imag < 0 else '+'} {abs(value.imag):g}j"


def _value(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
