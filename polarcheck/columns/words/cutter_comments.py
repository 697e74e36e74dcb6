"""The cutter as a comment names it: `EM10`, `8MM DIA. CUTTER`, `T9 END MILL D12`."""

from __future__ import annotations

import re

from polarcheck.columns.words.bar_comments import bar_in
from polarcheck.columns.words.comment_lengths import ENDS, NUMBER, UNIT, length_of, plain_text
from polarcheck.foundation.states import MM_PER_INCH

_IS = r"\s*+[=:]?+\s*+"
#: The rest of a word such as DIAMETER; digits behind it are the number, as in DIA16.
_LETTERS = r"[^\W\d]*+"
_DIAMETER = rf"(?:\bDIA{_LETTERS}\.?+|(?<![\w/-])D|\u00d8|\u2300)"
_OF_OTHERS = r"(?:FREZA|FRESA|FRAISE|\b\w*+(?<=FRAESER)|\b\w*+(?<=FR\u00c4SER))"
#: Words that name a cutter and are no verbs, and MILL, which may be one: MILL 2 FLATS.
#: EM is a word of other languages: it counts at the end, before what an end mill may have, and glued to its size.
_EM = r"(?:E/M|E\.M\.?|EM)(?![A-Z])"
_EM_LAST = rf"{_EM}(?=\s*+(?:$|[,;:()#-]|\d++\s?-?F|R\s?[\d.]|CARB|HSS|SOLID|COATED|ROUGH|FINISH|FOR\b|X\s?[\d.]))"
_EM_FIRST = (
    rf"(?:(?:^|[,;:-]|\bT\s?\d{{1,8}}+|ROUGH(?:ING)?|FINISH(?:ING)?|CARB(?:IDE)?|FLAT|HSS|MM)\s*+{_EM}"
    r"|EM(?=-?\d|-?\.\d))"
)
_NAMED = (
    r"END\s*+-?MILL|(?:FACE|SHELL|BALL|SLOT)\s*+MILL|SLOT\s*+DRILL|CUTTER(?![A-Z])"
    rf"|{_OF_OTHERS}"
)
_MILL = r"MILL\b"
#: What may stand between the size of a cutter and its name.
_KIND = (
    r"(?:DIA(?:M(?:ETER)?)?\b\.?|\u00d8|FLAT|SQUARE|BALL|BULL|NOSED?|ROUGH(?:ING|ER)?|FINISH(?:ING|ER)?|SOLID|CARB(?:IDE)?\.?"
    r"|HSS|VHM|HM|COBALT|COATED|STUB|LONG|SHORT|\d\s*-?FL(?:UTED?|T)?|\dF)"
)
_KINDS = rf"(?:[\s-]*+{_KIND}(?![A-Z])){{0,5}}"
#: A number behind the name of a cutter that counts something.
_COUNTS = (
    r"(?!\s*+-?\s*+(?:FL|F\b|TEETH|TOOTH|Z\b|EDGE|X|DEG|PASS|PL[AC]|TIMES|OFF\b|P[CT]S|CUTS?\b|MIN|HRS?\b|DEEP|LONG|LOC\b|OF\b"
    r"|AF\b|A/F|SIDE|FLATS|HOLE|SLOT|POCKET|PART|TOOL))"
)
#: Number before name, name before number, each with what says that it is a diameter between.
_SIZE_FIRST = re.compile(rf"(?:{_DIAMETER}{_IS})?{NUMBER}{UNIT}{_KINDS}[\s-]*+(?<![A-Z])(?:{_NAMED}|{_EM_LAST})")
_SIZE_OF_MILL = re.compile(rf"{NUMBER}{UNIT}({_KINDS})[\s-]*+{_MILL}")
_NAME_FIRST = re.compile(
    rf"(?<![A-Z])(?:{_NAMED}|{_EM_FIRST})[\s:=-]*+(?:{_DIAMETER}{_IS})?{NUMBER}{UNIT}{ENDS}{_COUNTS}"
)
_NAME_AND_KIND = re.compile(rf"(?<![A-Z])(?:{_NAMED}|{_EM}){_KINDS}[\s,:=-]*+{_DIAMETER}{_IS}{NUMBER}{UNIT}")
#: Without the name of a cutter; diameters before radii: posts write both, as in `D=12. CR=0.`, where CR is the radius
#: of the corner.
_DIAMETER_ALONE = re.compile(rf"{_DIAMETER}{_IS}{NUMBER}{UNIT}")
_SIZE_DIAMETER = re.compile(rf"{NUMBER}{UNIT}[\s-]*+DIA")
_RADIUS = re.compile(rf"(?:(?<![A-Z])R|\bRAD{_LETTERS}){_IS}{NUMBER}{UNIT}")
#: What stands before a number that counts tools, operations, sides.
_LABEL = re.compile(
    r"(?:\b(?:TOOL|T|NO|NR|NUMBER|OP|OPER\w*|STEP|STATION|POS\w*|TURRET|SIDE|PART|PASS|N|O|M|G|H|REV|OFFSET|PROG\w*|HEX"
    r"|SQ|SQUARE|FLATS?)\.?|#)[\s:#=-]*+$|[A-Z]$|=\s?-?$"
)
_WORD = re.compile(r"[^\W\d]+")
#: Words beside the size of a cutter without a name. With any other the size may be that of anything.
_BESIDE = re.compile(
    r"T|TOOL|D|DIA|DIAM|DIAMETER|R|RAD|RADIUS|CR|ZMIN|ZMAX|L|LOC|LIVE|DRIVEN|AXIAL|RADIAL|HSS|VHM|HM|CARBIDE|SOLID|MM|INCH"
    r"|IN|FL|FLUTES?|Z|ROUGH|ROUGHING|FINISH|FINISHING|MILLING|MILL|FLAT|PROFILE|X|NO|OFFSET"
)
#: Tools that are no mills, and mills whose size says nothing of R.
_NO_CUTTER = re.compile(
    r"DRILL|BROCA|\bFUR[AO]|FORET|BOHR|BORR|REAM|\bTAP\b|BOR(?:ING|E|ED)\b|CHAMF|SPOT|SINK|ENGRAV|DEBURR|INSERT\b|\bTURN"
    r"|\b[CDVSTW][CNP][MG][GTNA]\b|\bID\b|\bOD\b|THREAD\s*+TURN"
)
_SLOT_DRILL = re.compile(r"SLOT\s*+DRILL")
_ANY_CUTTER = re.compile(rf"(?<![A-Z])(?:{_NAMED}|{_EM})")
#: Radii that are not those of the cutter.
_OTHER_RADIUS = re.compile(r"NOSE|CORNER|FILLET|\bTIP|\bEDGE|\bEND\s*+-?MILL|\bBULL|\bE/?M\b")
_LARGEST = 100.0
#: Without a unit no diameter of a program in inch is larger than this [inch], and in mm none is a sixteenth of an inch.
_LARGEST_IN_INCH = 3.0


