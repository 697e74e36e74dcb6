"""
Findings in called programs: those of another file are shown at the block of this file that calls it, those of another
channel of this file where they are. A finding of some of the calls of a program says of which.
"""

from collections.abc import Callable, Mapping, Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.finding import Finding

#: Turns a finding at a block of the calling file into its reported form: that block may allow it.
Answered = Callable[[Finding, int], Finding]


#: The row of a finding by its rule, line and column.
RowsOfFindings = Mapping[tuple[str, int, int], int]


def in_call(trace: Trace, rows: Rows, row: int) -> str:
    """
    The calls in which a finding of a called program occurs, where only some of several calls have it.

    rows: all that the rule has hit. row: where the finding stands. Calls are those of the main program; where one of
    them runs the block several times, those of the program that calls it.
    """
    depth, line = trace.run.depth, trace.blocks.line
    if not depth[row] or trace.text.source.part_of(int(line[row])):
        return ""
    runs = np.flatnonzero(trace.run.block == trace.run.block[row])
    for level in range(int(depth[runs].min())):
        calls = _calls(depth, runs, level)
        if len(set(line[calls].tolist())) > 1 and not np.any(calls < 0):
            has = set(line[_calls(depth, rows[trace.run.block[rows] == trace.run.block[row]], level)].tolist())
            if has == set(line[calls].tolist()):
                return ""
            of_one = int(line[_calls(depth, np.array([row]), level)[0]])
            more = f" and {len(has) - 1} more" if len(has) > 1 else ""
            return f" (in the call of line {of_one}{more})"
    return ""


def _calls(depth: Rows, rows: Rows, level: int) -> Rows:
    """Per row the last row above it at a level of calls; -1 for none."""
    above = np.append(-1, np.flatnonzero(depth <= level))
    return above[np.searchsorted(above, rows) - 1]


def in_the_file(
    findings: Sequence[Finding], trace: Trace, answered: Answered, rows: RowsOfFindings | None = None
) -> list[Finding]:
    """
    Findings in a called program that lies in another file are shown at the block that calls it.

    What its text alone has wrong is left to a check of that file; what follows from that is shown for itself.
    """
    if not trace.text.source.parts:
        return list(findings)
    collected: list[Finding] = []
    for finding in findings:
        following = in_the_file(finding.follows, trace, answered, rows)
        row = (rows or {}).get((finding.rule, finding.line, finding.column))
        reported = _not_suppressed(finding, trace, answered, row)
        if reported is None:
            collected += following
        else:
            collected.append(msgspec.structs.replace(reported, follows=following))
    return collected


def _not_suppressed(finding: Finding, trace: Trace, answered: Answered, row: int | None) -> Finding | None:
    source = trace.text.source
    part = source.part_of(finding.line)
    if part is None:
        return finding
    call = _call_of(trace, finding.line, row)
    if call is None:
        return None
    line, block, text_of_block = call
    text = source.line_text(line)
    section_line = finding.section_line
    if source.is_own(part):
        return _moved_to_call(finding, part[1], source.part_of(section_line) if section_line else None)
    located = msgspec.structs.replace(
        finding,
        message=f"in {part[0]}, line {part[1]}, {finding.block}: {finding.message}",
        line=line,
        end_line=line,
        column=1 + len(text) - len(text.lstrip()),
        end_column=1 + len(text.rstrip()),
        block=text_of_block,
        section_line=None if section_line and source.part_of(section_line) else section_line,
        fix=None,
    )
    return answered(located, block)


def _moved_to_call(finding: Finding, line: int, section: tuple[str, int] | None) -> Finding:
    """A finding at a line of the file itself, with the line of its G12.1."""
    end_line = line + finding.end_line - finding.line
    section_line = section[1] if section else finding.section_line
    return msgspec.structs.replace(finding, line=line, end_line=end_line, section_line=section_line, fix=None)


def _call_of(trace: Trace, line: int, row: int | None) -> tuple[int, int, str] | None:
    """
    The line, number and text of the block of this file that ran last before a line of a called program.

    row: where the finding stands; without it the first run of the line counts. None where no block ran before it.
    """
    rows = (trace.blocks.line == line).nonzero()[0] if row is None else np.array([row])
    if not len(rows):
        return None
    first_part = trace.text.source.parts[0].first_line
    before_part = (trace.blocks.line[: rows[0]] < first_part).nonzero()[0]
    if not len(before_part):
        return None
    call_line = int(trace.blocks.line[before_part[-1]])
    return call_line, int(trace.run.block[before_part[-1]]), trace.text.source.line_text(call_line).strip()
