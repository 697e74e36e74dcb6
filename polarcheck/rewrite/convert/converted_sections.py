"""The blocks of polar sections as the other machine reads them: the same points, arcs, depths and feeds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polarcheck.foundation.arrays import side_by_side
from polarcheck.foundation.errors import counted
from polarcheck.foundation.states import STATES, Motion
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.axis_words import Translated
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.convert.computed_blocks import ComputedBlocks
from polarcheck.rewrite.convert.new_program import NewProgram
from polarcheck.rewrite.convert.section_ends import SectionEnds
from polarcheck.rewrite.convert.section_refusals import SectionFeeds, refusals
from polarcheck.rewrite.convert.section_words import SectionWords
from polarcheck.rewrite.convert.translating import Translation
from polarcheck.rewrite.writing.new_blocks import NewBlock
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import RefusedError, refused_at
from polarcheck.rewrite.writing.pen import Pen
from polarcheck.rewrite.writing.style import Style
from polarcheck.rules.editing import is_plain

#: Numbers of a column, since a name of states is looked up anew for each row.
_RAPID, _CCW = int(Motion.RAPID), int(Motion.CCW)
_PLANE_IN_MODE = "plane-selected-in-polar"
#: Lathes begin in X and Z.
_OF_TURNING = 18


def write_sections(
    original: Original, target: Machine, style: Style, translation: Translation, new: NewProgram
) -> None:
    """
    Write the blocks of the polar sections of a program as the other machine reads them.

    new: takes them. Raises RefusedError with all that cannot be written.
    """
    _Writer(original, target, style, translation, new).write()


class _Writer:
    """
    Writes sections one after the other.

    is_same: both machines write the geometry of sections in the same words, so that these stay as they are.
    """

    def __init__(
        self, original: Original, target: Machine, style: Style, translation: Translation, new: NewProgram
    ) -> None:
        self.original, self.trace, self.target, self.style = original, original.trace, target, style
        self.translation, self.new = translation, new
        measures = translation.measures
        self.texts = BlockTexts(self.trace)
        self.words = SectionWords(self.trace, target)
        self.feeds = SectionFeeds(self.trace, original.tables["tool_center"].moves, target, measures.basis)
        self.computed = ComputedBlocks(self.trace, target, measures, self.words)
        self.ends = SectionEnds(original, target, measures, self.texts, new)
        self.is_same = self.words.is_same
        self.has_axes = self.trace.blocks.has(*self.trace.machine.axis_words)
        path = self.trace.path
        #: Of each row what it moves: axes of the plane, Z, its motion, and the end and center of its path.
        self.moves = list(
            side_by_side(path.travels, path.moves_z, path.z, self.trace.axes.motion, path.end, path.is_arc, path.center)
        )
        self.blocks: list[int] = self.trace.run.block.tolist()
        self.lines: list[int] = self.trace.blocks.line_in_file.tolist()
        self.rapid_rows: set[int] = set()
        self.divided_rows: set[int] = set()

    def write(self) -> None:
        """Write the blocks of all sections."""
        reasons, new = refusals(self.original, self.is_same, self.translation.why_not), self.new
        sections = self.trace.mode.sections
        for enter, leave in zip(sections.enter.tolist(), sections.leave.tolist(), strict=True) if not reasons else ():
            try:
                self._section(enter, leave)
            except RefusedError as error:
                reasons += error.refusals
        if reasons:
            raise RefusedError(reasons)
        self._require_inside()
        new.rapid_as_line = bool(self.rapid_rows) and not self.target.writing.rapid_in_mode
        for block in [block for block, written in new.blocks.items() if self._is_unchanged(block, written)]:
            del new.blocks[block]
        new.notes[:0] = self._notes()

    # ---- one section ----

    def _section(self, enter: int, leave: int) -> None:
        rows, ends = self._with_words(enter, leave), self.ends
        ends.require_known_start(enter, rows)
        if self.is_same:
            for row in rows:
                self._put(row, self._as_written(row))
            return
        pen, turn = ends.pen(enter, self.style), ends.turn(enter)
        ends.note_x(enter, leave)
        planes = self.trace.modal.state("plane")[enter:leave]
        for row in np.flatnonzero((np.diff(planes) != 0) & (planes[1:] != planes[0])).tolist():
            if (code := f"G{int(planes[row + 1])}") not in self.trace.machine.writing.behind:
                self._note_plane(enter + row + 1, code)
        for row in ends.without(enter, leave, pen):
            self._put(row, [])
        targets = self._targets(rows)
        for row in rows:
            pen.numbers.line = self.lines[row]
            if self.blocks[row] in targets:
                pen.forget()
            self._put(row, [*self._row(row, enter, leave, pen, turn), *self._corner(row + 1, pen, turn)])
        block = self.blocks[leave]
        self.new.blocks[block] = [*self.new.blocks[block], *ends.feed_behind(leave, pen)]

    def _with_words(self, enter: int, leave: int) -> list[int]:
        """The rows of a section with executed words: a statement is none of them."""
        first, until = np.searchsorted(self.trace.run.row, (enter, leave + 1))
        rows: list[int] = np.unique(self.trace.run.row[first:until]).tolist()
        # The head of a subprogram is written with those of all programs.
        return [row for row in rows if self.blocks[row] not in self.texts.with_program_number]

    def _targets(self, rows: Sequence[int]) -> set[int]:
        """
        Return the blocks that do not always follow the same block: the first of a subprogram or of a loop, and those
        after it.

        What is written for them must not depend on the state before them.
        """
        block, depth = self.trace.run.block[rows], self.trace.run.depth[rows]
        jumps = (np.diff(depth) != 0) | (np.diff(block) <= 0)
        return set(block[1:][jumps].tolist())

    def _row(self, row: int, enter: int, leave: int, pen: Pen, turn: complex) -> list[NewBlock]:
        """The blocks in the place of one."""
        if self.words.is_plain[row] and row not in (enter, leave) and not self.translation.why_not(row):
            return self._moves(row, pen, turn, ())
        if (call := self._call(row)) is not None:
            return [NewBlock(tuple(call))]
        geometry, remaining = self.words.divided(row, self.translation.measures.words_of(row), row in (enter, leave))
        translated = self._translated(row, remaining)
        words, comment = translated.words, self._comment(row, translated)
        front = [word for word in words if word[:1].upper() == "G" and not self.words.is_dwell[row]]
        back = [word for word in words if word not in front]
        if row == enter:
            return _without_empty(*self.ends.switched_on(row, pen, turn, front), NewBlock(tuple(back), comment))
        if row == leave:
            return _without_empty(NewBlock(tuple(words), comment), *self.ends.switched_off(enter, leave, pen))
        codes = [*front, *self._sides(geometry)]
        if self.computed.is_computed(row):
            moves = self._computed_block(row, geometry, pen, turn, codes)
        else:
            moves = self._moves(row, pen, turn, codes)
        if not moves:
            return _without_empty(NewBlock((*codes, *back), comment))
        return [*moves[:-1], NewBlock((*moves[-1].words, *back), comment)]

    def _corner(self, row: int, pen: Pen, turn: complex) -> list[NewBlock]:
        """The line or arc of a corner that the control makes behind a block, as by RND=2; nothing for another row."""
        if row >= len(self.trace) or not self.trace.axes.makes_corner[row]:
            return []
        if self.computed.is_computed(row - 1) or self.computed.is_computed(row + 1):
            raise refused_at(self.trace, row, "its words are computed, and the control makes a corner beside it")
        return self._moves(row, pen, turn, ())

    def _comment(self, row: int, translated: Translated) -> str:
        """
        The comment in the new block on what is to be decided of a row.

        Raises RefusedError for a block that moves the tool and can only be decided whole.
        """
        content = self.texts.content(self.blocks[row])
        if translated.whole and (self.has_axes[row] or self.trace.axes.moves[row]):
            text = f"{content}: {translated.whole}, and the contour in the mode cannot go on without it"
            raise refused_at(self.trace, row, text)
        return self.new.comment(self.trace.line(row), content, translated)

    def _moves(self, row: int, pen: Pen, turn: complex, codes: Sequence[str]) -> list[NewBlock]:
        """The moves of a row; none where nothing moves."""
        travels, moves_z, depth, motion, point, is_arc, center = self.moves[row]
        if not travels and not moves_z:
            return []
        z = depth if moves_z else None
        if z is not None and math.isnan(z):
            raise refused_at(self.trace, row, "Z is a distance from a place that is not known")
        end = point * turn if travels else None
        if motion == _RAPID:
            self.rapid_rows.add(row)
            return pen.rapid(end, z, codes)
        feed = None if self.computed.has_computed_feed(row) else self.feeds.of_row(row)
        if end is None or not is_arc:
            return pen.line(end, z, feed, codes)
        blocks = pen.arc(end, center * turn, motion == _CCW, z, feed, codes)
        if len(blocks) > 1:
            self.divided_rows.add(row)
        return blocks

    def _computed_block(
        self, row: int, geometry: Sequence[int], pen: Pen, turn: complex, codes: Sequence[str]
    ) -> list[NewBlock]:
        if turn != 1:
            raise refused_at(self.trace, row, "its words are computed, and the plane lies otherwise there")
        path = self.trace.path
        words = self.computed.written(row, geometry, pen)
        has_feed = any(word.startswith("F") for word in words) or self.computed.has_computed_feed(row)
        feed = None if has_feed else self.feeds.of_row(row)
        end, z = complex(path.end[row]), float(path.z[row])
        return pen.written(words, self.computed.motion(row) if words else "", end, z, feed, codes)

    def _sides(self, geometry: Sequence[int]) -> list[str]:
        """The codes of cutter compensation in a block, as the other machine has them."""
        keys = [key for index in geometry if (key := self.words.key(index)) in STATES["side"]]
        return [self.target.codes(key)[0] for key in keys]

    def _call(self, row: int) -> list[str] | None:
        """The words of a block that calls a subprogram or returns from it; None for any other."""
        return self.translation.calls.words_of_row(row, self.texts.content(self.blocks[row]))

    def _translated(self, row: int, words: Sequence[int]) -> Translated:
        """The words of a row beside its geometry; none of them where the whole block is to be decided."""
        reason = self.translation.why_not(row)
        result = self.translation.words(row, words) if words and not reason else Translated(whole=reason)
        return Translated(whole=result.whole) if result.whole else result

    def _as_written(self, row: int) -> list[NewBlock] | None:
        """A block whose geometry stays as it is; None where all of it does."""
        indices = self.translation.measures.words_of(row)
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
            if index in geometry and self._is_lost_plane(row, index):
                self._note_plane(row, written(index))
                continue
            words += parts[index].words if index in parts else [] if index in remaining else [written(index)]
        if not comment and words == [written(index) for index in indices]:
            return None
        return _without_empty(NewBlock(tuple(words), comment))

    def _is_lost_plane(self, row: int, index: int) -> bool:
        """A word selects the plane that is in force in the mode, where that is an error on the other machine alone."""
        machines = self.trace.machine, self.target
        ours, theirs = (machine.severities.get(_PLANE_IN_MODE, "error") != "error" for machine in machines)
        if not ours or theirs or self.words.key(index) not in STATES["plane"] or not self.trace.mode.in_polar[row]:
            return False
        planes = self.trace.modal.state("plane")
        return (int(planes[row - 1]) or _OF_TURNING) == int(planes[row])

    def _note_plane(self, row: int, code: str) -> None:
        note = f"line {self.lines[row]}: {code} is left out: a section stays in the plane of the mode"
        self.new.notes += [note] if note not in self.new.notes else []

    # ---- blocks ----

    def _put(self, row: int, written: list[NewBlock] | None) -> None:
        block = self.blocks[row]
        self.new.taken.add(block)
        if written is not None and self.new.blocks.setdefault(block, written) != written:
            text = "the block runs several times, and would be another one each time"
            raise refused_at(self.trace, row, text)

    def _is_unchanged(self, block: int, new: Sequence[NewBlock]) -> bool:
        if len(new) != 1 or new[0].comment:
            return False
        return self.style.blank.join(new[0].words) == self.texts.content(block).replace(" ", self.style.blank)

    def _require_inside(self) -> None:
        """Raise RefusedError for blocks that are rewritten in sections and run outside of them, too."""
        trace = self.trace
        outside = np.flatnonzero(trace.mode.whole_section < 0)
        blocks = np.fromiter((block for block, new in self.new.blocks.items() if new), np.int64)
        hits = outside[np.isin(trace.run.block[outside], blocks)]
        if len(hits):
            text = "the block runs in polar sections and outside of them, and would be another one there"
            raise refused_at(self.trace, int(hits[0]), text)

    def _notes(self) -> list[str]:
        notes = []
        if self.new.rapid_as_line:
            moves, feed = counted(len(self.rapid_rows), "move"), f"F{self.target.writing.rapid_feed:g} mm/min"
            notes.append(f"{moves} in rapid traverse in the mode: a line with {feed} there")
        if self.divided_rows:
            notes.append(f"{counted(len(self.divided_rows), 'arc')} divided, as the machine takes them")
        return notes


def _without_empty(*blocks: NewBlock) -> list[NewBlock]:
    return [block for block in blocks if block.words or block.comment]
