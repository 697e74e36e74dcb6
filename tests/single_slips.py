"""
Slips that a setter makes in a sound program, one at a time, and whether each does something to the metal or the lathe.

A slip is counted where the part comes out otherwise, or the control stops, or metal is met by rapid, and where a check
without a drawing could know it. What it could know it by, is its witness.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable
from typing import NamedTuple

from metal_simulation import RAPID, cuts_the_part, differs, simulate
from setter_programs import BOSSES, Program, drawn

Draw = random.Random
Plant = Callable[[Program, Draw], Program | None]
_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+))(?![\d.\]\[])"
SHAPE = frozenset({"regular", "tangent", "repeated"})
ALWAYS = frozenset({"always"})
EVENT = frozenset[str]()


class Slip(NamedTuple):
    """
    A kind of slip.

    plant: makes it in a program, or gives None where it cannot be made. needs: the evidence of a program of which one
    must be there for a check to know, or "always"; what the simulation finds wrong without a drawing counts anyway.
    witness: what a check knows it by. is_real: it matters though the metal is the same, as a wrong comment does.
    """

    name: str
    plant: Plant
    needs: frozenset[str]
    witness: str
    is_real: bool = False


# ---- words and blocks ----


def at(program: Program, *roles: str) -> list[int]:
    """The blocks with these roles."""
    return [index for index, line in enumerate(program.lines) if line.role in roles]


def word_changed(letters: str, change: Callable[[str, Draw], str | None], *roles: str, pattern: str = "") -> Plant:
    """Another value of one word in one of the blocks with these roles."""

    def plant(program: Program, draw: Draw) -> Program | None:
        own = letters.replace(
            "C", program.dialect.virtual + program.dialect.virtual_step + ("C" if "position" in " ".join(roles) else "")
        )
        own = own.replace("X", "XU") if "X" in letters else own
        places = []
        for index in at(program, *roles):
            for match in re.finditer(rf"([{own}]){_NUMBER}", program.lines[index].text):
                if re.search(pattern, program.lines[index].text):
                    places.append((index, match))
        draw.shuffle(places)
        for index, match in places[:6]:
            value = change(match[2], draw)
            if value is not None and float(value) != float(match[2]):
                text = program.lines[index].text
                return program.changed(index, text[: match.start(2)] + value + text[match.end(2) :])
        return None

    return plant


def block_changed(old: str, new: str, *roles: str, every: bool = False) -> Plant:
    """`new` for `old` (regular expression) in one of the blocks with these roles, or in every one."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = [index for index in at(program, *roles) if re.search(old, program.lines[index].text)]
        if not places:
            return None
        for index in places if every else [draw.choice(places)]:
            program = program.changed(index, re.sub(old, new, program.lines[index].text, count=1).strip())
        return program

    return plant


def block_missing(*roles: str) -> Plant:
    def plant(program: Program, draw: Draw) -> Program | None:
        places = at(program, *roles)
        return program.changed(draw.choice(places)) if places else None

    return plant


def _swapped(value: str, draw: Draw) -> str | None:
    places = [
        i for i in range(len(value) - 1) if value[i].isdigit() and value[i + 1].isdigit() and value[i] != value[i + 1]
    ]
    if not places:
        return None
    i = draw.choice(places)
    return value[:i] + value[i + 1] + value[i] + value[i + 2 :]


def _digit_lost(value: str, draw: Draw) -> str | None:
    places = [i for i, sign in enumerate(value) if sign.isdigit()]
    if len(places) < 2:
        return None
    i = draw.choice(places)
    return value[:i] + value[i + 1 :]


def _digit_wrong(value: str, draw: Draw) -> str | None:
    places = [i for i, sign in enumerate(value) if sign.isdigit()]
    i = draw.choice(places[:3])
    return value[:i] + draw.choice([sign for sign in "123456789" if sign != value[i]]) + value[i + 1 :]


