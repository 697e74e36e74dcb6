"""The blocks of polar sections as the other machine reads them: the same points, arcs, depths and feeds."""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import STATES, Motion, Side, Units
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.compare.terms import ANGLE
from polarcheck.rewrite.convert.axis_words import Translated
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.convert.computed_blocks import ComputedBlocks
from polarcheck.rewrite.convert.section_refusals import SectionFeeds, refusals
from polarcheck.rewrite.convert.section_words import SectionWords
from polarcheck.rewrite.convert.translating import Translation
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Decision, RefusedError, refused_at
from polarcheck.rewrite.writing.pen import Pen
from polarcheck.rewrite.writing.style import Style
from polarcheck.rules.editing import is_plain


class Corners:
    """
    The codes that a section needs so that the other machine goes round its outer corners as the source does.

    A control that goes round by lines, as FANUC's, meets one that goes round by arcs (G450 on Siemens) on the
    intersection of the parallels (G451), as long as the contour turns by no more than a right angle.
    """

    def __init__(self, trace: Trace, target: Machine) -> None:
        self.trace, self.target = trace, target
        by_lines = trace.machine.compensation.corner != "arc"
        codes = target.codes("corner_by_intersection"), target.codes("corner_by_arc")
        self._codes = codes if by_lines and target.compensation.corner == "arc" and all(codes) else ([], [])

    def before(self, row: int) -> NewBlock:
        """The block behind the switch of a section; without words where it needs none. row: of the switch."""
        return self._block(row, 0)

    def behind(self, row: int) -> NewBlock:
        """The block behind the section, which takes that back. row: of the switch that ends it."""
        return self._block(row, 1)

    def _block(self, row: int, which: int) -> NewBlock:
        mode = self.trace.mode
        in_section = mode.whole_section == mode.whole_section[row]
        is_compensated = bool((self.trace.compensation.compensates & in_section).any())
        return NewBlock(tuple(self._codes[which][:1]) if is_compensated else ())


#: The words of an axis, a coordinate and a distance.
_STEPS = {"X": ("X", "U"), "Z": ("Z", "W")}
#: A plane that is turned by less is not turned [rad].
_SAME_DIRECTION = 1e-9
_ELSEWHERE = "the other control places it at another angle"
#: Numbers of a column, since a name of states is looked up anew for each row.
_RAPID, _CCW = int(Motion.RAPID), int(Motion.CCW)
_PLANES = {17: "plane_xy", 18: "plane_zx", 19: "plane_yz"}


class Inside(msgspec.Struct, frozen=True):
    """
    The blocks of polar sections.

    blocks: index in text.blocks -> what stands in its place; a block that is not in it stays as it is.
    taken: blocks of sections, those that stay as they are included.
    decisions: what is to be decided of single words. decided: lines of the original with such words.
    notes: what is written otherwise, and where. rapid_as_line: moves in rapid traverse are lines there.
    """

    blocks: dict[int, list[NewBlock]]
    taken: set[int]
    decisions: list[Decision]
    decided: set[int]
    notes: list[str]
    rapid_as_line: bool


def sections(original: Original, target: Machine, style: Style, translation: Translation) -> Inside:
    """
    Return the blocks of the polar sections of a program as the other machine reads them.

    Raises RefusedError with all that cannot be written.
    """
    return _Writer(original, target, style, translation).result()


