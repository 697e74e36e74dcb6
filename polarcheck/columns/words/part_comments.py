"""Shape, size and depth of the part in comments: `HEX 24 AF`, `SQ 20`, `FLATS 22`, `DIA 30 BOSS`, `5 DEEP`."""

from __future__ import annotations

import re
from typing import NamedTuple

from polarcheck.columns.words.bar_comments import bar_in
from polarcheck.columns.words.comment_lengths import ENDS, NUMBER, UNIT, length_of, plain_text
from polarcheck.foundation.states import MM_PER_INCH

_IS = r"\s*+[=:-]?+\s*+"
_AF = r"(?:A/?F\b|A\.F\.?|ACROSS\s++(?:THE\s++)?FLATS\b|SW(?![A-Z]))"
_NAMES = {
    "hexagon": r"(?:HEX(?:AGON)?|SECHSKANT|6-?KT|6-?KANT)(?![A-Z])",
    "square": r"(?:SQ(?:UARE)?|VIERKANT|4-?KT|4-?KANT)(?![A-Z])",
    "octagon": r"OCT(?:AGON)?(?![A-Z])",
    "pentagon": r"PENT(?:AGON)?(?![A-Z])",
}
_DIAMETER = r"(?:DIA(?:M(?:ETER)?)?\b\.?|D(?=\s*+=?\s*+[\d.])|\u00d8|\u2300)"
_VALUE = NUMBER + UNIT + ENDS
#: A number that is followed by one of these is another size, or counts.
_NOT_AFTER = (
    r"(?!\s*+-?(?:X|BY\b|/|BAR|STOCK|DEEP|LONG|WIDE|HIGH|THICK|SIDES|POINT"
    r"|PL[AC]|OFF\b|P[CT]S|DEG|TIMES|OF\b|FL\b|TPI|PITCH))"
)
_WHOLE = r"(?<![\w.,/-])"
#: By shape its word, and the plain forms of its size across flats, or of its diameter; the shape is empty where any has
#: such a size. `re` compiles a pattern at its first use: that of a form only for a comment in which the word stands.
_SHAPES = (
    *(
        (
            name,
            word,
            (
                # HEX 24 AF, SQUARE 20
                rf"{_WHOLE}{word}{_IS}(?:{_AF}{_IS})?{_VALUE}{_NOT_AFTER}",
                # 24 AF HEX, 24MM HEX
                rf"{_WHOLE}{NUMBER}{UNIT}[\s-]*+{_AF}[\s-]*+{word}",
                rf"^{NUMBER}{UNIT}[\s-]++{word}\s*+$",
            ),
        )
        for name, word in _NAMES.items()
    ),
    ("flats", "FLATS", (rf"{_WHOLE}FLATS{_IS}(?:AT\s++|{_AF}{_IS})?{_VALUE}{_NOT_AFTER}",)),
    (
        "boss",
        "BOSS",
        (
            rf"{_WHOLE}{_DIAMETER}{_IS}{_VALUE}\s*+(?:ROUND\s++)?BOSS\b",
            rf"{_WHOLE}BOSS{_IS}{_DIAMETER}{_IS}{_VALUE}{_NOT_AFTER}",
            rf"{_WHOLE}{NUMBER}{UNIT}\s*+{_DIAMETER}\s*+BOSS\b",
        ),
    ),
    (
        "",
        r"A[/.]?F|ACROSS|SW",
        (rf"{_WHOLE}{NUMBER}{UNIT}\s*+{_AF}", rf"{_WHOLE}(?:A/?F|SW){_IS}{_VALUE}{_NOT_AFTER}"),
    ),
)
_ACROSS_FLATS = rf"(?<![A-Z]){_AF}"
#: Of what is not cut here, or not to its size.
_NOT_HERE = (
    r"SOCKET|\bKEY\b|\bNUT\b|\bBOLT|SCREW|WRENCH|SPANNER|BROACH|\bBUSH|\bJAW|COLLET|CHUCK|\bGRIP|\bHOLD|\bCLAMP|\bROUGH|\bLEAVE"
    r"|ALLOW|\bBEFORE\b|\bPRE-?|\bA/?C\b|CORNERS|\bINSIDE\b|INTERNAL|\bNOT\b|\bWAS\b|\bOLD\b|\bDONE\b|\bLATER\b|\bOTHER\b"
    r"|\bNEXT\b|\bOP\s?\d|\bFROM\s++HEX|\bMIN\b|\bMAX\b|\bOR\b|\bM\d"
)
_DEPTH_WORDS = ("DEPTH", "DEEP")
_DEPTHS = (
    # DEPTH 5, DEPTH OF 5MM
    rf"{_WHOLE}DEPTH(?:\s++OF(?=\s++[\d.]))?{_IS}{_VALUE}{_NOT_AFTER}",
    # 5 DEEP
    rf"{_WHOLE}{NUMBER}{UNIT}\s*+(?:DEEP|DEPTH)\b",
)
#: Depths of cuts, and of what this section does not cut.
_OTHER_DEPTH = (
    r"OF\s++CUT|\bCUT\b|\bPASS|\bPER\b|\bSTEP|\bPECK|DRILL|\bHOLE|\bTAP\b|THREAD|\bCHUCK|\bJAW|\bBORE|\bBORING|\bGRIP|\bROUGH|\bLEAVE"
    r"|\bGROOVE|\bFLATS?\b|\bKEY|\bMIN\b|\bMAX\b|\bOR\b|\bNOT\b|\bWAS\b|\bOLD\b|\bDONE\b|\bOP\s?\d|CHAMF|REAM|SPOT|\bEACH\b|\bFEED\b|\bTOTAL\b"
)
#: Sizes [mm]; a number without a unit in a program in inch is none above so many inches.
_LEAST, _LARGEST, _LARGEST_IN_INCH = 2.0, 500.0, 12.0