def _point_moved(value: str, draw: Draw) -> str | None:
    if not float(value):
        return None
    return _plain(float(value) * draw.choice((10, 0.1)), value)


def _sign(value: str, draw: Draw) -> str | None:
    if not float(value):
        return None
    return value[1:] if value.startswith("-") else "-" + value


def _factor(factor: float) -> Callable[[str, Draw], str | None]:
    return lambda value, draw: _plain(float(value) * factor, value) if float(value) else None


def _plain(value: float, like: str) -> str:
    digits = max(len(like.partition(".")[2]), 3)
    text = f"{value:.{digits}f}".rstrip("0")
    return text if float(text) else "0"


def words_of(text: str, letters: str) -> list[re.Match[str]]:
    return list(re.finditer(rf"([{letters}]){_NUMBER}", text))


def neighbour(program: Program, draw: Draw) -> Program | None:
    """The value of the same address in the block before or behind."""
    places = at(program, "contour")
    draw.shuffle(places)
    for index in places[:8]:
        for other in draw.sample((index - 1, index + 1), 2):
            if not 0 <= other < len(program.lines) or program.lines[other].role not in ("contour", "ramp"):
                continue
            for match in words_of(program.lines[index].text, "X" + program.dialect.virtual):
                for value in words_of(program.lines[other].text, match[1]):
                    if float(value[2]) != float(match[2]):
                        text = program.lines[index].text
                        return program.changed(index, text[: match.start(2)] + value[2] + text[match.end(2) :])
    return None


def all_words(letter: str) -> Plant:
    """All X (or C) words of a section as the other of diameter and radius."""

    def plant(program: Program, draw: Draw) -> Program | None:
        sections = sorted({program.lines[index].section for index in at(program, "contour")})
        section = draw.choice(sections)
        own = "XU" if letter == "X" else program.dialect.virtual + program.dialect.virtual_step
        factor = (0.5 if program.dialect.diameter_inside else 2.0) if letter == "X" else 2.0
        roles = ("contour", "ramp")
        for index in at(program, *roles):
            line = program.lines[index]
            if line.section == section:
                text = re.sub(
                    rf"([{own}]){_NUMBER}",
                    lambda m: m[1] + (_plain(float(m[2]) * factor, m[2]) if float(m[2]) else m[2]),
                    line.text,
                )
                program = program.changed(index, text)
        return program

    return plant


def block_missing_in_contour(program: Program, draw: Draw) -> Program | None:
    places = [index for index in at(program, "contour") if "#" not in program.lines[index].text]
    return program.changed(draw.choice(places)) if len(places) > 3 else None


def block_doubled(program: Program, draw: Draw) -> Program | None:
    places = at(program, "contour")
    if not places:
        return None
    index = draw.choice(places)
    return program.changed(index, program.lines[index].text, program.lines[index].text)


def blocks_swapped(program: Program, draw: Draw) -> Program | None:
    places = [index for index in at(program, "contour") if program.lines[index + 1].role == "contour"]
    if not places:
        return None
    index = draw.choice(places)
    one, two = program.lines[index].text, program.lines[index + 1].text
    if one == two or re.search("#|G[123]", one + two):
        return None
    return program.changed(index, two).changed(index + 1, one)


def word_missing(program: Program, draw: Draw) -> Program | None:
    """One coordinate of a block with two."""
    own = "X" + program.dialect.virtual
    places = [index for index in at(program, "contour") if len(words_of(program.lines[index].text, own)) == 2]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    match = draw.choice(words_of(text, own))
    return program.changed(index, (text[: match.start()] + text[match.end() :]).replace("  ", " ").strip())


def axes_swapped(program: Program, draw: Draw) -> Program | None:
    """The values of X and C in each other's place."""
    own = "X" + program.dialect.virtual
    places = [index for index in at(program, "contour") if len(words_of(program.lines[index].text, own)) == 2]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    one, two = words_of(text, own)
    if one[2] == two[2]:
        return None
    return program.changed(
        index, text[: one.start(2)] + two[2] + text[one.end(2) : two.start(2)] + one[2] + text[two.end(2) :]
    )


