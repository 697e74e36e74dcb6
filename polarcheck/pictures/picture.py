"""
What a page draws of one program: data only, as it stands in the page, in a script that is no program.

Lengths in mm on the polar plane, x as a radius; angles deg, rates per min, times s; null is unknown. Columns of one
table have the same length.
"""

from __future__ import annotations

from typing import Literal

import msgspec

#: What a move is drawn as. corner: a line that the control adds at an outside corner. unknown: run in offset mode
#: while R or the position is not known; nobody knows the way of the tool, and the programmed one stands here.
Role = Literal["positioning", "cut", "start up", "cancel", "corner", "unknown"]


class Points(msgspec.Struct, frozen=True, kw_only=True):
    """
    A path as points, arcs thinned to chords; where a move begins elsewhere than the last one ended there is a null.

    x, c: [mm]. move: the move of each point in the table of moves; of the programmed path its block's first move. What
    leads up to a point is of the point's move, so that the first point of a stretch has the move that begins there.
    """

    x: list[float | None]
    c: list[float | None]
    move: list[int | None]


class MoveTable(msgspec.Struct, frozen=True, kw_only=True):
    """
    The moves of the tool center in a section, in order, those of Z alone included, on which x and c stand still.

    line: in the file. number: the N word as written, empty without. block: text of the block, cut at 120 characters.
    role, z, feed [mm/min]: programmed F as a rate along the path. true_feed: what override and clamp leave of it.
    nearest [mm], c_feed [deg/min], x_feed [mm/min]: the highest at the true feed. share: of the limit of C, null
    without one. begin, time: when it begins in the section, as in Rates, and how long it takes [s].
    """

    line: list[int]
    number: list[str]
    block: list[str]
    role: list[Role]
    start: list[tuple[float | None, float | None]]
    end: list[tuple[float | None, float | None]]
    z: list[tuple[float | None, float | None]]
    feed: list[float | None]
    true_feed: list[float | None]
    nearest: list[float | None]
    c_feed: list[float | None]
    x_feed: list[float | None]
    share: list[float | None]
    begin: list[float | None]
    time: list[float | None]


class Rates(msgspec.Struct, frozen=True, kw_only=True):
    """
    Curves over the time of a section: t [s], c_feed [deg/min] with its sign, x_feed, feed [mm/min], the move.

    A move whose time is not known takes none, and has no point here.
    """

    t: list[float | None]
    c_feed: list[float | None]
    x_feed: list[float | None]
    feed: list[float | None]
    move: list[int | None]


class PartPicture(msgspec.Struct, frozen=True, kw_only=True):
    """
    The finished part at one Z: rings as lists of [x, c], the first of each polygon its outside. text: what it is, as in
    `polarcheck part`; known_outside: False where the polygon ends somewhere in the stock, and its edge is no wall.
    """

    z: float | None
    polygons: list[list[list[tuple[float, float]]]]
    text: str
    known_outside: bool


class Mark(msgspec.Struct, frozen=True, kw_only=True):
    """
    An area that is cut too much or left standing. lines: of the block that does it and, where one is known, of the one
    that it does it to. place: [x, c]. depth [mm]: how deep or high. rings: of the area, [x, c]; may be empty.
    """

    kind: Literal["overcut", "left"]
    text: str
    lines: list[int]
    place: tuple[float, float]
    depth: float
    rings: list[list[tuple[float, float]]]


class FindingPicture(msgspec.Struct, frozen=True, kw_only=True):
    """
    A finding as it is told. section: its number among the pictures of sections, null outside; move: the first move of
    its block there, null without one. silenced: by whom, empty for none.
    """

    rule: str
    severity: str
    message: str
    line: int
    block: str
    why: str
    alarm: str
    fix: str
    section: int | None
    move: int | None
    silenced: str


class SectionPicture(msgspec.Struct, frozen=True, kw_only=True):
    """
    One polar section. title: its lines and tool. units: of the program there, mm or inch, in which labels are; scale:
    mm in one of them. radius of the cutter, stock (diameter), keep_out [mm]; c_limit [deg/min], x_limit [mm/min],
    feed_limit [mm/min]: those that the machine has. diameter: whether X is written as a diameter there. needs_radius:
    why no tool path is drawn, empty where it is. thinned: how far thinned paths lie off the true ones at most [mm].
    move_count: of the section; in the table stand fewer where there are very many. makes: what it makes, all depths
    together, as in `polarcheck part`, with what is left standing. remarks: what is not drawn, and why.
    """

    title: str
    line: int
    end_line: int
    channel: str
    units: str
    scale: float
    diameter: bool
    radius: float | None
    radius_source: str
    stock: float | None
    keep_out: float | None
    c_limit: float | None
    x_limit: float | None
    feed_limit: float | None
    needs_radius: str
    thinned: float
    time: float | None
    programmed: Points
    tool: Points
    moves: MoveTable
    rates: Rates
    parts: list[PartPicture]
    marks: list[Mark]
    move_count: int = 0
    makes: list[str] = []
    remarks: list[str] = []


class Picture(msgspec.Struct, frozen=True, kw_only=True):
    """
    One program. head: label and text of each line above the pictures: machine, units, what the verdict rests on, what
    was assumed. not_evaluated: as the text report tells it.
    """

    path: str
    verdict: str
    summary: str
    head: list[tuple[str, str]]
    not_evaluated: list[str]
    findings: list[FindingPicture]
    sections: list[SectionPicture]


class Drawn(msgspec.Struct, frozen=True, kw_only=True):
    """
    What is drawn of a program, besides what its report says. skip: with which state of block skip it was run, empty
    where that makes no difference. remarks: what is not drawn of the whole program, and why.
    """

    sections: list[SectionPicture]
    skip: str
    remarks: list[str]