class _Writer:
    """
    Writes sections one after the other.

    is_same: both machines write the geometry of sections in the same words, so that these stay as they are.
    """

    def __init__(self, original: Original, target: Machine, style: Style, translation: Translation) -> None:
        self.original, self.trace, self.target, self.style = original, original.trace, target, style
        self.source = self.trace.machine
        self.translation = translation
        self.texts = BlockTexts(self.trace)
        self.words = SectionWords(self.trace, target)
        self.feeds = SectionFeeds(self.trace, original.tables["tool_center"].moves, target, translation.measures.basis)
        self.computed = ComputedBlocks(self.trace, target, translation.measures, self.words)
        self.corners = Corners(self.trace, target)
        self.basis = translation.measures.basis
        self.is_same = self.words.is_same
        self.has_axes = self.trace.blocks.has(*self.source.axis_words)
        self.blocks: dict[int, list[NewBlock]] = {}
        self.taken: set[int] = set()
        self.decisions: list[Decision] = []
        self.decided: set[int] = set()
        self.rapid_rows: list[int] = []
        self.divided_rows: list[int] = []
        self.turned: list[tuple[int, float]] = []

    def result(self) -> Inside:
        """Return the blocks of all sections."""
        count = len(self.trace.mode.sections)
        reasons = refusals(self.original, self.is_same)
        for number in range(count) if not reasons else ():
            try:
                self._section(number)
            except RefusedError as error:
                reasons += error.refusals
        if reasons:
            raise RefusedError(reasons)
        self._require_inside()
        rapid_as_line = bool(self.rapid_rows) and not self.target.writing.rapid_in_mode
        blocks = {block: new for block, new in self.blocks.items() if not self._is_unchanged(block, new)}
        return Inside(blocks, self.taken, self.decisions, self.decided, self._notes(rapid_as_line), rapid_as_line)

    # ---- one section ----

    def _section(self, number: int) -> None:
        trace, sections = self.trace, self.trace.mode.sections
        enter, leave = int(sections.enter[number]), int(sections.leave[number])
        rows = self._with_words(enter, leave)
        self._require_entry(enter, rows)
        if self.is_same:
            for row in rows:
                self._put(row, self._as_written(row))
            return
        pen, turn = self._pen(enter), self._turn(enter)
        self._note_x(enter, leave)
        self._take_out_around(enter, leave, pen)
        targets = self._targets(rows)
        for row in rows:
            pen.numbers.line = self._line(row)
            if int(trace.run.block[row]) in targets:
                pen.forget()
            self._put(row, self._row(row, enter, leave, pen, turn))
        self._feed_behind(leave, pen)

    def _with_words(self, enter: int, leave: int) -> list[int]:
        """The rows of a section with executed words: a statement is none of them."""
        first, until = np.searchsorted(self.trace.run.row, (enter, leave + 1))
        rows: list[int] = np.unique(self.trace.run.row[first:until]).tolist()
        # The head of a subprogram is written with those of all programs.
        return [row for row in rows if not self.texts.has_program_number(int(self.trace.run.block[row]))]

    def _targets(self, rows: Sequence[int]) -> set[int]:
        """
        Return the blocks that do not always follow the same block: the first of a subprogram or of a loop, and those
        after it.

        What is written for them must not depend on the state before them.
        """
        block, depth = self.trace.run.block, self.trace.run.depth
        return {
            int(block[row])
            for before, row in itertools.pairwise(rows)
            if depth[row] != depth[before] or block[row] <= block[before]
        }

    def _pen(self, enter: int) -> Pen:
        trace = self.trace
        is_inch = self.translation.measures.writes_inch(enter)
        same_units = is_inch == bool(trace.lengths.units[enter] == Units.INCH)
        feed_inch = bool(trace.lengths.feed_units[enter] == Units.INCH) if same_units else is_inch
        return Pen(self.target, self.style, is_inch, feed_inch)

    def _turn(self, enter: int) -> complex:
        """What points of the plane are multiplied by: where the other machine lays its plane otherwise on the part."""
        trace, ours, theirs = self.trace, self.source.polar, self.target.polar
        number = int(trace.mode.section[enter])
        is_lost = self.translation.measures.is_lost(enter, "C")
        c_angle = math.nan if is_lost else float(trace.path.c_angle[enter])
        if math.isnan(c_angle):
            if ours.zero_angle == theirs.zero_angle and not theirs.direction_word:
                return 1.0 + 0j
            text = "C is not known where the mode begins, and the other control asks for it: position it, as C0"
            raise refused_at(self.trace, enter, text)
        of_ours = ours.c_sense * float(trace.path.section_entry[number])
        of_theirs = 0.0 if theirs.plane_is_fixed else ours.c_sense * c_angle
        angle = math.radians((of_ours - of_theirs + 180) % 360 - 180)
        if abs(angle) < _SAME_DIRECTION:
            return 1.0 + 0j
        self.turned.append((enter, math.degrees(angle)))
        self.basis.add("polar.zero_angle", enter)
        return cmath.exp(1j * angle)

    def _note_x(self, enter: int, leave: int) -> None:
        """Note that X of a section, which is no zero, counts otherwise there."""
        rows = np.arange(enter, leave)
        off_axis = self.trace.blocks.has("X", "U")[rows] & (self.trace.path.end[rows].real != 0)
        if self.source.polar.x != self.target.polar.x and off_axis.any():
            self.basis.add("polar.x", int(rows[np.argmax(off_axis)]))

    def _take_out_around(self, enter: int, leave: int, pen: Pen) -> None:
        """
        Take out the blocks that the source needs around its switches, such as the choice of a plane.

        A code of X that stands elsewhere stays, and so does that behind the section, where both machines have it: then
        the pen writes X as the code says.
        """
        trace, writing = self.trace, self.source.writing
        self._take_out(writing.before, range(enter - 1, -1, -1))
        control = self.source.control
        switches = trace.blocks.codes(*control.x_radius_words, *control.x_diameter_words)
        last = int(last_row(switches, trace.blocks.starts)[enter])
        stays = last >= 0 and self.blocks.get(int(trace.run.block[last])) != []
        if stays and self.translation.measures.same_x_switches and not self.target.writing.behind_end:
            pen.factors = round(1 / float(trace.lengths.x_factor[enter])), pen.factors[1]
            return
        self._take_out(writing.behind_end, range(leave + 1, len(trace)))

    def _take_out(self, texts: Sequence[str], rows: Sequence[int]) -> None:
        """Take out the blocks at the beginning of rows that are among the texts, each once."""
        remaining = list(texts)
        for row in rows:
            content = self.texts.content(int(self.trace.run.block[row])).upper()
            if content not in remaining:
                return
            remaining.remove(content)
            self._put(row, [])

    def _row(self, row: int, enter: int, leave: int, pen: Pen, turn: complex) -> list[NewBlock]:
        """The blocks in the place of one."""
        trace = self.trace
        if (call := self._call(row)) is not None:
            return [NewBlock(tuple(call))]
        geometry, remaining = self.words.divided(row, self.translation.words_of(row), row in (enter, leave))
        translated = self._translated(row, remaining)
        words, comment = translated.words, self._comment(row, translated)
        front = [word for word in words if word[:1].upper() == "G" and not self.words.is_dwell(row)]
        back = [word for word in words if word not in front]
        if row == enter:
            point = complex(trace.path.end[row]) * turn
            angle = float(trace.path.c_angle[row]) * self.source.polar.c_sense * self.target.polar.c_sense
            if self.source.polar.c_sense != self.target.polar.c_sense and angle and not math.isnan(angle):
                self.basis.add("polar.zero_angle", row)
            new = pen.enter(point, float(trace.path.z[row]), 0.0 if math.isnan(angle) else angle)
            last = NewBlock(tuple(back), comment)
            positioned = self._positioned(row, pen)
            return _without_empty(positioned, NewBlock(tuple(front)), *new, self.corners.before(row), last)
        if row == leave:
            restored = self.corners.behind(row), self._plane_behind(enter, leave)
            return _without_empty(NewBlock(tuple(words), comment), *pen.leave(), *restored)
        codes = [*front, *self._sides(geometry)]
        if self.computed.is_computed(row):
            moves = self._computed_block(row, geometry, pen, turn, codes)
        else:
            moves = self._moves(row, pen, turn, codes)
        if not moves:
            return _without_empty(NewBlock((*codes, *back), comment))
        return [*moves[:-1], NewBlock((*moves[-1].words, *back), comment)]

    def _positioned(self, enter: int, pen: Pen) -> NewBlock:
        """
        The block that turns C to where the plane of a section points, and what is to be decided of it.

        Without words where C stands there, and where the switch of the target says the direction itself. Raises
        RefusedError where no move in rapid traverse leads to the switch.
        """
        trace, source, target = self.trace, self.source, self.target
        word = source.polar.direction_word
        if not trace.mode.enters_with_direction[enter] or target.polar.direction_word:
            return NewBlock()
        angle, before = float(trace.path.c_angle[enter]), float(trace.path.c_angle_before[enter])
        is_there = abs((angle - before + 180) % 360 - 180) < ANGLE
        if is_there or math.isnan(angle):
            return NewBlock()
        stands = "where C stands is not known" if math.isnan(before) else f"C stands at {before % 360:.6g} deg"
        text = f"{word}{angle:.6g} beside {source.polar.on[0]}: {stands}, and the plane points to {angle:.6g} deg"
        moves = np.flatnonzero(trace.path.moves[:enter])
        if len(moves) and (trace.mode.section[moves[-1]] >= 0 or trace.axes.motion[moves[-1]] != _RAPID):
            raise refused_at(trace, enter, f"{text}: position C there by G0 before it")
        new_angle = angle * source.polar.c_sense * target.polar.c_sense
        axis = target.polar.rotary_address + pen.numbers.angle(new_angle)
        text += f": {axis} turns C there before the mode begins, where the tool must be clear"
        self._decide([Decision(self._line(enter), text)])
        self.decided.add(self._line(enter))
        return NewBlock((pen.numbers.code("G0"), axis), decision_comment(text))

    def _comment(self, row: int, translated: Translated) -> str:
        """
        The comment in the new block on what is to be decided of a row.

        Raises RefusedError for a block that moves the tool and can only be decided whole.
        """
        line, content = self._line(row), self.texts.content(int(self.trace.run.block[row]))
        text = f"{content}: {translated.whole}" if translated.whole else ""
        if text and (self.has_axes[row] or self.trace.axes.moves[row]):
            raise refused_at(self.trace, row, f"{text}, and the contour in the mode cannot go on without it")
        texts = [text] if text else translated.decisions
        self._decide([Decision(line, decision) for decision in texts])
        self.decided |= {line} if texts else set()
        self._decide([Decision(line, remark) for remark in translated.remarks])
        return decision_comment(text or translated.comment) if texts or translated.remarks else ""

    def _plane_behind(self, enter: int, leave: int) -> NewBlock:
        """The plane of before where the section selects one and arcs, cycles or compensation follow outside."""
        trace, writing = self.trace, self.target.writing
        planes = {code for key in _PLANES.values() for code in self.target.codes(key)}
        selects = [any(word in planes for text in texts for word in text.split()) for texts in (
            (*writing.before, *writing.behind), writing.behind_end
        )]  # fmt: skip
        key = _PLANES.get(int(trace.modal.state("plane")[enter - 1]) if enter else 0, "plane_zx")
        if not selects[0] or selects[1] or not self.target.codes(key):
            return NewBlock()
        ends = np.flatnonzero(trace.mode.enters | trace.blocks.starts)
        following = ends[ends > leave]
        until = int(following[0]) if len(following) else len(trace)
        rows = slice(leave + 1, until)
        needs = np.isin(trace.axes.motion[rows], (Motion.CW, Motion.CCW)) | trace.modal.in_cycle[rows]
        needs |= trace.compensation.side[rows] != Side.OFF
        return NewBlock((self.target.codes(key)[0],)) if needs.any() else NewBlock()

    def _moves(self, row: int, pen: Pen, turn: complex, codes: Sequence[str]) -> list[NewBlock]:
        """The moves of a row; none where nothing moves."""
        trace, path = self.trace, self.trace.path
        travels, moves_z = bool(path.travels[row]), bool(path.moves_z[row])
        if not travels and not moves_z:
            return []
        z = float(path.z[row]) if moves_z else None
        if z is not None and math.isnan(z):
            raise refused_at(self.trace, row, "Z is a distance from a place that is not known")
        end = complex(path.end[row]) * turn if travels else None
        motion = int(trace.axes.motion[row])
        if motion == _RAPID:
            self.rapid_rows.append(row)
            return pen.rapid(end, z, codes)
        feed = None if self.computed.has_computed_feed(row) else self.feeds.of_row(row)
        if end is None or not bool(path.is_arc[row]):
            return pen.line(end, z, feed, codes)
        is_ccw = motion == _CCW
        blocks = pen.arc(end, complex(path.center[row]) * turn, is_ccw, z, feed, codes)
        if len(blocks) > 1:
            self.divided_rows.append(row)
        return blocks

    def _computed_block(
        self, row: int, geometry: Sequence[int], pen: Pen, turn: complex, codes: Sequence[str]
    ) -> list[NewBlock]:
        if turn != 1:
            raise refused_at(self.trace, row, "its words are computed, and the plane lies otherwise there")
        path = self.trace.path
        words = self.computed.written(row, geometry, pen)
        feed = None if self._has_feed_word(words) or self.computed.has_computed_feed(row) else self.feeds.of_row(row)
        end, z = complex(path.end[row]), float(path.z[row])
        return pen.written(words, self.computed.motion(row) if words else "", end, z, feed, codes)

    def _has_feed_word(self, words: Sequence[str]) -> bool:
        return any(word.startswith("F") for word in words)

    def _sides(self, geometry: Sequence[int]) -> list[str]:
        """The codes of cutter compensation in a block, as the other machine has them."""
        keys = [key for index in geometry if (key := self.words.key(index)) in STATES["side"]]
        return [self.target.codes(key)[0] for key in keys]

    def _call(self, row: int) -> list[str] | None:
        """The words of a block that calls a subprogram or returns from it; None for any other."""
        return self.translation.calls.words_of_row(row, self.texts.content(int(self.trace.run.block[row])))

    def _translated(self, row: int, words: Sequence[int]) -> Translated:
        """The words of a row beside its geometry; none of them where the whole block is to be decided."""
        reason = self.translation.why_not(row)
        result = self.translation.words(row, words) if words and not reason else Translated(whole=reason)
        return Translated(whole=result.whole) if result.whole else result

    def _as_written(self, row: int) -> list[NewBlock] | None:
        """A block whose geometry stays as it is; None where all of it does."""
        indices = self.translation.words_of(row)
        if self._call(row) is not None or not is_plain(self.trace.run, row):
            return None
        is_switch = bool(self.trace.mode.enters[row] | self.trace.mode.leaves[row])
        geometry, remaining = self.words.divided(row, indices, is_switch)
        written = self.translation.measures.written
        # Words beside a code that moves nothing belong together; beside a move each has its place.
        groups = [[index] for index in remaining] if geometry else [remaining] if remaining else []
        parts = {group[0]: self._translated(row, group) for group in groups}
        whole = self.translation.why_not(row) or next((part.whole for part in parts.values() if part.whole), "")
        result = Translated(
            decisions=[text for part in parts.values() for text in part.decisions],
            remarks=[text for part in list(parts.values())[:1] for text in part.remarks],
            whole=whole,
        )
        comment = self._comment(row, result)
        if whole:
            return [NewBlock((), comment)]
        words: list[str] = []
        for index in indices:
            words += parts[index].words if index in parts else [] if index in remaining else [written(index)]
        if not comment and words == [written(index) for index in indices]:
            return None
        return [NewBlock(tuple(words), comment)]

    def _require_entry(self, enter: int, rows: Sequence[int]) -> None:
        """Raise RefusedError for a section that begins where nobody knows, and whose first moves do not say it."""
        trace, measures = self.trace, self.translation.measures
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

    def _feed_behind(self, leave: int, pen: Pen) -> None:
        """Write F behind the section again where a block behind it moves by an F from within."""
        trace = self.trace
        takes_feed = ~np.isin(trace.axes.motion, (Motion.RAPID, Motion.NONE)) & trace.axes.moves
        for row in range(leave + 1, len(trace)):
            if trace.blocks.has("F")[row] or trace.blocks.starts[row] or trace.mode.section[row] >= 0:
                return
            if takes_feed[row]:
                word = self.feeds.word_in_force(row, pen)
                if word and word != pen.feed_word:
                    block = int(trace.run.block[leave])
                    self.blocks[block] = [*self.blocks[block], NewBlock((word,))]
                return

    # ---- blocks ----

    def _put(self, row: int, new: list[NewBlock] | None) -> None:
        block = int(self.trace.run.block[row])
        self.taken.add(block)
        if new is not None and self.blocks.setdefault(block, new) != new:
            text = "the block runs several times, and would be another one each time"
            raise refused_at(self.trace, row, text)

    def _is_unchanged(self, block: int, new: Sequence[NewBlock]) -> bool:
        if len(new) != 1 or new[0].comment:
            return False
        return self.style.blank.join(new[0].words) == self.style.blank.join(self.texts.content(block).split())

    def _require_inside(self) -> None:
        """Raise RefusedError for blocks that are rewritten in sections and run outside of them, too."""
        trace = self.trace
        outside = np.flatnonzero(trace.mode.whole_section < 0)
        blocks = np.fromiter((block for block, new in self.blocks.items() if new), np.int64)
        hits = outside[np.isin(trace.run.block[outside], blocks)]
        if len(hits):
            text = "the block runs in polar sections and outside of them, and would be another one there"
            raise refused_at(self.trace, int(hits[0]), text)

    def _decide(self, decisions: Sequence[Decision]) -> None:
        self.decisions += [decision for decision in decisions if decision not in self.decisions]

    def _notes(self, rapid_as_line: bool) -> list[str]:
        notes = []
        if rapid_as_line:
            feed = f"F{self.target.writing.rapid_feed:g} mm/min"
            notes.append(f"{_count(self.rapid_rows, 'move')} in rapid traverse in the mode: a line with {feed} there")
        if self.divided_rows:
            notes.append(f"{_count(self.divided_rows, 'arc')} divided, as the machine takes them")
        for row, angle in self.turned:
            notes.append(f"line {self._line(row)}: the plane is turned by {angle:.3f} deg: {_ELSEWHERE}")
        return notes

    def _line(self, row: int) -> int:
        return int(self.trace.blocks.line_in_file[row])


def _without_empty(*blocks: NewBlock) -> list[NewBlock]:
    return [block for block in blocks if block.words or block.comment]


def _count(rows: Sequence[int], name: str) -> str:
    count = len(set(rows))
    return f"{count} {name}{'s' * (count != 1)}"
