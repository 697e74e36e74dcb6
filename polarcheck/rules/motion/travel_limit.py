from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.columns.path.travel import Travel
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "{travel}",
    values=("axis", "position", "limit"),
    worse=("position:limit",),
    at=("X", "U", "C", "H", "Z", "W"),
)
def travel_limit(path: ProgrammedPath, travel: Travel, machine: Machine) -> Mask:
    """
    Move beyond the travel of X or Z.

    In the mode X of the machine is the distance of the tool center from the center of C, never negative, and largest
    where the contour is farthest out: at the corner of a square it is larger than X there. Outside the mode it is X as
    programmed. Limits are those of the profile in the coordinates of the program; without them nothing is looked at.

    Source: limits.x_minimum to limits.z_maximum of the machine profile; FANUC B-62764EN/01, p. 51.

    Bad, set limits.x_maximum=40:

        G98 G0 X60. C0
        G12.1
        G1 X60. C20. F200
        C30.              (expect: travel-limit)
        X20. C0
        G13.1

    Bad, set limits.x_minimum=-5, set limits.z_minimum=-20:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        Z-25.             (expect: travel-limit)
        X60.
        G13.1
        G0 X-20.          (expect: travel-limit)
        X60.

    Good, set limits.x_maximum=40, set limits.x_minimum=-5:

        G98 G0 X60. C0
        G12.1
        G1 X60. C20. F200
        X-60.
        C0
        G13.1
        G0 X70.
    """
    limits = machine.limits
    x_beyond = (travel.most_x > limits.x_maximum + ROUNDING) | (travel.least_x < limits.x_minimum - ROUNDING)
    z_beyond = (travel.z > limits.z_maximum + ROUNDING) | (travel.z < limits.z_minimum - ROUNDING)
    return travel.first_beyond(x_beyond, travel.moves_x) | travel.first_beyond(z_beyond, path.moves_z)


def details(hit: Hit, travel: Travel, machine: Machine) -> Details:
    import numpy as np

    limits, row = machine.limits, hit.row
    ends = (
        ("X", "diameter", travel.most_x[row], limits.x_maximum, 1),
        ("X", "diameter", travel.least_x[row], limits.x_minimum, -1),
        ("Z", "length", travel.z[row], limits.z_maximum, 1),
        ("Z", "length", travel.z[row], limits.z_minimum, -1),
    )
    beyond = [end for end in ends if np.isfinite(end[2]) and end[4] * end[2] > end[4] * end[3] + ROUNDING]
    axis, form, value, limit, _ = beyond[0]
    goes, stops = hit.quantity(value), hit.quantity(limit)
    return {
        "axis": axis,
        "position": value,
        "limit": limit,
        "travel": f"{axis} would go to {goes.beside(stops, form)}, its travel ends at {stops.beside(goes, form)}",
    }


def needs(travel: Travel) -> Needs:
    return travel.is_limited_in_x, {"travel": travel.most_x}
