"""Arcs that lead to a contour or away from it, tangent in one pass and not in another one of the same moves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.passes import Passes, numbered
from polarcheck.foundation.arrays import Rows
from polarcheck.geometry.plane import angle_between

#: A turn that is none, and one that is a corner [rad]; the same place, and another one [mm]; moves of a pass, at least.
_TANGENT, _CORNER = 0.01, 0.03
_SAME, _OTHER, _FEWEST = 1e-3, 0.02, 4


class OddLead(NamedTuple):
    """An arc that is not tangent, and the one that is in another pass; begins: they lead to their contours."""

    move: int
    model: int
    begins: bool


def odd_leads(passes: Passes) -> list[OddLead]:
    """Leads of the same R, side and contour, with one coordinate of their outer ends that is another."""
    first, last = passes.first, passes.last
    return [
        *_odd(passes, first, np.minimum(first + 1, last), passes.shape_of(first + 1, last)),
        *_odd(passes, last, np.maximum(last - 1, first), passes.shape_of(first, last - 1)),
    ]


def _odd(passes: Passes, lead: Rows, inner: Rows, shape: Rows) -> list[OddLead]:
    trace, row, begins = passes.trace, passes.row[lead], bool((lead < inner).any())
    leaving, arriving = passes.tangents
    before, behind = (lead, inner) if begins else (inner, lead)
    turn = np.abs(angle_between(arriving[before], leaving[behind]))
    at_contour, outside = passes.end[before], passes.start[lead] if begins else passes.end[lead]
    words = [trace.lengths.length_of(address)[row] for address in (trace.machine.arcs.radius_word, "I", "J")]
    places = [np.round(np.nan_to_num(part), 3) for part in (at_contour.real, at_contour.imag, *words)]
    state = passes.motion[lead] + 100 * trace.compensation.side[row].astype(np.int64)
    kind = numbered([shape, *places, state, trace.blocks.program[row]])
    is_lead = passes.is_arc[lead] & passes.compensated & (passes.last - passes.first + 1 >= _FEWEST)
    is_tangent = np.flatnonzero(is_lead & (turn <= _TANGENT))[::-1]
    model = np.full(len(kind), -1)
    model[kind[is_tangent]] = is_tangent
    odd = np.flatnonzero(is_lead & (turn > _CORNER) & (model[kind] >= 0))
    model = model[kind[odd]]
    apart = outside[odd] - outside[model]
    aside = np.abs(apart.real), np.abs(apart.imag)
    is_one = (np.minimum(*aside) <= _SAME) & (np.maximum(*aside) > _OTHER)
    moves, models = lead[odd[is_one]].tolist(), lead[model[is_one]].tolist()
    return [OddLead(move, other, begins) for move, other in zip(moves, models, strict=True)]
