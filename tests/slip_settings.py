"""Slips in what a program is run with: codes, tools, feeds, units and comments."""

from __future__ import annotations

import re

from setter_programs import Program
from slip_words import Draw, Plant, at


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
    match = re.search(r"T(\d\d)(\d\d).*D", program.lines[index].text)
    if not match:
        return None
    other = next(offset for offset in program.radii if offset != int(match[2]))
    if abs(program.radii[other] - program.radii[int(match[2])]) < 0.3:
        return None
    return program.changed(index, program.lines[index].text.replace(match[1] + match[2], f"{match[1]}{other:02}", 1))
