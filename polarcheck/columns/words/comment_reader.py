"""What one comment states, by the patterns of comment_patterns: None where its words do not say so plainly."""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec

from polarcheck.columns.words.comment_patterns import (
    ACROSS_FLATS,
    ALLOWANCE,
    ANY_CUTTER,
    BAR,
    BESIDE_HEXAGON,
    BESIDE_SIZE,
    COUNTED,
    CUTTER,
    FROM_BAR,
    HEXAGON_BAR,
    KIND_OF_TOOL,
    LONGEST,
    MILL,
    MILLED,
    NAME_OF_BAR,
    NOT_BEFORE_BAR,
    OTHER_RADIUS,
    OTHER_TOOL,
    PART_DEPTH,
    PART_SIZE,
    ROUGHING,
    SIZE_ALONE,
    SIZE_BEFORE_BAR,
    TITLE_DIAMETER,
    Form,
    Subject,
)
from polarcheck.foundation.states import MM_PER_INCH

_MILLIMETERS = "MM"
#: Fractions of an inch have these denominators.
_DENOMINATORS = (2, 4, 8, 16, 32, 64)
#: Of no more roughing leaves, where the comment does not say how much [mm].
_LEFT = 0.75
#: No more digits than this are a length; a longer number would cost more than its text to convert.
_MOST_DIGITS = 9


#: What is made may differ from a comment by so much: sizes of drawings are rounded, and have tolerances [mm].
_TOLERANCE, _TOLERANCE_SHARE = 0.25, 0.01


def tolerance_of(size: float) -> float:
    """How much what is made may differ from a size of a comment [mm]."""
    return max(_TOLERANCE, _TOLERANCE_SHARE * size)


class StatedBar(msgspec.Struct, frozen=True):
    """A bar: its diameter, or the distance across the flats of a hexagon [mm]; NaN for the other of the two."""

    diameter: float
    across_flats: float


class StatedShape(msgspec.Struct, frozen=True):
    """
    A shape and its size in a comment.

    shape: hexagon, square, octagon, pentagon, flats, boss (a round one), keyway, or empty for what is so wide across
    its flats.
    size: across flats, the diameter, or the width [mm].
    is_across_flats: the comment says AF; without it corners may be meant.
    """

    shape: str
    size: float
    is_across_flats: bool = False


def plain_text(comment: str) -> str:
    """
    A comment in upper case without its parentheses, as the patterns read it: names of posts have `_` for a blank.

    Empty for a comment so long that it is no plain note.
    """
    comment = re.sub(r"0{9,}+", "0", comment)
    if len(comment) > LONGEST:
        return ""
    # Quotes round a word go; behind a number they are inches.
    plain = re.sub(r"\"(?=[A-Z])|(?<=[A-Z])\"", "", comment.upper().replace("_", " "))
    return plain.strip(";()% \"'\t\r\n")


# in_inch of what follows: the unit of the program, which counts where the comment has none of its own.


def bar_in(comment: str, in_inch: bool) -> StatedBar | None:
    """The bar that a comment states."""
    text = plain_text(comment)
    if not _may_state(BAR, text):
        return None
    text = _without_allowances(text, in_inch)
    has_hexagon = bool(re.search(HEXAGON_BAR, text))
    for form in BAR.forms:
        # A hexagon that is cut from a bar may stand beside it: then only BAR DIA 28 says which of the two is which.
        if has_hexagon != (form.gives == "hexagon") and not (has_hexagon and form is BESIDE_HEXAGON):
            continue
        size = _bar_size(form, text, in_inch)
        if size is not None:
            unknown = float("nan")
            return StatedBar(unknown, size) if form.gives == "hexagon" else StatedBar(size, unknown)
    return None