def letter_for_other(program: Program, draw: Draw) -> Program | None:
    """X for the virtual axis, or the other way, in a block with one of them."""
    own = "X" + program.dialect.virtual
    places = [index for index in at(program, "contour") if len(words_of(program.lines[index].text, own)) == 1]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    match = words_of(text, own)[0]
    letter = program.dialect.virtual if match[1] == "X" else "X"
    return program.changed(index, text[: match.start()] + letter + text[match.end(1) :])


def arc_code(change: Callable[[str, Program], str]) -> Plant:
    def plant(program: Program, draw: Draw) -> Program | None:
        codes = (program.dialect.cw, program.dialect.ccw)
        pattern = rf"({codes[0]}|{codes[1]})(?!\d)"
        places = [index for index in at(program, "contour") if re.search(pattern, program.lines[index].text)]
        if not places:
            return None
        index = draw.choice(places)
        text = (
            re.sub(pattern, lambda m: change(m[1], program), program.lines[index].text, count=1)
            .replace("  ", " ")
            .strip()
        )
        return program.changed(index, text) if text else None

    return plant


def _other_arc(code: str, program: Program) -> str:
    return program.dialect.ccw if code == program.dialect.cw else program.dialect.cw


def arc_word(letters: str, change: Callable[[str, Draw], str | None]) -> Plant:
    def plant(program: Program, draw: Draw) -> Program | None:
        word = program.dialect.radius_word
        pattern = rf"({word}){_NUMBER}" if letters == "R" else rf"([IJ]){_NUMBER}"
        places = [
            (index, m) for index in at(program, "contour") for m in re.finditer(pattern, program.lines[index].text)
        ]
        draw.shuffle(places)
        for index, match in places[:5]:
            value = change(match[2], draw)
            if value is not None and float(value) != float(match[2]):
                text = program.lines[index].text
                return program.changed(index, text[: match.start(2)] + value + text[match.end(2) :])
        return None

    return plant


def all_arcs(program: Program, draw: Draw) -> Program | None:
    """R of all arcs of a section doubled, as a diameter."""
    word = program.dialect.radius_word
    places = [index for index in at(program, "contour") if re.search(rf"{word}{_NUMBER}", program.lines[index].text)]
    if not places:
        return None
    section = program.lines[draw.choice(places)].section
    for index in places:
        if program.lines[index].section == section:
            text = re.sub(
                rf"({word}){_NUMBER}", lambda m: m[1] + _plain(2 * float(m[2]), m[2]), program.lines[index].text
            )
            program = program.changed(index, text)
    return program


# ---- compensation ----


def side_swapped(program: Program, draw: Draw) -> Program | None:
    places = [index for index in at(program, "ramp") if re.search("G4[12]", program.lines[index].text)]
    if not places:
        return None
    index = draw.choice(places)
    return program.changed(
        index, re.sub("G4[12]", lambda m: "G42" if m[0] == "G41" else "G41", program.lines[index].text)
    )


def side_late(program: Program, draw: Draw) -> Program | None:
    """G41 or G42 in the block behind."""
    places = [
        index
        for index in at(program, "ramp")
        if program.lines[index + 1].role == "contour" and re.search("G4[12]", program.lines[index].text)
    ]
    places = [index for index in places if not re.search(r"G10?[23](?!\d)", program.lines[index + 1].text)]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    side = re.search("G4[12]", text)
    assert side
    behind = program.lines[index + 1].text
    number = re.match(r"N\d+ ", behind)
    first = len(number[0]) if number else 0
    space = "" if " " not in text else " "
    behind = behind[:first] + side[0] + space + behind[first:]
    return program.changed(index + 1, behind).changed(index, text.replace(side[0], "").replace("  ", " ").strip())


