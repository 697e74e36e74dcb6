"""
The data that a page draws of one program, embedded in the page as JSON.

Lengths are in mm on the polar plane, x as a radius; angles in deg, rates per min, times in s; null is unknown. The
columns of a table have the same length.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import msgspec

if TYPE_CHECKING:
    from polarcheck.foundation.finding import Finding

#: How a move is drawn. corner: a line that the control adds at an outside corner. unknown: the move runs in offset mode
#: and R or the position is unknown, so that the programmed path is drawn.
Role = Literal["positioning", "cut", "start up", "cancel", "corner", "unknown"]


class Points(msgspec.Struct, frozen=True, kw_only=True):
    """
    A path as points; arcs are chords, and a gap in the path is a null.

    x, c: [mm].
    move: the move that leads to each point, in the table of moves; on the programmed path the first move of its block.
        The first point after a gap has the move that begins there.
    """

    x: list[float | None]
    c: list[float | None]
    move: list[int | None]


class Writing(msgspec.Struct, frozen=True, kw_only=True):
    """
    How the program writes a point of the plane.

    linear, virtual: what stands before the numbers, as X and C, Y or C2=.
    virtual_diameter: the virtual axis is written as a diameter.
    origin: the zero of the program on the plane, [x, c] [mm]; null where the section changes it or it is not known.
    turn: the angle of the program's axes on the plane [deg].
    """

    linear: str = "X"
    virtual: str = "C"
    virtual_diameter: bool = False
    origin: tuple[float, float] | None = (0.0, 0.0)
    turn: float = 0.0


class MoveTable(msgspec.Struct, frozen=True, kw_only=True):
    """
    The moves of the tool center in a section, in order; in moves of Z alone x and c stand still.

    line: the line in the file.
    number: the N word as written, empty if there is none.
    block: the text of the block, at most 120 characters.
    role: how it is drawn.
    start, end: [x, c] [mm].
    z: before and after [mm].
    feed: programmed F as a rate along the path [mm/min].
    true_feed: the feed that override and clamp leave, the lowest in the move [mm/min].
    nearest: the smallest distance to the center [mm].
    c_feed, x_feed: the highest rates at the true feed [deg/min], [mm/min].
    share: c_feed as a share of the limit of C, null without a limit.
    begin: the start in the section, as in Rates [s].
    time: the duration [s].
    center: [x, c] of the center of an arc [mm], null for other moves.
    jump: C would have to turn at once at the center: the move passes it, or begins there in another direction.
    angle: C as the control shows it, before and after [deg].
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
    center: list[tuple[float, float] | None]
    jump: list[bool]
    angle: list[tuple[float | None, float | None]]


class Rates(msgspec.Struct, frozen=True, kw_only=True):
    """
    Curves over the time of a section. A move of unknown time has no points.

    Between two points of a move all columns but `move` are nearly straight: x, c, z and machine_x within 0.01 mm and
    angle within 0.1 deg, unless the page says that points are left out. Where C jumps, two points have the same time.

    t: [s].
    c_feed: the rate of C, with its sign [deg/min]; null where C jumps.
    x_feed, feed: [mm/min].
    move: the move in the table of moves.
    x, c: the center of the cutter on the plane [mm].
    z: [mm].
    angle: C as the control shows it, continuous along the section [deg].
    machine_x: the X axis, a radius, negative on a machine that stays on the negative side [mm].
    """

    t: list[float | None]
    c_feed: list[float | None]
    x_feed: list[float | None]
    feed: list[float | None]
    move: list[int | None]
    x: list[float | None]
    c: list[float | None]
    z: list[float | None]
    angle: list[float | None]
    machine_x: list[float | None]


class PartPicture(msgspec.Struct, frozen=True, kw_only=True):
    """
    The finished part at one Z.

    z: the depth [mm].
    polygons: rings of [x, c] [mm]; the first ring of each polygon is its outside.
    text: the shape in words, as in `polarcheck part`.
    known_outside: False if the polygon is cut off within the stock, so that its edge is no wall.
    """

    z: float | None
    polygons: list[list[list[tuple[float, float]]]]
    text: str
    known_outside: bool


class Mark(msgspec.Struct, frozen=True, kw_only=True):
    """
    An area that is overcut or left standing.

    kind: overcut or left.
    text: one line on it.
    lines: the line of the block that causes it and, if known, of the block whose wall it affects.
    place: [x, c] [mm].
    depth: its depth or height [mm].
    rings: the rings of the area, [x, c] [mm]; may be empty.
    """

    kind: Literal["overcut", "left"]
    text: str
    lines: list[int]
    place: tuple[float, float]
    depth: float
    rings: list[list[tuple[float, float]]]


class DrawnPart(msgspec.Struct, frozen=True, kw_only=True):
    """
    What the job asks for, a drawing or a shape.

    title: the name of the drawing, or the shape.
    z: the depth that it was compared at [mm].
    agrees: what is made agrees with it; null if nothing was compared with it.
    rings: its closed curves as points [x, c] [mm], the last of which is joined to the first.
    lines: its open curves, likewise.
    """

    title: str
    z: float | None
    agrees: bool | None
    rings: list[list[tuple[float, float]]]
    lines: list[list[tuple[float, float]]]


