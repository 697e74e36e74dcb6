"""Why no path of the tool can be drawn, and what to give."""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking.phrases.offsets import called_tool, to_give
from polarcheck.table.moves import Moves
from polarcheck.table.trace import Trace


def why_unknown(trace: Trace, moves: Moves, chosen: Rows) -> str:
    """A sentence on those of the chosen moves whose tool path is not known, and empty without them."""
    unknown = moves.row[chosen[~moves.is_of_tool[chosen]]]
    if not len(unknown):
        return ""
    lacking = unknown[np.isnan(trace.radius_of_move[unknown])]
    _, first = np.unique(trace.offset_number[lacking], return_index=True)
    rows = lacking[np.sort(first)].tolist()
    if not rows:
        line = int(trace.line_in_file[unknown[0]])
        return f"the path of the tool is not known from line {line} on: a position there is not known"
    missing = ", ".join(f"R of {called_tool(trace, row)}" for row in rows if trace.offset_number[row])
    remedies = "; ".join(to_give(trace, row, "radius") for row in rows)
    return f"what is run with G41 or G42 is drawn as programmed: {missing or 'R'} is not known; {remedies}"
