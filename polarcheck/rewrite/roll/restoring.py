"""What a stretch has left in force and the blocks behind its section take over."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import MM_PER_INCH, FeedMode
from polarcheck.rewrite.roll.following import Following, x_factor
from polarcheck.rewrite.writing.blocks import NewBlock
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rewrite.writing.pen import Pen

_PLANES = ("plane_xy", "plane_zx", "plane_yz")
_FEED_CODES = {
    FeedMode.INVERSE_TIME: "feed_inverse_time",
    FeedMode.PER_MINUTE: "feed_per_minute",
    FeedMode.PER_REVOLUTION: "feed_per_revolution",
}


def restored(trace: Trace, following: Following, last: int, pen: Pen, *, is_line: bool) -> list[NewBlock]:
    """
    Return a block with the plane, what F is, G1, X and F, each where the blocks behind the section build on it.

    last: the last row of the stretch. is_line: G1 is in force behind the section. X stands where it stood, but the
    control counts it otherwise in the mode: it is written before anything builds on it.
    """
    mode = FeedMode(int(trace.feedrate.modal_feed_mode[last]))
    takes_motion = not is_line and following.takes_over(last, following.moves, following.motion)
    on_plane = following.behind(last, following.on_plane)
    writes_x = on_plane == len(trace) or (trace.blocks.has("X")[on_plane] and not trace.modal.is_step("X")[on_plane])
    words = _plane(trace, following, last, pen)
    if mode != FeedMode.PER_MINUTE and following.takes_over(last, following.at_feed, following.feed_mode):
        words.append(feed_code(pen, mode))
    if takes_motion or not writes_x:
        words.append(in_case(pen, pen.numbers.code("G1")))
    if not writes_x:
        count = pen.numbers.increments(float(trace.path.x[last]) / x_factor(trace, last))
        words.append(in_case(pen, pen.word("X", count)))
    is_time = mode == FeedMode.INVERSE_TIME
    if following.takes_over(last, following.at_feed, following.feed) or (is_time and not writes_x):
        feed = float(trace.feedrate.written_feed[last])
        if is_time:  # a number, and no length
            scale = float(np.broadcast_to(trace.lengths.feed_scale, len(trace))[last])
            feed = feed / scale * (MM_PER_INCH if pen.numbers.feed_inch else 1.0)
        words.append(in_case(pen, "F" + pen.numbers.feed(feed)))
    return [NewBlock(tuple(words))] if words else []


def feed_code(pen: Pen, mode: FeedMode) -> str:
    """The code of what F is. Raises RefusedError where the machine has none."""
    codes = pen.machine.codes(_FEED_CODES[mode])
    if not codes:
        raise RefusedError([Refusal(pen.numbers.line, f"no code for that F is known: {pen.machine.title}")])
    return in_case(pen, pen.numbers.code(codes[0]))


def in_case(pen: Pen, word: str) -> str:
    """A word in the letters of the program."""
    return word.lower() if pen.style.lower_case else word


def _plane(trace: Trace, following: Following, last: int, pen: Pen) -> list[str]:
    """The code of the plane that was in force, where the section leaves another one and arcs follow."""
    machine, writing = trace.machine, trace.machine.writing
    planes = {code: key for key in _PLANES for code in machine.codes(key)}
    blocks = (*writing.before, writing.switch, *writing.behind, writing.end, *writing.behind_end)
    after = [planes[word] for block in blocks for word in block.split() if word in planes]
    state = int(trace.modal.state("plane")[last])
    # Lathes begin in the plane of X and Z.
    before = planes.get(f"G{state}", "plane_zx")
    if not after or after[-1] == before or not following.takes_over(last, following.arcs, following.plane):
        return []
    return [in_case(pen, pen.numbers.code(machine.codes(before)[0]))]
