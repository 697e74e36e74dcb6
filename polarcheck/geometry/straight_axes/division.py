"""Lines and arcs of the polar plane divided into pieces along which X and C move evenly, within a chord error."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows, Table, folded, ranges
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane import angle_between, cross, quiet
from polarcheck.geometry.straight_axes.spans import Spans, places
from polarcheck.geometry.straight_axes.spiral_pieces import SHARES, distances

#: Turn of C in a piece along which X changes by more than _EVEN [rad].
_TURN = np.radians(5.0)
_EVEN = 0.02
#: Spans that are divided at once.
_TOGETHER = 4096
#: The estimate of the chord error is right within that; what it leaves too large is divided again.
_AIM = 0.95
_ROUNDS = 12


class Pieces(Table, frozen=True):
    """
    One element per piece, in order: X and C move evenly from its start to its end.

    span: the span that it belongs to. first, last: its share of the way of the span. start, end: plane points, 0 at the
    center. turn: what the angle of the plane point grows by [rad]; at the center the direction of travel counts.
    """

    span: Rows
    first: Floats
    last: Floats
    start: Points
    end: Points
    turn: Floats


def divide(spans: Spans, chord_error: Floats | float, largest_turn: float, most: int) -> Pieces:
    """
    Divide spans so that the pieces leave them by no more than the chord error [mm].

    chord_error: of each span, or of all. largest_turn: of C in one piece [rad]; where X changes along a piece it turns
    by no more than 5 deg, so that the speed of the tool stays even. most: of the pieces.
    Raises TooHardError where there would be more.

    The way of a piece for a chord error is sqrt(8 error / |kappa - (sin a / r)(1 + cos^2 a)|), with kappa the curvature
    of the path and a its angle against the radius: the second derivatives of both, across the path. Where the
    expression vanishes it says too much: so all pieces are measured, and divided again where they are too long.
    """
    parts = []
    count = 0
    errors = np.broadcast_to(np.asarray(chord_error, np.float64), len(spans))
    for first in range(0, len(spans), _TOGETHER):
        keep_time()
        part = slice(first, first + _TOGETHER)
        pieces = _divided(spans[part], errors[part], largest_turn, most - count)
        count += len(pieces.span)
        parts.append(Pieces(pieces.span + first, pieces.first, pieces.last, pieces.start, pieces.end, pieces.turn))
    return Pieces.concatenated(parts) if parts else Pieces(*_nothing())


def _nothing() -> tuple[Rows, Floats, Floats, Points, Points, Floats]:
    none, points = np.zeros(0), np.zeros(0, np.complex128)
    return np.zeros(0, np.int64), none, none, points, points, none


@quiet
def _divided(spans: Spans, chord_error: Floats, largest_turn: float, most: int) -> Pieces:
    shares = places(spans)
    need = _needed(spans, shares, chord_error, largest_turn)
    total = need[:, -1]
    count = np.maximum(np.ceil(total - 1e-9), 1)
    for _ in range(_ROUNDS):
        if not count.sum() <= most:
            raise TooHardError(f"more than {most} blocks: use a larger chord error")
        pieces = _placed(spans, shares, need, count.astype(np.int64))
        error = folded(np.maximum, pieces.span, np.max(deviations(spans, pieces), axis=1, initial=0.0), len(spans), 0.0)
        turn = folded(np.maximum, pieces.span, np.abs(pieces.turn), len(spans), 0.0)
        more = np.maximum(np.sqrt(error / chord_error), turn / (largest_turn * (1 + 1e-9)))
        if not np.any(more > 1):
            return pieces
        count = np.where(more > 1, np.maximum(np.ceil(count * np.minimum(more, 16)), count + 1), count)
    raise TooHardError("no division keeps the chord error")


def _needed(spans: Spans, shares: Floats, chord_error: Floats, largest_turn: float) -> Floats:
    """The number of pieces needed from the start of a span up to each share, float64[spans, shares], rising."""
    point, direction = spans.points(shares), spans.directions(shares)
    r = np.abs(point)
    sine = cross(point, direction) / np.maximum(r, 1e-12) ** 2 * r
    turn = np.abs(np.where(r > 0, sine / r, 0.0))
    chord = np.abs(spans.bend[:, None] - np.where(r > 0, sine / r, 0.0) * (2 - np.minimum(sine**2, 1.0)))
    near, far = r.min(axis=1), r.max(axis=1)
    most_turn = np.where(far > near * (1 + _EVEN), min(_TURN, largest_turn), largest_turn)
    density = np.maximum(np.sqrt(chord / (8 * chord_error[:, None] * _AIM)), turn / most_turn[:, None])
    step = np.diff(shares, axis=1) * spans.length[:, None]
    # At the center itself the turn of an arc is finite, and that of a line nothing.
    density = np.where(np.isfinite(density), density, 0.0)
    need = np.cumsum((density[:, 1:] + density[:, :-1]) / 2 * step, axis=1)
    return np.concatenate((np.zeros((len(spans), 1)), need), axis=1)


def _placed(spans: Spans, shares: Floats, need: Floats, count: Rows) -> Pieces:
    """Each span divided into `count` pieces of equal need."""
    number = np.arange(len(spans), dtype=np.float64)
    # A span without need is divided by length; a little of its length makes the need rise everywhere.
    total = need[:, -1:]
    share = np.where(total > 0, need / np.where(total > 0, total, 1.0), shares) * (1 - 1e-6) + shares * 1e-6
    span, index = ranges(count)
    of = count[span]
    cuts = np.interp(number[span] + index / of, (number[:, None] + share).ravel(), shares.ravel())
    first = np.where(index == 0, 0.0, cuts)
    last = np.where(index == of - 1, 1.0, np.append(first[1:], 1.0))
    of_piece = spans[span]
    ends = of_piece.points(np.stack((first, (first + last) / 2, last), axis=1))
    directions = of_piece.directions(np.stack((first, last), axis=1))
    begins = np.where(ends[:, 0] == 0, directions[:, 0], ends[:, 0])
    arrives = np.where(ends[:, 2] == 0, -directions[:, 1], ends[:, 2])
    turn = angle_between(begins, ends[:, 1]) + angle_between(ends[:, 1], arrives)
    return Pieces(span, first, last, ends[:, 0], ends[:, 2], turn)


def deviations(spans: Spans, pieces: Pieces) -> Floats:
    """The distance of each piece from its span [mm], float64[pieces, points between its ends]."""
    of_piece = spans[pieces.span]
    r = np.abs(pieces.start)[:, None] + (np.abs(pieces.end) - np.abs(pieces.start))[:, None] * SHARES
    directions = of_piece.directions(pieces.first[:, None])[:, 0]
    first = np.angle(np.where(pieces.start == 0, directions, pieces.start))[:, None]
    return distances(
        r * np.exp(1j * (first + pieces.turn[:, None] * SHARES)),
        of_piece.start,
        of_piece.end,
        of_piece.center,
        of_piece.sweep,
    )
