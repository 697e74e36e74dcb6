"""The cutter radius as the comments of a program tell it: `3/4 DIA. CUTTER`, `D=12.`, `R0.25`."""

from __future__ import annotations

import re
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.arrays import Mask, Rows
from polarcheck.machines.modal import MM_PER_INCH
from polarcheck.reading.words import Text

# No text may cost more than its length: a repeat takes all it can and gives nothing back (`++`), and a number is tried
# at the first of its digits only.
_NUMBER = r"((?<!\d)\d++\s*+/\s*+\d++|(?<!\d)\d++(?:\.\d++)?+|\.\d++)"
_UNIT = r"\s*+(\"|''|IN\b\.?+|INCH\b|MM\b)?+"
_IS = r"\s*+[=:]?+\s*+"
#: The rest of a word such as DIAMETER; digits behind it are the number, as in DIA16.
_LETTERS = r"[^\W\d]*+"
_CUTTER_NAMES = r"FREZA|FR(?:Ä|AE)SER"
_CUTTER = rf"DIA\w*+|END\s*+MILL|EM\b|CUTTER|MILL\b|{_CUTTER_NAMES}"
#: Diameters before radii: posts write both, as in `D=12. CR=0.`, where CR is the radius of the corner.
_PATTERNS = (
    (2.0, re.compile(rf"(?:\bDIA{_LETTERS}\.?+|\bD|Ø|\b(?:{_CUTTER_NAMES})){_IS}{_NUMBER}{_UNIT}")),
    (2.0, re.compile(rf"{_NUMBER}{_UNIT}[\s-]*+(?:{_CUTTER})")),
    (1.0, re.compile(rf"(?:(?<![A-Z])R|\bRAD{_LETTERS}){_IS}{_NUMBER}{_UNIT}")),
)
#: A tool number of up to eight digits behind its zeros, more than any T word has.
_OF_TOOL = re.compile(r"\W*+T\s*+(?=\d)0*+(\d{0,8}+)\b")
_LARGEST = 100.0


class Found(msgspec.Struct, frozen=True):
    """A radius [mm] that a comment gives to an offset, and the comment."""

    radius: float
    comment: str


def radius_in(comment: str, inch: bool) -> float | None:
    """The radius [mm] that a comment names; inch: the unit of the program, unless the comment says its own."""
    text = comment.upper()
    for divisor, pattern in _PATTERNS:
        found = pattern.search(text)
        if not found:
            continue
        above, _, below = found[1].partition("/")
        if below and not float(below):
            continue
        value = float(above) / (float(below) if below else 1.0)
        unit = found[2] or ("IN" if inch else "MM")
        radius = value / divisor * (1.0 if unit == "MM" else MM_PER_INCH)
        if 0 < radius < _LARGEST:
            return radius
    return None


class Called(NamedTuple):
    """The rows with a T word, one element each: block, offset number, tool number; inch: the program's unit."""

    block: Rows
    offset_number: Rows
    tool: Rows
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
        listed = _OF_TOOL.match(comment.upper())
        if listed:
            of_tool.setdefault(int(listed[1] or 0), comment)
    beside = np.concatenate((called.block - 1, called.block + 1))
    filled = set(beside[np.isin(beside, text.words.block)].tolist())
    found: dict[int, Found] = {}
    rows = zip(*(column.tolist() for column in called), strict=True)
    for block, offset, tool, inch in rows:
        near = list(of_block.get(block, []))
        near += [c for other in (block - 1, block + 1) if other not in filled for c in of_block.get(other, [])]
        near += [of_tool[tool]] if tool in of_tool else []
        for comment in near:
            radius = radius_in(comment, inch)
            if offset and radius is not None and offset not in found:
                found[offset] = Found(radius, comment)
    return found
