"""
The languages of other machines, and the signs by which a file in one of them is recognized.

No lathe program in ISO code contains such a sign outside of its comments. One sign may be a slip or a title without
parentheses; a language is recognized by several signs.
"""

from __future__ import annotations

import functools
import re

import msgspec

from polarcheck.foundation.patterns import lazy_pattern

#: How much of a file is examined: other languages show near the head; preview pictures of slicers are shorter.
_LOOKED_AT = 100_000
_COMMENT = lazy_pattern(rb"\([^)\n]*+\)?")
_REMARK = lazy_pattern(rb";[^\n]*+")
_LINE = rb"^[ \t]*+(?:/?[ \t]*+N?\d++[ \t]++)?"


class Sign(msgspec.Struct, frozen=True):
    """
    A sign of a language.

    pattern: regular expression.
    weight: 2 for a sign that is enough alone.
    """

    pattern: bytes
    weight: int = 1


class Language(msgspec.Struct, frozen=True):
    """
    A language.

    title: as a message names it.
    signs: its signs.
    needed: sum of the weights of signs by which it is recognized.
    never: pattern of what no file in it contains outside of comments.
    reads_as_macros: a file in it may look like one with macro statements.
    """

    title: str
    signs: tuple[Sign, ...]
    needed: int = 2
    never: bytes = b""
    reads_as_macros: bool = False


class Recognised(msgspec.Struct, frozen=True):
    """
    The language of a file.

    title: of the language.
    sign: the line with its first sign.
    line: its number, from 1.
    """

    title: str
    sign: str
    line: int


_O_WORD = rb"^[ \t]*+(?:N\d++[ \t]*+)?O"
_OPENS = rb"(?:sub|if|while|do|repeat)"
_CLOSES = rb"(?:endsub|endif|endwhile|endrepeat|elseif|else|while|return|break|continue)"
_ENDS = rb"[ \t\r]*+(?:\[|;|$)"

