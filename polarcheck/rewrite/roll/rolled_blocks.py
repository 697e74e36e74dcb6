"""The blocks of a section in the place of those of a stretch."""

from __future__ import annotations

import cmath
from collections.abc import Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.states import FEED_MODES, MM_PER_INCH, FeedMode, Motion
from polarcheck.program.machines.code_tables import code_set
from polarcheck.rewrite.roll.entries import Entry
from polarcheck.rewrite.roll.following import Following
from polarcheck.rewrite.roll.rollable import Stretch
from polarcheck.rewrite.roll.rolled_elements import Element
from polarcheck.rewrite.roll.ways import AxisMoves
from polarcheck.rewrite.writing.new_blocks import NewBlock, plane_behind
from polarcheck.rewrite.writing.pen import Pen, pen_at
from polarcheck.rewrite.writing.style import Style
from polarcheck.rules.editing import is_plain


def restored(trace: Trace, following: Following, last: int, pen: Pen, *, is_line: bool) -> list[NewBlock]:
    """
    Return a block with the plane, the mode of F, G1, X and F, each only if the blocks after the section depend on it.

    last: the last row of the stretch.
    is_line: G1 is in force after the section.

    X is where it was, but in the mode the control counts it differently: it is written before any block depends on it.
    """
    mode = FeedMode(int(trace.feedrate.modal_feed_mode[last]))
    takes_motion = not is_line and following.takes_over(last, following.moves, following.motion)
    on_plane = following.behind(last, following.on_plane)
    writes_x = on_plane == len(trace) or (trace.blocks.has("X")[on_plane] and not trace.modal.is_step("X")[on_plane])
    plane = plane_behind(trace, last, last, trace.machine)
    words = [pen.numbers.code_for(plane)] if plane else []
    if mode != FeedMode.PER_MINUTE and following.takes_over(last, following.at_feed, following.feed_mode):
        words.append(pen.numbers.code_for(FEED_MODES[mode]))
    if takes_motion or not writes_x:
        words.append(pen.numbers.code("G1"))
    if not writes_x:
        count = pen.numbers.increments(float(trace.path.x[last] / trace.lengths.x_factor[last]))
        words.append(pen.numbers.word("X", count))
    is_time = mode == FeedMode.INVERSE_TIME
    if following.takes_over(last, following.at_feed, following.feed) or (is_time and not writes_x):
        feed = float(trace.feedrate.written_feed[last])
        if is_time:  # a number, and no length
            feed = feed / float(trace.lengths.feed_scale[last]) * (MM_PER_INCH if pen.numbers.feed_inch else 1.0)
        words.append("F" + pen.numbers.feed(feed))
    return [NewBlock(tuple(words))] if words else []


#: F of the turn back is so much of what C allows.
_BELOW = 0.9


