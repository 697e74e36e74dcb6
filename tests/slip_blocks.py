"""Slips in the blocks around a contour: compensation, depth, index, the mode, tools, feeds and comments."""

from __future__ import annotations

import math
import re

from setter_programs import Program
from slip_words import NUMBER, Draw, Plant, at, plain, words_of

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


# ---- tools, feeds, comments ----


def text_missing(pattern: str, *roles: str) -> Plant:
    """A code (regular expression) is missing, with its block where nothing else stands there."""

    def plant(program: Program, draw: Draw) -> Program | None:
        lines = enumerate(program.lines)
        places = [i for i, line in lines if re.search(pattern, line.text) and (not roles or line.role in roles)]
        if not places:
            return None
        index = draw.choice(places)
        text = re.sub(pattern, "", program.lines[index].text, count=1).strip()
        return program.changed(index, *([text] if text and not re.fullmatch(r"N\d+", text) else []))

    return plant


def code_missing(name: str) -> Plant:
    """The code that the dialect writes for something is missing."""

    def plant(program: Program, draw: Draw) -> Program | None:
        code = getattr(program.dialect, name)
        return text_missing(rf"{re.escape(code)}(?![\d.])")(program, draw) if code else None

    return plant


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
    least = min(program.reach, program.bar) / program.scale * draw.choice((0.5, 0.7, 0.85))
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
