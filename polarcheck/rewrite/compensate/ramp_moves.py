"""
Where cutter compensation starts and ends along a contour: start-up and offset cancel, each no shorter than R.

Compensation is built up in the move that leads to the contour. Without such a move, the start-up runs along the first
stretch of the contour. In both cases the path of the tool center stays the programmed one.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import msgspec

from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.compensate.parallel import NEAR, NoContourError, contour_beside
from polarcheck.rewrite.compensate.pieces import Piece
from polarcheck.rewrite.compensate.section_moves import Move

#: A ramp is longer than R by this [mm], so that rounding cannot make it shorter than R.
_RESERVE = 0.0021
#: The largest deviation of a ramp from the path [mm].
_ASIDE = 5e-4
#: The largest deviation of a ramp from an arc if only a longer ramp satisfies R and the reserve [mm].
_MOST_ASIDE = 0.002
#: A ramp takes no more than this share of a path.
_MOST_OF_PATH = 0.4
#: The largest turn between smooth moves [rad]; the same for a lead, whose ends are rounded as well.
_SMOOTH, _SMOOTH_LEAD = 5e-3, 0.02


class Contour(msgspec.Struct, frozen=True):
    """
    A contour in a list of moves.

    first, last: numbers of its moves, both included.
    aside: distance of the contour to the left of the path [mm]; below 0 to the right.
    closed: the last move of the path ends at the start of the first.
    """

    first: int
    last: int
    aside: float
    closed: bool


class Ramped(msgspec.Struct, frozen=True):
    """
    A contour with its ramps.

    contour: its pieces as programmed, each with the number of the move that it replaces.
    enters: the move that becomes the start-up; -1 if a new move leads from the path to the contour.
    leaves: the move that becomes the offset cancel; -1 if a new move leads back to the path, to `back`.
    back: the end of that new move [mm].
    """

    contour: list[Piece]
    enters: int
    leaves: int
    back: complex


def with_ramps(moves: Sequence[Move], contour: Contour, low: int, high: int) -> Ramped:
    """
    Return a contour with its ramps.

    low, high: first and end of the moves that belong to the same run and to no other contour.
    Raises NoContourError where there is no contour, or no room for a ramp.
    """
    path = [moves[number].piece for number in range(contour.first, contour.last + 1)]
    if contour.closed and _turn(path[-1], path[0]) < _SMOOTH:
        try:
            return _with_leads(moves, contour, path, low, high)
        except NoContourError:
            pass
    if contour.closed:
        return _past_its_beginning(contour, path, -1)
    enters = _host(moves, contour.first - 1, low, high, path[0].start, path[0].leaving, contour.aside)
    leaves = _host(moves, contour.last + 1, max(low, enters + 1), high, path[-1].end, path[-1].arriving, contour.aside)
    return _open(contour, path, enters, leaves)


def _with_leads(moves: Sequence[Move], contour: Contour, ring: list[Piece], low: int, high: int) -> Ramped:
    """Return a contour that closes smoothly, with its leads; these may be arcs, which are compensated as well."""
    aside = contour.aside
    arcs_in = _arcs(moves, range(contour.first - 1, low - 1, -1), ring[0].start, ring[0].leaving, aside)
    path = [*reversed(arcs_in), *ring]
    enters = _host(moves, contour.first - 1 - len(arcs_in), low, high, path[0].start, path[0].leaving, aside)
    if enters < 0 and not arcs_in:
        return _past_its_beginning(contour, ring, -1)
    arcs_out = _arcs(moves, range(contour.last + 1, high), ring[-1].end, ring[-1].arriving, aside)
    path += arcs_out
    after = contour.last + 1 + len(arcs_out)
    leaves = _host(moves, after, max(low, enters + 1), high, path[-1].end, path[-1].arriving, aside)
    if leaves < 0 and not arcs_out and not arcs_in:
        return _past_its_beginning(contour, ring, enters)
    return _open(contour, path, enters, leaves)


def _past_its_beginning(contour: Contour, ring: list[Piece], enters: int) -> Ramped:
    """Return a ring that continues along its start, from where a new move leads back to the path."""
    radius = abs(contour.aside)
    turn = cmath.phase(ring[0].leaving / ring[-1].arriving)
    # At an outer corner the contour begins where its parallels have crossed.
    corner = radius * math.tan(abs(turn) / 2) if turn * contour.aside > 0 else 0.0
    stretch = _stretch(ring, radius, corner)
    again = [msgspec.structs.replace(piece, move=contour.last) for piece in _beginning(ring, stretch)]
    path = [*(ring if enters >= 0 else _rest_after(ring, stretch)), *again]
    if enters < 0 and ring[0].sweep == math.tau and len(ring) == 1:
        path = [ring[0].replaced(path[0].start, path[0].start)]
    return Ramped(contour_beside(path, contour.aside), enters, -1, ring[-1].end)


def _open(contour: Contour, path: list[Piece], enters: int, leaves: int) -> Ramped:
    """Return a path whose ramps are the moves before and after it, or else its first and its last stretch."""
    radius, back = abs(contour.aside), path[-1].end
    if enters < 0:
        path = _rest_after(path, _stretch(path, radius))
    if leaves < 0:
        backwards = [piece.back for piece in reversed(path)]
        path = [piece.back for piece in reversed(_rest_after(backwards, _stretch(backwards, radius)))]
    return Ramped(contour_beside(path, contour.aside), enters, leaves, back)


def _turn(before: Piece, after: Piece) -> float:
    return abs(cmath.phase(after.leaving / before.arriving))


def _arcs(moves: Sequence[Move], numbers: Sequence[int], point: complex, along: complex, aside: float) -> list[Piece]:
    """Return the arcs that lead smoothly to a contour, or away from it; the nearest first."""
    result: list[Piece] = []
    for number in numbers:
        move, piece = moves[number], moves[number].piece
        is_in = abs(piece.end - point) <= abs(piece.start - point)
        direction = piece.arriving if is_in else piece.leaving
        fits = piece.radius - piece.turning * aside > 2 * NEAR and piece.sweep < math.tau
        if piece.center is None or not (fits and move.feeds and move.is_level) or abs(direction - along) > _SMOOTH_LEAD:
            break
        point, along = (piece.start, piece.leaving) if is_in else (piece.end, piece.arriving)
        result.append(piece)
    return result


def _host(moves: Sequence[Move], number: int, low: int, high: int, point: complex, along: complex, aside: float) -> int:
    """
    Return the number of a straight move if it is long enough for a ramp from its far end to the contour; otherwise -1.
    """
    if not low <= number < high:
        return -1
    move, arc_end = moves[number], point + 1j * aside * along
    far = move.piece.start if abs(move.piece.end - point) <= abs(move.piece.start - point) else move.piece.end
    suits = move.piece.center is None and move.feeds and abs(far - arc_end) >= abs(aside) + _RESERVE
    return number if suits else -1


# ---- stretches of a path ----


def _stretch(path: Sequence[Piece], radius: float, corner: float = 0.0) -> float:
    """
    Return the length of the first, almost straight stretch of a path that makes a ramp [mm].

    corner: the length of that stretch before the contour starts [mm].
    """
    whole = sum(piece.length for piece in path)
    least = math.sqrt((radius + _RESERVE) ** 2 - radius**2)
    for length, most in [(share * radius, _ASIDE) for share in (0.5, 0.25, 0.1)] + [(least, _MOST_ASIDE)]:
        stretch = corner + max(length, least)
        if stretch < _MOST_OF_PATH * whole and _leaves_by(_beginning(path, stretch)) <= most:
            return stretch
    raise NoContourError(path[0].move, "it is too short, or too round, for a start-up along it")


def _leaves_by(path: Sequence[Piece]) -> float:
    """Return the largest distance of a path from the line between its ends [mm]."""
    start, chord = path[0].start, path[-1].end - path[0].start
    along = chord / (abs(chord) or 1.0)
    points = [point for piece in path for point in (piece.at(0.5), piece.end)]
    return max(abs(((point - start) * along.conjugate()).imag) for point in points)


def _beginning(path: Sequence[Piece], stretch: float) -> list[Piece]:
    """Return the first stretch of a path. stretch: its length [mm]."""
    result: list[Piece] = []
    for piece in path:
        if piece.length >= stretch:
            return [*result, piece.replaced(end=piece.at(stretch / piece.length))]
        result.append(piece)
        stretch -= piece.length
    return result


def _rest_after(path: Sequence[Piece], stretch: float) -> list[Piece]:
    """Return a path without its first stretch. stretch: its length [mm]."""
    for number, piece in enumerate(path):
        if piece.length > stretch + ZERO:
            return [piece.replaced(start=piece.at(stretch / piece.length)), *path[number + 1 :]]
        stretch -= piece.length
    return []