def cancelled_at_once(program: Program, draw: Draw) -> Program | None:
    places = [
        index
        for index in at(program, "ramp")
        if program.lines[index + 1].role == "contour" and "#" not in program.lines[index + 1].text
    ]
    places = [index for index in places if not re.search(r"G10?[23](?!\d)", program.lines[index + 1].text)]
    if not places:
        return None
    index = draw.choice(places)
    behind = program.lines[index + 1].text
    number = re.match(r"N\d+ ", behind)
    first = len(number[0]) if number else 0
    return program.changed(index + 1, behind[:first] + "G40 " + behind[first:])


# ---- depth, index, mode ----


def depth_word(change: Callable[[str, Draw], str | None]) -> Plant:
    return word_changed("Z", change, "plunge", "plunge outside")


def _deeper(value: str, draw: Draw) -> str | None:
    if not value.startswith("-"):
        return None
    return draw.choice((_plain(float(value) * 10, value), "-1" + value[1:], "-2" + value[1:]))


def contour_at_two_depths(program: Program, draw: Draw) -> Program | None:
    places = [
        index
        for index in at(program, "contour")
        if program.lines[index + 1].role == "contour" and program.lines[index - 1].role == "contour"
    ]
    if not places or "#" in "".join(line.text for line in program.lines):
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    if re.search(r"Z|G91|[UHV]-?[\d.]", text) or (
        program.dialect.system == "B" and any("G91" in line.text for line in program.lines)
    ):
        return None
    deep = draw.choice(("Z-1.", "Z-12."))
    arc = re.search(r"(G10?[23])(?!\d)", text)
    behind = program.lines[index + 1].text
    if arc or re.match(r"(N\d+ )?[XCY]", behind):
        return None
    return program.changed(index, text, deep)


def index_word(change: str) -> Plant:
    """The C of a later section left out, or that of the one before."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = at(program, "index")
        if not places:
            return None
        index = draw.choice(places)
        if change == "missing":
            return program.changed(index)
        text = program.lines[index].text
        before = [place for place in places if place < index]
        value = "C0" if not before else re.search(r"C[\d.]+", program.lines[before[-1]].text)[0]  # type: ignore[index]
        return program.changed(index, re.sub(r"C[\d.]+", value, text))

    return plant


def retract_missing(program: Program, draw: Draw) -> Program | None:
    places = at(program, "retract", "lift")
    if not places:
        return None
    index = draw.choice(places)
    clear = index + 1 if program.lines[index + 1].role == "clear" else index + 2
    if program.lines[clear].role == "clear" and draw.random() < 0.7:
        program = program.changed(clear)
    return program.changed(index)


def x_too_small(share: float) -> Plant:
    """X of the approach inside the bar."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = [index for index in at(program, "position") if re.search(rf"X{_NUMBER}", program.lines[index].text)]
        if not places:
            return None
        index = draw.choice(places)
        match = re.search(rf"X{_NUMBER}", program.lines[index].text)
        assert match
        value = _plain(float(match[1]) * share * draw.uniform(0.8, 1.1), "0.0")
        text = program.lines[index].text
        return program.changed(index, text[: match.start(1)] + value + text[match.end(1) :])

    return plant


def z_at_depth_before(program: Program, draw: Draw) -> Program | None:
    """The approach goes down in a pocket's place by rapid, to its depth."""
    places = [index for index in at(program, "position") if re.search(rf"Z{_NUMBER}", program.lines[index].text)]
    deep = [
        match[1]
        for index in at(program, "plunge", "plunge outside")
        for match in re.finditer(rf"Z{_NUMBER}", program.lines[index].text)
    ]
    if not places or not deep:
        return None
    index = draw.choice(places)
    return program.changed(index, re.sub(rf"Z{_NUMBER}", "Z" + deep[0], program.lines[index].text))


