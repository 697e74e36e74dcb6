"""Single slips in drawn contours: one word, one code or one block is another than was meant."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

from drawn_contours import Drawn

Blocks = list[str]
Slip = Callable[[Drawn, Blocks, random.Random], Blocks | None]


def passes(blocks: Blocks) -> list[range]:
    """The blocks of each pass between its start-up and its cancel."""
    begins = [at for at, block in enumerate(blocks) if block.startswith(("G41", "G42"))]
    return [range(at + 1, next(end for end in range(at, len(blocks)) if "G40" in blocks[end])) for at in begins]


def _one_of(blocks: Blocks, pattern: str, draw: random.Random) -> int | None:
    """One of the blocks of a pass that have this."""
    at = [at for at in draw.choice(passes(blocks)) if re.search(pattern, blocks[at])]
    return draw.choice(at) if at else None


def _with_word(blocks: Blocks, pattern: str, draw: random.Random, change: Callable[[float], float]) -> Blocks | None:
    """One of these words, not 0, with another value."""
    at = _one_of(blocks, rf"{pattern}-?\d*\.?\d*[1-9]", draw)
    if at is None:
        return None
    words = [word for word in re.finditer(rf"({pattern})(-?\d*\.?\d+\.?)", blocks[at]) if float(word[2])]
    word = draw.choice(words)
    value = f"{change(float(word[2])):.4f}".rstrip("0")
    return [*blocks[:at], blocks[at][: word.start(2)] + value + blocks[at][word.end(2) :], *blocks[at + 1 :]]


def _code(drawn: Drawn, code: str) -> str:
    return drawn.control.code.get(code, code)


def other_radius(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    factor = draw.choice((2, 10))
    return _with_word(blocks, drawn.control.radius_word, draw, lambda value: value * factor)


def sign_of_radius(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    return _with_word(blocks, drawn.control.radius_word, draw, lambda value: -value)


def all_radii_doubled(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    def doubled(word: re.Match[str]) -> str:
        return drawn.control.radius_word + f"{2 * float(word[1]):.4f}".rstrip("0")

    changed = [re.sub(drawn.control.radius_word + r"(\d*\.?\d+\.?)", doubled, block) for block in blocks]
    return changed if changed != blocks else None


def other_sense(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    clockwise, other = _code(drawn, "G2"), _code(drawn, "G3")
    at = _one_of(blocks, f"^({clockwise}|{other}) ", draw)
    if at is None:
        return None
    code, _, words = blocks[at].partition(" ")
    return [*blocks[:at], f"{other if code == clockwise else clockwise} {words}", *blocks[at + 1 :]]


def arc_code_forgotten(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    at = _one_of(blocks, f"^({_code(drawn, 'G2')}|{_code(drawn, 'G3')}) ", draw)
    return None if at is None else [*blocks[:at], blocks[at].partition(" ")[2], *blocks[at + 1 :]]


def depth_too_late(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    chosen = draw.choice(passes(blocks))
    depth = chosen.start - 2
    if len(chosen) < 4 or not blocks[depth].startswith("Z"):
        return None
    late = draw.randrange(chosen.start + 1, chosen.stop - 1)
    rest = blocks[late:]
    motions = [code for block in blocks[:late] for code in re.findall(r"G0?1?0?[0-3](?= )", block[:5])]
    line = _code(drawn, "G1")
    if not rest[0].startswith("G") and motions and motions[-1] != line:
        rest[0] = f"{motions[-1]} {rest[0]}"
    return [*blocks[:depth], *blocks[depth + 1 : late], f"{line} {blocks[depth]}", *rest]


def wrong_increment(drawn: Drawn, blocks: Blocks, draw: random.Random) -> Blocks | None:
    if not drawn.incremental:
        return None
    off = draw.choice((0.3, -0.3)) / drawn.control.unit
    at = draw.choice(passes(blocks))[:-1]
    lines = [
        index for index in at if re.search(f"[U{drawn.control.step}]", blocks[index]) and " I" not in blocks[index]
    ]
    lines = [index for index in lines if drawn.control.radius_word not in blocks[index]]
    if not lines:
        return None
    index = draw.choice(lines)
    word = draw.choice(list(re.finditer(rf"[U{drawn.control.step}](-?\d*\.?\d+\.?)", blocks[index])))
    value = f"{float(word[1]) + off:.4f}".rstrip("0")
    return [
        *blocks[:index],
        blocks[index][: word.start(1)] + value + blocks[index][word.end(1) :],
        *blocks[index + 1 :],
    ]


#: Slips, and the families in which nothing else of the contour tells of them: corners that are meant.
SLIPS: dict[str, tuple[Slip, tuple[str, ...]]] = {
    "another R": (other_radius, ("bullet", "crowned", "slot", "keyed", "flats", "teardrop")),
    "sign of R": (sign_of_radius, ("bullet", "crowned", "slot", "circle")),
    "all R doubled": (all_radii_doubled, ("bullet", "crowned", "flats", "keyed", "circle", "free")),
    "G2 for G3": (other_sense, ("crowned", "circle", "teardrop", "bullet")),
    "G2 forgotten": (arc_code_forgotten, ()),
    "depth too late": (depth_too_late, ()),
    "an increment off": (wrong_increment, ()),
}
