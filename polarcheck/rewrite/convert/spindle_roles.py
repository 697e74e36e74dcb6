"""Which spindle the codes and speeds of a program are for: the main spindle, or the live tool that mills."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, mask_at


class SpindleRoles:
    """
    The spindle that each row starts, stops or gives a speed.

    of_live_tool: a boolean per row: M3, M4 and M5 of it are for the live tool, which has no codes of its own on this
    machine: the spindle that they start runs in a polar section, whose C axis is the main spindle.
    speed_of_live_tool: a boolean per row: S of it is that of the live tool.
    """

    def __init__(self, trace: Trace) -> None:
        codes, blocks, modal = trace.machine.m_codes, trace.blocks, trace.modal
        begins = blocks.codes(*(word for word in codes.spindle_on if word not in codes.live_tool_on))
        begins_live = blocks.codes(*codes.live_tool_on)
        self.of_live_tool = np.zeros(len(trace), bool) if codes.live_tool_on else _in_sections(trace, begins)
        live = begins_live | (begins & self.of_live_tool)
        starts = begins | begins_live
        runs = np.asarray(modal.live_tool | (modal.spindle & self.of_live_tool))
        self.speed_of_live_tool = np.where(starts, live, np.where(runs | modal.spindle, runs, _next(live, starts)))
        self.speed_of_live_tool &= ~blocks.listed("coordinate_setting", "constant_surface_speed")


def _in_sections(trace: Trace, begins: Mask) -> Mask:
    """Rows from the start of a spindle that runs in a section up to the code that stops it, that row included."""
    stretch = np.cumsum(begins | trace.blocks.starts)
    milling = mask_at(int(stretch[-1]) + 1 if len(stretch) else 1, stretch[trace.modal.spindle & trace.mode.in_polar])
    return milling[stretch]


def _next(live: Mask, starts: Mask) -> Mask:
    """Per row: the next start of a spindle from there on is that of the live tool."""
    rows = np.flatnonzero(starts)
    index = np.searchsorted(rows, np.arange(len(starts)))
    return np.append(live[rows], False)[index]
