"""Draws a polar section in the characters of a terminal, seen from in front of the spindle: X to the right, C up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Mask, Points
from polarcheck.reports.pages.painting import Paint, painted, plain

#: The label right of the row of the center, where C is 0.
_C0 = " C0"
_CENTER, _MARK, _TOOL, _PROGRAMMED = "+", "x", "o", "."
#: The bit of each dot in a Braille pattern, by row and column (Unicode 15.0, chapter 21.1).
_BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
_BRAILLE, _MIDDLE_DOT = 0x2800, "\u00b7"
_OF_PATH = "note"
_STYLES = {_CENTER: "message", _MARK: "error", _PROGRAMMED: "aside", _MIDDLE_DOT: "aside"}


def face_view(
    programmed: Points, tool: Points, marks: Points, columns: int, rows: int, *, dots: bool, paint: Paint = plain
) -> list[str]:
    """
    Return the lines of a picture with equal scales; a cell is twice as high as it is wide.

    programmed, tool, marks: points [mm]; NaN is not shown.
    columns, rows: the largest size, two or more.
    dots: draw with Braille patterns, eight dots per cell; else ASCII.

    The tool path is drawn over the programmed one. Without a tool path the programmed one is drawn alone.
    """
    first, second = (points[np.isfinite(points)] for points in (tool, programmed))
    if not len(first):
        first, second = second, first
    marks = marks[np.isfinite(marks)]
    grid = _Grid(np.concatenate((first, second, marks, np.zeros(1, complex))), columns - len(_C0), rows, dots)
    cells = np.full(grid.shape, " ", dtype="<U1")
    if len(second):
        cells[grid.touched(second)] = _MIDDLE_DOT if dots else _PROGRAMMED
    cells = np.where(grid.touched(first), grid.patterns(first) if dots else _TOOL, cells)
    center = np.zeros(1, complex)
    cells[grid.touched(center)] = _CENTER
    cells[grid.touched(marks)] = _MARK
    lines = ["".join(row) for row in cells]
    center_line = int(np.flatnonzero(grid.touched(center).any(axis=1))[0])
    painted = [_painted(line.rstrip(), paint) for line in lines]
    painted[center_line] = _painted(lines[center_line], paint) + paint("aside", _C0)
    return painted


class _Grid:
    """
    The grid of dots of a picture that contains the given points; row 0 is at the top.

    shape: rows and columns of cells.
    """

    def __init__(self, points: Points, columns: int, rows: int, dots: bool) -> None:
        # Dots per cell, and the ratio of height to width of a dot.
        self._across, self._down, high = (2, 4, 1) if dots else (1, 1, 2)
        wide, tall = max(columns * self._across - 1, 1), max(rows * self._down - 1, 1)
        self._left, self._top = float(points.real.min()), float(points.imag.max())
        width, height = float(points.real.max()) - self._left, self._top - float(points.imag.min())
        self._dot = max(width / wide, height / (tall * high), np.finfo(float).tiny)
        self._high = high * self._dot
        right, bottom = round(width / self._dot), round(height / self._high)
        self.shape = bottom // self._down + 1, right // self._across + 1

    def _dots(self, points: Points) -> Mask:
        """Return the dots that points lie on, bool[rows, dots down, columns, dots across]."""
        rows, columns = self.shape
        dots = np.zeros((rows * self._down, columns * self._across), bool)
        down = np.round((self._top - points.imag) / self._high).astype(np.int64)
        across = np.round((points.real - self._left) / self._dot).astype(np.int64)
        dots[down, across] = True
        return dots.reshape(rows, self._down, columns, self._across)

    def touched(self, points: Points) -> Mask:
        """Return the cells that points lie in, bool[rows, columns]."""
        return np.asarray(self._dots(points).any(axis=(1, 3)))

    def patterns(self, points: Points) -> NDArray[np.str_]:
        """Return the Braille pattern of each cell."""
        bits = (self._dots(points) * _BITS[None, :, None, :]).sum(axis=(1, 3))
        return np.asarray((_BRAILLE + bits).astype("<u4").view("<U1"))


def _painted(line: str, paint: Paint) -> str:
    styles = ["" if cell == " " else _STYLES.get(cell, _OF_PATH) for cell in line]
    return painted(line, styles, paint)
