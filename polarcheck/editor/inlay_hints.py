"""Values at the ends of blocks in the polar mode: the C angle, or the highest F."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from lsprotocol import types

from polarcheck.columns.trace import Trace
from polarcheck.editor.analysis import Analysis
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.time_limit import time_limit
from polarcheck.rules.quantity import in_row
from polarcheck.rules.tables import Tables

#: What is shown, as the settings of the editor name it.
OFF, C_ANGLE, HIGHEST_FEED = "off", "c_angle", "highest_feed"
#: The time limit, since hints may need tables that no rule has used [s].
_PATIENCE = 5.0
#: The most hints of an answer.
_MOST = 5_000


def inlay_hints(analysis: Analysis, visible: types.Range, what: str) -> list[types.InlayHint]:
    """Return the hints of the lines of a range; what: C_ANGLE or HIGHEST_FEED. Unknown values are left out."""
    if what not in (C_ANGLE, HIGHEST_FEED):
        return []
    first, last = analysis.text.line_of(visible.start), analysis.text.line_of(visible.end)
    hints: dict[int, types.InlayHint] = {}
    try:
        with time_limit(_PATIENCE):
            for _, tables in analysis.runs:
                trace: Trace = tables["trace"]
                for line, label, remark in _of_run(tables, trace, first, last, what):
                    if line not in hints:
                        hints[line] = _hint(analysis, line, label, remark)
    except TooHardError:
        return []
    return [hints[line] for line in sorted(hints)][:_MOST]


def _hint(analysis: Analysis, line: int, label: str, remark: str) -> types.InlayHint:
    end = analysis.text.line_range(line).end
    return types.InlayHint(position=end, label=label, tooltip=remark, padding_left=True)


def _of_run(tables: Tables, trace: Trace, first: int, last: int, what: str) -> Iterator[tuple[int, str, str]]:
    """Yield line, label and remark of the lines that a run executes in the polar mode."""
    lines = trace.blocks.line_in_file
    rows = np.flatnonzero((lines >= first) & (lines <= last) & trace.mode.in_polar & (trace.run.depth == 0))
    if not len(rows):
        return
    values = trace.path.c_angle if what == C_ANGLE else tables["tool_center"].feed_allowed
    moves = trace.axes.moves_plane
    for line in np.unique(lines[rows]).tolist():
        of_line = rows[(lines[rows] == line) & moves[rows] & np.isfinite(values[rows])]
        if not len(of_line):
            continue
        several = f", the first of {len(of_line)} runs" if len(of_line) > 1 else ""
        if what == C_ANGLE:
            row = int(of_line[0])
            yield line, f"C {float(values[row]):.2f}\u00b0", f"C axis behind this block{several}"
        else:
            row = int(of_line[np.argmin(values[of_line])])
            highest = in_row(float(values[row]), trace.lengths, row)
            several = f", the lowest of {len(of_line)} runs" if len(of_line) > 1 else ""
            yield line, f"F {highest:highest}", f"highest F here{several}"