class Size(NamedTuple):
    """
    A shape and its size in a comment.

    shape: hexagon, square, octagon, pentagon, flats, boss (a round one), or empty for what is so wide across its flats.
    size: across flats, or the diameter [mm].
    is_across_flats: the comment says AF; without it corners may be meant.
    """

    shape: str
    size: float
    is_across_flats: bool = False


def shape_in(comment: str, in_inch: bool) -> Size | None:
    """The shape and size that a comment states of the part; None where its words do not say so plainly."""
    text = plain_text(comment)
    shapes = [(shape, patterns) for shape, word, patterns in _SHAPES if re.search(word, text)]
    if not shapes or re.search(_NOT_HERE, text):
        return None
    bar = bar_in(comment, in_inch)
    if bar is not None and bar.across_flats == bar.across_flats:
        return None
    sizes: list[Size] = []
    is_across_flats = bool(re.search(_ACROSS_FLATS, text))
    for shape, patterns in shapes:
        if not shape and sizes:
            break
        for match in (match for pattern in patterns for match in re.finditer(pattern, text)):
            size = _length(match, in_inch)
            if size is None:
                return None
            sizes.append(Size(shape, size, is_across_flats))
    # Two sizes: nobody knows which section is which.
    if not sizes or any(size != sizes[0] for size in sizes):
        return None
    return sizes[0]


def depth_in(comment: str, in_inch: bool) -> float | None:
    """The depth [mm] that a comment states; None where its words do not say so plainly."""
    text = plain_text(comment)
    if not any(word in text for word in _DEPTH_WORDS) or re.search(_OTHER_DEPTH, text):
        return None
    depths = [_length(match, in_inch, 0.0) for pattern in _DEPTHS for match in re.finditer(pattern, text)]
    return depths[0] if len(depths) == 1 else None


def _length(match: re.Match[str], in_inch: bool, least: float = _LEAST) -> float | None:
    number, unit = match[1], match[2]
    size = length_of(number, unit, in_inch)
    if size is None or not least < size < _LARGEST:
        return None
    return None if not unit and in_inch and size > _LARGEST_IN_INCH * MM_PER_INCH else size
