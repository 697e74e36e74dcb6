"""What a program is taken to mean where its control reads something else: numbers without a decimal point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polarcheck.foundation.errors import counted
from polarcheck.foundation.states import Units

if TYPE_CHECKING:
    from polarcheck.columns.trace import Trace


def as_meant(trace: Trace, section: int) -> str:
    """
    The numbers of a section that are followed as if they had a decimal point, and what the control reads.

    Empty where there are none. The part and the pictures show what is meant, and a finding says what will be cut.
    """
    taken = trace.coordinates.is_taken_as_pointed
    if not taken.any():
        return ""
    group = np.where(trace.mode.section == section, 0, -1)
    words, control = trace.coordinates.written_once(taken, group)[0], trace.machine.control
    if not len(words):
        return ""
    table, first = trace.run.words, int(words[0])
    row, value = int(trace.run.row[first]), float(table.value[first])
    word = f"{chr(int(table.address[first]))}{value:g}"
    inch = bool(trace.lengths.units[row] == Units.INCH)
    read = f"{value * control.least_increment_inch:.4f}" if inch else f"{value * control.least_increment:.3f}"
    more = len(words) - 1
    remark = f" (and {counted(more, 'more number')} without a decimal point)" if more else ""
    line = int(trace.blocks.line_in_file[row])
    return f"line {line}: {word} is taken as {word}., as probably meant{remark}; the control reads {read}"
