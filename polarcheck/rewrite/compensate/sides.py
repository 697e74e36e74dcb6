"""On which side of a tool center path the part is: what the cutters clear on either side decides it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polarcheck.columns.path.moves import Moves, z_along
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Points, Rows
from polarcheck.geometry.segments import Curves, segments
from polarcheck.rewrite.compensate.pieces import Piece

#: Sagitta of the chords of paths [mm]; a point deeper than this within a cleared area is taken away [mm].
_TOLERANCE, _DEEP = 1e-3, 0.01
#: Points nearer together than this are one [mm].
_SAME_PLACE = 1e-6
#: Number of points of a contour that are tested.
_POINTS = 400


class Swept:
    """
    What cutters clear at feed, in the frame of the part.

    moves: the moves of the tool center. radius: R of each move [mm]; NaN where it is not known. frame, turn: per move
    the number of its frame, and the unit complex number that turns its points into it. top: the higher Z of its ends
    [mm]. at_feed: the moves at feed with known R. usable: those of them that no deeper move repeats.
    """

    def __init__(self, trace: Trace, moves: Moves, radius: Floats) -> None:
        is_known = trace.path.knows_section_entry[moves.section]
        self.turn = trace.path.section_turn[moves.section]
        #: Sections share frame -1; one that begins at an unknown C has a frame of its own.
        self.frame = np.where(is_known, -1, moves.section)
        begins, ends = z_along(trace, moves)
        self.top = np.fmax(begins, ends)
        usable = trace.path.cuts[moves.row] & ~np.isnan(radius) & ~np.isnan(moves.start + moves.end) & moves.is_of_tool
        self.moves, self.radius = moves, radius
        self.at_feed = np.flatnonzero(usable)
        self.usable = self._deepest(self.at_feed)

    def _deepest(self, usable: Rows) -> Rows:
        """The deepest of moves along the same path with the same R: it clears what the others clear."""
        moves, turn = self.moves[usable], self.turn[usable]
        points = (
            np.concatenate([moves.start * turn, moves.end * turn, np.nan_to_num(moves.center * turn)]) / _SAME_PLACE
        )
        places = np.round([points.real, points.imag]).reshape(6, -1)
        columns = [*places, self.radius[usable], self.frame[usable], moves.kind]
        order = np.lexsort((np.nan_to_num(self.top[usable], nan=np.inf), *columns))
        is_other = np.any([column[order][1:] != column[order][:-1] for column in columns], axis=0)
        return np.sort(usable[order[np.append(True, is_other)]]) if len(usable) else usable

    def frame_of(self, section: int) -> tuple[int, complex]:
        """The number of the frame of a section, and the factor that turns its points into that frame."""
        first_move = int(np.argmax(self.moves.section == section))
        return int(self.frame[first_move]), complex(self.turn[first_move])

    def distance(self, points: Points, section: int, z: float) -> Floats:
        """
        Distance of points from the nearest cutter on all paths [mm]; below 0 the point is cleared.

        points: on the plane of a section [mm], at the depth z. A path clears the depth at which it runs and all above.
        """
        import shapely  # type: ignore[import-untyped]

        from polarcheck.geometry.polygons.faces import coordinates, lines_of

        frame, turn = self.frame_of(section)
        in_reach = ~(self.top > z + _TOLERANCE) | (math.isnan(z) & (self.moves.section == section))
        chosen = self.usable[((self.frame == frame) & in_reach)[self.usable]]
        distance = np.full(len(points), np.inf)
        geometries = shapely.points(coordinates(points * turn))
        for size in np.unique(self.radius[chosen]).tolist():
            with_size = chosen[self.radius[chosen] == size]
            chords = segments(self._curves(with_size), _TOLERANCE)
            tree = shapely.STRtree(lines_of(chords.start, chords.end))
            (index, _), far = tree.query_nearest(geometries, return_distance=True, all_matches=False)
            distance[index] = np.minimum(distance[index], far - size)
        return distance

    def farthest_from(self, reference: Swept, section: int) -> tuple[float, int]:
        """The largest distance of the tool center in a section from its path in another program [mm], and the row."""
        import shapely

        from polarcheck.geometry.polygons.faces import coordinates, lines_of

        chosen, reference_moves = (
            sweep.at_feed[sweep.moves.section[sweep.at_feed] == section] for sweep in (self, reference)
        )
        pieces, lines = (
            segments(self._curves(chosen), _TOLERANCE),
            segments(reference._curves(reference_moves), _TOLERANCE),
        )
        tree = shapely.STRtree(lines_of(lines.start, lines.end))
        points = shapely.points(coordinates(pieces.end))
        (index, _), far = tree.query_nearest(points, return_distance=True, all_matches=False)
        worst = int(np.argmax(far))
        return float(far[worst]), int(self.moves.row[chosen[pieces.move[index[worst]]]])

    def _curves(self, chosen: np.ndarray) -> Curves:
        """The chosen moves as curves in their frame."""
        moves = self.moves[chosen].turned_by(self.turn[chosen])
        return Curves(*moves.shape, np.zeros(len(chosen), int), chosen)


def points_along(contour: Sequence[Piece]) -> Points:
    """Return some 400 points along a contour, at least two inside each piece, none at a corner."""
    whole = sum(piece.length for piece in contour) or 1.0
    result: list[complex] = []
    for piece in contour:
        points_of_piece = max(2, math.ceil(_POINTS * piece.length / whole))
        result += [piece.at((number + 0.5) / points_of_piece) for number in range(points_of_piece)]
    return np.array(result)


def standing_share(swept: Swept, contour: Sequence[Piece], section: int, z: float, bar: float) -> float:
    """
    Return the share of a contour that lies in the bar; 0 if anything takes a point of that share away.

    bar: diameter beyond which there is no material [mm]; NaN where it is not known.
    """
    points = points_along(contour)
    count = len(points)
    if not math.isnan(bar):
        points = points[np.abs(points) < bar / 2 - _DEEP]
    if not len(points) or not (swept.distance(points, section, z) > -_DEEP).all():
        return 0.0
    return len(points) / count