def mode_missing(role: str) -> Plant:
    def plant(program: Program, draw: Draw) -> Program | None:
        places = at(program, role)
        return program.changed(draw.choice(places)) if places else None

    return plant


def degrees(program: Program, draw: Draw) -> Program | None:
    """The virtual axis as angles of the points."""
    places = at(program, "contour")
    section = program.lines[places[0]].section
    letter = program.dialect.virtual
    x, c = 0.0, 0.0
    for index in at(program, "ramp", "contour"):
        line = program.lines[index]
        if line.section != section:
            continue
        if "#" in line.text or re.search(r"[UHV]-?[\d.]|G91", line.text):
            return None
        for match in words_of(line.text, "X" + letter):
            if match[1] == "X":
                x = float(match[2]) / (2 if program.dialect.diameter_inside else 1)
            else:
                c = float(match[2])
        if line.role == "contour" and words_of(line.text, letter):
            angle = math.degrees(math.atan2(c, x)) % 360
            program = program.changed(
                index, re.sub(rf"{letter}{_NUMBER}", f"{letter}{angle:.3f}".rstrip("0"), line.text)
            )
    return program


def position_angle_missing(program: Program, draw: Draw) -> Program | None:
    """C of a later section is not positioned: it stands where the one before has left it."""
    places = [
        index
        for index in at(program, "position", "position angle")
        if program.lines[index].section > 0 and re.search(r"C0(?!\d)", program.lines[index].text)
    ]
    if not places:
        return None
    index = draw.choice(places)
    text = re.sub(r" ?C0(?!\d)", "", program.lines[index].text)
    return program.changed(index, *([text] if re.search("[XZ]", text) else []))


# ---- tools, feeds, comments ----


def tool_comment(program: Program, draw: Draw) -> Program | None:
    """A comment that names another cutter."""
    places = at(program, "call")
    index = draw.choice(places)
    text = program.lines[index].text
    number = re.match(r"\S+(?: D1)?", text)
    assert number
    offset = int(re.search(r"(\d{1,2})(?: D1)?$", number[0])[1])  # type: ignore[index]
    radius = program.radii.get(offset)
    if radius is None:
        return None
    size = 2 * radius / program.scale * draw.choice((0.5, 1.5, 2.0))
    word = draw.choice(("END MILL D{}", "EM{}", "D{} END MILL", "CUTTER {}")).format(f"{size:.4g}")
    return program.changed(index, f"{number[0]} {word.join(program.dialect.remark)}")


def size_comment(program: Program, draw: Draw) -> Program | None:
    places = at(program, "size")
    if not places:
        return None
    change = lambda m: f"{float(m[0]) + draw.choice((2, -2, 3)) * (0.1 if program.inch else 1):.4g}"  # noqa: E731
    return program.changed(places[0], re.sub(r"[\d.]+", change, program.lines[places[0]].text))


def bar_comment(program: Program, draw: Draw) -> Program | None:
    """A bar that is smaller than the part."""
    places = at(program, "bar")
    if not places:
        return None
    least = program.bar / program.scale * draw.choice((0.5, 0.7))
    return program.changed(places[0], re.sub(r"[\d.]+", f"{least:.3g}", program.lines[places[0]].text))


def units_missing(program: Program, draw: Draw) -> Program | None:
    code = program.dialect.inch if program.inch else program.dialect.metric
    places = [index for index in at(program, "head") if code and code in program.lines[index].text]
    if not places or program.inch == program.dialect.starts_in_inch or program.stock is None:
        return None
    rest = program.lines[places[0]].text.replace(code, "").strip()
    return program.changed(places[0], *([rest] if rest else []))


def per_revolution(program: Program, draw: Draw) -> Program | None:
    dialect = program.dialect
    places = [index for index in at(program, "start") if dialect.per_minute in program.lines[index].text]
    if not places:
        return None
    return program.changed(places[0], program.lines[places[0]].text.replace(dialect.per_minute, dialect.per_revolution))


