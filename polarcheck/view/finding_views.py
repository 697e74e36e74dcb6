"""Where findings are on the face, which other lines they stand for, and how large a window shows them."""

from __future__ import annotations

import cmath
import contextlib
import enum
import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.checking.engine import Listed
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import Finding
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rules import places
from polarcheck.rules.hit import Hit
from polarcheck.rules.message import details_of
from polarcheck.rules.rule import Rule, load_all
from polarcheck.rules.tables import Tables
from polarcheck.view.drawn_moves import SectionMoves

#: The most rows of a finding that get a place, and other lines of it that are listed.
MOST = 500
#: Places of a finding that are looked up in the tables of its rule; others are those of their blocks.
_LOOKED_UP = 50
#: Values of findings that say how large the fault is, and how many times as wide the window is.
_SIZES, _OF_SIZE = ("depth", "height", "gap", "difference", "cut_away", "too_much", "largest"), 8.0
#: The same of distances from the center, of R, and of the way of a block.
_OF_DISTANCE, _OF_RADIUS, _OF_WAY = 8.0, 6.0, 3.0
#: Values of findings about ramps, whose scale is R.
_OF_RAMPS = ("length_needed",)
#: The narrowest window [mm].
_NARROWEST = 0.05
#: The width of a window at the center, if R is not known [mm].
_AT_CENTER = 5.0


#: Subjects of rules (rules/causes.py) that judge the contour as programmed.
_OF_CONTOUR = ("arc", "side", "outline", "compensation", "metal")


class Wanted(NamedTuple):
    """
    Lines of a file whose moves stay on the page however many there are.

    findings: the lines with findings; all points of their moves stay.
    also: the other lines that findings stand for; their moves stay in the table.
    """

    findings: Rows
    also: Rows


class Where(enum.Enum):
    """The part of a block that a finding is about: of the tool path its middle, or its point nearest to the center."""

    MOVE, NEAREST, CONTOUR, END_OF_CONTOUR = range(4)


class Spot(msgspec.Struct, frozen=True):
    """
    The place of a finding in its run.

    rows: the rows that it stands for, the row at fault first; empty if nothing is executed.
    known: the points of the first of these rows that are known from its values or its rule; NaN for others [mm].
    also: the other lines that it stands for.
    where: the part of a block that it is about.
    span: as in FindingPicture.
    """

    rows: list[int]
    known: list[complex]
    also: list[int]
    where: Where
    span: float | None


