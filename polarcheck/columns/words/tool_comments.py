"""Comments that name another tool than the one that is called beside them."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.words.comments import Comments, named_tool
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, mask_at, repeated
from polarcheck.program.execution.run import Run


class ToolComments(Columns, frozen=True):
    """The comments beside the words that call tools, one value per row."""

    run: Run
    blocks: ExecutedBlocks
    tools: CalledTools
    comments: Comments

    @property
    def named_tool(self) -> Rows:
        """The number of the tool in the comment, as it is written; -1 where no comment names another one."""
        return self._beside[1]

    @property
    def comment(self) -> Rows:
        """The number in text.comments of the comment that names another tool than T calls; -1 for none."""
        return self._beside[0]

    @cached_property
    def _beside(self) -> tuple[Rows, Rows]:
        nothing = repeated(np.int64(-1), len(self.run))
        calls = np.flatnonzero(self.tools.calls_tool & (self.tools.tool > 0) & ~self.run.unknown)
        if not len(calls) or not len(self.comments):
            return nothing, nothing
        of_block = self._comments_of_block(self.run.block[calls])
        if not of_block:
            return nothing, nothing
        comment, named = nothing.copy(), nothing.copy()
        tools, offsets, blocks = (
            c[calls].tolist() for c in (self.tools.tool, self.tools.offset_number, self.run.block)
        )
        words = np.abs(np.nan_to_num(self.blocks.word("T")[calls])).tolist()
        called = {*tools, *words}
        for row, tool, offset, block, word in zip(calls.tolist(), tools, offsets, blocks, words, strict=True):
            if tool in self.run.names:
                continue
            for place in (block, block - 1, block + 1):
                number, other = of_block.get(place, (-1, -1))
                if other >= 0 and (place == block or self._stands_alone(place, of_block)):
                    # Alone on a line, it may be the list of the tools of the program.
                    known = {tool, word, offset} | (called if place != block else set())
                    if other not in known:
                        comment[row], named[row] = number, other
                    break
        return comment, named

    def _comments_of_block(self, calls: Rows) -> dict[int, tuple[int, int]]:
        """By block the comment there that speaks of a tool, and the number of that: of the blocks beside calls."""
        comments = self.comments
        block = comments.text.comments.block
        # Two blocks off stand the neighbors of a comment, by which a list of tools is seen.
        is_near = np.zeros(len(comments.text.blocks) + 4, bool)
        for step in range(5):
            is_near[calls + step] = True
        of_block: dict[int, tuple[int, int]] = {}
        for number in np.flatnonzero(comments.may_name_tool & is_near[block + 2]).tolist():
            comment = comments.written(number)
            tool = named_tool(comment)
            if tool is None:
                continue
            from polarcheck.columns.words.comment_reader import speaks_of_tool  # imported late: most files need none

            if speaks_of_tool(comment):
                of_block.setdefault(int(block[number]), (number, tool))
        return of_block

    def _stands_alone(self, block: int, of_block: dict[int, tuple[int, int]]) -> bool:
        """A comment with its block for itself, beside one call of a tool, and in no list of tools."""
        if self._has_words[block]:
            return False
        beside = [place for place in (block - 1, block + 1) if 0 <= place < len(self._has_words)]
        return not any(place in of_block for place in beside) and sum(self._calls_tool[place] for place in beside) == 1

    @cached_property
    def _has_words(self) -> Mask:
        text = self.comments.text
        mask = text.blocks.is_macro.copy()
        mask[text.words.block] = True
        return mask

    @cached_property
    def _calls_tool(self) -> Mask:
        text = self.comments.text
        return mask_at(len(text.blocks), text.words.block[text.words.address == ord("T")])