class Writer:
    """
    Writes the section of a stretch.

    first: the first row whose block is replaced.
    replaced: the new blocks by the index of the block that they replace.
    inserted: the new blocks after the block of the entry; empty without an entry.
    positions: the new C word of that block; empty if it stays.
    """

    def __init__(
        self,
        trace: Trace,
        candidate: Stretch,
        moves: AxisMoves,
        entry: Entry | None,
        style: Style,
        following: Following,
    ) -> None:
        self.trace, self.each, self.way, self.entry, self.following = trace, candidate, moves, entry, following
        self.pen = pen_at(trace, candidate.first, style)
        run = trace.run
        self.first = _with_feed_mode(trace, candidate.first) if entry is None else entry.behind + 1
        words = slice(*stretch(run.row, self.first, candidate.last + 1))
        rows = np.unique(run.row[words][run.words.address[words] != ord("N")])
        self.replaced: dict[int, list[NewBlock]] = {block: [] for block in run.block[rows].tolist()}
        self.inserted: list[NewBlock] = []
        self.positions = ""
        # A plane that begins at the switch begins where the tool stands; the others stand still on the part.
        is_turned = entry is None and not trace.machine.polar.plane_is_fixed
        self._turn = cmath.exp(1j * float(moves.start_angle[0])) if is_turned else 1 + 0j

    @property
    def count(self) -> int:
        """Blocks of the section."""
        return sum(map(len, (*self.replaced.values(), self.inserted)))

    def write(self, elements: Sequence[Element], feeds: Sequence[float]) -> None:
        """
        Write the section: the mode, the elements at the blocks at which they end, and what is in force behind it.

        feeds: F of each element [mm/min]. Raises RefusedError where the machine has no words for an element.
        """
        trace, pen, candidate = self.trace, self.pen, self.each
        if self.entry is None:
            self._blocks_of(candidate.first).extend(self._entered())
        else:
            self._enter_above(self.entry)
        lines = trace.blocks.line_in_file
        for element, feed in zip(elements, feeds, strict=True):
            row = int(self.way.row[element.until - 1])
            pen.numbers.line = int(lines[row])
            end = element.end / self._turn
            if element.kind == Motion.NONE:
                blocks = pen.line(None, element.z, feed)
            elif element.kind == Motion.LINE:
                blocks = pen.line(end, element.z, feed)
            else:
                blocks = pen.arc(end, element.center / self._turn, element.kind == Motion.CCW, element.z, feed)
            self._blocks_of(row).extend(blocks)
        last = self._blocks_of(candidate.last)
        last += [block for block in pen.leave() if self._makes_of_x(block) in (None, self._is_radius)]
        is_line = elements[-1].kind in (Motion.LINE, Motion.NONE) and not trace.machine.control.motion_codes
        last += restored(trace, self.following, candidate.last, pen, is_line=is_line)

    def _blocks_of(self, row: int) -> list[NewBlock]:
        return self.replaced[int(self.trace.run.block[row])]

    # ---- the mode ----

    def _entered(self) -> list[NewBlock]:
        """The mode switched on where the stretch begins."""
        point = complex(self.way.start_radius[0] * np.exp(1j * self.way.start_angle[0]))
        direction = float(self.trace.path.c_angle_before[self.each.first]) % 360
        z = float(self.trace.path.z_before[self.each.first])
        return [*self._per_minute(self.first), *self._switched_on(point / self._turn, z, direction)]

    def _enter_above(self, entry: Entry) -> None:
        """The mode switched on above the part with C at 0; from there C turns back, and Z leads down."""
        trace, pen = self.trace, self.pen
        axis, angle = trace.machine.polar.rotary_address, pen.numbers.angle(entry.turns)
        if entry.c_word >= 0:
            self.positions = (axis + angle).lower() if pen.style.lower_case else axis + angle
        else:
            self.inserted.append(NewBlock((pen.numbers.code("G0"), axis + "=" * (len(axis) > 1) + angle)))
        radius = float(trace.path.x_before[entry.first])
        self.inserted += self._per_minute(entry.behind + 1)
        self.inserted += self._switched_on(complex(radius), float(trace.path.z_before[entry.first]))
        feed = trace.machine.writing.rapid_feed
        if trace.machine.limits.c_feed > 0:
            feed = min(feed, _BELOW * float(np.radians(trace.machine.limits.c_feed)) * radius)
        back = radius * cmath.exp(1j * float(self.way.start_angle[0]))
        self.inserted += pen.arc(back, 0j, back.imag > 0, feed=feed)
        for row in range(entry.first, self.each.first):
            if not trace.path.moves_z[row]:
                continue
            pen.numbers.line = trace.line(row)
            z, feed = float(trace.path.z[row]), float(trace.feedrate.written_feed[row])
            is_rapid = trace.axes.motion[row] == Motion.RAPID
            self._blocks_of(row).extend(pen.rapid(z=z) if is_rapid else pen.line(None, z, feed))

    def _per_minute(self, row: int) -> list[NewBlock]:
        """The code of F per minute where it is not in force before a row."""
        before = row if self.trace.blocks.starts[row] else row - 1
        if self.trace.feedrate.modal_feed_mode[before] == FeedMode.PER_MINUTE:
            return []
        return [NewBlock((self.pen.numbers.code_for(FEED_MODES[FeedMode.PER_MINUTE]),))]

    def _switched_on(self, point: complex, z: float, direction: float = 0.0) -> list[NewBlock]:
        """The blocks that switch the mode on, without one that makes of X what it is already."""
        blocks = self.pen.enter(point, z, direction)
        return [block for block in blocks if self._makes_of_x(block) != self._is_radius]

    @property
    def _is_radius(self) -> bool:
        return bool(self.trace.lengths.x_factor[self.each.first] == 1)

    def _makes_of_x(self, block: NewBlock) -> bool | None:
        """True where a block makes X a radius, False for a diameter, None where it does neither."""
        control, text = self.trace.machine.control, " ".join(block.words)
        code = control.native_words.get(text, text)
        return True if code in control.x_radius_words else False if code in control.x_diameter_words else None


def _with_feed_mode(trace: Trace, row: int) -> int:
    """
    Return the first of the rows directly before a row that only switch to inverse time; the row itself if there are
    none.
    """
    run, codes = trace.run, code_set(trace.machine.codes("feed_inverse_time"))
    while row and not trace.blocks.starts[row - 1] and run.block[row - 1] < run.block[row]:
        if run.depth[row - 1] != run.depth[row]:
            break
        low, high = stretch(run.row, row - 1, row)
        letters = run.words.address[low:high].tolist()
        if letters.count(ord("G")) != 1 or not set(letters) <= {ord("G"), ord("N")} or not is_plain(run, row - 1):
            break
        index = int(np.searchsorted(trace.blocks.g_words, low + letters.index(ord("G"))))
        if not codes[trace.blocks.g_codes[index]]:
            break
        row -= 1
    return row
