"""
The path of the tool on the part, in the polar mode and without it.

`path_deviation` of geometry/comparison is the distance of two such paths, however blocks divide them.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, ranges
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane_path import SpacePath
from polarcheck.geometry.tolerances import CHORDS_OF_FILE
from polarcheck.rewrite.compare.compared_sections import NOWHERE, FedPath, Stretch, of_sections, outside
from polarcheck.rewrite.compare.terms import ANGLE, Terms
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rules.tables import Tables

#: How far the chords of a move of X and C may leave its true path [mm].
CHORD = 1e-4


def path_on_part(tables: Tables, chord: float = CHORD) -> FedPath:
    """
    Return the path of the tool on the part, whose x axis points to C0.

    chord: the largest distance of chords from the true path of a move of X and C [mm].

    Raises RefusedError with the line where R or a position is not known; TooHardError for too many chords.
    """
    trace: Trace = tables["trace"]
    # With ANGLE as its tolerance C stays in degrees.
    terms = Terms(ANGLE)
    sections = of_sections(trace, tables["tool_center"], (), terms)
    around = _without_mode(outside(trace, (), np.arange(len(trace)), terms), chord)
    moves = FedPath.concatenated([*(section.path for section in sections), around])
    moves = moves[np.argsort(moves.row, kind="stable")]
    programmed = [section for section in sections if section.as_programmed]
    missing = np.append(moves.row[~moves.is_known], [section.path.row[0] for section in programmed])
    if len(missing):
        reason = programmed[0].as_programmed if programmed else "where the tool is there is not known"
        raise refused_at(trace, int(missing.min()), reason)
    return moves


def _without_mode(stretch: Stretch, chord: float) -> FedPath:
    """
    The moves outside of sections: chords between points that lie at even shares of X, Z and C, or of an arc.

    A move in rapid traverse is straight: only its ends count, since its axes need not arrive together.
    """
    path = stretch.path  # Z + 1j*X, and C [deg] in the place of Z
    turn = np.radians(path.z_end - path.z_start)
    count = _counts(path, turn, path.rapid, chord)
    move, step = ranges(count)
    start, end = (_points_at(path, turn, move, share) for share in (step / count[move], (step + 1) / count[move]))
    return msgspec.structs.replace(
        path[move],
        start=start[0],
        end=end[0],
        center=np.full(len(move), NOWHERE),
        kind=np.where(path.rapid, Motion.RAPID, Motion.LINE).astype(np.int16)[move],
        z_start=start[1],
        z_end=end[1],
    )


def _counts(path: SpacePath, turn: Floats, rapid: Mask, chord: float) -> Rows:
    """
    Chords of each move: a curve p(u) leaves a chord of the length h of u by no more than h^2 / 8 max|p''|.

    Here p = r exp(i t) with r and t linear in u, so that |p''| <= 2 |r'| |t'| + r t'^2; of an arc it is R sweep^2.
    """
    x_start, x_end = path.start.imag, path.end.imag
    largest = np.maximum(np.abs(x_start), np.abs(x_end))
    bend = 2 * np.abs(x_end - x_start) * np.abs(turn) + largest * turn**2
    bend += np.abs(path.start - np.nan_to_num(path.center)) * path.sweep**2
    count = np.where(rapid, 1, np.ceil(np.sqrt(np.nan_to_num(bend) / (8 * chord))))
    if count.sum() > CHORDS_OF_FILE:
        raise TooHardError(f"the moves of C take more than {CHORDS_OF_FILE} chords")
    return np.asarray(np.maximum(count, 1), np.int64)


def _points_at(path: SpacePath, turn: Floats, move: Rows, share: Floats) -> tuple[Points, Floats]:
    """Points on the part, and Z, at a share of moves."""
    keep_time()
    point = path.points(move, share)
    angle = np.radians(path.z_start[move]) + turn[move] * share
    return point.imag * np.exp(1j * angle), point.real
