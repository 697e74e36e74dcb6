"""The cutter radius of each offset as the comments of a program state it: `3/4 DIA. CUTTER`, `D=12.`, `R0.25`."""

from __future__ import annotations

import re

import msgspec
import numpy as np

from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.words.comments import Comments, named_tool
from polarcheck.foundation.arrays import is_among, side_by_side

#: A longer number calls nothing.
_LARGEST_T = 1e15


class StatedRadius(msgspec.Struct, frozen=True):
    """
    A radius that a comment gives to an offset.

    radius: [mm].
    comment: as it is written.
    allowance: the most that this comment, or one beside it, says is left for another tool [mm]; 0 for none.
    """

    radius: float
    comment: str
    allowance: float


def radius_in(comment: str, inch: bool) -> float | None:
    """
    The radius of the cutter that a comment names [mm]; None where its words do not say so plainly.

    inch: the unit of the program, unless the comment says its own.
    """
    if not re.search(r"\d", comment):
        return None
    # Imported late: its patterns take longer to compile than the check of a small file, and few comments have digits.
    from polarcheck.columns.words.comment_reader import cutter_radius

    return cutter_radius(comment, inch)


def radii(comments: Comments, tools: CalledTools) -> dict[int, StatedRadius]:
    """
    What the comments say of each offset number: in the block of its T word, in a comment alone on the line before or
    after it, or in a list of tools at the head (`(T8 D=12. CR=0. - FLAT END MILL)`).
    """
    if not len(comments):
        return {}
    rows = np.flatnonzero(tools.calls_offset & ~tools.takes_offset_of_other)
    called = comments.run.block[rows]
    of_block: dict[int, list[str]] = {}
    of_tool: dict[int, str] = {}
    block_of_comment = comments.text.comments.block
    is_near = is_among(block_of_comment, np.concatenate((called - 1, called, called + 1)).tolist())
    for number in np.flatnonzero(is_near | comments.may_name_tool).tolist():
        comment = comments.written(number).strip("();% ")
        of_block.setdefault(int(block_of_comment[number]), []).append(comment)
        named = named_tool(comment)
        if named is not None:
            of_tool.setdefault(named, comment)
    beside = np.concatenate((called - 1, called + 1))
    filled = set(beside[np.isin(beside, comments.text.words.block)].tolist())
    number_of_word = np.abs(np.nan_to_num(comments.blocks.word("T")[rows]))
    words = np.where(number_of_word < _LARGEST_T, number_of_word, 0).astype(np.int64)
    columns = (called, tools.offset_number[rows], tools.tool[rows], words, comments.lengths.scale[rows] != 1.0)
    stated: dict[int, StatedRadius] = {}
    for block, offset, tool, word, in_inch in side_by_side(*columns):
        near = list(of_block.get(block, []))
        near += [c for other in (block - 1, block + 1) if other not in filled for c in of_block.get(other, [])]
        near = [comment for comment in near if named_tool(comment) in (None, tool, word)]
        near += [of_tool[number] for number in (tool, word) if number in of_tool]
        for comment in near:
            radius = radius_in(comment, in_inch)
            if offset and radius is not None and offset not in stated:
                stated[offset] = StatedRadius(radius, comment, _allowance(near, in_inch))
    return stated


def _allowance(comments: list[str], in_inch: bool) -> float:
    from polarcheck.columns.words.comment_reader import allowance_in

    return max(allowance_in(comment, in_inch) for comment in comments)