def shapes_in(comment: str, in_inch: bool) -> list[StatedShape]:
    """The shapes and sizes that a comment states of the part; none where it speaks of roughing."""
    text = plain_text(comment)
    if not _may_state(PART_SIZE, text) or allowance_in(comment, in_inch):
        return []
    bar, text = bar_in(comment, in_inch), _without_bar(text)
    sizes: dict[StatedShape, None] = {}
    is_across_flats = bool(re.search(ACROSS_FLATS, text))
    for form in PART_SIZE.forms:
        if not _has_any(form.words, text):
            continue
        if not form.gives and any(size.shape for size in sizes):
            break
        for match in re.finditer(form.pattern, text):
            size = _size(PART_SIZE, match, in_inch)
            if size is None:
                return []
            if bar is None or size != bar.across_flats:
                sizes[StatedShape(form.gives, size, is_across_flats)] = None
    return [*sizes]


def title_diameter_in(comment: str, in_inch: bool) -> float | None:
    """The largest diameter that the title of a program states of the part [mm]."""
    text = plain_text(comment)
    if not _has_any(TITLE_DIAMETER.words, text):
        return None
    is_other = re.search(rf"{ANY_CUTTER}|{PART_SIZE.never}", text) or allowance_in(comment, in_inch)
    if is_other or bar_in(comment, in_inch) is not None:
        return None
    sizes = [_size(PART_SIZE, match, in_inch) for match in re.finditer(TITLE_DIAMETER.pattern, _without_bar(text))]
    return max((size for size in sizes if size is not None), default=None)


def depth_in(comment: str, in_inch: bool) -> float | None:
    """The depth [mm] that a comment states."""
    text = plain_text(comment)
    if not _may_state(PART_DEPTH, text) or re.search(ROUGHING, text):
        return None
    depths = [
        _size(PART_DEPTH, match, in_inch) for form in PART_DEPTH.forms for match in re.finditer(form.pattern, text)
    ]
    return depths[0] if len(depths) == 1 else None


def allowance_in(comment: str, in_inch: bool) -> float:
    """The metal that a comment says is left for another tool [mm]; _LEFT where it does not say how much, 0 for none."""
    text = plain_text(comment)
    if not _has_any(ALLOWANCE.words, text):
        return 0.0
    stated = [size for _, size in _allowances(text, in_inch)]
    return max(stated, default=_LEFT if re.search(ROUGHING, text) else 0.0)


def cutter_radius(comment: str, in_inch: bool) -> float | None:
    """The radius of the cutter that a comment names [mm]."""
    text = _without_allowances(plain_text(comment), in_inch)
    if re.search(CUTTER.never, re.sub(r"SLOT\s*+DRILL", "", text)):
        return None
    diameters = [size for form in CUTTER.forms if (size := _cutter_size(form, text, in_inch)) is not None]
    if diameters:
        # Two sizes of one cutter: nobody knows which.
        return diameters[0] / 2 if max(diameters) - min(diameters) < 1e-6 else None
    return None if bar_in(comment, in_inch) is not None else _size_alone(text, in_inch)


def speaks_of_tool(comment: str) -> bool:
    """True for a comment that says of a tool by its number which it is, and of no other tool."""
    text = comment.upper()
    return (
        len(text) <= LONGEST
        and len(re.findall(r"\bT\s?\d|\bTOOL\b", text)) == 1
        and not re.search(OTHER_TOOL, text)
        and (bool(re.search(KIND_OF_TOOL, text)) or not re.search(r"[^\W\d]{2}", text))
    )


# ---- sizes ----


def _has_any(words: tuple[str, ...], text: str) -> bool:
    return any(word in text for word in words)


def _may_state(subject: Subject, text: str) -> bool:
    return _has_any(subject.words, text) and not re.search(subject.never, text)


def _allowances(text: str, in_inch: bool) -> Iterator[tuple[str, float]]:
    """What a comment writes of metal that is left, and how much that is [mm]."""
    for form in ALLOWANCE.forms if _has_any(ALLOWANCE.words, text) else ():
        for match in re.finditer(form.pattern, text):
            size = _size(ALLOWANCE, match, in_inch)
            if size is not None:
                yield match[0], size


