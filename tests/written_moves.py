"""Plain moves of X and C read from the text of a program, and where the tool is in them: nothing of polarcheck."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.complex128]
Floats = NDArray[np.float64]
_WORD = re.compile(r"([A-Z])=?([-+]?[0-9]*\.?[0-9]+|[-+]?[0-9]+\.)")


class Block(NamedTuple):
    """
    A block that moves X or C, with F, by words of the program: lengths in mm, X as a radius, C in degrees.

    start, end: (X, C, Z). rapid: by G0. inverse: F is 1 / time.
    """

    text: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]
    feed: float
    rapid: bool
    inverse: bool

    @property
    def ways(self) -> tuple[float, float, float]:
        x, c, z = (after - before for before, after in zip(self.start, self.end, strict=True))
        return abs(x), abs(c), abs(z)

    def minutes(self, method: str) -> float:
        """How long it takes, by what F is."""
        x, c, z = self.ways
        if method == "inverse-time":
            return 1 / self.feed
        if method == "per-minute-c":
            return (c or math.hypot(x, z)) / self.feed
        return math.hypot(x * (2 if method == "per-minute-diameter" else 1), c, z) / self.feed

    def points(self, count: int = 33) -> Points:
        """Where the tool center is on the part: X and C move evenly."""
        share = np.linspace(0, 1, count)
        x, c = (self.start[axis] + (self.end[axis] - self.start[axis]) * share for axis in (0, 1))
        return np.asarray(x * np.exp(1j * np.radians(c)))


def blocks_of(text: str, x_per_word: float = 0.5, scale: float = 1.0) -> list[Block]:
    """
    The blocks between the first block with G0 and C and the next with G0 or M behind them that move X, C or Z by G1.

    x_per_word: radius per X. scale: mm per length.
    """
    blocks = []
    place = [math.nan] * 3
    feed, motion, inverse = math.nan, 0, False
    for line in text.splitlines():
        words = _WORD.findall(re.sub(r"\(.*?\)", "", line.upper()))
        codes = {float(number) for letter, number in words if letter == "G"}
        if codes & {28.0, 30.0}:
            continue
        motion = next((int(code) for code in codes if code in (0, 1, 2, 3)), motion)
        inverse = 93 in codes or (inverse and not codes & {94.0, 98.0, 95.0, 99.0})
        values = {letter: float(number) for letter, number in words}
        feed = values.get("F", feed)
        ends = list(place)
        for axis, (letter, unit) in enumerate((("X", x_per_word * scale), ("C", 1.0), ("Z", scale))):
            ends[axis] = values[letter] * unit if letter in values else ends[axis]
        if motion in (2, 3) and {"X", "C", "Z"} & set(values):
            raise AssertionError(f"an arc is left: {line}")
        moves = {"X", "C", "Z"} & set(values)
        if moves and not any(math.isnan(value) for value in (*place, *ends)):
            blocks.append(Block(line, tuple(place), tuple(ends), feed, motion == 0, inverse))
        place = ends
    return blocks


def of_section(blocks: list[Block], first: complex, last: complex, near: float = 2e-3) -> list[Block]:
    """The blocks of X and C from the first one that begins at a point to the last one that ends at another [mm]."""
    on_plane = [block for block in blocks if block.ways[0] or block.ways[1]]
    begins = [n for n, block in enumerate(on_plane) if abs(block.points(2)[0] - first) <= near]
    ends = [n for n, block in enumerate(on_plane) if abs(block.points(2)[-1] - last) <= near]
    assert begins, "the contour does not begin in the program"
    assert ends, "the contour does not end in the program"
    return on_plane[begins[0] : ends[-1] + 1]


def largest(blocks: list[Block], distance: Callable[[Points], Floats]) -> float:
    """The largest distance of the tool center from a contour."""
    return max(float(np.max(np.abs(distance(block.points())))) for block in blocks)


def way(blocks: list[Block]) -> float:
    """The length of the true path [mm]."""
    return sum(float(np.sum(np.abs(np.diff(block.points(65))))) for block in blocks)


def fastest(blocks: list[Block], method: str) -> tuple[float, float]:
    """The largest speed of the tool in a block [mm/min]: on the average, and anywhere within."""
    average = local = 0.0
    for block in blocks:
        steps = np.abs(np.diff(block.points(65)))
        minutes = block.minutes(method)
        average = max(average, float(steps.sum()) / minutes)
        local = max(local, float(steps.max()) * len(steps) / minutes)
    return average, local


# ---- contours by closed forms: distance of points from them ----


def from_circle(center: complex, radius: float) -> Callable[[Points], Floats]:
    return lambda points: np.abs(points - center) - radius


def from_polygon(sides: int, apothem: float) -> Callable[[Points], Floats]:
    """A regular polygon about the center, with a flat across the first axis."""
    normals = np.exp(2j * np.pi * np.arange(sides) / sides)
    return lambda points: np.max((points[:, None] * np.conj(normals)).real, axis=1) - apothem


def from_flattened_circle(radius: float, flat: float) -> Callable[[Points], Floats]:
    """A circle about the center that is cut off at X = flat (D)."""
    return lambda points: np.maximum(np.abs(points) - radius, points.real - flat)


def from_slot(middle: complex, half: float, radius: float) -> Callable[[Points], Floats]:
    """A slot with round ends along the first axis."""

    def distance(points: Points) -> Floats:
        offset = points - middle
        return np.hypot(np.maximum(np.abs(offset.real) - half, 0), offset.imag) - radius

    return distance


def from_line(start: complex, end: complex) -> Callable[[Points], Floats]:
    along = (end - start) / abs(end - start)
    return lambda points: ((points - start) * np.conj(along)).imag
