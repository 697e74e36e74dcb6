"""The bar as the comments of a program state it: `BAR DIA 28`, `STOCK D50`, `RD 40`, `HEX BAR 32`."""

from __future__ import annotations

import re
from typing import NamedTuple

from polarcheck.columns.words.comment_lengths import ENDS, NUMBER, UNIT, length_of, plain_text
from polarcheck.foundation.states import MM_PER_INCH

#: One of these stands in each comment that states a bar.
WORDS = ("BAR", "STOCK", "RD", "MAT", "BLANK", "BILLET", "ROH", "STANGE", "RUND")
_IS = r"\s*+[=:-]?+\s*+"
_BAR = r"BAR(?:\s*+-?STOCK)?+\b"
_NOUN = (
    rf"\b(?:{_BAR}|STOCK\b|BLANK\b|BILLET\b|MATERIAL\b|MATL?\b\.?|ROHTEIL\b|ROHLING\b|STANGE\b|RUNDSTAHL\b"
    r"|RUNDMATERIAL\b)"
)
_ROUND = (
    r"(?:DIA(?:M(?:ETER|ETRE)?)?\b\.?|D(?=\s*[=:]?\s*[\d.])|O\.?D\b\.?|\u00d8|\u2300|ROUND\b(?:\s+BAR\b)?"
    r"|RD(?![A-Z])\.?|RUND\b)"
)
_ROUND_WORD = r"(?:DIA(?:M(?:ETER|ETRE)?)?\b\.?|O\.?D\b\.?|ROUND\b|RD\b)"
_AF = r"(?:AF\b|A/F\b|ACROSS\s+FLATS\b|SW(?![A-Z]))"
_HEX = r"\b(?:HEX(?:AGON(?:AL)?)?(?![A-Z])|SECHSKANT|6-?KT|6-?KANT)"
_VALUE = NUMBER + UNIT + ENDS
_LABEL = rf"^\s*+(?:{_NOUN}{_IS})?"

# `re` compiles a pattern at its first use, and keeps it. To compile all of them takes longer than a small check.
_ROUND_PATTERNS = (
    # BAR DIA 28, STOCK: OD 50, MATERIAL RD 40
    rf"{_NOUN}{_IS}{_ROUND}{_IS}{_VALUE}",
    # STOCK 28 DIA
    rf"{_NOUN}{_IS}{NUMBER}{UNIT}\s*+{_ROUND_WORD}",
    # BAR 28, ROUND BAR: 28
    rf"^\s*+(?:(?:ROUND|RUND)\s++)?+{_BAR}{_IS}{_VALUE}\s*+(?:$|[,;])",
    rf"^\s*+ROUND\s++STOCK{_IS}{_VALUE}\s*+(?:$|[,;])",
    # 28 DIA BAR, 2" DIA STOCK
    rf"{_LABEL}{NUMBER}{UNIT}[\s-]*+{_ROUND_WORD}[\s-]*+(?:{_BAR}|STOCK\b)",
    # DIA 28 BAR
    rf"{_LABEL}{_ROUND}{_IS}{_VALUE}[\s-]*+(?:{_BAR}|STOCK\b|BLANK\b)",
    # RD 40
    rf"^\s*+RD(?![A-Z])\.?{_IS}{_VALUE}",
)
#: 1.25" BAR, 5" 6061 ALUMINUM BARSTOCK; without a unit, a point or a fraction it may be a pressure.
_SIZE_FIRST = rf"{_LABEL}{NUMBER}{UNIT}[\s-]+(?:[A-Z0-9]++[\s-]++){{0,4}}?(?:{_BAR})(?=\s*+(?:$|[,;.\d]))"
_HEX_PATTERNS = (
    # STOCK HEX 32, BAR HEX AF 32
    rf"{_NOUN}{_IS}{_HEX}\s*+(?:{_AF})?{_IS}{_VALUE}",
    # HEX BAR 32
    rf"{_HEX}[\s-]*+{_NOUN}\s*+(?:{_AF})?{_IS}{_VALUE}",
    # HEX 32 BAR, HEX 32 AF STOCK
    rf"{_HEX}{_IS}{NUMBER}{UNIT}\s*+(?:{_AF})?\s*+{_NOUN}",
    # 32 HEX BAR, 1 1/4 AF HEX STOCK
    rf"{_LABEL}{NUMBER}{UNIT}\s*+(?:{_AF})?\s*+{_HEX}[\s-]*+{_NOUN}",
)
#: Of tools, pressures, tubes, bars that are neither round nor hexagons, and allowances.
_NO_BAR = (
    r"\bBOR(?:ING|E|ED)\b|PRESSURE|COOLANT|\bPSI\b|\bTUB|\bPIPE|\bLARGER|\bOVERSIZE|\bSQUARE\b|\bSQ\b|\bFLAT\b|KNURL"
    r"|\bDRILL|\bTAP\b|REAM|\bINSERT|\bTOOL|\bHOLDER|\bSHANK|\b[CDVSTW][CNP][MG][GTNA]\b|\bI\.?D\b|\bMIN\b|\bMAX\b|\bOR\b"
    r"|\bLEAVE|\bALLOW|\bREMOV|\bGRIP|\bSTEADY|\bX\s*+(?:D|\u00d8|DIA)\s*+[\d.]|^\s*+T\s?\d"
)
#: In front of the bar these say that something else is meant.
_NOT_BEFORE = r"\bCHUCK|\bJAWS?\b|\bCLAMP|\bTURN|\bFACE|\bFINISH|\bROUGH|\bCUT|\bMILL|\bNOT?\b"
#: Sizes of bars [mm]; a number without a unit in a program in inch is none above so many inches.
_LEAST, _LARGEST, _LARGEST_IN_INCH = 3.0, 1000.0, 20.0


class Bar(NamedTuple):
    """A bar: its diameter, or the distance across the flats of a hexagon [mm]; NaN for the other of the two."""

    diameter: float
    across_flats: float


def bar_in(comment: str, in_inch: bool) -> Bar | None:
    """The bar that a comment states; in_inch: the unit of the program. None where its words do not say so plainly."""
    text = plain_text(comment)
    if not any(word in text for word in WORDS) or re.search(_NO_BAR, text):
        return None
    has_hex = bool(re.search(_HEX, text))
    for pattern in _HEX_PATTERNS if has_hex else ():
        size = _size_in(text, pattern, in_inch)
        if size is not None:
            return Bar(float("nan"), size)
    # A hexagon that is cut from a bar may stand beside it: then only BAR DIA 28 says which of the two is which.
    for pattern in _ROUND_PATTERNS[:1] if has_hex else (*_ROUND_PATTERNS, _SIZE_FIRST):
        size = _size_in(text, pattern, in_inch)
        if size is not None:
            return Bar(size, float("nan"))
    return None


def _size_in(text: str, pattern: str, in_inch: bool) -> float | None:
    match = re.search(pattern, text)
    if not match or re.search(_NOT_BEFORE, text[: match.start(1)]):
        return None
    number, unit = match[1], match[2]
    if in_inch and text[match.start(1) - 1 : match.start(1)] == ".":  # DIA.5 may be a half and a five
        return None
    if pattern is _SIZE_FIRST and not (unit or "/" in number or ("." in number and in_inch)):
        return None
    size = length_of(number, unit, in_inch)
    if (
        size is None
        or not _LEAST <= size <= _LARGEST
        or (not unit and in_inch and size > _LARGEST_IN_INCH * MM_PER_INCH)
    ):
        return None
    return size
