"""The cutter radius as the comments of a program state it: `3/4 DIA. CUTTER`, `D=12.`, `R0.25`."""

from __future__ import annotations

import re
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.columns.words.tool_numbers import named_tool
from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.program.reading.words import Text

_DIGIT = re.compile(r"\d")


class Found(msgspec.Struct, frozen=True):
    """A radius [mm] that a comment gives to an offset, and the comment."""

    radius: float
    comment: str


def radius_in(comment: str, inch: bool) -> float | None:
    """
    The radius of the cutter that a comment names [mm]; None where its words do not say so plainly.

    inch: the unit of the program, unless the comment says its own.
    """
    if not _DIGIT.search(comment):
        return None
    # Imported late: its patterns take longer to compile than the check of a small file, and few comments have digits.
    from polarcheck.columns.words.cutter_comments import cutter_radius

    return cutter_radius(comment, inch)


class Called(NamedTuple):
    """
    The rows with a T word, one element each.

    block: in the text. offset_number, tool: that are called. word: the number that T has, 808 for T0808. inch: the
    program's unit.
    """

    block: Rows
    offset_number: Rows
    tool: Rows
    word: Rows
    inch: Mask


def _candidates(text: Text, called: Called) -> Mask:
    """The comments beside a T word, and those that begin as an entry of a list of tools may."""
    comments, code = text.comments, text.source.code
    first = code[np.minimum(comments.start + 1, len(code) - 1)]
    is_word = ((first >= ord("A")) & (first <= ord("Z"))) | ((first >= ord("a")) & (first <= ord("z")))
    is_digit = (first >= ord("0")) & (first <= ord("9"))
    near = np.concatenate((called.block - 1, called.block, called.block + 1))
    is_of_tool = np.isin(first, list(b"Tt")) | ~(is_word | is_digit)
    return np.asarray(np.isin(comments.block, near) | is_of_tool)


def radii(text: Text, called: Called) -> dict[int, Found]:
    """
    What the comments say of each offset number: in the block of its T word, in a comment alone on the line before or
    after it, or in a list of tools at the head (`(T8 D=12. CR=0. - FLAT END MILL)`).
    """
    if not len(text.comments):
        return {}
    of_block: dict[int, list[str]] = {}
    of_tool: dict[int, str] = {}
    comments, chosen = text.comments, _candidates(text, called)
    for start, end, block in zip(comments.start[chosen], comments.end[chosen], comments.block[chosen], strict=True):
        comment = text.source.excerpt(int(start), int(end)).strip("();% ")
        of_block.setdefault(int(block), []).append(comment)
        named = named_tool(comment)
        if named is not None:
            of_tool.setdefault(named, comment)
    beside = np.concatenate((called.block - 1, called.block + 1))
    filled = set(beside[np.isin(beside, text.words.block)].tolist())
    found: dict[int, Found] = {}
    rows = zip(*(column.tolist() for column in called), strict=True)
    for block, offset, tool, word, inch in rows:
        near = list(of_block.get(block, []))
        near += [c for other in (block - 1, block + 1) if other not in filled for c in of_block.get(other, [])]
        near = [comment for comment in near if named_tool(comment) in (None, tool, word)]
        near += [of_tool[number] for number in (tool, word) if number in of_tool]
        for comment in near:
            radius = radius_in(comment, inch)
            if offset and radius is not None and offset not in found:
                found[offset] = Found(radius, comment)
    return found
