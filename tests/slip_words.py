"""Slips in the words of a contour: another value, another letter, a block too few or too many."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

from setter_programs import Program

Draw = random.Random
Plant = Callable[[Program, Draw], Program | None]
NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+))(?![\d.\]\[])"


def at(program: Program, *roles: str) -> list[int]:
    """The blocks with these roles."""
    return [index for index, line in enumerate(program.lines) if line.role in roles]


def word_changed(letters: str, change: Callable[[str, Draw], str | None], *roles: str, pattern: str = "") -> Plant:
    """Another value of one word in one of the blocks with these roles."""

    def plant(program: Program, draw: Draw) -> Program | None:
        addresses = letters.replace(
            "C",
            program.dialect.virtual
            + program.dialect.virtual_step
            + ("C" if re.search("position|index", " ".join(roles)) else ""),
        )
        addresses = addresses.replace("X", "XU") if "X" in letters else addresses
        places = []
        for index in at(program, *roles):
            for match in re.finditer(rf"([{addresses}]){NUMBER}", program.lines[index].text):
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


def swapped(value: str, draw: Draw) -> str | None:
    places = [
        i for i in range(len(value) - 1) if value[i].isdigit() and value[i + 1].isdigit() and value[i] != value[i + 1]
    ]
    if not places:
        return None
    i = draw.choice(places)
    return value[:i] + value[i + 1] + value[i] + value[i + 2 :]


def digit_lost(value: str, draw: Draw) -> str | None:
    places = [i for i, sign in enumerate(value) if sign.isdigit()]
    if len(places) < 2:
        return None
    i = draw.choice(places)
    return value[:i] + value[i + 1 :]


def digit_doubled(value: str, draw: Draw) -> str | None:
    i = draw.choice([i for i, sign in enumerate(value) if sign.isdigit()])
    return value[: i + 1] + value[i:]


def digit_wrong(value: str, draw: Draw) -> str | None:
    places = [i for i, sign in enumerate(value) if sign.isdigit()]
    i = draw.choice(places[:3])
    return value[:i] + draw.choice([sign for sign in "123456789" if sign != value[i]]) + value[i + 1 :]


def point_moved(value: str, draw: Draw) -> str | None:
    if not float(value):
        return None
    return plain(float(value) * draw.choice((10, 0.1)), value)


def sign_changed(value: str, draw: Draw) -> str | None:
    if not float(value):
        return None
    return value[1:] if value.startswith("-") else "-" + value


def factor_of(factor: float) -> Callable[[str, Draw], str | None]:
    return lambda value, draw: plain(float(value) * factor, value) if float(value) else None


def plain(value: float, like: str) -> str:
    digits = max(len(like.partition(".")[2]), 3)
    text = f"{value:.{digits}f}".rstrip("0")
    return text if float(text) else "0"


#: How a number is written wrong.
VALUES = {
    "sign wrong": sign_changed,
    "digits swapped": swapped,
    "digit lost": digit_lost,
    "digit doubled": digit_doubled,
    "another digit": digit_wrong,
    "ten times or a tenth": point_moved,
    "twice": factor_of(2),
    "half": factor_of(0.5),
}


def words_of(text: str, letters: str) -> list[re.Match[str]]:
    return list(re.finditer(rf"([{letters}]){NUMBER}", text))


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
        addresses = "XU" if letter == "X" else program.dialect.virtual + program.dialect.virtual_step
        factor = (0.5 if program.dialect.diameter_inside else 2.0) if letter == "X" else 2.0
        roles = ("contour", "ramp")
        for index in at(program, *roles):
            line = program.lines[index]
            if line.section == section:
                text = re.sub(
                    rf"([{addresses}]){NUMBER}",
                    lambda m: m[1] + (plain(float(m[2]) * factor, m[2]) if float(m[2]) else m[2]),
                    line.text,
                )
                program = program.changed(index, text)
        return program

    return plant


def word_missing(program: Program, draw: Draw) -> Program | None:
    """One coordinate of a block with two."""
    addresses = "X" + program.dialect.virtual
    places = [index for index in at(program, "contour") if len(words_of(program.lines[index].text, addresses)) == 2]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    match = draw.choice(words_of(text, addresses))
    return program.changed(index, (text[: match.start()] + text[match.end() :]).replace("  ", " ").strip())


def axes_swapped(program: Program, draw: Draw) -> Program | None:
    """The values of X and C in each other's place."""
    addresses = "X" + program.dialect.virtual
    places = [index for index in at(program, "contour") if len(words_of(program.lines[index].text, addresses)) == 2]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    one, two = words_of(text, addresses)
    if one[2] == two[2]:
        return None
    return program.changed(
        index, text[: one.start(2)] + two[2] + text[one.end(2) : two.start(2)] + one[2] + text[two.end(2) :]
    )


def letter_for_other(program: Program, draw: Draw) -> Program | None:
    """X for the virtual axis, or the other way, in a block with one of them."""
    addresses = "X" + program.dialect.virtual
    places = [index for index in at(program, "contour") if len(words_of(program.lines[index].text, addresses)) == 1]
    if not places:
        return None
    index = draw.choice(places)
    text = program.lines[index].text
    match = words_of(text, addresses)[0]
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


def other_arc(code: str, program: Program) -> str:
    return program.dialect.ccw if code == program.dialect.cw else program.dialect.cw


def arc_word(letters: str, change: Callable[[str, Draw], str | None]) -> Plant:
    def plant(program: Program, draw: Draw) -> Program | None:
        word = program.dialect.radius_word
        pattern = rf"({word}){NUMBER}" if letters == "R" else rf"([IJ]){NUMBER}"
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
    places = [index for index in at(program, "contour") if re.search(rf"{word}{NUMBER}", program.lines[index].text)]
    if not places:
        return None
    section = program.lines[draw.choice(places)].section
    for index in places:
        if program.lines[index].section == section:
            text = re.sub(
                rf"({word}){NUMBER}", lambda m: m[1] + plain(2 * float(m[2]), m[2]), program.lines[index].text
            )
            program = program.changed(index, text)
    return program
