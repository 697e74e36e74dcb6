"""What stays of a program beside its sections: their blocks with Z alone, and all outside of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, is_among
from polarcheck.foundation.states import MM_PER_INCH, Motion
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at


def outside(old: Trace, new: Trace, rows: Mask) -> Iterator[Refusal]:
    """What differs in blocks outside of sections, which are the same text in both."""
    before, after = np.flatnonzero(old.mode.whole_section < 0), np.flatnonzero(rows)
    if len(before) != len(after):
        yield Refusal(0, "the result runs other blocks outside of the sections")
        return
    arcs = is_among(old.axes.motion, (Motion.CW, Motion.CCW))
    columns: dict[str, tuple[NDArray[Any], NDArray[Any]]] = {
        "X": (old.path.x, new.path.x),
        "Z": (old.path.z, new.path.z),
        "C": (_within_turn(old.path.c_angle), _within_turn(new.path.c_angle)),
        "G code of motion": (old.axes.motion, new.axes.motion),
        "feed mode": (old.feedrate.modal_feed_mode, new.feedrate.modal_feed_mode),
        "F": (old.feedrate.feed_number, new.feedrate.feed_number),
        "plane": (np.where(arcs, old.modal.state("plane"), 0), new.modal.state("plane")),
        "distances": (old.modal.state("distance"), new.modal.state("distance")),
    }
    tolerance = max(old.machine.control.least_increment, old.machine.control.least_increment_inch * MM_PER_INCH)
    for name, (was, is_now) in columns.items():
        first, second = was[before].astype(np.float64), is_now[after].astype(np.float64)
        if name == "plane":
            second = np.where(first == 0, 0, second)
        if name == "C":
            second = first + (second - first + 180) % 360 - 180
        limit = 1e-3 * np.abs(first) if name == "F" else tolerance
        differs = ~(np.abs(first - second) <= limit) & ~(np.isnan(first) & np.isnan(second))
        if differs.any():
            yield refusal_at(old, before[np.argmax(differs)], f"{name} would differ from here on")


def _within_turn(angle: Floats) -> Floats:
    return np.asarray(angle % 360)


def depths(old: Trace, new: Trace, within: Mask) -> Iterator[Refusal]:
    """Blocks with Z alone in the sections, in order."""
    alone = np.zeros(len(old), bool)
    alone[old.path.moves_z & (old.mode.section >= 0)] = True
    on_plane = old.path.travels
    before = np.flatnonzero(alone & ~on_plane)
    rotary = new.machine.polar.rotary_address
    after = np.flatnonzero(within & new.path.moves_z & ~new.blocks.has("X", rotary))
    if len(before) != len(after):
        yield Refusal(0, f"the result has {len(after)} blocks with Z alone, not {len(before)}")
        return
    tolerance = old.lengths.least_step[before]
    differs = ~(np.abs(old.path.z[before] - new.path.z[after]) <= tolerance)
    differs |= old.axes.motion[before] != new.axes.motion[after]
    feeds = old.feedrate.feed[before], new.feedrate.feed[after]
    differs |= (old.axes.motion[before] != Motion.RAPID) & ~(np.abs(feeds[0] - feeds[1]) <= 1e-3 * feeds[0])
    for index in np.flatnonzero(differs)[:1].tolist():
        yield refusal_at(old, before[index], "Z or its F would differ")