def per_minute_missing(program: Program, draw: Draw) -> Program | None:
    dialect = program.dialect
    if not at(program, "turn"):
        return None
    places = [index for index in at(program, "start") if dialect.per_minute in program.lines[index].text]
    return program.changed(places[0]) if places else None


def entered_again(program: Program, draw: Draw) -> Program | None:
    """The mode is left and entered between two passes, where C stands elsewhere."""
    places = [index for index in at(program, "plunge", "lift") if program.lines[index - 1].role == "cancel"]
    dialect = program.dialect
    if not places or not dialect.index or dialect.on != "G12.1" or dialect.before:
        return None
    index = draw.choice(places)
    return program.changed(index, dialect.off, dialect.on, program.lines[index].text)


def unknown_offset(program: Program, draw: Draw) -> Program | None:
    """An offset that has no R."""
    index = draw.choice(at(program, "call"))
    text = program.lines[index].text
    match = re.match(r"(?:N\d+ )?T(\d\d)(\d\d)", text)
    if not match or program.machine == "okuma-osp" or program.family.endswith(("center path", "zigzag")):
        return None
    return program.changed(index, text.replace(match[1] + match[2], f"{match[1]}{int(match[2]) + 20}", 1))


def other_offset(program: Program, draw: Draw) -> Program | None:
    """The offset of the other cutter."""
    places = at(program, "call")
    if len(program.radii) < 2 or program.machine in ("siemens-transmit", "okuma-osp"):
        return None
    index = draw.choice(places)
    match = re.search(r"T(\d\d)(\d\d)", program.lines[index].text)
    if not match:
        return None
    other = next(offset for offset in program.radii if offset != int(match[2]))
    if abs(program.radii[other] - program.radii[int(match[2])]) < 0.3:
        return None
    return program.changed(index, program.lines[index].text.replace(match[0], f"T{match[1]}{other:02}"))


def ends_inside(program: Program, draw: Draw) -> Program | None:
    """The end of an open pass, far beyond the bar, falls short by a digit or its sign."""
    if not re.match("one_flat|slot|keyway", program.family):
        return None
    letter = "X" if not program.family.startswith("one_flat") else program.dialect.virtual
    contour = at(program, "contour")
    last = [index for index in contour if program.lines[index + 1].role in ("cancel", "lead")]
    if not last:
        return None
    index = draw.choice(last)
    found = words_of(program.lines[index].text, letter)
    if not found or abs(float(found[-1][2])) * program.scale < 10:
        return None
    match = found[-1]
    digits = match[2].lstrip("-")
    value = match[2].replace(digits, digits[1:] if digits[1] != "." else digits[0] + ".", 1)
    if value == match[2] or not float(value):
        value = _plain(float(match[2]) / 10, match[2])
    text = program.lines[index].text
    return program.changed(index, text[: match.start(2)] + value + text[match.end(2) :])


def _words(change: Callable[[str, Draw], str | None]) -> Plant:
    return word_changed("XC", change, "contour")