LANGUAGES = (
    # linuxcnc.org/docs/html/gcode/o-code.html; named parameters in gcode/overview.html
    Language(
        "LinuxCNC",
        (
            Sign(_O_WORD + rb"[ \t]*+<[^>\n]++>[ \t]*+(?:call|" + _OPENS + b"|" + _CLOSES + rb")\b", 2),
            Sign(_O_WORD + rb"\d++[ \t]*+(?:call|if|elseif|while|repeat)[ \t]*+\[", 2),
            Sign(_O_WORD + rb"\d++[ \t]*+(?:call|" + _OPENS + rb")" + _ENDS),
            Sign(_O_WORD + rb"\d++[ \t]*+" + _CLOSES + _ENDS),
            Sign(rb"#<_?[a-z][^<>\n]{0,60}>", 2),
        ),
        reads_as_macros=True,
    ),
    # marlinfw.org/meta/gcode; E is the filament. A lathe may have an E word, and M104, but then codes of a lathe, too.
    Language(
        "a 3D printer",
        (
            Sign(_LINE + rb"G0*[0123][ \t]++[^;\n]*?E[ \t]?-?(?:\d|\.\d)"),
            Sign(_LINE + rb"G92[ \t]++E-?\d[\d.]*+[ \t\r]*+(?:;|$)"),
            Sign(_LINE + rb"M10[49][ \t]++(?:T\d[ \t]++)?S[1-3]?\d?\d(?!\d)"),
            Sign(_LINE + rb"M1[49]0[ \t]++S1?\d?\d(?!\d)"),
            Sign(rb"^;[ \t]*+(?:LAYER\b|TYPE:|FLAVOR:|generated (?:by|with) \w*(?:Slic|Cura|Simplify)|LAYER_CHANGE)"),
        ),
        never=_LINE + rb"[O:]\d{1,8}[ \t]*+$|\bG0*(?:9[6789](?!\d)|12\.1)|\bT\d{4}(?!\d)",
    ),
    # TNC 640, klartext programming; also with sequence numbers 0, 1, 2
    Language(
        "a Heidenhain control (plain language)",
        (
            Sign(_LINE + rb"BEGIN[ \t]++PGM\b"),
            Sign(_LINE + rb"END[ \t]++PGM\b"),
            Sign(_LINE + rb"TOOL[ \t]++(?:CALL|DEF)\b"),
            Sign(_LINE + rb"(?:L|CC)[ \t]++(?:I?[XYZABC][-+]?\d[\d.]*+[ \t\r]*+)+(?:R[0LR]\b|F[ \t]?MAX|$)"),
            Sign(_LINE + rb"CYCL[ \t]++(?:DEF|CALL)\b"),
            Sign(_LINE + rb"BLK[ \t]++FORM\b"),
            Sign(_LINE + rb"LBL[ \t]++\d"),
            Sign(_LINE + rb"FN[ \t]?\d++[ \t]?:"),
            Sign(_LINE + rb"[LC][PTR]?[ \t][^\n]*\b(?:F[ \t]?MAX|DR[-+])"),
        ),
    ),
    # MillPlus IT: the first line names the memory, %PM of programs, %MM of macros; the second the program's number
    Language("MillPlus", (Sign(rb"\A\s*+(?:N\d++[ \t]++)?%[PM]M\d*+[ \t]*+\n\s*+N9\d{3,6}\b", 2),)),
    # ShopBot command reference
    Language(
        "ShopBot",
        (
            Sign(rb"^[ \t]*+J(?:[2-6]|[XYZABS])[ \t]*+,[ \t]*+-?[\d.]"),
            Sign(rb"^[ \t]*+M(?:[2-6]|[XYZAB])[ \t]*+,[ \t]*+-?[\d.]"),
            Sign(rb"^[ \t]*+(?:MS|JS|TR|VS|VR)[ \t]*+,[ \t]*+[\d.]"),
            Sign(rb"^[ \t]*+(?:C[#6-9][ \t]*+$|SO[ \t]*+,|&\w++[ \t]*+=)"),
        ),
    ),
    # HP-GL; CAMM-GL of Roland
    Language(
        "a plotter (HPGL)",
        (
            Sign(rb"(?:^|;)[ \t]*+P[UDA][ \t]*+-?\d++[ ,]++-?\d++", 1),
            Sign(rb"(?:^|;)[ \t]*+(?:IN|PU|PD|DF)[ \t]*+;", 1),
            Sign(rb"(?:^|;)[ \t]*+(?:SP|VS)[ \t]*+\d++[ \t]*+;", 1),
            Sign(rb"^[ \t]*+[!^](?:MC|PR|PA|DF|IN)\b", 1),
        ),
    ),
    # RS-274X: format, apertures, and operations D01 to D03
    Language(
        "a photoplotter (Gerber)",
        (
            Sign(rb"^%FS[LTD]?[AI]X\d\dY\d\d\*%"),
            Sign(rb"^%ADD\d++[A-Z]"),
            Sign(rb"^%MO(?:IN|MM)\*%"),
            Sign(rb"^(?:[XY]-?\d++)++D0?[123]\*"),
        ),
    ),
    # Excellon drill format
    Language(
        "a drilling machine for circuit boards (Excellon)",
        (
            Sign(rb"^M48[ \t\r]*+$"),
            Sign(rb"^(?:METRIC|INCH)(?:,[LT]Z)?+(?:,[\d.]++)?+[ \t\r]*+$"),
            Sign(rb"^T\d\d?C\d*+\.\d++[ \t\r]*+$"),
        ),
        needed=3,
    ),
    # ISO 4343, CLDATA of APT
    Language(
        "a postprocessor (cutter location data)",
        (
            Sign(rb"^[ \t]*+GOTO[ \t]*+/[ \t]*+-?[\d.]"),
            Sign(rb"^[ \t]*+FEDRAT[ \t]*+/"),
            Sign(rb"^[ \t]*+(?:SPINDL|LOADTL|LOAD|COOLNT|RAPID|TLDATA|CUTTER|MULTAX|UNITS)[ \t]*+/"),
            Sign(rb"^[ \t]*+(?:PARTNO|PPRINT|MACHIN)\b"),
        ),
    ),
)


def recognised(text: bytes, only_macros_are_odd: bool = False) -> Recognised | None:
    """
    Recognize the language of a text that is not a program in ISO code; None where there are not enough signs.

    only_macros_are_odd: test only languages that read as macro statements.
    """
    head = text[:_LOOKED_AT]
    head = head.replace(b"\r\n", b" \n") if b"\n" in text else head.replace(b"\r", b"\n")
    text = _COMMENT.sub(lambda comment: b" " * len(comment[0]), head)
    for language in LANGUAGES:
        if only_macros_are_odd and not language.reads_as_macros:
            continue
        matches = _signs(language, text)
        if not matches or (language.never and _compiled(language.never).search(_REMARK.sub(b"", text))):
            continue
        first = min(matches, key=lambda match: match.start())
        begin = text.rfind(b"\n", 0, first.start()) + 1
        line = text[begin:].partition(b"\n")[0]
        return Recognised(language.title, line.decode("latin-1").strip(), text.count(b"\n", 0, begin) + 1)
    return None


def _signs(language: Language, text: bytes) -> list[re.Match[bytes]]:
    """The first match of each sign; empty as soon as the remaining signs are not enough."""
    matches = []
    possible = sum(sign.weight for sign in language.signs)
    for sign in language.signs:
        match = _compiled(sign.pattern).search(text)
        if match:
            matches.append(match)
            continue
        possible -= sign.weight
        if possible < language.needed:
            return []
    return matches


@functools.cache
def _compiled(pattern: bytes) -> re.Pattern[bytes]:
    return re.compile(pattern, re.IGNORECASE | re.MULTILINE)
