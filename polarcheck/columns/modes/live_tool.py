"""The speed of the live tool."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask
from polarcheck.geometry.tolerances import SHARE


def speed(trace: Trace) -> Floats:
    """
    S of the live tool in force per row [1/min]; NaN where none is known.

    Where the profile names codes of the live tool, S counts that stands in a block with one, or while it runs and
    no code of the main spindle is beside it; else any S but a surface speed and the limit of G50. A live tool may have
    a word of its own, as S3=.
    """
    codes, takes = trace.machine.m_codes, _takes(trace)
    is_speed = trace.modal.state("speed") == 0
    if codes.live_tool_on:
        starts = trace.blocks.codes(*codes.live_tool_on)
        waits = takes & ~trace.blocks.codes(*codes.spindle_on) & (trace.modal.live_tool | _next_starts_live_tool(trace))
        is_speed = np.where(starts, takes, waits & is_speed)
    values = np.where(takes & is_speed, trace.blocks.word("S"), np.nan)
    for name in trace.machine.live_tool_speeds:
        values = np.where(trace.blocks.has(name), trace.blocks.word(name), values)
    return fill_down(values, takes | trace.blocks.has(*trace.machine.live_tool_speeds) | trace.blocks.starts, np.nan)


def exceeds_highest_speed(trace: Trace) -> Mask:
    """
    Rows with an S for the live tool above its highest speed.

    Where the profile names no codes of the live tool, an S is for it if a section cuts with it.
    """
    written = _takes(trace) | trace.blocks.has(*trace.machine.live_tool_speeds)
    above = written & (speed(trace) > trace.machine.limits.live_tool_speed * (1 + SHARE))
    if trace.machine.m_codes.live_tool_on:
        return above
    last = np.maximum.accumulate(np.where(written | trace.blocks.starts, np.arange(len(trace)), 0))
    cuts = trace.blocks.mask_of(last[trace.path.cuts])
    return above & cuts


def _takes(trace: Trace) -> Mask:
    return trace.blocks.has("S") & ~trace.modal.sets_coordinates & ~trace.blocks.listed("dwell")


def _next_starts_live_tool(trace: Trace) -> Mask:
    """The live tool is the spindle that starts next."""
    codes = trace.machine.m_codes
    started = trace.blocks.codes(*codes.live_tool_on)
    begins = np.flatnonzero(started | trace.blocks.codes(*codes.spindle_on))
    return np.asarray(np.append(started[begins], False)[np.searchsorted(begins, np.arange(len(trace)))])