SLIPS = (
    Slip("digits swapped", _words(_swapped), SHAPE, "shape"),
    Slip("digit lost", _words(_digit_lost), SHAPE, "shape"),
    Slip("digit wrong", _words(_digit_wrong), SHAPE, "shape"),
    Slip("point moved", _words(_point_moved), SHAPE, "shape"),
    Slip("sign lost", _words(_sign), SHAPE, "shape"),
    Slip("value doubled", _words(_factor(2)), SHAPE, "shape"),
    Slip("value halved", _words(_factor(0.5)), SHAPE, "shape"),
    Slip("one X as the other of diameter and radius", word_changed("X", _factor(0.5), "contour"), SHAPE, "shape"),
    Slip("all X as the other of diameter and radius", all_words("X"), SHAPE - {"repeated"}, "shape"),
    Slip("all C doubled", all_words("C"), SHAPE - {"repeated"}, "shape"),
    Slip("neighbour's value", neighbour, SHAPE, "shape"),
    Slip("block missing", block_missing_in_contour, SHAPE, "shape"),
    Slip("block doubled", block_doubled, SHAPE, "shape"),
    Slip("blocks swapped", blocks_swapped, SHAPE, "the contour crosses itself"),
    Slip("word missing", word_missing, SHAPE, "shape"),
    Slip("X and C swapped", axes_swapped, SHAPE, "shape"),
    Slip("X for C", letter_for_other, SHAPE, "shape"),
    Slip("R wrong", arc_word("R", _digit_wrong), SHAPE, "no tangent at its ends"),
    Slip("R with point moved", arc_word("R", _point_moved), SHAPE, "no tangent at its ends"),
    Slip("sign of R", arc_word("R", _sign), SHAPE | {"concentric"}, "tangent with the other sign"),
    Slip("all R doubled", all_arcs, SHAPE - {"repeated"}, "each would be tangent"),
    Slip("sign of I or J", arc_word("I", _sign), ALWAYS, "end off the circle, or no tangent"),
    Slip("I or J wrong", arc_word("I", _digit_wrong), ALWAYS, "end off the circle"),
    Slip("G2 and G3 swapped", arc_code(_other_arc), SHAPE | {"concentric"}, "no tangent at its ends"),
    Slip("G2 forgotten", arc_code(lambda code, program: ""), ALWAYS, "R or I beside a line"),
    Slip("G1 for G2", arc_code(lambda code, program: program.dialect.line), ALWAYS, "R or I beside a line"),
    Slip("G41 for G42", side_swapped, ALWAYS, "cuts into the part"),
    Slip("G41 forgotten", block_changed("G4[12] ?", "", "ramp"), ALWAYS, "G40 that cancels nothing"),
    Slip("G41 late", side_late, ALWAYS, "cuts before it"),
    Slip("G40 at once", cancelled_at_once, ALWAYS, "nothing lies between"),
    Slip("ramp block missing", block_missing("ramp"), ALWAYS, "G40 that cancels nothing"),
    Slip("X halved in the ramp", word_changed("X", _factor(0.5), "ramp"), ALWAYS, "ramp through the part"),
    Slip("X wrong in the ramp", word_changed("X", _digit_wrong, "ramp"), EVENT, "ramp through the part"),
    Slip("G40 forgotten", block_changed("G40 ?", "", "cancel"), ALWAYS, "G13.1 in offset mode"),
    Slip("cancel block missing", block_missing("cancel"), ALWAYS, "G13.1 in offset mode"),
    Slip("approach block missing", block_missing("approach"), EVENT, "ramp or plunge through the part"),
    Slip("depth missing", block_missing("plunge", "plunge outside"), ALWAYS, "cuts only air, or twice the same"),
    Slip("sign of the depth", depth_word(_sign), ALWAYS, "cuts only air"),
    Slip("depth ten times", depth_word(_deeper), frozenset({"steps"}), "far deeper than the other passes"),
    Slip("retract missing", retract_missing, EVENT, "C or X moved in the part"),
    Slip("sign of the retract", word_changed("Z", _sign, "retract", "lift"), EVENT, "rapid in the part"),
    Slip("index missing", index_word("missing"), ALWAYS, "cuts only air"),
    Slip("index twice", index_word("twice"), ALWAYS, "cuts only air"),
    Slip("G0 for G1 in the plunge", block_changed("G1(?!0|1)", "G0", "plunge"), EVENT, "rapid into the bar"),
    Slip("G0 for G1 in the ramp", block_changed("G1(?!0|1)", "G0", "ramp", "approach"), EVENT, "G0 in the mode"),
    Slip("approach inside the bar", x_too_small(0.6), EVENT, "plunge into the part"),
    Slip("approach near the center", x_too_small(0.25), EVENT, "plunge into the part"),
    Slip("down by rapid at the approach", z_at_depth_before, EVENT, "rapid into the bar"),
    Slip("G12.1 missing", mode_missing("on"), ALWAYS, "G13.1 without it"),
    Slip("G13.1 missing", mode_missing("off"), ALWAYS, "the mode is left open"),
    Slip("degrees", degrees, ALWAYS, "rise to 360"),
    Slip("C elsewhere at the second section", position_angle_missing, ALWAYS, "nobody positioned it"),
    Slip("contour at two depths", contour_at_two_depths, ALWAYS, "Z in the middle of a contour"),
    Slip("pass ends inside the bar", ends_inside, frozenset({"bar"}), "material left"),
    Slip("wrong cutter in the comment", tool_comment, ALWAYS, "the comment", is_real=True),
    Slip("wrong size in the comment", size_comment, ALWAYS, "the comment", is_real=True),
    Slip("wrong bar in the comment", bar_comment, ALWAYS, "the part is larger", is_real=True),
    Slip("unit missing", units_missing, ALWAYS, "never reaches its bar, or is all in it", is_real=True),
    Slip("G99 for G98", per_revolution, ALWAYS, "F of a feed per minute"),
    Slip("G98 missing", per_minute_missing, ALWAYS, "F of a feed per minute"),
    Slip("F of a feed per revolution", block_changed(r"F[\d.]+", "F0.1", "ramp", "plunge"), ALWAYS, "takes hours"),
    Slip("left and entered again", entered_again, ALWAYS, "C stands elsewhere"),
    Slip("offset without R", unknown_offset, ALWAYS, "no radius is known"),
    Slip("offset of the other cutter", other_offset, ALWAYS, "the comment, or T with another number"),
)


