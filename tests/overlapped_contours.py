"""
Closed contours that run on past their start, with what they enclose by construction.

    overlapped = contour(7)
    overlapped.drawn.text(), overlapped.area

Their walls lie at any angle, so that rounding moves the end to one side of the wall that it follows. Corners are arcs
or many short chords; leads are perpendicular, tangent, or arcs, as ramps or in offset mode; the tool is tiny or large.
"""

from __future__ import annotations

import cmath
import math
import random
from typing import NamedTuple

from drawn_contours import CONTROLS, Control, Drawn, Element

LEADS = ("ramp", "perpendicular", "tangent", "arc")


class Overlapped(NamedTuple):
    """A contour; what it encloses [mm2] and the length of its walls [mm], without roundings."""

    drawn: Drawn
    area: float
    around: float


def contour(seed: int, control: Control | None = None) -> Overlapped:
    """A contour of three to six sides."""
    draw = random.Random(seed)  # noqa: S311 - contours that can be drawn again
    sides = draw.choice((3, 4, 4, 4, 5, 6))
    size = draw.choice((8, 20, 20, 60))
    corners = [
        cmath.rect(draw.uniform(0.6, 1.1) * size, 2 * math.pi * (number + draw.uniform(-0.25, 0.25)) / sides)
        for number in range(sides)
    ]
    is_pocket = draw.random() < 0.3
    radius = draw.choice((0.3, 0.34, 0.5, 1) if is_pocket else (0.3, 0.34, 0.5, 1, 4, 8))
    corner = max(draw.uniform(0.02, 0.12) * size, 1.2 * radius if is_pocket else 0)
    chords = draw.choice((0, 4, 8, 16, 24))
    return overlapped(
        corners,
        corner,
        chords,
        radius,
        is_pocket=is_pocket,
        overlap=draw.choice((0, 0.1, 0.2, 0.5, 1, 2)),
        begin=draw.uniform(0.35, 0.65),
        leads=(draw.choice(LEADS), draw.choice(LEADS)),
        control=control or draw.choice(CONTROLS),
    )


def overlapped(
    corners: list[complex],
    corner: float,
    chords: int,
    radius: float,
    is_pocket: bool = False,
    overlap: float = 0.5,
    begin: float = 0.5,
    leads: tuple[str, str] = ("ramp", "ramp"),
    control: Control = CONTROLS[0],
    drift: complex = 0,
) -> Overlapped:
    """
    Such a contour round these corners, counterclockwise, from the middle of the side behind the first corner.

    corner: R of the corners [mm]. chords: so many stand for each corner, 0 for an arc. radius: R of the tool.
    drift: how far off its place it ends [mm].
    """
    rounds = [_rounded(corners, number, corner) for number in range(len(corners))]
    first, second = rounds[0][2], rounds[1][0]
    along = (second - first) / abs(second - first)
    start = first + begin * (second - first)
    air = along * (1j if is_pocket else -1j)
    elements, area, points = [], 0.0, []
    for number in [*range(1, len(corners)), 0]:
        begins, center, ends = rounds[number]
        turn = cmath.phase((ends - center) / (begins - center))
        steps = [center + (begins - center) * cmath.exp(1j * turn * step / chords) for step in range(1, chords + 1)]
        elements += [Element(begins), *(map(Element, steps) if chords else [Element(ends, center, turn > 0)])]
        points += [begins, *steps] if chords else [begins, ends]
        area += 0 if chords else corner**2 * (turn - math.sin(turn)) / 2
    end = start + overlap * along + drift
    elements.append(Element(end))
    area += sum((a.conjugate() * b).imag for a, b in zip(points, points[1:] + points[:1], strict=True)) / 2
    around = sum(abs(b - a) for a, b in zip(points, points[1:] + points[:1], strict=True))
    reach = 1.3 * radius * air
    begins, ends = (
        _away(kind, point, way, reach) for kind, point, way in ((leads[0], start, -along), (leads[1], end, along))
    )
    drawn = Drawn(
        "overlapped",
        begins,
        (
            *_leads(leads[0], start, start + reach, is_pocket),
            *elements,
            *_leads(leads[1], ends, end + reach, is_pocket),
        ),
        control,
        "G41" if is_pocket else "G42",
        (begins + ends) / 2 + 1.6 * radius * air,
        radius,
        by_radius=False,
        incremental=False,
        depths=(2.0,),
        has_arcs=not chords,
    )
    return Overlapped(drawn, area, around)


def _rounded(corners: list[complex], number: int, radius: float) -> tuple[complex, complex, complex]:
    """Where the arc round a corner begins, its center, and where it ends."""
    at = corners[number]
    back, ahead = (cmath.rect(1, cmath.phase(corners[(number + step) % len(corners)] - at)) for step in (-1, 1))
    half = abs(cmath.phase(ahead / back)) / 2
    middle = (back + ahead) / abs(back + ahead)
    return (
        at + back * radius / math.tan(half),
        at + middle * radius / math.sin(half),
        at + ahead * radius / math.tan(half),
    )


def _away(lead: str, point: complex, way: complex, reach: complex) -> complex:
    """The other end of a lead. way: unit vector away from the contour along its wall. reach: straight into the air."""
    aside = way * abs(reach)
    return {"ramp": point, "perpendicular": point + reach, "tangent": point + aside, "arc": point + reach + aside}[lead]


def _leads(lead: str, end: complex, center: complex, is_pocket: bool) -> list[Element]:
    """The blocks of a lead."""
    return [] if lead == "ramp" else [Element(end, center if lead == "arc" else None, is_pocket)]
