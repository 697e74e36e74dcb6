"""Slips in blocks: missing, twice or at another place; compensation, depth, index and the mode."""

from __future__ import annotations

import math
import re

from setter_programs import Program
from slip_words import NUMBER, Draw, Plant, at, digit_wrong, plain, word_changed, words_of

# ---- any block ----


def block_doubled(*roles: str) -> Plant:
    def plant(program: Program, draw: Draw) -> Program | None:
        places = at(program, *roles)
        if not places:
            return None
        index = draw.choice(places)
        return program.changed(index, program.lines[index].text, program.lines[index].text)

    return plant


def block_moved(by: int, *roles: str) -> Plant:
    """A block in the place of the one before (-1) or behind (1), and that in its place."""

    def plant(program: Program, draw: Draw) -> Program | None:
        last = len(program.lines) - 1
        places = [index for index in at(program, *roles) if 0 <= index + by <= last and _is_plain(program, index, by)]
        if not places:
            return None
        index = draw.choice(places)
        one, two = program.lines[index], program.lines[index + by]
        if one.text == two.text:
            return None
        return program._replace(
            lines=tuple({index: two, index + by: one}.get(number, line) for number, line in enumerate(program.lines))
        )

    return plant


def _is_plain(program: Program, index: int, by: int) -> bool:
    return not re.search("[#O%]|M30|M9[89]|END|WHILE", program.lines[index].text + program.lines[index + by].text)


def code_moved(code: str, by: int, *roles: str) -> Plant:
    """A code (regular expression) in the block before (-1) or behind (1)."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = [index for index in at(program, *roles) if re.search(code, program.lines[index].text)]
        group = "G4[012]" if "G4" in code else r"G(0|10?)?[0123](?!\d)"
        places = [index for index in places if _is_plain(program, index, by)]
        places = [index for index in places if not re.search(group, program.lines[index + by].text)]
        if not places:
            return None
        index = draw.choice(places)
        text, other = program.lines[index].text, program.lines[index + by].text
        written = re.search(code, text)
        assert written
        text = (text[: written.start()] + text[written.end() :]).replace("  ", " ").strip()
        first = len(re.match(r"(N\d+ ?)?", other)[0])  # type: ignore[index]
        other = other[:first] + written[0] + " " * (" " in other) + other[first:]
        return program.changed(index + by, other).changed(index, *([text] if text else []))

    return plant


def block_written(text: str, *roles: str) -> Plant:
    """A block that is not meant, before one of those with these roles."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = at(program, *roles)
        if not places:
            return None
        index = draw.choice(places)
        return program.changed(index, text, program.lines[index].text)

    return plant


# ---- compensation ----


def side_swapped(program: Program, draw: Draw) -> Program | None:
    places = [index for index in at(program, "ramp") if re.search("G4[12]", program.lines[index].text)]
    if not places:
        return None
    index = draw.choice(places)
    return program.changed(
        index, re.sub("G4[12]", lambda m: "G42" if m[0] == "G41" else "G41", program.lines[index].text)
    )


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


def deeper(value: str, draw: Draw) -> str | None:
    if not value.startswith("-"):
        return None
    return draw.choice((plain(float(value) * 10, value), "-1" + value[1:], "-2" + value[1:]))


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
    """The C of a later section left out, that of the one before, or, where it has equal steps, another one."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = at(program, "index")
        if not places:
            return None
        index = draw.choice(places)
        if change == "missing":
            return program.changed(index)
        text = program.lines[index].text
        if change == "another digit":
            return word_changed("C", digit_wrong, "index")(program, draw) if len(places) > 2 else None
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
        places = [index for index in at(program, "position") if re.search(rf"X{NUMBER}", program.lines[index].text)]
        if not places:
            return None
        index = draw.choice(places)
        match = re.search(rf"X{NUMBER}", program.lines[index].text)
        assert match
        value = plain(float(match[1]) * share * draw.uniform(0.8, 1.1), "0.0")
        text = program.lines[index].text
        return program.changed(index, text[: match.start(1)] + value + text[match.end(1) :])

    return plant


def z_at_depth_before(program: Program, draw: Draw) -> Program | None:
    """The approach goes down in a pocket's place by rapid, to its depth."""
    places = [index for index in at(program, "position") if re.search(rf"Z{NUMBER}", program.lines[index].text)]
    deep = [
        match[1]
        for index in at(program, "plunge", "plunge outside")
        for match in re.finditer(rf"Z{NUMBER}", program.lines[index].text)
    ]
    if not places or not deep:
        return None
    index = draw.choice(places)
    return program.changed(index, re.sub(rf"Z{NUMBER}", "Z" + deep[0], program.lines[index].text))


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
                index, re.sub(rf"{letter}{NUMBER}", f"{letter}{angle:.3f}".rstrip("0"), line.text)
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
    hits = words_of(program.lines[index].text, letter)
    if not hits or abs(float(hits[-1][2])) * program.scale < 10:
        return None
    match = hits[-1]
    digits = match[2].lstrip("-")
    value = match[2].replace(digits, digits[1:] if digits[1] != "." else digits[0] + ".", 1)
    if value == match[2] or not float(value):
        value = plain(float(match[2]) / 10, match[2])
    text = program.lines[index].text
    return program.changed(index, text[: match.start(2)] + value + text[match.end(2) :])