class Spots:
    """The places of the findings of one run, without what a page lists of its sections."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.trace: Trace = tables["trace"]

    @property
    def channel(self) -> str:
        """The channel of the run, empty if there is only one."""
        return self.trace.text.source.channel

    @cached_property
    def _elements(self) -> dict[tuple[str, int, int], Rows]:
        """The elements that each finding stands for, by rule, line and column."""
        listed: dict[str, Listed] = self.tables.get("listed", {})
        elements: dict[tuple[str, int, int], Rows] = {}
        for rule, of_rule in listed.items():
            order = np.argsort(of_rule.finding, kind="stable")
            bounds = np.searchsorted(of_rule.finding[order], np.arange(len(of_rule.findings) + 1))
            for number, finding in enumerate(of_rule.findings):
                indices = of_rule.index[order[bounds[number] : bounds[number + 1]]]
                elements.setdefault((rule, finding.line, finding.column), indices)
        return elements

    @cached_property
    def _lines(self) -> tuple[Rows, Rows]:
        """The rows in the order of their lines in the file, and these lines."""
        line = self.trace.blocks.line_in_file
        order = np.argsort(line, kind="stable")
        return order, line[order]

    def has(self, finding: Finding) -> bool:
        """Return True if the run has this finding."""
        return (finding.rule, finding.line, finding.column) in self._elements

    def of(self, finding: Finding) -> Spot:
        """Return the place of a finding of the file."""
        rows, also = self._rows(finding)
        values, rule = finding.values, load_all().get(finding.rule)
        where = Where.MOVE
        if "nearest" in values or (rule is not None and "center" in rule.parameters):
            where = Where.NEAREST
        elif "end_radius" in values:
            where = Where.END_OF_CONTOUR
        elif rule is not None and rule.subject in _OF_CONTOUR:
            where = Where.CONTOUR
        span = self._span(finding, rows[0], where) if rows else None
        return Spot(rows, self._known_points(finding, rule, rows), also, where, span)

    def _known_points(self, finding: Finding, rule: Rule | None, rows: Sequence[int]) -> list[complex]:
        """Return the points that the values of a finding give, and the rule gives for its other rows [mm]."""
        x, c = finding.values.get("plane_x"), finding.values.get("plane_c")
        if not isinstance(x, float | int) or not isinstance(c, float | int):
            return []
        points = [complex(x, c)]
        if rule is not None and rule.over == "rows":
            for row in rows[1:_LOOKED_UP]:
                with contextlib.suppress(TooHardError):
                    details = details_of(rule, self.tables, Hit(self.trace, places.of_row(self.tables, row), []))
                    points.append(complex(details["plane_x"], details["plane_c"]))
        return points

    def _rows(self, finding: Finding) -> tuple[list[int], list[int]]:
        """Return the rows of a finding, those of its line first, and its other lines."""
        trace = self.trace
        order, lines = self._lines
        low, high = np.searchsorted(lines, [finding.line, finding.line + 1])
        of_line = order[low:high]
        if not len(of_line) and low:
            # Text between blocks, or behind them: the block before it.
            of_line = order[low - 1 : low]
        elif not len(of_line):
            of_line = order[:1]
        elements, rule = self._elements.get((finding.rule, finding.line, finding.column)), load_all().get(finding.rule)
        if elements is None or rule is None:
            return of_line[:MOST].tolist(), []
        row = places.rows(rule.over, self.tables)[elements]
        line = trace.text.blocks.line[places.blocks(rule.over, self.tables)[elements]]
        line[row >= 0] = trace.blocks.line_in_file[row[row >= 0]]
        is_own = line == finding.line
        row = np.concatenate([row[is_own], row[~is_own]])
        also = np.unique(line[~is_own])[:MOST].tolist() if finding.count > 1 else []
        return (row[row >= 0] if (row >= 0).any() else of_line)[:MOST].tolist(), also

    def _span(self, finding: Finding, row: int, where: Where) -> float | None:
        values = finding.values
        radius = self._number(values.get("radius")) or abs(float(self.trace.compensation.radius_of_move[row]))
        size = max((self._number(values.get(name)) for name in _SIZES), default=0.0)
        size = size or abs(self._number(values.get("start_radius")) - self._number(values.get("end_radius")))
        if size > 0:
            span = _OF_SIZE * size
        elif where == Where.NEAREST:
            near = self._number(values.get("nearest"))
            span = _OF_DISTANCE * near if near > ZERO else _OF_RADIUS * radius if radius > 0 else _AT_CENTER
        elif any(name in values for name in _OF_RAMPS):
            span = _OF_RADIUS * radius
        else:
            span = _OF_WAY * float(self.trace.path.length[row])
            if radius > 0 and "radius" in values:
                span = min(span, _OF_RADIUS * radius)
        return max(span, _NARROWEST) if span > 0 else None

    @staticmethod
    def _number(value: object) -> float:
        return float(value) if isinstance(value, float | int) and math.isfinite(value) else 0.0


class Face:
    """Where the tool stands on the faces of a run."""

    def __init__(self, table: SectionMoves) -> None:
        self.trace = table.trace
        self._table = table
        self._order = np.argsort(table.moves.row, kind="stable")
        self._rows = table.moves.row[self._order]

    def moves_of(self, row: int) -> Rows:
        """Return the moves of a row, in order."""
        low, high = np.searchsorted(self._rows, [row, row + 1])
        return self._order[low:high]

    def place(self, row: int, where: Where) -> complex:
        """Return the place of a row on its face [mm]; NaN if it is not known."""
        path = self.trace.path
        if path.travels[row] and not np.isnan(path.start[row] + path.end[row]):
            if where == Where.END_OF_CONTOUR:
                return complex(path.end[row])
            moves, indices = self._table.moves, self.moves_of(row)
            if where != Where.CONTOUR and len(indices) and self._table.is_known[move := self.move(row, where)]:
                single = moves[move : move + 1]
                return _nearest_point(single) if where == Where.NEAREST else _middle(single)
            center = path.center[[row]]
            kind = np.where(path.is_arc[[row]] & ~np.isnan(center), self.trace.axes.motion[[row]], Motion.LINE)
            return _middle(PlanePath(path.start[[row]], path.end[[row]], center, kind.astype(np.int16)))
        return self._standing(row)

    def move(self, row: int, where: Where) -> int:
        """Return the move of a row that is drawn for it, else the last move before it; -1 if there is none."""
        indices, moves = self.moves_of(row), self._table.moves
        if not len(indices):
            before = int(np.searchsorted(self._rows, row))
            return int(self._order[before - 1]) if before else -1
        is_nearest = where == Where.NEAREST and not np.isnan(moves.nearest[indices]).all()
        return int(
            indices[
                np.nanargmin(moves.nearest[indices]) if is_nearest else np.argmax(np.nan_to_num(moves.length[indices]))
            ]
        )

    def _standing(self, row: int) -> complex:
        """Return where the tool stands behind a row without a move on the plane [mm]."""
        trace, moves = self.trace, self._table.moves
        section = self.nearest_section(row)
        known_moves = np.flatnonzero((moves.section == section) & ~np.isnan(moves.start + moves.end))
        is_inside = trace.mode.section[row] >= 0
        if is_inside:
            before = int(np.searchsorted(moves.row[known_moves], row, side="right"))
            if before:
                return complex(moves.end[known_moves[before - 1]])
            point = complex(trace.path.end[row])
        elif section >= 0:
            # Where C is not known the tool is drawn on the X axis.
            turn = float(trace.path.c_angle[row]) - float(trace.path.section_entry[section])
            point = cmath.rect(float(trace.path.x[row]), math.radians(trace.path.c_axis.sense * np.nan_to_num(turn)))
        else:
            return complex(math.nan)
        if cmath.isnan(point) and len(known_moves):
            # Nobody knows where it stands there: where it is known next, or was known last.
            is_before = row < moves.row[known_moves[0]]
            point = complex(moves.start[known_moves[0]] if is_before else moves.end[known_moves[-1]])
        return point

    def nearest_section(self, row: int) -> int:
        """Return the section of a row or, outside sections, the nearest one; -1 if there is none."""
        mode = self.trace.mode
        if mode.section[row] >= 0:
            return int(mode.section[row])
        enter, leave = mode.sections.enter, mode.sections.leave
        following = int(np.searchsorted(enter, row))
        if following == len(enter):
            return following - 1
        if not following:
            return 0
        return following if enter[following] - row <= row - leave[following - 1] else following - 1


def _middle(move: PlanePath) -> complex:
    """Return the point in the middle of a single move, of an arc on the circle of its start [mm]."""
    start, end, center = complex(move.start[0]), complex(move.end[0]), complex(move.center[0])
    if move.is_arc[0]:
        return center + (start - center) * cmath.exp(0.5j * float(move.sweep[0]))
    return (start + end) / 2


def _nearest_point(move: PlanePath) -> complex:
    """Return the point of a single move that is nearest to the center of C [mm]."""
    start, end, center = complex(move.start[0]), complex(move.end[0]), complex(move.center[0])
    ends = min(start, end, key=abs)
    if move.is_arc[0]:
        if abs(center) <= ZERO:
            return start
        radius = abs(start - center)
        toward = center - center / abs(center) * radius
        sweep = float(move.sweep[0])
        turn = cmath.phase((toward - center) / (start - center)) if radius > ZERO else 0.0
        turn = turn % (2 * math.pi) if sweep > 0 else -(-turn % (2 * math.pi))
        return toward if abs(turn) <= abs(sweep) else ends
    chord = end - start
    if abs(chord) <= ZERO:
        return ends
    share = -(start * chord.conjugate()).real / abs(chord) ** 2
    return start + share * chord if 0 < share < 1 else ends


def with_followers(findings: Sequence[Finding]) -> Iterator[Finding]:
    """Yield findings and those that follow from them."""
    for finding in findings:
        yield finding
        yield from finding.follows