class Planted(NamedTuple):
    """A program with a slip; line: of the first block that differs, from 1."""

    slip: str
    program: Program
    line: int


def planted(slip: Slip, program: Program, draw: Draw) -> Planted | None:
    """The program with the slip, where it can be made, does something, and a check could know it."""
    changed = slip.plant(program, draw)
    if changed is None or changed.text() == program.text():
        return None
    try:
        if not is_real(slip, program, changed):
            return None
    except (ValueError, SyntaxError, ZeroDivisionError, OverflowError):
        return None
    return Planted(slip.name, changed, _first_change(program, changed) + 1)


def is_real(slip: Slip, program: Program, changed: Program) -> bool:
    """Whether metal or lathe are affected, and a check could know."""
    if slip.is_real:
        return True
    sound, other = simulate(program), simulate(changed)
    events = other.events - sound.events
    if RAPID in events and "bar" not in program.evidence:
        events -= set() if cuts_the_part(program, sound, changed, other, rapids=True) else {RAPID}
    if events:
        return True
    if not differs(sound, other):
        return False
    if "always" in slip.needs or slip.needs & program.evidence:
        return True
    index = _first_change(program, changed)
    is_beside = index < len(program.lines) and program.lines[index].role != "contour"
    is_drilled = program.family.endswith("center path") and not program.family.startswith(BOSSES)
    return is_beside and not is_drilled and cuts_the_part(program, sound, changed, other)


def _first_change(program: Program, changed: Program) -> int:
    pairs = zip(program.lines, changed.lines, strict=False)
    return next((index for index, (one, two) in enumerate(pairs) if one.text != two.text), len(changed.lines))


def drawn_slip(
    seed: int,
    kinds: tuple[Slip, ...] = SLIPS,
    machine: str = "",
    is_sound: Callable[[Program], bool] = lambda one: True,
) -> Planted | None:
    """A slip of the kind that is in turn, in a program of which nothing is said without it."""
    draw = random.Random(f"slip {seed}")  # noqa: S311 - programs that can be written again
    slip = kinds[seed % len(kinds)]
    for _ in range(60):
        program = drawn(draw.randrange(10**6), machine)
        with_slip = planted(slip, program, draw)
        if with_slip is not None and is_sound(program):
            return with_slip
    return None
