"""
Corners that a control makes between two moves (RND=, RNDM=, CHR=, CHF=): the program with the word and the one with the
arc or the chamfer written out are the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of

from polarcheck.foundation.states import Motion
from polarcheck.geometry.made_corners import CornerPairs
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.reports.made_parts.part_report import in_one_line, made_by
from polarcheck.rewrite.feeds.feed_edits import with_feeds
from polarcheck.rewrite.feeds.table import feed_table

MACHINE = "siemens-transmit"
HEAD = "T8 D1\nG94 S2=1000 M2=3\nDIAMOF\nG0 X60 C0 Z5\nTRANSMIT\nG17\nG1 Z-5 F200\n"
TAIL = "G40 X60\nG0 Z5\nTRAFOOF\nM2=5\nM30\n"
TOOL = "8:radius=4,nose=0"


class Element(NamedTuple):
    """A line or an arc to a point; turning: 1 CCW, -1 CW, 0 a line. word: the corner at its end."""

    end: complex
    word: str = ""
    center: complex | None = None
    turning: int = 0


def line(x: float, y: float, word: str = "") -> Element:
    return Element(complex(x, y), word)


def arc(x: float, y: float, i: float, j: float, turning: int, word: str = "") -> Element:
    """An arc to a point about a center, both as coordinates."""
    return Element(complex(x, y), word, complex(i, j), turning)


def back(element: Element, start: complex, way: float) -> tuple[complex, complex]:
    """The point so far before the end of an element, and the direction there."""
    if element.center is None:
        direction = (element.end - start) / abs(element.end - start)
        return element.end - way * direction, direction
    spoke = element.end - element.center
    turned = spoke * np.exp(-1j * element.turning * way / abs(spoke))
    return element.center + turned, 1j * element.turning * turned / abs(turned)


def leaving(element: Element, start: complex) -> complex:
    """The direction at the start of an element."""
    if element.center is None:
        return (element.end - start) / abs(element.end - start)
    spoke = start - element.center
    return 1j * element.turning * spoke / abs(spoke)


def rounded(start: complex, first: Element, second: Element, radius: float) -> tuple[complex, complex, complex, int]:
    """
    Start, end and center of the arc in a corner, and its sense: found by walking back along the first element until a
    circle that touches it there touches the second one, too.
    """
    arriving = back(first, start, 0.0)[1]
    side = 1 if (leaving(second, first.end) * arriving.conjugate()).imag > 0 else -1

    def center_at(way: float) -> complex:
        point, direction = back(first, start, way)
        return point + 1j * side * radius * direction

    def misses(way: float) -> float:
        center = center_at(way)
        if second.center is None:
            direction = leaving(second, first.end)
            return side * ((center - first.end) * direction.conjugate()).imag - radius
        of_circle = abs(first.end - second.center) - side * second.turning * radius
        return abs(center - second.center) - of_circle

    low = 1e-9
    high = next(way for way in np.arange(0.01, 60, 0.01) if misses(way) * misses(low) <= 0)
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if misses(middle) * misses(low) > 0 else (low, middle)
    center = center_at(low)
    if second.center is None:
        direction = leaving(second, first.end)
        end = first.end + direction * ((center - first.end) * direction.conjugate()).real
    else:
        spoke = center - second.center
        end = second.center + spoke / abs(spoke) * abs(first.end - second.center)
    return back(first, start, low)[0], end, center, side


def chamfered(start: complex, first: Element, second: Element, leg: float) -> tuple[complex, complex]:
    return back(first, start, leg)[0], first.end + leg * leaving(second, first.end)


def block(start: complex, element: Element, word: str = "") -> str:
    end = element.end
    to = f"X={end.real:.12f} Y={end.imag:.12f}"
    if element.center is None:
        return f"G1 {to} {word}\n"
    of_center = element.center - start
    return f"G{2 if element.turning < 0 else 3} {to} I={of_center.real:.12f} J={of_center.imag:.12f} {word}\n"


def with_words(start: complex, elements: Sequence[Element]) -> Iterator[str]:
    for element in elements:
        yield block(start, element, element.word)
        start = element.end


def written_out(start: complex, elements: Sequence[Element], modal: float = 0.0) -> Iterator[str]:
    """The blocks with the corners as moves of their own."""
    begins = start
    for index, element in enumerate(elements):
        name, _, number = element.word.partition("=")
        size = float(number or 0)
        modal = size if name == "RNDM" else modal
        if name in ("", "RNDM"):
            name, size = "RND", modal
        following = elements[index + 1] if index + 1 < len(elements) else None
        if not size or following is None:
            yield block(begins, element)
            begins = start = element.end
            continue
        if name == "RND":
            first, last, center, turning = rounded(start, element, following, size)
            corner = Element(last, "", center, turning)
        else:
            turn = leaving(following, element.end) * back(element, start, 0)[1].conjugate()
            leg = size if name == "CHR" else size / 2 / math.cos(abs(math.atan2(turn.imag, turn.real)) / 2)
            first, last = chamfered(start, element, following, leg)
            corner = Element(last)
        yield block(begins, element._replace(end=first)) + block(first, corner)
        start, begins = element.end, last


SQUARE = [line(20, 15, "RND=4"), line(-20, 15, "CHR=3"), line(-20, -15, "CHF=2.5"), line(20, -15, "RND=6"), line(20, 1)]
OBLIQUE = [line(25, 6, "RND=3"), line(-4, 22, "CHF=3"), line(-18, 2, "CHR=2"), line(3, -19, "RND=2.5"), line(20, 1)]
BESIDE_ARCS = [
    line(20, 10, "RND=3"),
    arc(-20, 10, 0, 5, 1, "RND=2"),
    line(-20, -10, "RND=4"),
    arc(0, -20, -5, -5, 1, "RND=1.5"),
    arc(10 + 10 * math.cos(math.pi / 6), -15, 10, -20, -1, "RND=2"),
    line(20, 1),
]
MODAL = [line(20, 15, "RNDM=3"), line(-20, 15), line(-20, -15, "CHR=2"), line(20, -15, "RNDM=0"), line(20, 1)]


def whole(blocks: Iterator[str], head: str = HEAD, tail: str = TAIL) -> str:
    return head + "".join(blocks) + tail


def compare(program: str, twin: str, *tools: str) -> None:
    """Path, rates, part and findings are the same."""
    ours, theirs = (tables_of(text, MACHINE, *tools) for text in (program, twin))
    assert len(ours["run"].corners.row) > 0
    for column in ("start", "end", "center", "kind", "feed", "c_feed", "known", "phase"):
        pair = (getattr(tables["moves"], column) for tables in (ours, theirs))
        np.testing.assert_allclose(*pair, rtol=1e-7, atol=1e-8, equal_nan=True, err_msg=column)
    if not tools:
        return
    assert in_one_line(ours) == in_one_line(theirs)
    reports = [report_of(text, MACHINE, *tools) for text in (program, twin)]
    rules = [sorted((one.rule, one.severity) for one in report.findings) for report in reports]
    assert rules[0] == rules[1]
    assert reports[0].verdict == reports[1].verdict


@pytest.mark.nightly
@looped("side", ["G42", "", "G41"], one_in=5)
@looped("elements", [SQUARE, OBLIQUE, BESIDE_ARCS, MODAL], ids=["square", "oblique", "arcs", "modal"])
def test_the_corner_is_the_one_that_is_written_out(elements: list[Element], side: str) -> None:
    start = 20 + 1j
    head = HEAD + f"G1 {side} X20 Y1 F300\n"
    program, twin = whole(with_words(start, elements), head), whole(written_out(start, elements), head)
    compare(program, twin, TOOL)
    compare(program, twin)


#: A contour with corners, and its end: R 4, a leg of 3, a length of 3 (legs of 3 / sqrt 2) and F of the block behind.
_PLAIN = "G1 G42 X20 Y1 F300\n{}"
_WRITTEN = """X20 Y11
G3 X16 Y15 CR=4
G1 X-17 Y15
X-20 Y12
X-20 Y-15
X20 Y-15
Y1
"""
_ALIKE = [
    ("Y15 RND=4\nX-20 CHR=3\nY-15\nX20\nY1\n", _WRITTEN),
    # Small letters, blanks, a parameter, and both words, of which the radius counts.
    ("R1=0\nY15 rnd = 4\nX-20 CHR=R1+3 ; chamfer\nY-15\nX20\nY1\n", _WRITTEN),
    ("Y15 CHR=3 RND=4\nX-20 CHR=3\nY-15\nX20\nY1\n", _WRITTEN),
    # Increments count from the corner, not from where the arc ends.
    ("G91\nY14 RND=4\nX-40 CHR=3\nY-30\nX40\nY16\nG90\n", _WRITTEN),
    ("Y=IC(14) RND=4\nX=IC(-40) CHR=3\nY-15\nX20\nY1\n", _WRITTEN),
    # Up to three blocks without a move may stand between.
    ("Y15 RND=4\nM8\nR5=3\nX-20 CHR=3\nM9\nY-15\nX20\nY1\n", _WRITTEN.replace("G1 X-17", "M8\nG1 X-17")),
    # A modal radius, ended before the last corners; a chamfer in its block counts before it; 0 makes none.
    ("Y15 RNDM=4\nX-20 CHR=3\nY-15 RNDM=0\nX20\nY1\n", _WRITTEN),
    ("RNDM=4\nY15\nX-20 CHR=3\nRNDM=0 Y-15\nX20 RND=0\nY1\n", _WRITTEN),
    # In a loop, and F of the block that leads away.
    ("FOR R2=1 TO 2\nY15 RND=4\nX-20 CHR=3\nY-15\nX20\nY1\nENDFOR\n", 2 * _WRITTEN),
    ("Y15 RND=4\nX-20 F250 CHR=3\nY-15\nX20\nY1\n", _WRITTEN.replace("G3 X16 Y15", "G3 X16 Y15 F250")),
    # The plane is turned and shifted; X is a diameter; inches.
    ("ROT RPL=30\nX20 Y1\nY15 RND=4\nX-20 CHR=3\nY-15\nX20\nY1\nROT\n", f"ROT RPL=30\nX20 Y1\n{_WRITTEN}ROT\n"),
    ("ATRANS X3 Y2\nX20 Y1\nY15 RND=4\nX-20 CHR=3\nY-15\nX20\nY1\nTRANS\n", f"ATRANS X3 Y2\nX20 Y1\n{_WRITTEN}TRANS\n"),
    (
        "DIAMON\nY15 RND=4\nX-40 CHR=3\nY-15\nX40\nY1\nDIAMOF\n",
        "DIAMON\nY11\nG3 X32 Y15 CR=4\nG1 X-34\nX-40 Y12\nY-15\nX40\nY1\nDIAMOF\n",
    ),
    (
        "G700\nX.8 Y.1\nY.7 RND=.125\nX-.8 CHR=.1\nY-.7\nX.8\nY.1\nG710\n",
        "G700\nX.8 Y.1\nY.575\nG3 X=.8-.125 Y.7 CR=.125\nG1 X-.7\nX-.8 Y.6\nY-.7\nX.8\nY.1\nG710\n",
    ),
    # An arc of more than half a circle keeps its center where the corners cut off a part of it.
    (
        "Y5 RND=1\nG3 X20 Y-5 CR=-21\nG1 Y1\n",
        None,
    ),
    # What a corner leaves of a move may be nothing.
    (
        "Y15 RND=5\nX10 RND=5\nY25\nX-20 Y-15\nX20\nY1\n",
        "Y10\nG3 X15 Y15 CR=5\nG2 X10 Y20 CR=5\nG1 Y25\nX-20 Y-15\nX20\nY1\n",
    ),
]


@pytest.mark.nightly
@looped(("contour", "twin"), _ALIKE, ids=map(str, range(len(_ALIKE))), one_in=4)
def test_a_corner_of_each_form_is_the_one_that_is_written_out(contour: str, twin: str | None) -> None:
    if twin is None:
        height, radius = 5.0, 21.0
        center = complex(20 - math.sqrt(radius**2 - height**2), 0)
        elements = [line(20, 5, "RND=1"), arc(20, -5, center.real, 0, 1), line(20, 1)]
        twin = "".join(written_out(20 + 1j, elements))
    program, written = (HEAD + _PLAIN.format(text) + TAIL for text in (contour, twin))
    compare(program, written, TOOL)


@looped(
    ("radius", "turn"), [(radius, turn) for radius in (0.5, 2.0) for turn in (-150, -90, -30, 0.01, 45, 90, 135, 175)]
)
def test_the_arc_touches_both_lines(radius: float, turn: float) -> None:
    """Its tangent points lie R tan(turn / 2) from the corner, and its length is R times the turn."""
    direction = np.exp(1j * np.radians(turn))
    none = np.array([complex("nan+nanj")])
    one = np.array([1], np.int16)
    before = PlanePath(np.array([-100.0 + 3j]), np.array([3j]), none, one)
    after = PlanePath(np.array([3j]), np.array([3j + 100 * direction]), none, one)
    pairs = CornerPairs(before, after, np.array([radius]), np.array([0.0]))
    made = pairs.made()
    away = radius * math.tan(abs(math.radians(turn)) / 2)
    assert made.start[0] == pytest.approx(3j - away)
    assert made.end[0] == pytest.approx(3j + away * direction)
    assert made.length[0] == pytest.approx(radius * abs(math.radians(turn)))
    assert made.kind[0] == (Motion.CCW if turn > 0 else Motion.CW)
    assert [float(way[0]) for way in pairs.cut_off(made)] == pytest.approx([away, away])


_NOT_MADE = [
    ("Y15 RND=20\nX-20\nY-15\nX20\nY1\n", "RND=20 is not simulated: it is too large"),
    ("Y15 CHR=14.1\nX-20\nY-15\nX20\nY1\n", "CHR=14.1 is not simulated: it is too large"),
    # Each of both fits alone: together they need more than the move between them has.
    ("Y15 RND=8\nX5 RND=8\nY25\nX-20 Y-15\nX20\nY1\n", "RND=8 is not simulated: it is too large"),
    ("Y15 RND=4\nG0 X-20\nG1 Y-15\nX20\nY1\n", "RND=4 is not simulated: the corner is not one"),
    ("Y15 RND=4\nZ-6\nX-20\nY-15\nX20\nY1\n", "RND=4 is not simulated: the corner is not one"),
    ("Y15 RND=4\nM8\nM9\nM8\nM9\nX-20\nY-15\nX20\nY1\n", "RND=4 is not simulated: the corner is not one"),
    ("Y15\nRND=4\nX-20\nY-15\nX20\nY1\n", "RND=4 is not simulated: the corner is not one"),
    ("Y15\nX-20\nY-15\nX20\nY1 RND=2\n", "RND=2 is not simulated: cutter compensation changes"),
    ("Y15\nX-20\nY-15\nX20\nY1 RNDM=2\n", "RNDM=2 is not simulated: cutter compensation changes"),
    ("Y15 CHR=2\nG3 X-20 Y15 CR=21\nG1 Y-15\nX20\nY1\n", "CHR=2 is not simulated: how the control lays a chamfer"),
    ("Y15 RND=-4\nX-20\nY-15\nX20\nY1\n", "RND=-4 is not simulated: a size below 0"),
    ("Y15\nX-20 CHF=-1\nY-15\nX20\nY1\n", "CHF=-1 is not simulated: a size below 0"),
    ("Y15 RND=2\nY-15\nX20\nY1\n", "RND=2 is not simulated: it is too large"),
    ("Y15 RND=R99\nX-20\nY-15\nX20\nY1\n", ""),
]


@pytest.mark.nightly
@looped(("contour", "reason"), _NOT_MADE)
def test_a_corner_that_is_not_known_is_not_evaluated(contour: str, reason: str) -> None:
    report = report_of(HEAD + _PLAIN.format(contour) + TAIL, MACHINE, TOOL)
    reasons = [one.reason for one in report.not_evaluated if one.rule == "all" and one.matters]
    assert report.verdict != "pass"
    assert not reason or [one.startswith(reason) for one in reasons] == [True]
    assert "corner-word-in-polar" not in {rule for _, rule in said(report)}
    shapes = made_by(tables_of(HEAD + _PLAIN.format(contour) + TAIL, MACHINE, TOOL))
    expected = (
        "its contour leaves nothing" if "RND=2\nY-15" in contour else "corners not simulated: the rounds" * bool(reason)
    )
    assert all((shape.needs or "").startswith(expected) for shape in shapes)


@pytest.mark.nightly
@looped(
    "contour",
    [
        # Nothing is to be made where the moves are tangent, behind the contour, and where Z moves next.
        "Y15 RNDM=2\nY20\nX-20\nY-15\nX20\nY1 RNDM=0\n",
        "Y15\nX-20\nY-15\nX20 RNDM=2\nZ-6\nRNDM=0\nY1\n",
    ],
)
def test_a_modal_radius_without_a_corner_says_nothing(contour: str) -> None:
    report = report_of(HEAD + _PLAIN.format(contour) + TAIL, MACHINE, TOOL)
    assert [one.reason for one in report.not_evaluated if one.rule == "all"] == []


def test_a_corner_outside_the_mode_changes_nothing() -> None:
    turned = "G0 X40 Z2\nG1 Z-20 RND=2 F200\nX50 CHF=1\nG0 X60 Z5\n"
    program = HEAD.replace("G0 X60 C0 Z5\n", turned + "G0 X60 C0 Z5\n") + _PLAIN.format("Y15\nX-20\nY-15\nX20\nY1\n")
    assert [one.reason for one in report_of(program + TAIL, MACHINE, TOOL).not_evaluated if one.rule == "all"] == []


@pytest.mark.ci
def test_a_lathe_may_make_corners_by_words_with_a_comma() -> None:
    head = "O1\nG98 G0 X60. C0\nT0808\nG12.1\nG1 G42 X40. F200\n"
    program = head + "C15. ,R4.\nX-40. ,C3.\nC-15.\nX40.\nC0\nG40 X60.\nG13.1\nM30\n"
    changes = {"arcs": {"made_corners": {",R": "radius", ",C": "leg"}}}
    tables = tables_of(program, "fanuc", TOOL, changes=changes)
    assert "1 corner R4.000, 1 chamfered 3.000, 2 sharp" in in_one_line(tables)
    assert "corner-word-in-polar" not in {rule for _, rule in said(report_of(program, "fanuc", TOOL, changes=changes))}
    assert [line for line, rule in said(report_of(program, "fanuc", TOOL)) if rule == "corner-word-in-polar"] == [6, 7]


def test_the_feed_of_a_corner_is_that_of_the_block_behind_it() -> None:
    """The feed table counts the corner among what this block runs, and its F is low enough for both."""
    program = HEAD + _PLAIN.format("Y15 RND=4\nX-20\nY-15\nX20\nY1\n") + TAIL
    limit = {"limits": {"c_feed": 620.0}}
    tables = tables_of(program, MACHINE, TOOL, changes=limit)
    assert [(row.line, row.runs) for row in feed_table(tables).rows] == [(line, 1) for line in range(7, 15)]
    new = with_feeds("-", program.encode(), [tables], None)
    assert new is not None
    assert new.left == [9]  # words behind = are not edited
    for text, corners, lines in ((program, 1, {9, 10, 11, 12, 13}), (new.data, 0, {9})):
        edited = tables_of(text, MACHINE, TOOL, changes=limit)
        exceeds, trace = edited["tool_center"].exceeds_c_feed_limit, edited["trace"]
        assert np.count_nonzero(exceeds & trace.axes.makes_corner) == corners
        assert set(trace.blocks.line[exceeds].tolist()) == lines
