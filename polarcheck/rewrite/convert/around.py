"""The blocks outside of polar sections on the other machine; words that no profile explains become decisions."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase

import numpy as np

from polarcheck.checking.settings import Settings
from polarcheck.columns.filling import fill_down
from polarcheck.foundation.arrays import Rows, mask_at
from polarcheck.foundation.states import MOVES
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.axis_words import Translated
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.convert.heads import Heads, writes_numbers
from polarcheck.rewrite.convert.new_program import NewProgram
from polarcheck.rewrite.convert.translating import Translation
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError, refused_at

_WORD = re.compile(r"[$A-Z_][A-Z0-9_$]*+(?:\[[^\[\]]{0,80}+\])?=?")
_INDEX = re.compile(r"\[[^\[\]]*+\]")


def is_without_effect(content: str, machine: Machine) -> bool:
    """
    The statement moves nothing and changes no path: a message, a limit of the speed, how corners are run, a wait.

    content: of its block, without N word and comment.
    """
    rest = content.upper()
    words = [match[0] for match in _WORD.finditer(rest)][:1]
    if not words:
        return False
    plain = _INDEX.sub("[*]", words[0])
    numbered = re.sub(r"(?<=[A-Z])\d+=", "n=", plain)
    for name, effect in machine.macro.statements.items():
        if effect in ("none", "speeds") and (fnmatchcase(plain, name) or numbered == name):
            return True
    return False


def write_around(original: Original, target: Settings, translation: Translation, new: NewProgram) -> None:
    """
    Write the blocks outside of polar sections as the other machine reads them.

    new: has the sections, and takes these blocks. Raises RefusedError with all that cannot be written.
    """
    _Writer(original, target, translation, new).write()


class _Writer:
    def __init__(self, original: Original, target: Settings, translation: Translation, new: NewProgram) -> None:
        self.trace, self.target, self.translation, self.new = original.trace, target.machine, translation, new
        self.source = self.trace.machine
        self.texts = BlockTexts(self.trace)
        self.refusals: list[Refusal] = []
        count = len(self.trace.text.blocks)
        self._taken = mask_at(count, list(new.taken))
        self._order, self._begins = _grouped(self.trace.run.block, count)
        self._from_section = self._motion_from_section()
        ours, theirs = self.source.control, self.target.control
        is_signed_alike = (ours.line_comments, ours.parentheses_are_comments) == (
            theirs.line_comments,
            theirs.parentheses_are_comments,
        )
        #: Named blocks, whose names become comments; with them those whose comments have other signs.
        is_same_language = self.source.macro.language == self.target.macro.language
        self._named = set() if is_same_language else set(self.trace.text.labels.block.tolist())
        self._restated = self._named | (set() if is_signed_alike else self.texts.with_comment)
        self._reported = False
        self._contours: dict[tuple[float, float], tuple[int, int]] = {}
        self._has_lost_motion = False

    def write(self) -> None:
        new = self.new
        for block in np.flatnonzero(~self._taken).tolist():
            try:
                self._block(block)
            except RefusedError as error:
                self.refusals += error.refusals
        self._decide_contours()
        if self.refusals:
            raise RefusedError(self.refusals)
        heads = Heads(self.trace, self.target, self.texts)
        new.before, new.behind, new.edits = heads.before(self.translation.measures), heads.behind(), heads.edits
        new.decisions += heads.decisions
        new.decided |= self.translation.left_out

    def _rows(self, block: int) -> Rows:
        return self._order[self._begins[block] : self._begins[block + 1]]

    def _motion_from_section(self) -> np.typing.NDArray[np.bool_]:
        """Per row: the code of the motion in force stands in a block that is written elsewhere."""
        sets = self.trace.modal.sets("motion")
        return fill_down(sets & self._taken[self.trace.run.block], sets | self.trace.blocks.starts, False).astype(bool)

    def _decide_contours(self) -> None:
        """Leave the contour from N of P to N of Q to be decided with its turning cycle, without which it is a cut."""
        blocks, decided = self.trace.blocks, self.new.decided
        rows = np.flatnonzero(blocks.listed("repetitive_cycle") & ~self._taken[self.trace.run.block])
        for row in rows.tolist():
            line = int(blocks.line_in_file[row])
            cycle = int(self.trace.run.block[row])
            key = float(blocks.word("P")[row]), float(blocks.word("Q")[row])
            first, last = (self.texts.block_numbered(number, cycle) for number in key)
            if first is None or last is None:
                first, last = self._contours.get(key, (-1, -1))
                if first >= 0 and line not in decided:
                    # A finishing cycle along a contour that is left to be decided.
                    content = self.texts.content(cycle)
                    self.new.decide(line, f"{content}: its contour is left to be decided")
                    self.new.blocks[cycle] = [NewBlock((), decision_comment(f"{content}: ITS CONTOUR"))]
                continue
            if line not in decided:
                continue
            self._contours[key] = first, last
            for block in range(first, last + 1):
                if self.texts.content(block) and not self._taken[block] and self.texts.line(block) not in decided:
                    self._leave(block, f"it is the contour of the cycle in line {line}")

    # ---- one block ----

    def _block(self, block: int) -> None:
        rows = self._rows(block)
        if not len(rows):
            self._without_row(block)
            return
        row = int(rows[0])
        content = self.texts.content(block)
        self._reported = False
        if block in self.texts.with_program_number:
            if self.translation.measures.words_of(row):
                raise refused_at(self.trace, row, "words stand beside O: put them into a block of their own")
            self._program(block)
            return
        called = self._call(row, content)
        result = called or self._same_each_time(rows)
        rest = "" if called else self.texts.rest(block, row)
        if rest and not result.whole:
            self._rest(rest, result)
        self._with_motion(row, result)
        self._write(block, result)

    def _program(self, block: int) -> None:
        """A block with a program number, which stays or is written by Heads."""
        if block in self._restated and writes_numbers(self.target):
            self.new.blocks[block] = [NewBlock()]

    def _same_each_time(self, rows: Rows) -> Translated:
        """The words of a block, which are the same each time that it runs."""
        indices = self.translation.measures.words_of(int(rows[0]))
        for in_steps in (False, True):
            first = self.translation.words(int(rows[0]), indices, in_steps)
            if all(self._is_same(first, int(row), in_steps) for row in rows[1:]):
                return first
        raise refused_at(self.trace, int(rows[0]), "it runs several times, and would be another block each time")

    def _is_same(self, first: Translated, row: int, in_steps: bool) -> bool:
        second = self.translation.words(row, self.translation.measures.words_of(row), in_steps)
        return (second.words, second.behind, second.whole) == (first.words, first.behind, first.whole)

    def _call(self, row: int, content: str) -> Translated | None:
        """A block that calls a subprogram or returns from it; None for any other."""
        words = self.translation.calls.words_of_row(row, content)
        return None if words is None else Translated(words=words, changed=words != content.split())

    def _rest(self, rest: str, result: Translated) -> None:
        """What of a block is no word: a statement beside words, a stray character."""
        if self.source.macro.language == self.target.macro.language:
            if result.changed or result.decisions:
                result.whole = f"{rest} stands beside words that are other ones there"
            return
        result.whole = f"{rest} is a statement of another language"

    def _with_motion(self, row: int, result: Translated) -> None:
        """The code of the motion in force, where only a section, or a block that is to be decided, has it."""
        trace, motion = self.trace, int(self.trace.modal.state("motion")[row])
        if bool(trace.modal.sets("motion")[row]):
            self._has_lost_motion = bool(result.whole)
        if result.whole or not (self._from_section[row] or self._has_lost_motion) or motion not in MOVES:
            return
        moves = trace.modal.uses_axes[row] and trace.blocks.has(*trace.machine.axis_words)[row]
        if not moves or bool(trace.modal.in_cycle[row]):
            return
        code = self.target.codes(MOVES[motion])[0]
        result.words.insert(len(result.behind), code)
        result.changed, self._has_lost_motion = True, False

    def _leave(self, block: int, reason: str) -> None:
        """Leave a block to be decided, of which nothing is in the new program but a comment."""
        self._write(block, Translated(whole=reason))

    def _write(self, block: int, result: Translated) -> None:
        comment = self.new.comment(self.texts.line(block), self.texts.content(block), result)
        if result.whole:
            self.new.blocks[block] = [NewBlock((), comment)]
            return
        if not (result.changed or comment or block in self._restated):
            return
        new = [NewBlock(tuple(result.words), comment)]
        if result.behind:
            before = [] if self._taken[block - 1] else self.new.blocks.get(block - 1, [])
            if len(before) > 1 and before[-1].words == tuple(result.behind) and self._leads_on(block - 1):
                # Of blocks of distances one behind the other the last alone has G90 behind it.
                before.pop()
        if result.behind and not self._says_absolute(block):
            new.append(NewBlock(tuple(result.behind)))
        stays = new[0].words or comment or block in self.texts.with_comment or block in self._named
        self.new.blocks[block] = new if stays else new[1:]

    def _leads_on(self, block: int) -> bool:
        """Whenever a block runs, the next one runs behind it, in the same program."""
        rows, run = self._rows(block), self.trace.run
        behind = np.minimum(rows + 1, len(run.block) - 1)
        return bool(((run.block[behind] == block + 1) & (run.depth[behind] == run.depth[rows])).all())

    def _says_absolute(self, block: int) -> bool:
        """The next block begins with G90 itself."""
        following = self._rows(block + 1) if block + 1 < len(self._begins) - 1 else self._order[:0]
        return bool(len(following) and self.trace.blocks.listed("absolute")[following[0]])

    # ---- blocks that are not executed ----

    def _without_row(self, block: int) -> None:
        content, line = self.texts.content(block), self.texts.line(block)
        if self.texts.is_mark(block):
            return
        if not content or (block in self._named and self.texts.is_text(block)):
            if block in self._restated:
                self.new.blocks[block] = [NewBlock()]
            return
        if not self.trace.text.blocks.is_macro[block]:
            if not self.texts.is_text(block):
                self._never_run(block, line, content)
            return
        if self.source.macro.language == self.target.macro.language:
            return
        if not is_without_effect(content, self.source):
            text = f"{content} is a statement of a language that {self.target.title} does not have"
            self.refusals.append(Refusal(line, text))
            return
        self._leave(block, f"a statement that {self.target.title} does not have")
        self._reported = False

    def _never_run(self, block: int, line: int, content: str) -> None:
        """A block that is never run: of several one behind the other the first is a thing to decide."""
        reason = "it is never run, so that what is in force there is not known"
        if self._reported:
            self.new.decided.add(line)
            self.new.blocks[block] = [NewBlock((), decision_comment(f"{content}: {reason}"))]
        else:
            self._leave(block, reason)
        self._reported = True


def _grouped(block: Rows, count: int) -> tuple[Rows, Rows]:
    """Rows grouped by their blocks, each in order, and where each block begins."""
    order = np.argsort(block, kind="stable")
    return order, np.append(0, np.cumsum(np.bincount(block, minlength=count)))
