"""The switches of polar sections, and what stands around them: where the plane lies, its codes, C, X and F there."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.foundation.states import Motion, Units
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.compare.terms import ANGLE
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.convert.measures import Measures
from polarcheck.rewrite.convert.new_program import NewProgram
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment, plane_behind
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rewrite.writing.pen import Pen
from polarcheck.rewrite.writing.style import Style

#: The words of an axis, a coordinate and a distance.
_STEPS = {"X": ("X", "U"), "Z": ("Z", "W")}
#: A plane that is turned by less is not turned [rad].
_SAME_DIRECTION = 1e-9
_ELSEWHERE = "the other control places it at another angle"


class SectionEnds:
    """The beginning and the end of each polar section on another machine. new: takes notes and decisions."""

    def __init__(
        self, original: Original, target: Machine, measures: Measures, texts: BlockTexts, new: NewProgram
    ) -> None:
        self.trace, self.target, self.measures, self.texts, self.new = original.trace, target, measures, texts, new
        self.source = self.trace.machine
        self._same_sense = self.source.polar.c_sense * target.polar.c_sense
        # A control that goes round outer corners by lines, as FANUC's, meets one that goes round by arcs (G450 on
        # Siemens) on the intersection of the parallels (G451), as long as the contour turns by no more than a right
        # angle.
        by_lines = self.source.compensation.corner != "arc"
        codes = target.codes("corner_by_intersection"), target.codes("corner_by_arc")
        self._corner_codes = codes if by_lines and target.compensation.corner == "arc" and all(codes) else ([], [])

    def pen(self, enter: int, style: Style) -> Pen:
        """What writes a section, in the units of its beginning."""
        lengths = self.trace.lengths
        is_inch = self.measures.writes_inch(enter)
        same_units = is_inch == bool(lengths.units[enter] == Units.INCH)
        feed_inch = bool(lengths.feed_units[enter] == Units.INCH) if same_units else is_inch
        return Pen(self.target, style, is_inch, feed_inch)

    def turn(self, enter: int) -> complex:
        """What points of the plane are multiplied by: where the other machine lays its plane otherwise on the part."""
        trace, ours, theirs = self.trace, self.source.polar, self.target.polar
        is_lost = self.measures.is_lost(enter, "C")
        c_angle = math.nan if is_lost else float(trace.path.c_angle[enter])
        if math.isnan(c_angle):
            if ours.zero_angle == theirs.zero_angle and not theirs.direction_word:
                return 1.0 + 0j
            text = "C is not known where the mode begins, and the other control asks for it: position it, as C0"
            raise refused_at(trace, enter, text)
        of_ours = ours.c_sense * float(trace.path.section_entry[int(trace.mode.section[enter])])
        of_theirs = 0.0 if theirs.plane_is_fixed else ours.c_sense * c_angle
        angle = math.radians((of_ours - of_theirs + 180) % 360 - 180)
        if abs(angle) < _SAME_DIRECTION:
            return 1.0 + 0j
        self.new.notes.append(
            f"line {self.trace.line(enter)}: the plane is turned by {math.degrees(angle):.3f} deg: {_ELSEWHERE}"
        )
        self.measures.basis.add("polar.zero_angle", enter)
        return cmath.exp(1j * angle)

    def require_known_start(self, enter: int, rows: Sequence[int]) -> None:
        """Raise RefusedError for a section that begins where nobody knows, and whose first moves do not say it."""
        trace, measures = self.trace, self.measures
        inside = np.array(rows, np.int64)
        inside = inside[inside > enter]
        moves: list[int] = inside[trace.axes.motion[inside] != Motion.NONE].tolist()
        for axis in "XZ":
            has_step = trace.blocks.has(*_STEPS[axis])
            first = next((row for row in moves if has_step[row]), None)
            if not measures.is_lost(enter, axis) or first is None:
                continue
            if measures.is_lost(first + 1, axis) or bool(trace.path.is_arc[moves[0]]):
                raise refused_at(
                    trace, first, f"where {axis} stands is not known, behind a block that is to be decided"
                )

    # ---- the switches ----

    def switched_on(self, enter: int, pen: Pen, turn: complex, codes: Sequence[str]) -> list[NewBlock]:
        """The blocks that switch the mode on. codes: that stand before the switch."""
        path = self.trace.path
        angle = float(path.c_angle[enter]) * self._same_sense
        if self._same_sense < 0 and angle and not math.isnan(angle):
            self.measures.basis.add("polar.zero_angle", enter)
        point, z = complex(path.end[enter]) * turn, float(path.z[enter])
        switch = pen.enter(point, z, 0.0 if math.isnan(angle) else angle)
        return [self._positioned(enter, pen), NewBlock(tuple(codes)), *switch, self._corners(enter, 0)]

    def switched_off(self, enter: int, leave: int, pen: Pen) -> list[NewBlock]:
        """The blocks that switch the mode off."""
        return [*pen.leave(), self._corners(leave, 1), self._plane_behind(enter, leave)]

    def _positioned(self, enter: int, pen: Pen) -> NewBlock:
        """
        The block that turns C to where the plane of a section points, and what is to be decided of it.

        Without words where C stands there, and where the switch of the target says the direction itself. Raises
        RefusedError where no move in rapid traverse leads to the switch.
        """
        trace, source, target = self.trace, self.source, self.target
        if not trace.mode.enters_with_direction[enter] or target.polar.direction_word:
            return NewBlock()
        angle, before = float(trace.path.c_angle[enter]), float(trace.path.c_angle_before[enter])
        if abs((angle - before + 180) % 360 - 180) < ANGLE or math.isnan(angle):
            return NewBlock()
        stands = "where C stands is not known" if math.isnan(before) else f"C stands at {before % 360:.6g} deg"
        switch = f"{source.polar.direction_word}{angle:.6g} beside {source.polar.on[0]}"
        text = f"{switch}: {stands}, and the plane points to {angle:.6g} deg"
        moves = np.flatnonzero(trace.path.moves[:enter])
        if len(moves) and (trace.mode.section[moves[-1]] >= 0 or trace.axes.motion[moves[-1]] != Motion.RAPID):
            raise refused_at(trace, enter, f"{text}: position C there by G0 before it")
        axis = target.polar.rotary_address + pen.numbers.angle(angle * self._same_sense)
        text += f": {axis} turns C there before the mode begins, where the tool must be clear"
        self.new.decide(self.trace.line(enter), text)
        return NewBlock((pen.numbers.code("G0"), axis), decision_comment(text))

    def _corners(self, row: int, which: int) -> NewBlock:
        """The code at the beginning (0) or end (1) of a compensated section that sets how outer corners are rounded."""
        section = self.trace.mode.whole_section == self.trace.mode.whole_section[row]
        is_compensated = bool((self.trace.compensation.compensates & section).any())
        return NewBlock(tuple(self._corner_codes[which][:1]) if is_compensated else ())

    def _plane_behind(self, enter: int, leave: int) -> NewBlock:
        """The plane of before where the section selects another one and arcs, cycles or compensation follow outside."""
        key = plane_behind(self.trace, enter - 1, leave, self.target)
        return NewBlock((self.target.codes(key)[0],) if key else ())

    # ---- around ----

    def note_x(self, enter: int, leave: int) -> None:
        """Note that X of a section, which is no zero, counts otherwise there."""
        rows = np.arange(enter, leave)
        off_axis = self.trace.blocks.has("X", "U")[rows] & (self.trace.path.end[rows].real != 0)
        if self.source.polar.x != self.target.polar.x and off_axis.any():
            self.measures.basis.add("polar.x", int(rows[np.argmax(off_axis)]))

    def without(self, enter: int, leave: int, pen: Pen) -> Iterator[int]:
        """
        Yield the rows with blocks that the source alone needs around its switches, such as the choice of a plane.

        A code of X that stands elsewhere stays, and so does that behind the section, where both machines have it: then
        the pen writes X as the code says.
        """
        trace, control = self.trace, self.source.control
        yield from self._beginning(self.source.writing.before, range(enter - 1, -1, -1))
        switches = trace.blocks.codes(*control.x_radius_words, *control.x_diameter_words)
        last = int(last_row(switches, trace.blocks.starts)[enter])
        stays = last >= 0 and self.new.blocks.get(int(trace.run.block[last])) != []
        if stays and self.measures.same_x_switches and not self.target.writing.behind_end:
            pen.factors = round(1 / float(trace.lengths.x_factor[enter])), pen.factors[1]
            return
        yield from self._beginning(self.source.writing.behind_end, range(leave + 1, len(trace)))

    def _beginning(self, texts: Sequence[str], rows: Sequence[int]) -> Iterator[int]:
        """Yield the rows at the beginning of some whose blocks are among the texts, each text once."""
        remaining = list(texts)
        for row in rows:
            content = self.texts.content(int(self.trace.run.block[row])).upper()
            if content not in remaining:
                return
            remaining.remove(content)
            yield row

    def feed_behind(self, leave: int, pen: Pen) -> list[NewBlock]:
        """F behind a section again where a block behind it moves by an F from within."""
        trace, feed = self.trace, self.trace.feedrate.feed_number
        takes_feed = ~np.isin(trace.axes.motion, (Motion.RAPID, Motion.NONE)) & trace.axes.moves
        ends = trace.blocks.has("F") | trace.blocks.starts | (trace.mode.section >= 0)
        row = next((row for row in range(leave + 1, len(trace)) if ends[row] or takes_feed[row]), len(trace))
        if row == len(trace) or ends[row] or math.isnan(feed[row]):
            return []
        word = "F" + pen.numbers.feed(float(feed[row]))
        return [NewBlock((word,))] if word != pen.feed_word else []
