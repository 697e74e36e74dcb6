"""Writes other moves into blocks of polar sections and keeps the remaining words of these blocks."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.states import STATES
from polarcheck.program.reading.excerpt import shortened
from polarcheck.rewrite.compare.compared_sections import NOWHERE
from polarcheck.rewrite.compensate.pieces import Piece
from polarcheck.rewrite.compensate.section_moves import consecutive
from polarcheck.rewrite.writing.new_blocks import NewBlock, next_move_in_motion
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rewrite.writing.pen import MOTION_CODES, Pen, pen_at
from polarcheck.rewrite.writing.style import Style
from polarcheck.rules.editing import is_plain, words_behind_head, words_of, written_word

#: Modal groups whose codes are written with the new moves.
_GROUPS = ("motion", "side", "distance")
_CODES = {0: "G1", 1: "G3", -1: "G2"}
#: A word with a number, also of an address with several letters, as CR=5.
_NUMBER = re.compile(r"[A-Za-z]*=?[-+]?[\d.]+")
#: Characters of a block in a reason.
_LONGEST = 40


class Stroke(msgspec.Struct, frozen=True):
    """
    A move of the new program.

    piece: its line or arc.
    codes: the codes before it, as G41.
    z: depth at its end [mm]; None if Z does not move.
    """

    piece: Piece
    codes: tuple[str, ...] = ()
    z: float | None = None


#: The rewritten rows in order, with their new moves; a row without moves keeps its other words.
Strokes = Mapping[int, Sequence[Stroke]]


def new_blocks(trace: Trace, strokes: Strokes, style: Style) -> dict[int, list[NewBlock]]:
    """
    Return the new blocks of a program by the index of the block that they replace.

    Raises RefusedError for blocks that cannot be rewritten: with macro expressions, in frames, or run several times
    with different moves.
    """
    writer = _Writer(trace, style)
    rows = sorted(strokes)
    for group in consecutive(rows):
        writer.write(group, strokes)
    writer.require_once(rows)
    return writer.blocks


class _Writer:
    """Writes groups of consecutive rows."""

    def __init__(self, trace: Trace, style: Style) -> None:
        self.trace, self.style = trace, style
        self.blocks: dict[int, list[NewBlock]] = {}
        self.is_said = _said_by_moves(trace)
        self.sets_motion = trace.modal.sets("motion")
        block = trace.run.block
        self.runs_again = np.bincount(block)[block] > 1
        #: The last row of the previous group, and the code of its last move.
        self.last, self.motion = -1, ""
        #: The pens of sections by the units of their lengths.
        self.pens: dict[int, Pen] = {}

    def write(self, group: Sequence[int], strokes: Strokes) -> None:
        """Write consecutive rows."""
        trace, first, last = self.trace, group[0], group[-1]
        units = int(trace.lengths.units[first])
        pen = self.pens.setdefault(units, pen_at(trace, first, self.style))
        pen.virtual = trace.axes.virtual_axis_of(first)
        start = next((stroke.piece.start for row in group for stroke in strokes[row]), complex(trace.path.start[first]))
        motion = self._motion_before(first)
        point, z = start + complex(trace.path.center_shift[first]), float(trace.path.z_before[first])
        if not self._is_section_of_group_before(first):
            pen.at = NOWHERE
        pen.go_on(point, z, motion)
        if self.runs_again[first]:
            # A block of a loop or a subprogram has the same words each time.
            pen.forget()
        steps = self._steps(first)
        new: dict[int, list[NewBlock]] = {}
        for row in group:
            pen.numbers.line = self.trace.line(row)
            self._require_plain(row)
            moves: list[NewBlock] = []
            for stroke in strokes[row]:
                codes = (*steps, *stroke.codes)
                steps = ()
                moves += self._moves(pen, row, stroke, codes)
            new[row] = self._with_others(row, moves)
        feed = ""
        for row in group:
            new[row], feed = _with_feed(new[row], feed)
        if feed:
            new[last].append(NewBlock((feed,)))
        if trace.modal.incremental[last]:
            new[last].append(NewBlock((trace.machine.codes("incremental")[0],)))
        kinds = [stroke.piece.turning for row in group for stroke in strokes[row]]
        for row in group:
            self._put(row, new[row])
        if kinds:
            self.motion = _CODES[kinds[-1]]
            self._say_motion_behind(last, self.motion, pen)
        self.last = last

    def _is_section_of_group_before(self, first: int) -> bool:
        section = self.trace.mode.section
        return self.last >= 0 and bool(section[self.last] == section[first])

    def _motion_before(self, first: int) -> str:
        """Return the code of motion in force before a group; empty if the group starts with its own code."""
        trace = self.trace
        if self.sets_motion[first] or not first or trace.run.starts[first]:
            return ""
        between = slice(self.last + 1, first)
        if self.motion and not (self.sets_motion[between] | trace.axes.moves[between]).any():
            return self.motion
        return MOTION_CODES.get(int(trace.modal.state("motion")[first - 1]), "")

    def _steps(self, row: int) -> tuple[str, ...]:
        """Return the code for absolute coordinates if incremental distances are in force."""
        trace = self.trace
        in_force = trace.modal.incremental[row] or (row > 0 and trace.modal.incremental[row - 1])
        return (trace.machine.codes("absolute")[0],) if in_force else ()

    def _moves(self, pen: Pen, row: int, stroke: Stroke, codes: tuple[str, ...]) -> list[NewBlock]:
        piece, shift = stroke.piece, complex(self.trace.path.center_shift[row])
        end = piece.end + shift
        if piece.center is None:
            return pen.line(end, stroke.z, codes=codes)
        return pen.arc(end, piece.center + shift, piece.turning > 0, stroke.z, codes=codes)

    def _with_others(self, row: int, moves: list[NewBlock]) -> list[NewBlock]:
        """Return the moves with the other words of the block: G codes before the first move, the rest after it."""
        run = self.trace.run
        front: list[str] = []
        back: list[str] = []
        for index in words_behind_head(run, row):
            if not self.is_said[index]:
                (front if chr(int(run.words.address[index])) == "G" else back).append(written_word(run, index))
        if not front and not back:
            return moves
        first = moves[0].words if moves else ()
        return [NewBlock((*front, *first, *back)), *moves[1:]]

    def _put(self, row: int, blocks: list[NewBlock]) -> None:
        block = int(self.trace.run.block[row])
        if self.blocks.setdefault(block, blocks) != blocks:
            raise refused_at(self.trace, row, "the block runs several times, and would move otherwise each time")

    def _say_motion_behind(self, row: int, code: str, pen: Pen) -> None:
        """
        Write the code of the next move if that move took it over from before the rewritten rows and it has changed.
        """
        trace, following = self.trace, next_move_in_motion(self.trace, row)
        motion = "" if following is None else MOTION_CODES.get(int(trace.axes.motion[following]), "")
        if following is not None and motion and motion != code:
            words = [written_word(trace.run, index) for index in words_behind_head(trace.run, following)]
            self._put(following, [NewBlock((pen.numbers.code(motion), *words))])

    def require_once(self, rows: Sequence[int]) -> None:
        """Raise RefusedError if a rewritten block also runs in other rows."""
        block = self.trace.run.block
        is_other_run = np.isin(block, block[list(rows)])
        is_other_run[list(rows)] = False
        if is_other_run.any():
            raise refused_at(
                self.trace, int(np.argmax(is_other_run)), "the block runs several times, not always along a contour"
            )

    def _require_plain(self, row: int) -> None:
        trace = self.trace
        run = trace.run
        words = [written_word(run, index) for index in words_of(run, row)]
        is_macro = run.text.blocks.is_macro[int(run.block[row])]
        if not is_plain(run, row) and (is_macro or not all(map(_NUMBER.fullmatch, words))):
            block = shortened(" ".join(trace.text.without_comments(int(run.block[row])).split()), _LONGEST)
            raise refused_at(trace, row, f"{block}: an expression or a statement: write its words as numbers first")
        if trace.path.frames is not None:
            raise refused_at(self.trace, row, "the program shifts or turns its coordinates by frames")


def _said_by_moves(trace: Trace) -> Mask:
    """Return a mask of the words that the new moves replace: coordinates, arcs, codes of motion and of compensation."""
    blocks, machine = trace.blocks, trace.machine
    rotary = machine.polar.rotary_words
    words = blocks.word_indices("X", "U", "Z", "W", "I", "J", "K", *rotary, machine.arcs.radius_word)
    keys = [key for group in _GROUPS for key in STATES[group]]
    codes = dict.fromkeys(code for key in keys for code in machine.codes(key))
    written = np.concatenate([words, trace.axes.virtual_words, blocks.code_indices(*codes)])
    mask = trace.blocks.words_at(written.astype(np.int64))
    # P, Q or X beside a dwell count seconds.
    return mask & ~blocks.listed("dwell")[trace.run.row]


def _with_feed(blocks: list[NewBlock], feed: str) -> tuple[list[NewBlock], str]:
    """
    Return the blocks of a row with the pending F of an earlier row, and the F that is still pending.

    The F of a row that is left without a move is pending until the next row with blocks.
    """
    feed_word = next((word for block in blocks for word in block.words if word[:1].upper() == "F"), "")
    if len(blocks) == 1 and blocks[0].words == (feed_word,):
        return [], feed_word
    if not blocks or not feed:
        return blocks, feed
    if not feed_word:
        blocks = [NewBlock((*blocks[0].words, feed), blocks[0].comment), *blocks[1:]]
    return blocks, ""