def _without_bar(text: str) -> str:
    """A text without what it says of the bar: SHAFT 24 AF FROM HEX 32, HEX 32 BAR, MATERIAL HEX 32 AF."""
    clauses = []
    for clause in re.split(r"[,;](?!\d)", text):
        head = re.split(FROM_BAR, clause)[0]
        name = re.search(NAME_OF_BAR, head)
        if name and not re.search(r"\d", head[name.end() :]):
            continue
        clauses.append(head[: name.start()] if name else head)
    return ", ".join(clauses)


def _without_allowances(text: str, in_inch: bool) -> str:
    for match, _ in _allowances(text, in_inch):
        text = text.replace(match, " ROUGH ")
    return text


def _bar_size(form: Form, text: str, in_inch: bool) -> float | None:
    match = re.search(form.pattern, text)
    if not match or re.search(NOT_BEFORE_BAR, text[: match.start(1)]):
        return None
    number, unit = match[1], match[2]
    if in_inch and text[match.start(1) - 1 : match.start(1)] == ".":  # DIA.5 may be a half and a five
        return None
    if form is SIZE_BEFORE_BAR and not (unit or "/" in number or ("." in number and in_inch)):
        return None
    return _size(BAR, match, in_inch)


def _cutter_size(form: Form, text: str, in_inch: bool) -> float | None:
    """The diameter that a comment with the name of a cutter states in a form [mm]."""
    match = re.search(form.pattern, text)
    if match is None or (match.start() == match.start(1) and re.search(COUNTED, text[: match.start(1)])):
        return None
    if form is MILL and match.span() != (0, len(text)):
        # MILL may be a verb.
        is_diameter = match[2] or "DIA" in match[3]
        if not is_diameter or re.search(MILLED, text):
            return None
    size = _size(CUTTER, match, in_inch)
    # In mm none is a sixteenth of an inch.
    is_bare = not match[2] and "/" not in match[1]
    return None if size is not None and is_bare and not in_inch and size < 1 and (16 * size).is_integer() else size


def _size_alone(text: str, in_inch: bool) -> float | None:
    """The radius in a comment that names no cutter: nothing else may stand there."""
    for form in SIZE_ALONE:
        match = re.search(form.pattern, text)
        size = length_of(match[1], match[2], in_inch) if match else None
        radius = None if size is None else size / (2.0 if form.gives == "diameter" else 1.0)
        if radius is None or not 0 < radius < CUTTER.largest / 2:
            continue
        names_cutter = re.search(ANY_CUTTER, text) is not None
        if not names_cutter and not all(re.fullmatch(BESIDE_SIZE, word) for word in re.findall(r"[^\W\d]+", text)):
            return None
        return None if form.gives == "radius" and re.search(OTHER_RADIUS, text) else radius
    return None


def _size(subject: Subject, match: re.Match[str], in_inch: bool) -> float | None:
    """The size in a form of a subject [mm]; None where the subject cannot have it."""
    number, unit = match[1], match[2]
    size = length_of(number, unit, in_inch)
    if size is None or not subject.least < size < subject.largest:
        return None
    is_bare = not unit and "/" not in number
    return None if is_bare and in_inch and size > subject.largest_in_inch else size


def length_of(number: str, unit: str | None, in_inch: bool) -> float | None:
    """A number of a comment and its unit as a length [mm]; None where it is none. A fraction is always of an inch."""
    value = _value_of(number)
    if value is None:
        return None
    is_inch = (unit != _MILLIMETERS) if unit else in_inch or "/" in number
    if "/" in number and not is_inch:
        return None
    return value * (MM_PER_INCH if is_inch else 1.0)


def _value_of(number: str) -> float | None:
    if len(number) > 2 * _MOST_DIGITS:
        return None
    if "/" not in number:
        return float(number.replace(",", ".").rstrip("."))  # the point of 28.5. ends a sentence
    above, below = re.split(r"\s*/\s*", number)
    whole, _, above = above.replace("-", " ").rpartition(" ")
    if int(below) not in _DENOMINATORS or (whole.strip() and int(above) >= int(below)):
        return None
    return (int(whole) if whole.strip() else 0) + int(above) / int(below)
