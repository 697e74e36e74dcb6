"""Where the tool stands on the polar plane where a section begins, on controls whose plane C does not turn."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.filling import positions
from polarcheck.columns.modes.sections import Sections
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, mask_at
from polarcheck.geometry import polar
from polarcheck.geometry.tolerances import ZERO

#: Digits to which the sine of an angle is rounded: C180 leads to the linear axis.
_DIGITS = 15


class EntryPlaces(msgspec.Struct, frozen=True):
    """
    The tool at the G12.1 of each section, X being positive; arrays of one length.

    by_words: its direction as a number of length 1, by the C words since the section before; 1, on the linear axis,
    where there are none. turned: by how much C has turned since the section before where no word says its angle [deg];
    NaN where that does not tell where C stands. last: the last row of the section before. c_axis: sense of C.
    """

    by_words: Points
    turned: Floats
    last: Rows
    c_axis: polar.CAxis

    @property
    def off_axis(self) -> Mask:
        """Sections that begin beside the linear axis, or may."""
        return np.asarray((self.by_words != 1) | ~np.isnan(self.turned))

    def directions(self, after: Points) -> Points:
        """The directions of all sections; after: plane points after each row, of the sections before."""
        result = self.by_words.copy()
        for number in np.flatnonzero(~np.isnan(self.turned)).tolist():
            point = after[self.last[number]]
            if abs(point) > ZERO:
                direction = np.array([point / abs(point)])
                result[number] = _turned(direction, self.c_axis.sense * self.turned[number : number + 1])[0]
        return result


def entry_places(
    sections: Sections, c_axis: polar.CAxis, words: tuple[Floats, Floats], referenced: Mask, lost: Mask
) -> EntryPlaces:
    """
    The places for the C words of a program.

    words: coordinates of C, NaN where none, and increments, 0 where none [deg]. referenced: rows that take C to its
    reference point. lost: rows after which the position of C is unknown.
    """
    count = len(sections)
    last = np.append(0, sections.leave)[:count] - 1
    places = EntryPlaces(np.ones(count, np.complex128), np.full(count, np.nan), last, c_axis)
    if not count:
        return places
    absolute, turn = words
    ends = mask_at(len(turn), sections.leave[sections.leave < len(turn)])
    resets = referenced | ends | lost
    angle = positions(absolute, turn, resets, np.where(referenced, 0.0, np.nan))[sections.enter]
    places.by_words[:] = _turned(places.by_words, c_axis.sense * np.nan_to_num(angle))
    # A tool whose angle is known by words alone hangs on no section before.
    nowhere = np.full(len(turn), np.nan)
    since = positions(nowhere, turn, resets | ~np.isnan(absolute), np.where(ends & ~lost, 0.0, np.nan))[sections.enter]
    places.turned[1:] = np.where(np.isnan(angle), since, np.nan)[1:]
    return places


def _turned(direction: Points, angle: Floats) -> Points:
    """Directions turned by angles [deg]."""
    return np.round(np.exp(1j * np.radians(angle)) * direction, _DIGITS)
