"""The new program of a conversion, as its writers fill it: blocks, and what somebody has to decide of them."""

from __future__ import annotations

import msgspec

from polarcheck.rewrite.convert.axis_words import Translated
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment
from polarcheck.rewrite.writing.outcome import Decision
from polarcheck.rules.editing import Replace


class NewProgram(msgspec.Struct):
    """
    The new program, as far as it is written.

    blocks: index in text.blocks -> what stands in its place; a block that is not in it stays as it is.
    before, behind: new blocks before and behind a block that stays.
    edits: of heads and ends of programs.
    taken: blocks of polar sections, those that stay as they are included.
    decisions: what is to be decided.
    decided: lines of the original that lost a word, or whose M code stands in another list there.
    notes: what is written otherwise in sections, and where. rapid_as_line: rapid traverse in sections is a line there.
    """

    blocks: dict[int, list[NewBlock]] = {}
    before: dict[int, list[NewBlock]] = {}
    behind: dict[int, list[NewBlock]] = {}
    edits: list[Replace] = []
    taken: set[int] = set()
    decisions: list[Decision] = []
    decided: set[int] = set()
    notes: list[str] = []
    rapid_as_line: bool = False

    def decide(self, line: int, *texts: str) -> None:
        """Leave words of a line to be decided, which the new program does not have."""
        self.decisions += [Decision(line, text) for text in texts]
        self.decided |= {line} if texts else set()

    def comment(self, line: int, content: str, translated: Translated) -> str:
        """
        Return the comment on what is to be decided of a block; empty where nothing is.

        content: of the block, which the comment has where none of its words stays.
        """
        if translated.whole:
            text = f"{content}: {translated.whole}"
            self.decide(line, text)
        else:
            text = translated.comment
            self.decide(line, *translated.decisions)
            self.decisions += [Decision(line, remark) for remark in translated.remarks]
        return decision_comment(text) if text else ""