class FindingPicture(msgspec.Struct, frozen=True, kw_only=True):
    """
    A finding, as it is shown.

    section: its number among the pictures of sections: of its block or, outside sections, of the nearest one; null if
        nothing is drawn.
    move: the move at its place or, without one of its block, the nearest one of the section; null without moves.
    silenced: what silences it, empty if nothing does.
    places: where it is on the face, [x, c] [mm]; several if it stands for several blocks.
    span: the width of a window that shows it at its own scale [mm]; null if it has no scale, or no place.
    also: the other lines that it stands for.
    is_beside: its block is not on the drawn path.
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
    places: list[tuple[float, float]] = []
    span: float | None = None
    also: list[int] = []
    is_beside: bool = False


class SectionPicture(msgspec.Struct, frozen=True, kw_only=True):
    """
    One polar section.

    title: its lines and tool.
    line, end_line: its first and last line.
    channel: its channel, empty if there is only one.
    units: the units of the program there and of the labels, mm or inch.
    scale: one unit in mm.
    diameter: X is written as a diameter.
    radius: the radius of the cutter [mm].
    radius_source: where the radius comes from.
    stock: the diameter of the stock [mm].
    keep_out: the radius of the keep-out zone around the center [mm].
    c_limit, x_limit, feed_limit: the limits of the machine [deg/min], [mm/min], [mm/min].
    needs_radius: why no tool path is drawn, empty if one is.
    thinned: the largest deviation of the drawn paths [mm].
    played: the largest deviation of the positions over time [mm].
    time: [s].
    programmed, tool: the paths.
    moves: the moves of the tool center; some are left out if there are very many.
    rates: the rates over time.
    parts: the finished part at each depth.
    marks: areas that are overcut or left standing.
    move_count: the number of all moves.
    makes: the shapes that it makes, all depths together, as in `polarcheck part`, with what is left standing.
    remarks: what is not drawn, and why; what is drawn as meant and not as the control reads it.
    writing: how the program writes a point.
    frame: [x0, c0, x1, c1] of all that is drawn, with the cutter, the stock and the center [mm].
    entry: C where the x of the plane lies on the X axis, which is C at G12.1 [deg].
    entry_known: False if nothing says C there, and it is taken as 0.
    sense: 1 where C grows with the angle on the plane, -1 where it falls.
    face: Z of the face, above which nothing is cut; null if it is not known [mm].
    bar: rings of the bar before milling [mm], its outside first, then its bore; empty if it is not known.
    drawing: the lines of the part asked for, where the comparison has placed it.
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
    played: float = 0.0
    makes: list[str] = []
    remarks: list[str] = []
    writing: Writing = Writing()
    frame: tuple[float, float, float, float] = (-1.0, -1.0, 1.0, 1.0)
    entry: float = 0.0
    entry_known: bool = True
    sense: int = 1
    face: float | None = None
    bar: list[list[tuple[float, float]]] = []
    drawing: list[DrawnPart] = []


class Picture(msgspec.Struct, frozen=True, kw_only=True):
    """
    One program.

    path: the path of the file.
    verdict: the verdict in words.
    summary: the numbers of findings, sections and blocks.
    head: label and text of each line above the pictures: machine, units, what the verdict rests on, assumptions.
    not_evaluated: a line for each reason.
    findings: the findings, silenced ones included.
    sections: the pictures of the sections.
    source: the lines of the file, long ones shortened; a part of them if there are very many.
    source_line: the number of the first of these lines.
    source_lines: the number of all lines of the file.
    """

    path: str
    verdict: str
    summary: str
    head: list[tuple[str, str]]
    not_evaluated: list[str]
    findings: list[FindingPicture]
    sections: list[SectionPicture]
    source: list[str] = []
    source_line: int = 1
    source_lines: int = 0


class FindingLocation(msgspec.Struct, frozen=True, kw_only=True):
    """
    The place of a finding on the face, as in FindingPicture.

    section, move: as in FindingPicture; section is the number among all pictures of the program.
    """

    section: int | None
    move: int | None
    places: list[tuple[float, float]]
    span: float | None
    also: list[int]
    is_beside: bool


#: Identifies a finding of a file: its rule, line, column and channel.
Key = tuple[str, int, int, str]


def key_of(finding: Finding) -> Key:
    """Return what identifies a finding of a file."""
    return finding.rule, finding.line, finding.column, finding.channel or ""


class Drawn(msgspec.Struct, frozen=True, kw_only=True):
    """
    The drawing of a program.

    sections: the pictures of the sections.
    skip: the state of block skip that is drawn, empty if it makes no difference.
    remarks: what is not drawn of the whole program, and why.
    places: where its findings are.
    source, source_line, source_lines: as in Picture.
    """

    sections: list[SectionPicture]
    skip: str
    remarks: list[str]
    places: dict[Key, FindingLocation] = {}
    source: list[str] = []
    source_line: int = 1
    source_lines: int = 0
