"""Heads and ends of programs: numbers, names and % for the other machine, and the words of its first block."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.convert.measures import Measures
from polarcheck.rewrite.writing.new_blocks import NewBlock, comment_text, comments_of
from polarcheck.rewrite.writing.outcome import Decision
from polarcheck.rules.editing import Replace, content_of, line_without

_MARK = "%"
_NUMBER = re.compile(r"O?0*(\d{1,9})", re.IGNORECASE)
_NAME = re.compile(r"[A-Z0-9][A-Z0-9_-]{0,60}", re.IGNORECASE)


def writes_numbers(machine: Machine) -> bool:
    """Programs of the machine begin with O and their number."""
    return any("O#" in head for head in machine.writing.program_head)


class Heads:
    """
    The heads of the programs of a file for another machine.

    edits: of the blocks with them. decisions: what is to be decided about them.
    """

    def __init__(self, trace: Trace, target: Machine, texts: BlockTexts) -> None:
        self.trace, self.source, self.target, self.texts = trace, trace.machine, target, texts
        self.edits: list[Replace] = []
        self.decisions: list[Decision] = []
        ours, theirs = (machine.writing for machine in (self.source, target))
        self._takes_marks, self._has_marks = (_MARK in head for head in (theirs.program_head, ours.program_head))
        starts = trace.blocks.starts & (trace.run.depth == 0)
        self._main = set(trace.run.block[starts].tolist())
        if not writes_numbers(target):
            self._numbers_to_names()
        if (ours.program_head, ours.archive_heads) != (theirs.program_head, theirs.archive_heads):
            self._marks()

    # ---- blocks of heads ----

    def _numbers_to_names(self) -> None:
        """O and a number of each program: comments, or the heads of an archive where there are several programs."""
        blocks = sorted(self.texts.with_program_number)
        # The first program may have none, and call those behind it.
        first_main = min(self._main, default=0)
        has_several = len(blocks) > 1 or any(block > first_main for block in blocks)
        for index, block in enumerate(blocks):
            content = self.texts.content(block)
            number = _NUMBER.search(content)
            heads = self.target.writing.archive_heads
            if has_several and heads and number:
                is_main = block in self._main or (not index and block <= first_main)
                text = heads[0 if is_main else 1].replace("#", number[1])
                # Nothing stands beside such a head: the control would take it for a part of the name.
                self._replace(block, self._lines(block, [text, *self._comments(block)]))
            else:
                self._replace(block, " ".join([comment_text(content, self.target), *self._comments(block)]))

    def _comments(self, block: int) -> list[str]:
        return [comment_text(comment, self.target) for comment in comments_of(self.trace.text, block)]

    def _marks(self) -> None:
        """% and names such as %_N_SHAFT_MPF."""
        for index, block in enumerate(self.texts.marks()):
            content = self.texts.content(block)
            if content == _MARK:
                if not self._takes_marks:
                    self.edits.append(line_without(self.trace.text.source, *content_of(self.trace.text, block)))
                continue
            number = self._archived(content)
            name = number or next(iter(_NAME.findall(re.sub(r"^[%$]?_?N?_?", "", content))), content)
            head = next((head for head in self.target.writing.program_head if "O#" in head), "")
            if number and head:
                texts = [*([_MARK] if self._takes_marks and not index else []), head.replace("#", number)]
                self._replace(block, self._lines(block, texts))
                continue
            remark = comment_text(name, self.target)
            lead = [_MARK] if self._takes_marks and not index else []
            self._replace(block, self._lines(block, [*lead, remark]))
            if head:
                text = f"{content}: programs of {self.target.title} have a number: {head}"
                self.decisions.append(Decision(self.texts.line(block), text))

    def _archived(self, content: str) -> str:
        """The number of a program in the head of an archive; empty without one."""
        for head in self.source.writing.archive_heads:
            if match := _archive_pattern(head).fullmatch(content):
                return match[1]
        return ""

    def _lines(self, block: int, texts: Sequence[str]) -> str:
        return self.texts.line_end(block).join(texts)

    def _replace(self, block: int, text: str) -> None:
        begin, _ = content_of(self.trace.text, block)
        self.edits.append((begin, int(self.trace.text.blocks.end[block]), text))

    # ---- further blocks ----

    def before(self, measures: Measures) -> dict[int, list[NewBlock]]:
        """New blocks by the block before which they stand."""
        new: dict[int, list[NewBlock]] = {}
        for row in np.flatnonzero(self.trace.blocks.starts & (self.trace.run.depth == 0)).tolist():
            first = self.texts.first_block(row)
            words = head_words(self.trace, self.target, measures, row)
            if words and first is not None:
                new[first] = [NewBlock(tuple(words))]
        begin, _ = self.texts.ends()
        if self._takes_marks and not self._has_marks and begin not in self.texts.marks():
            new[begin] = [NewBlock((_MARK,)), *new.get(begin, [])]
        return new

    def behind(self) -> dict[int, list[NewBlock]]:
        """New blocks by the block behind which they stand."""
        _, last = self.texts.ends()
        needs_mark = self._takes_marks and not self._has_marks and self.texts.content(last) != _MARK
        return {last: [NewBlock((_MARK,))]} if needs_mark else {}


def _archive_pattern(head: str) -> re.Pattern[str]:
    """The head of a program in an archive, with its number as the group."""
    before, _, after = head.partition("#")
    return re.compile(rf"{re.escape(before)}0*(\d{{1,9}}){re.escape(after)}", re.IGNORECASE)


def head_words(trace: Trace, target: Machine, measures: Measures, row: int) -> list[str]:
    """
    Codes for the first block of a program: units, coordinates (G90), X as a diameter, where the other control needs
    them and the original does not say them. row: its first one.
    """
    words: list[str] = []
    if not len(trace):
        return words
    # A control with codes for units may be in those of its last program; one without any has those of the machine.
    has_codes = trace.machine.codes("mm") or trace.machine.codes("inch")
    is_same = has_codes and trace.machine.control.units == target.control.units
    if not trace.modal.sets("units").any() and not is_same:
        codes = target.codes("inch" if measures.writes_inch(row) else "mm")
        of_lengths_alone = target.control.units_of_lengths_alone
        if codes:
            words.append(next((code for code in codes if code not in of_lengths_alone), codes[0]))
    systems = trace.machine.control.g_code_system, target.control.g_code_system
    if systems[0] == "A" != systems[1] and target.codes("absolute") and not trace.modal.sets("distance").any():
        words.append(target.codes("absolute")[0])
    control = target.control
    is_switched = trace.machine.control.x_diameter_words == control.x_diameter_words
    if not is_switched and control.x_without_words and control.x_diameter_words and control.x == "diameter":
        words.append(shown(control.native_words, control.x_diameter_words[0]))
    return words
