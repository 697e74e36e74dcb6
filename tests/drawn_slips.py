"""
Slips that are planted in drawn sections, alone and in pairs.

A slip changes one thing, as a programmer who forgets or mistypes it would. Its aspect says what it concerns: two slips
of different aspects are two mistakes, also in one loop, as are two slips in different sections or loops.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from typing import NamedTuple

from drawn_sections import Section, number, program, sections
from programs import report_of

Blocks = list[str]
#: Where most slips are planted: the contour and its ramps.
CONTOUR = ("G41", "G42")


class Slip(NamedTuple):
    """
    A mistake.

    name: in the words of a shop. aspect: entry, text, code, feed or path. of_loop: it concerns one pass of a section,
    not all of it. plant: from the blocks of the loop or of the section, the section and a source of chance to the
    blocks with the mistake; None where it cannot be made there.
    """

    name: str
    aspect: str
    of_loop: bool
    plant: Callable[[Blocks, Section, random.Random], Blocks | None]


def loops(section: Section) -> list[range]:
    """The blocks of each pass, from its G41 or G42 to its lead-out."""
    blocks = section.blocks
    begin = [index for index, block in enumerate(blocks) if block.startswith(CONTOUR)]
    depth = [index for index, block in enumerate(blocks) if block.startswith(("G1 Z", "Z2."))]
    return [range(index, next(end for end in depth if end > index)) for index in begin]


def planted(slip: Slip, section: Section, loop: int, draw: random.Random) -> Section | None:
    """The section with the slip in one of its loops, or as a whole; None where it cannot be made."""
    part = loops(section)[loop] if slip.of_loop else range(len(section.blocks))
    blocks = slip.plant([*section.blocks[part.start : part.stop]], section, draw)
    if blocks is None:
        return None
    return section._replace(blocks=(*section.blocks[: part.start], *blocks, *section.blocks[part.stop :]))


# ---- how a slip is made ----


def one_block(
    starts: tuple[str, ...], change: Callable[[str, Section, random.Random], str | None]
) -> Callable[[Blocks, Section, random.Random], Blocks | None]:
    """A slip in one of the blocks that start so."""

    def plant(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
        at = [index for index, block in enumerate(blocks) if block.startswith(starts)]
        if not at:
            return None
        index = draw.choice(at)
        block = change(blocks[index], section, draw)
        return None if block is None else [*blocks[:index], block, *blocks[index + 1 :]]

    return plant


def replaced(
    old: str, new: str, starts: tuple[str, ...] = ("",)
) -> Callable[[Blocks, Section, random.Random], Blocks | None]:
    """`new` in place of `old` in one of the blocks that start so and have it."""

    def plant(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
        at = [index for index, block in enumerate(blocks) if block.startswith(starts) and re.search(old, block)]
        if not at:
            return None
        index = draw.choice(at)
        return [*blocks[:index], re.sub(old, new, blocks[index], count=1), *blocks[index + 1 :]]

    return plant


def beside(code: str) -> Callable[[Blocks, Section, random.Random], Blocks | None]:
    """A block of its own between two blocks of the contour."""

    def plant(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
        index = draw.randint(2, len(blocks) - 2)
        return [*blocks[:index], code, *blocks[index:]]

    return plant


def before_the_mode(block: str, after: str) -> Callable[[Blocks, Section, random.Random], Blocks | None]:
    """A block before G12.1, and what undoes it behind the section."""

    def plant(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
        index = blocks.index("G12.1")
        return [*blocks[:index], block, *blocks[index:], after]

    return plant


def without_line_code(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
    at = [index for index in range(1, len(blocks)) if blocks[index].startswith("G1 ") and " I" in blocks[index - 1]]
    if not at:
        return None
    index = draw.choice(at)
    return [*blocks[:index], blocks[index].removeprefix("G1 "), *blocks[index + 1 :]]


def other_side(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
    swapped = {"G41": "G42", "G42": "G41"}
    return [re.sub("^G4[12]", lambda code: swapped[code[0]], block) for block in blocks]


def ramp_across(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
    """A lead-out to the other side of the contour."""
    far = section.stock + 20
    x, c = draw.choice(((-far, None), (-far, draw.uniform(3, 10)), (-far * draw.uniform(0.5, 1), far / 2)))
    return [*blocks[:-1], f"G40 X{number(x)}" + ("" if c is None else f" C{number(c)}")]


def approach_across(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
    """A lead-in from behind the part: the way around it, and a start-up to the near side."""
    if section.family == "pocket":
        return None
    index = next(index for index, block in enumerate(blocks) if block.startswith(CONTOUR))
    far, start = section.stock + 20, blocks[index]
    if " C" not in start:
        start = re.sub(r"(X\S+)", r"\1 C0", start, count=1)
    side = draw.choice((-1, 1)) * far / 2
    ways = (
        [f"G1 X{number(far)} C{number(side)} F100", f"X{number(-far)}", "C0"],
        [f"G1 X{number(far)} C{number(side)} F100", f"X{number(-far)}"],
        [f"G1 X{number(far)} C{number(side)} F100", "X0"],
    )
    return [*blocks[:index], *draw.choice(ways), start, *blocks[index + 1 :]]


def halved(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
    """X as a radius from G12.1 on; of a contour without arcs that makes another sound one."""
    if not any(" I" in block for block in blocks):
        return None
    half = [re.sub(r"X(-?[\d.]+)", lambda word: "X" + number(float(word[1]) / 2), block) for block in blocks]
    return [blocks[0], *half[1:]]


def too_near(blocks: Blocks, section: Section, draw: random.Random) -> Blocks | None:
    """An approach that ends nearer to the contour than the cutter radius, and inside the bar."""
    start = next(block for block in blocks if block.startswith(CONTOUR))
    found = re.search(r"X([\d.]+)", start)
    assert found
    near = float(found[1]) + 2 * section.radius * draw.uniform(0.2, 0.9)
    if section.family == "pocket" or near >= section.stock:
        return None
    return [re.sub(r"X[\d.]+", f"X{number(near)}", blocks[0]), *blocks[1:]]


def _center(block: str, section: Section, draw: random.Random) -> str:
    value = draw.uniform(1.5, 4) * draw.choice((-1, 1))
    return re.sub(r"([IJ])(-?\d+\.\d+)", lambda word: word[1] + number(float(word[2]) + value), block, count=1)


SLIPS = (
    Slip("G1 forgotten after an arc", "path", True, without_line_code),
    Slip("wrong center of an arc", "path", True, one_block(("G2 ", "G3 "), _center)),
    Slip("G41 for G42", "path", True, other_side),
    Slip("lead-out across the contour", "path", True, ramp_across),
    Slip("lead-in across the contour", "path", False, approach_across),
    Slip("G40 forgotten", "path", False, replaced("^G40 ", "", ("G40",))),
    Slip("X halved", "path", False, halved),
    Slip("approach inside the bar", "path", False, too_near),
    Slip("G13.1 forgotten", "path", False, replaced("^G13.1$", "", ("G13.1",))),
    Slip("Y for C", "path", True, replaced(" C", " Y", ("X", "G1 X", "G2", "G3"))),
    Slip("G0 in the contour", "path", True, replaced("^G1 ", "G0 ", ("G1 ",))),
    Slip("stray character", "text", True, replaced("$", " ?", ("X", "C"))),
    Slip("word twice", "text", True, replaced(r"(C\S+)$", r"\1 \1", ("X", "C"))),
    Slip("G54 in the contour", "code", True, beside("G54")),
    Slip("tool call in the contour", "code", True, beside("T0202")),
    Slip("F0", "feed", False, replaced(r"F(80|120|200)$", "F0", CONTOUR)),
    Slip("F too high", "feed", False, replaced(r"F(80|120|200)$", "F20000", CONTOUR)),
    Slip("constant surface speed", "entry", False, before_the_mode("G96 S200", "G97 S1000")),
    Slip("rotation in force", "entry", False, before_the_mode("G68 R45.", "G69")),
    Slip("C not known", "entry", False, replaced(" C0", "", ("G0 ",))),
)


# ---- two slips in one program ----

#: The limit of the C axis [deg/min]; at the lower ones a path near the center is too fast.
LIMITS = (1800, 3600, 20000)
#: Controls that run these sections as they are.
CONTROLS = ("fanuc", "fanuc-16i", "fanuc-30i", "doosan", "gsk-988", "siemens-iso")


PLACES = ("sections", "loops", "aspects")


def rules_of(number: int, *written: Section, stock: float | None = None) -> list[str]:
    """The rules that report something at or above warning of a program of sections; machines change with the number."""
    tools = (f"{offset}:radius={written[0].radius}" for offset in (1, 2))
    limits = {"limits": {"c_feed": LIMITS[number % len(LIMITS)]}}
    job = None if stock is None else {"stock": {"diameter": stock}}
    report = report_of(program(*written), CONTROLS[number % len(CONTROLS)], *tools, changes=limits, job=job)
    return [found.rule for found in report.findings if found.severity != "note"]


def sound_sections(count: int, seed: int) -> list[Section]:
    """Those of the drawn sections of which nothing is reported at the lowest limit of the C axis."""
    return [section for section in sections(count, seed) if not rules_of(0, section)]


class Pair(NamedTuple):
    """
    Two slips, in other sections, in other loops of a section, or of other aspects in one loop.

    place: which of these. names: of the slips. both: the program with both. first, second: with one of them alone.
    """

    place: str
    names: tuple[str, str]
    both: tuple[Section, ...]
    first: tuple[Section, ...]
    second: tuple[Section, ...]


def pairs(drawn: list[Section], count: int, seed: int) -> list[Pair]:
    """Pairs of slips in these sections."""
    draw = random.Random(seed)  # noqa: S311 - programs that can be written again
    found: list[Pair] = []
    while len(found) < count:
        pair = _pair(PLACES[len(found) % len(PLACES)], drawn, draw)
        if pair is not None:
            found.append(pair)
    return found


def _pair(place: str, drawn: list[Section], draw: random.Random) -> Pair | None:
    first, second = draw.sample(SLIPS, 2)
    section = draw.choice(drawn)
    names, seed = (first.name, second.name), draw.random()

    def plant(slip: Slip, at: Section, loop: int) -> Section | None:
        return planted(slip, at, loop, random.Random(seed))  # noqa: S311

    if place == "sections":
        other = draw.choice([one for one in drawn if one.radius == section.radius])
        one = plant(first, section, draw.randrange(len(loops(section))))
        two = plant(second, other, draw.randrange(len(loops(other))))
        return Pair(place, names, (one, two), (one, other), (section, two)) if one and two else None
    if place == "loops" and not (first.of_loop and second.of_loop and len(loops(section)) > 1):
        return None
    if place == "aspects" and (first.aspect == second.aspect or (second.of_loop and not first.of_loop)):
        return None
    loop = 0 if place == "loops" else draw.randrange(len(loops(section)))
    one, two = plant(first, section, loop), plant(second, section, 1 if place == "loops" else loop)
    # The later loop first, as a slip may add blocks.
    both = two and plant(first, two, loop)
    return Pair(place, names, (both,), (one,), (two,)) if one and two and both else None


def gives_two_findings(numbered: tuple[int, Pair]) -> bool | None:
    """Two slips give two findings; None where one of them alone gives none, or more than one."""
    number, pair = numbered
    if len(rules_of(number, *pair.first)) != 1 or len(rules_of(number, *pair.second)) != 1:
        return None
    return len(rules_of(number, *pair.both)) > 1
