"""Pictures of parts that are known by construction, made without the program that would make them."""

from __future__ import annotations

import math
from typing import Any

import msgspec

from polarcheck.view.picture_data import (
    FindingPicture,
    Mark,
    MoveTable,
    PartPicture,
    Picture,
    Points,
    Rates,
    SectionPicture,
)

FLATS = 6
R = 4.0
#: Half of what the hexagon measures across its flats.
HALF = 15.0


def corners(distance: float) -> list[tuple[float, float]]:
    """The corners of a hexagon whose flats are so far from the center, from the one at 30 deg on."""
    reach = distance / math.cos(math.pi / FLATS)
    angles = [math.pi / FLATS + number * math.pi / 3 for number in range(FLATS + 1)]
    return [(reach * math.cos(angle), reach * math.sin(angle)) for angle in angles]


def finding(message: str, *, line: int = 2, **more: Any) -> FindingPicture:
    """An error at a block; more: what else is known of it."""
    whole = {
        "rule": "c-feed-above-limit",
        "severity": "error",
        "block": f"N{line} G1",
        "why": "",
        "alarm": "",
        "fix": "",
    }
    return FindingPicture(
        **{**whole, "message": message, "line": line, "section": 0, "move": line - 1, "silenced": "", **more}
    )


def points(path: list[tuple[float, float]]) -> Points:
    """A path of which each line is a move."""
    moves: list[int | None] = [0, *range(len(path) - 1)]
    return Points(x=[x for x, _ in path], c=[c for _, c in path], move=moves)


def hexagon(*, blocks: list[str] | None = None, **more: Any) -> SectionPicture:
    """A hexagon 30 across, milled outside with R 4 at 200 mm/min, a move for each flat; more: fields that differ."""
    wall, way = corners(HALF), corners(HALF + R)
    count = FLATS
    length = math.dist(way[0], way[1])
    time = length / 200.0 * 60.0
    rate = math.degrees(200.0 / (HALF + R))
    near = math.degrees(200.0 * (HALF + R) / abs(complex(*way[0])) ** 2)
    moves = MoveTable(
        line=list(range(1, count + 1)),
        number=[f"N{number}" for number in range(1, count + 1)],
        block=blocks or [f"N{number} G1" for number in range(1, count + 1)],
        role=["cut"] * count,
        start=[*way[:-1]],
        end=[*way[1:]],
        z=[(-5.0, -5.0)] * count,
        feed=[200.0] * count,
        true_feed=[200.0] * count,
        nearest=[HALF + R] * count,
        c_feed=[rate] * count,
        x_feed=[100.0] * count,
        share=[rate / 500.0] * count,
        begin=[number * time for number in range(count)],
        time=[time] * count,
        center=[None] * count,
        jump=[False] * count,
        angle=[(30.0 + 60.0 * number, 90.0 + 60.0 * number) for number in range(count)],
    )
    stops = [
        (1 - part) * complex(*way[number]) + part * complex(*way[number + 1])
        for number in range(count)
        for part in (0.0, 0.5, 1.0)
    ]
    rates = Rates(
        t=[(number + part) * time for number in range(count) for part in (0.0, 0.5, 1.0)],
        c_feed=[near, rate, near] * count,
        x_feed=[-100.0, 0.0, 100.0] * count,
        feed=[200.0] * (3 * count),
        move=[number for number in range(count) for _ in range(3)],
        x=[point.real for point in stops],
        c=[point.imag for point in stops],
        z=[-5.0] * (3 * count),
        angle=[30.0 + 60.0 * (number + part) for number in range(count) for part in (0.0, 0.5, 1.0)],
        machine_x=[abs(point) for point in stops],
    )
    whole = SectionPicture(
        title="Lines 1 to 6, offset 1",
        line=1,
        end_line=6,
        channel="",
        units="mm",
        scale=1.0,
        diameter=True,
        radius=R,
        radius_source="command line",
        stock=60.0,
        keep_out=0.5,
        c_limit=500.0,
        x_limit=None,
        feed_limit=None,
        needs_radius="",
        thinned=0.002,
        time=count * time,
        programmed=points(wall),
        tool=points(way),
        moves=moves,
        rates=rates,
        parts=[PartPicture(z=-5.0, polygons=[[wall[:-1]]], text="hexagon, 30.000 across flats", known_outside=True)],
        marks=[],
        frame=(-32.0, -32.0, 32.0, 32.0),
        bar=[[(30.0 * math.cos(angle * math.pi / 32), 30.0 * math.sin(angle * math.pi / 32)) for angle in range(64)]],
    )
    return msgspec.structs.replace(whole, **more)


def notch(depth: float = 1.0) -> Mark:
    """A triangle cut into the flat at the right of the hexagon by its third block."""
    ring = [(HALF, -1.0), (HALF - depth, 0.0), (HALF, 1.0)]
    text = f"line 3 cuts {depth:.3f} mm into line 6"
    return Mark(kind="overcut", text=text, lines=[3, 6], place=ring[1], depth=depth, rings=[ring])


def picture(*sections: SectionPicture, findings: list[FindingPicture] | None = None, **more: Any) -> Picture:
    """A program with these sections."""
    whole = Picture(
        path="hexagon.nc",
        verdict="fail" if findings else "pass",
        summary=f"{len(findings or [])} findings",
        head=[("machine", "a lathe"), ("radius", "R 4.000 (command line)")],
        not_evaluated=[],
        findings=findings or [],
        sections=list(sections),
    )
    return msgspec.structs.replace(whole, **more)
