"""
Programs with contours at several depths, written by chance: loops that close nearly, run over each other, cross, and
go on at the next depth; with lines, arcs, circles and spirals, with and without compensation. Nobody would mill them.
"""

from __future__ import annotations

from random import Random

#: Half the size of a contour [mm], and by how much its words are off.
_SIZES, _OFF = (5, 20, 51), (0, 0, 1, 2, 0.5)


def program(random: Random) -> bytes:
    """A program of a few sections; the same Random gives the same one."""
    sections = (_section(random) for _ in range(random.choice((1, 1, 1, 2))))
    unit = random.choice(("", "", "G21", "G20"))
    blocks = [f"O1{unit}", "T0101", *(block for section in sections for block in section), "M30"]
    return "\n".join(blocks).encode()


def _section(random: Random) -> list[str]:
    size = random.choice(_SIZES)
    side = random.choice(("G41", "G42", "G41", ""))
    entry = random.choice(("", "G0 X130. C0 Z2."))
    blocks = [entry, "G12.1", f"G1 {side} X{2 * size + 1}. C0. F200."]
    z = 0.0
    for _ in range(random.choice((1, 2, 3, 4))):
        z -= random.choice((0.5, 1, 1, 2))
        blocks += [*_contour(random, size), f"G1 Z{z:g}{'' if z % 1 else '.'}"]
        if random.random() < 0.2:
            blocks += [f"G1 G40 X{2 * size + 26}. C0.", f"G1 {side} X{2 * size + 1}. C0."]
    leave = random.choice(("G1 G40 X129. C0.", "G1 G40 X129. C0.", ""))
    return [*blocks, *_contour(random, size), leave, random.choice(("G13.1", "G13.1", ""))]


def _contour(random: Random, size: float) -> list[str]:
    """Corners of a square, each a little off, or left out, or a circle or spiral in between."""
    corners = [(1, -1), (-1, -1), (-1, 1), (1, 1)]
    first = random.randrange(4)
    blocks = []
    for k in range(random.choice((2, 3, 4, 4, 5, 8))):
        x, c = corners[(first + k) % 4]
        x, c = ((sign * size + random.choice((-1, 1)) * random.choice(_OFF)) for sign in (x, c))
        kind = random.random()
        if kind < 0.75:
            blocks.append(f"G1 X{_word(x)} C{_word(c)}")
        elif kind < 0.9:
            blocks.append(f"{_arc(random)} X{_word(x)} C{_word(c)} R{_word(random.choice((1.2, 0.7, -0.8, 2)) * size)}")
        else:
            blocks.append(f"{_arc(random)} X{_word(x)} C{_word(c)} I{_word(-x)} J{_word(random.choice((-c, 0, 1)))}")
    return blocks


def _arc(random: Random) -> str:
    return random.choice(("G2", "G3"))


def _word(value: float) -> str:
    return f"{value:.3f}".rstrip("0")
