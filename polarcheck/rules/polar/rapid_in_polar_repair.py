from __future__ import annotations

import re

import numpy as np

from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.rules.editing import in_place_of, is_head, is_plain, separator, with_word, words_of, written_word
from polarcheck.rules.feed_words import feed_below, feed_text, restored, takes_feed
from polarcheck.rules.repair import FEED, Mended, repair
from polarcheck.rules.wording.arcs import arc_in_force_before

_RAPID = re.compile(r"(G\s*0*?)0", re.IGNORECASE)


@repair(FEED)
def rapid_in_polar(trace: Trace, tool_center: ToolCenter, row: int, at: list[int]) -> Mended | None:
    """
    G0 in the mode becomes G1 with the lowest F for positioning that the machine recommends.

    That is feed.positioning_minimum; without it G1 has the F of the section: the one in force, else that of the next
    move that cuts. An F of the block itself stays, and so does the F of a contour with G41 or G42. Where C would
    turn too fast for it, F is as high as its limit allows. The F from before is written again where cutting goes on.
    A block with R, I or J was meant as an arc, and stays. Unsafe: a feed that nobody has chosen.

    Bad, machine turning-center:

        G20 G98 G18 G0 X2.4 C0
        G12.1
        G18
        G1 X2.2 F8.
        N50 G0 C.5
        X2.1
        G1 C.4
        G13.1

    Good, machine turning-center:

        G20 G98 G18 G0 X2.4 C0
        G12.1
        G18
        G1 X2.2 F8.
        N50 G1 C.5 F30.
        X2.1
        G1 C.4 F8.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        X40. F200
        G1 C5.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G1 C5.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        X50.
        G1 X40. F200
        G0 C5.
        G1 C-5.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X50. F200
        G1 X40. F200
        G1 C5.
        G1 C-5.
        G13.1
    """
    of_same_code = (trace.modal.motion_word == trace.modal.motion_word[row]) & (np.arange(len(trace)) > row)
    if not is_plain(trace.run, row) or np.any(of_same_code & trace.axes.moves & ~trace.mode.in_polar):
        return None
    if arc_in_force_before(trace, row)[0]:
        return None
    edits = []
    for index in at:
        code = _RAPID.fullmatch(written_word(trace.run, index))
        if code is None:
            return None
        edits.append(in_place_of(trace.run, index, f"{code[1]}1"))
    if not at:
        body = [index for index in words_of(trace.run, row) if not is_head(trace.run, index)]
        start = int(trace.run.words.start[body[0]])
        edits.append((start, start, f"G1{separator(trace.run, row)}"))
    in_contour = trace.compensation.compensates[row] and not trace.compensation.starts_up[row]
    if trace.blocks.has("F")[row] or (in_contour and trace.feedrate.feed[row] > 0):
        return Mended("Write G1", False, tuple(edits))
    feed, is_of_section = trace.machine.feed.positioning_minimum, False
    if not feed > 0:
        feed, is_of_section = _of_section(trace, row), True
    again = restored(trace, row)
    if not feed > 0 or not trace.feedrate.per_minute[row] or again is None:
        return None
    moving = np.append(row, np.flatnonzero(of_same_code & trace.mode.in_polar))
    allowed = float(np.nanmin(np.append(tool_center.feed_allowed[moving], np.inf)))
    if is_of_section and feed <= allowed and feed == trace.feedrate.feed[row]:
        return Mended("Write G1, with the F in force", False, tuple(edits))
    word = (
        feed_text(trace.blocks, trace.lengths, trace.run, row, feed)
        if feed <= allowed
        else feed_below(trace.blocks, trace.lengths, trace.run, row, allowed)
    )
    if word is None:
        return None
    edits += [with_word(trace.run, row, word), *again]
    return Mended(f"Write G1 with {word}", False, tuple(edits))


def _of_section(trace: Trace, row: int) -> float:
    """Return the F with which a section cuts [mm/min]: the one in force, else that of its next move; NaN if unknown."""
    feed, section = trace.feedrate.feed, trace.mode.section[row]
    cuts = takes_feed(trace.axes) & trace.mode.in_polar & (trace.mode.section == section) & (feed > 0)
    rows = np.flatnonzero(cuts)
    if not len(rows):
        return np.nan
    # The F in force counts once the section has cut with it, or goes on to do so.
    later = rows[rows > row]
    return float(feed[row] if rows[0] < row and feed[row] > 0 else feed[later[0]] if len(later) else np.nan)
