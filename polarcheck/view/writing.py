"""How a program writes a point of the polar plane in a section."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.view.moves import LENGTH
from polarcheck.view.picture import Writing


def writing(trace: Trace, section: int) -> Writing:
    """Return how points are written in a section of a trace."""
    sections = trace.mode.sections
    enter, leave = int(sections.enter[section]), int(sections.leave[section])
    rows = np.arange(enter, max(leave, enter + 1))
    moving = rows[trace.path.travels[rows]]
    origin, turn = _origin(trace, moving if len(moving) else rows[:1])
    linear = int(trace.axes.linear_axis[enter])
    return Writing(
        linear=_address(chr(linear) if linear else trace.machine.polar.linear_address),
        virtual=_address(trace.axes.virtual_axis_of(enter)),
        virtual_diameter=trace.machine.polar.virtual_axis_programming == "diameter",
        origin=None if np.isnan(origin) else (round(origin.real, LENGTH) + 0.0, round(origin.imag, LENGTH) + 0.0),
        turn=round(turn, LENGTH),
    )


def _address(name: str) -> str:
    """Return what stands before the number: C, but C2= for a name of more than one character."""
    return f"{name}=" if len(name) > 1 else name


def _origin(trace: Trace, rows: Rows) -> tuple[complex, float]:
    """Return the zero of the program on the plane [mm] and the turn of its axes [deg]; NaN unless all rows agree."""
    path = trace.path
    shift, turn = -path.center_shift[rows], np.zeros(1)
    if path.frames is not None:
        shift, turn = shift + path.frames.shift[rows], path.frames.angle[rows]
    agrees = bool(np.all(shift == shift[0]) and np.all(turn == turn[0]))
    return (complex(shift[0]), float(turn[0])) if agrees else (complex(np.nan, np.nan), 0.0)