def cutter_radius(comment: str, inch: bool) -> float | None:
    """
    The radius of the cutter that a comment names [mm]; None where its words do not say so plainly.

    inch: the unit of the program, unless the comment says its own.
    """
    text = plain_text(comment)
    if _NO_CUTTER.search(_SLOT_DRILL.sub("", text)):
        return None
    diameters = [
        *_diameters(text, _SIZE_FIRST, inch),
        *_diameters(text, _NAME_FIRST, inch),
        *_diameters(text, _NAME_AND_KIND, inch),
        *_diameters_of_mill(text, inch),
    ]
    if diameters:
        # Two sizes of one cutter: nobody knows which.
        return diameters[0] / 2 if max(diameters) - min(diameters) < 1e-6 else None
    if bar_in(comment, inch) is not None:
        return None
    return _size_alone(text, inch)


def _diameters(text: str, pattern: re.Pattern[str], inch: bool) -> list[float]:
    match = pattern.search(text)
    if match is None or (match.start() == match.start(1) and _LABEL.search(text, 0, match.start(1))):
        return []
    size = _cutter_size(match[1], match[2], inch)
    return [] if size is None else [size]


def _diameters_of_mill(text: str, inch: bool) -> list[float]:
    """Of MILL alone, which may be a verb: only with a unit or DIA before it, or where nothing else is said."""
    match = _SIZE_OF_MILL.search(text)
    if match is None or _LABEL.search(text, 0, match.start(1)):
        return []
    is_all = match.start() == 0 and match.end() == len(text)
    if not is_all and (not (match[2] or "DIA" in match[3]) or _OTHER_WORDS.search(text)):
        return []
    size = _cutter_size(match[1], match[2], inch)
    return [] if size is None else [size]


#: What is milled, where MILL is a verb.
_OTHER_WORDS = re.compile(r"\bHEX|\bSQ|\bFLATS?\b|\bA/?F\b|\bSLOT|\bKEY|\bPOCKET|\bBOSS|\bDEEP|\bDEPTH|\bWIDE")


def _cutter_size(number: str, unit: str | None, inch: bool) -> float | None:
    """A diameter [mm] that a cutter can have."""
    size = length_of(number, unit, inch)
    if size is None or not 0 < size < 2 * _LARGEST:
        return None
    if not unit and "/" not in number:
        if inch and size > _LARGEST_IN_INCH * MM_PER_INCH:
            return None
        if not inch and size < 1 and (16 * size).is_integer():
            return None
    return size


def _size_alone(text: str, inch: bool) -> float | None:
    """The radius in a comment that names no cutter: nothing else may stand there."""
    for divisor, pattern in ((2.0, _DIAMETER_ALONE), (2.0, _SIZE_DIAMETER), (1.0, _RADIUS)):
        match = pattern.search(text)
        if match is None:
            continue
        size = length_of(match[1], match[2], inch)
        if size is None or not 0 < size / divisor < _LARGEST:
            continue
        named = _ANY_CUTTER.search(text)
        if named is None and not all(map(_BESIDE.fullmatch, _WORD.findall(text))):
            return None
        if pattern is _RADIUS and _OTHER_RADIUS.search(text):
            return None
        return size / divisor
    return None
