"""Draws the paths of a polar section and its rate of C as lines for a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

import numpy as np

from polarcheck.pictures.face_view import face_view
from polarcheck.pictures.painting import Paint, plain
from polarcheck.pictures.section_view import SectionView
from polarcheck.pictures.strip import strip
from polarcheck.reading.excerpt import head

#: The largest picture in columns and rows, and the rows of the strip.
_COLUMNS, _ROWS, _STRIP_ROWS = 64, 24, 5
_INDENT = "  "


def path_view(view: SectionView, columns: int, *, dots: bool, paint: Paint = plain, path: str = "") -> Iterator[str]:
    """
    Yield the lines of one section: its title, the picture, the rate of C over time, and an empty line.

    columns: the width of the terminal.
    dots: draw with Braille and block characters, else ASCII.
    path: the path of the program, if there may be several.
    """
    room = columns - len(_INDENT)
    face = face_view(view.programmed, view.tool, view.marks, min(room, _COLUMNS), _ROWS, dots=dots, paint=paint)
    curve = strip(view.time, view.rate, view.limit, min(room, _COLUMNS), _STRIP_ROWS, dots=dots, paint=paint)
    yield paint("message", f"{head(path)}: {view.title}" if path else view.title)
    legend, remarks = (
        [line for text in texts for line in textwrap.wrap(text, room)]
        for texts in (_legend(view, dots), (_rate(view), *view.remarks))
    )
    yield from (_INDENT + line if line else "" for line in (*face, "", *legend, "", *curve, *remarks))
    yield ""


def _legend(view: SectionView, dots: bool) -> Iterator[str]:
    first, second = ("\u2812\u2812", "\u00b7\u00b7") if dots else ("oo", "..")
    if len(view.tool):
        yield f"{first} tool center  {second} contour as programmed"
    else:
        yield f"{first} contour as programmed; no path of the tool is known"
    marks = "  x end of a block with a finding" if len(view.marks) else ""
    yield f"+ spindle center, C0 to the right{marks}"
    points = np.concatenate((view.programmed, view.tool, view.marks, np.zeros(1, complex)))
    yield f"shown: {np.ptp(points.real):.3f} x {np.ptp(points.imag):.3f} mm"


def _rate(view: SectionView) -> str:
    """Return the range of the strip in numbers."""
    known = view.rate[~np.isnan(view.rate)]
    if not len(known):
        return "rate of C over time: not known"
    limit = "no limit given" if np.isnan(view.limit) else f"limit {view.limit:.0f}"
    if not view.highest_line:
        return f"C does not turn ({limit})"
    highest = f"at most {known.max():.0f} deg/min" if np.isfinite(known.max()) else "without bound, through the center,"
    return f"rate of C over {view.time[-1]:.0f} s on the plane: {highest} in line {view.highest_line} ({limit})"
