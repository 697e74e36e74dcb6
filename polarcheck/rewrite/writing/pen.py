"""Writes polar sections for a machine: what it does by words, rounded so that no rounding adds up."""

from __future__ import annotations

import math
from collections.abc import Sequence

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Motion, Units
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.arc_words import ArcWords
from polarcheck.rewrite.writing.new_blocks import NewBlock
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rewrite.writing.style import PLAIN, Style
from polarcheck.rewrite.writing.written_arcs import Arc, arc_between
from polarcheck.rewrite.writing.written_numbers import Numbers

#: The code of each motion, as the functions of Pen take it.
MOTION_CODES = {int(Motion.RAPID): "G0", int(Motion.LINE): "G1", int(Motion.CW): "G2", int(Motion.CCW): "G3"}
#: How often an arc is halved where its words would not come near enough: into 64 parts.
_HALVINGS = 6
#: Points that differ by less are one [mm].
_SAME_POINT = 1e-9


class Pen:
    """
    Writes the blocks of polar sections for a machine. Points are x + 1j * c on the polar plane [mm, X as a radius].

    machine: that reads them. style: how the program is written. inch: its lengths are in inch. feed_inch: so is F.
    at: the programmed point that the last block leads to, exactly; NaN where it is not known. z: depth [mm], or NaN.
    feed_word: the F word that was written last; empty before the first.
    numbers: writes numbers; its `line` is the line of the original that refusals name.
    """

    def __init__(
        self, machine: Machine, style: Style = PLAIN, inch: bool = False, feed_inch: bool | None = None
    ) -> None:
        self.machine, self.style = machine, style
        self.numbers = Numbers(machine, style, inch, feed_inch)
        self._arcs = ArcWords(machine, style, self.numbers)
        self.at = complex(math.nan, math.nan)
        self.z = math.nan
        control, polar, writing = machine.control, machine.polar, machine.writing
        self._codes = {motion: self.numbers.code(written) for written, motion in control.motion_codes.items()}
        pairs = [pair for word, pair in polar.virtual_axis_by_word.items() if word in writing.switch.split()]
        self.linear, self.virtual = machine.linear_address, pairs[0][0] if pairs else polar.virtual_axis
        if self.linear in ("", "Z"):
            raise RefusedError([Refusal(0, f"the linear axis of {machine.title} is not known, or is Z")])
        x = polar.x
        for block in (*writing.before, *writing.behind):
            x = "radius" if block in control.x_radius_words else "diameter" if block in control.x_diameter_words else x
        #: What the words of the two axes count, by the length on the plane.
        self.factors = (2 if x == "diameter" else 1, 2 if polar.virtual_axis_programming == "diameter" else 1)
        self._written: list[int | None] = [None, None, None]
        self._motion = ""
        self.feed_word, self._wanted_feed = "", ""
        #: The F words of the feeds that were written.
        self._feed_words: dict[float, str] = {}

    @property
    def written_point(self) -> complex:
        """Where the words that are written lead to: `at`, rounded to the least increment [mm]."""
        return self._point(*self._rounded(self.at))

    def enter(self, point: complex, z: float = math.nan, direction: float = 0.0) -> list[NewBlock]:
        """
        The blocks that switch the mode on.

        point: that of the tool there. direction: C angle of the linear axis [deg], where a word of the switch has it.
        """
        writing, letter = self.machine.writing, self.machine.polar.direction_word
        switch = [
            letter + self.numbers.angle(direction) if direction and letter and word.startswith(letter) else word
            for word in writing.switch.split()
        ]
        self.at, self.z = point, z
        self.forget()
        return [*self._blocks(writing.before), NewBlock(tuple(switch)), *self._blocks(writing.behind)]

    def leave(self) -> list[NewBlock]:
        """The blocks that switch the mode off; X is written again behind them, since it may count otherwise."""
        self.forget()
        return [*self._blocks([self.machine.writing.end]), *self._blocks(self.machine.writing.behind_end)]

    def forget(self) -> None:
        """Write all words again from here on, as behind blocks that somebody else has written."""
        self._written = [None, None, None]
        self._motion = self.feed_word = ""

    def go_on(self, point: complex, z: float, motion: str = "") -> None:
        """
        Go on behind blocks that somebody else has written: words that would repeat what is in force are left out.

        point: the programmed point there [mm]; the words for it are known where it is the point written last, or whole
        least increments. z: [mm]. motion: the code in force, as G1; empty where it has to be written.
        """
        words: list[int | None] = self._written[:2] if abs(point - self.at) <= _SAME_POINT else [None, None]
        self.forget()
        self.at, self.z = point, z
        if abs(point - self.written_point) <= _SAME_POINT:
            words = list(self._rounded(point))
        self._written[:2] = words
        self._motion = self._code(motion) if motion else ""

    def line(
        self, end: complex | None = None, z: float | None = None, feed: float | None = None, codes: Sequence[str] = ()
    ) -> list[NewBlock]:
        """
        A straight move by G1 to a point, a depth [mm], or both; feed: [mm/min], that in force where it is None.

        codes: further words, in front, as ("G41", "D1"). No block where nothing moves and there are none.
        Raises RefusedError where Z may not stand beside the other axes.
        """
        return self._straight("G1", end, z, feed, codes)

    def rapid(self, end: complex | None = None, z: float | None = None, codes: Sequence[str] = ()) -> list[NewBlock]:
        """A positioning move: G0 or, where that may not stand in the mode, G1 with the F for it."""
        writing = self.machine.writing
        if writing.rapid_in_mode:
            return self._straight("G0", end, z, None, codes)
        feed_before = self._wanted_feed
        blocks = self._straight("G1", end, z, writing.rapid_feed, codes)
        self._wanted_feed = feed_before
        return blocks

    def arc(
        self,
        end: complex,
        center: complex,
        ccw: bool,
        z: float | None = None,
        feed: float | None = None,
        codes: Sequence[str] = (),
    ) -> list[NewBlock]:
        """
        An arc about a center to a point, a full circle where that is the present one; in parts as the machine asks for.

        A line where it ends in the direction in which it starts, seen from the center.

        z: depth at its end [mm], of a helix. The others are as those of `line`.
        Raises RefusedError for a helix where `helices` is not so, for an arc without a radius, and for an arc that no
        words come near to.
        """
        if min(abs(self.at - center), abs(end - center)) <= ROUNDING:
            raise RefusedError([Refusal(self.numbers.line, "the center of this arc is its start or its end")])
        arc = arc_between(self.at, end, center, ccw)
        if z is not None and self._written[2] in (None, self.numbers.increments(z)) and z == self.z:
            z = None
        if z is not None and not self.machine.writing.helices:
            raise RefusedError([self._refusal("Z cannot move in an arc (a helix)")])
        if abs(arc.sweep) * arc.radius <= ROUNDING:
            # Its radius at the end is another one: within the tolerance of arcs it leads straight along its radius.
            return self.line(end, z, feed, codes)
        blocks: list[NewBlock] = []
        count = self._arcs.parts(arc)
        from_z = self.z
        for number, part in enumerate(arc.parts(count), 1):
            depth = None if z is None else z if number == count else from_z + (z - from_z) * number / count
            target = end if number == count else part.end
            blocks += self._arc(part, target, depth, feed, () if blocks else codes, _HALVINGS)
        if not blocks and codes:
            blocks.append(NewBlock(tuple(codes)))
        return blocks

    def written(
        self, words: Sequence[str], motion: str, end: complex, z: float, feed: float | None, codes: Sequence[str] = ()
    ) -> list[NewBlock]:
        """
        A block whose axis words somebody else has written, such as X[#1+2.].

        motion: its code, as G1. end, z: where it leads to [mm]. feed: as in `line`; None where it is among the words.
        """
        own_feed = next((word for word in words if word.startswith("F")), "")
        if own_feed:
            self._wanted_feed = self.feed_word = own_feed
        block = self._block(codes, motion, words, feed, bool(own_feed) or motion == "G0")
        self.at, self.z = end, z
        self._written = [None, None, None]
        return [block] if block.words else []

    # ---- words ----

    def _straight(
        self, code: str, end: complex | None, z: float | None, feed: float | None, codes: Sequence[str]
    ) -> list[NewBlock]:
        words: list[str] = []
        moves_z = z is not None and self.numbers.increments(z) != self._written[2]
        if end is not None:
            counts = self._rounded(end)
            moves_plane = counts != tuple(self._written[:2])
            together = moves_z and z != self.z and abs(end - self.at) > 0
            if moves_plane and together and self.machine.polar.other_axes == "forbidden":
                raise RefusedError([self._refusal("Z cannot move beside the axes of the plane there")])
            words += self._axes(counts, self.style.repeats_axes and moves_plane)
            self.at = end
        if z is not None:
            words += self._depth(z)
        if not words and not codes and feed is None:
            return []
        return [self._block(codes, code if words else "", words, feed if code != "G0" else None, code == "G0")]

    def _axes(self, counts: tuple[int, int], everything: bool) -> list[str]:
        """The words of the linear and of the virtual axis; those that do not change are left out."""
        before, self._written[:2] = self._written[:2], counts
        names = (self.linear, self.virtual)
        return [self.numbers.word(names[n], counts[n]) for n in (0, 1) if everything or counts[n] != before[n]]

    def _depth(self, z: float) -> list[str]:
        count = self.numbers.increments(z)
        words = [self.numbers.word("Z", count)] if count != self._written[2] else []
        self.z, self._written[2] = z, count
        return words

    def _arc(
        self, arc: Arc, end: complex, z: float | None, feed: float | None, codes: Sequence[str], halvings: int
    ) -> list[NewBlock]:
        start, target = self._start(arc), self._point(*self._rounded(end))
        if start == target and abs(arc.sweep) < math.pi:
            # With these words it would be a full circle.
            self.at = end
            return self.line(None, z, feed, codes) if z is not None or codes else []
        words = self._arcs.written(arc, start, target)
        if words is None:
            if not halvings:
                if abs(arc.sweep) < math.pi and arc.radius * (1 - math.cos(arc.sweep / 2)) < self.numbers.step:
                    return self.line(end, z, feed, codes)
                raise RefusedError([self._refusal("no words come near enough to this arc")])
            first, second = arc.parts(2)
            middle = None if z is None else (self.z + z) / 2
            blocks = self._arc(first, first.end, middle, feed, codes, halvings - 1)
            return blocks + self._arc(second, end, z, feed, () if blocks else codes, halvings - 1)
        code = "G3" if arc.sweep > 0 else "G2"
        axes = self._axes(self._rounded(end), True)
        axes += [] if z is None else self._depth(z)
        self.at = end
        return [self._block(codes, code, [*axes, *words], feed)]

    def _start(self, arc: Arc) -> complex:
        return self.written_point if all(count is not None for count in self._written[:2]) else arc.start

    def _block(
        self, codes: Sequence[str], code: str, words: Sequence[str], feed: float | None, without_feed: bool = False
    ) -> NewBlock:
        motion = self._code(code) if code else ""
        left_out = motion == self._motion and not self.style.repeats_motion
        if feed is not None:
            if feed not in self._feed_words:
                self._feed_words[feed] = "F" + self.numbers.feed(feed)
            self._wanted_feed = self._feed_words[feed]
        text = "" if without_feed else self._wanted_feed
        has_feed = bool(text) and (text != self.feed_word or (self.style.repeats_feed and bool(code)))
        if code:
            self._motion = motion
        if text:
            self.feed_word = text
        all_words = (*codes, *([motion] if motion and not left_out else []), *words, *([text] if has_feed else []))
        return NewBlock(all_words)

    def _code(self, code: str) -> str:
        if code not in self._codes:
            self._codes[code] = self.numbers.code(code)
        return self._codes[code]

    def _blocks(self, texts: Sequence[str]) -> list[NewBlock]:
        return [NewBlock(tuple(text.split())) for text in texts]

    # ---- points ----

    def _rounded(self, point: complex) -> tuple[int, int]:
        linear, virtual = self.factors
        return self.numbers.increments(point.real * linear), self.numbers.increments(point.imag * virtual)

    def _point(self, linear: int, virtual: int) -> complex:
        step = self.numbers.step
        return complex(linear * step / self.factors[0], virtual * step / self.factors[1])

    def _refusal(self, text: str) -> Refusal:
        return Refusal(self.numbers.line, f"{text}: {self.machine.title}")


def pen_at(trace: Trace, row: int, style: Style) -> Pen:
    """Return a pen for the machine of a program, in the units in force in a row; refusals name its line."""
    units = trace.lengths.units, trace.lengths.feed_units
    pen = Pen(trace.machine, style, *(bool(column[row] == Units.INCH) for column in units))
    pen.numbers.line = trace.line(row)
    return pen
