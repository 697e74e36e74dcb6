"""A shape: its name and its numbers; lengths in mm, angles in degrees against C0, points x + 1j*c."""

from __future__ import annotations

import cmath
import math

import msgspec

from polarcheck.foundation.arrays import Floats, Points

#: Sizes and places that agree in this [mm] are the same: what the last digit of a program in inches may move a side by.
SAME = 0.004
#: Directions that agree in this are the same, where a length gives no better measure [rad].
SAME_DIRECTION = 2e-3

#: Of polygons with so many sides; those with more are told by their number.
POLYGONS = {
    3: "triangle",
    4: "square",
    5: "pentagon",
    6: "hexagon",
    7: "heptagon",
    8: "octagon",
    9: "nonagon",
    10: "decagon",
    12: "dodecagon",
}
#: How many sides each of these names has.
SIDES_OF = {name: sides for sides, name in POLYGONS.items()}


class OddSide(msgspec.Struct, frozen=True):
    """A side that differs from the others: the row of its block and its size as it is told of the others [mm]."""

    row: int
    size: float


class Shape(msgspec.Struct, frozen=True):
    """
    What one outline is.

    name: circle, triangle to dodecagon or `11-sided`, rectangle, polygon, round with flats, round with keyway, flats,
    slot, keyway, cam, cross, groove, contour. inside: it is a pocket. values: its numbers [mm, mm2, deg], each only
    where it applies:

    diameter; across_flats (of an odd number of sides twice the distance of a side from the middle), width, length,
    sides, flats, keyways, distance (of a flat or a bottom from the axis), apart (of parallel flats, of the circles of a
    cam), corner_radius or corner_chamfer, and corner_least where corners differ, corner_1, corner_2 and so on of each,
    counterclockwise from the side that has the direction turned; radius, radius_small (of a cam, of the end of a slot);
    joined (R of the arc between two flats); corners_round, corners_chamfered, corners_sharp, how many, of both kinds;
    turned (the direction of the first side's normal or of the length); distance_1, turned_1 and so on, of the flats
    where they are uneven; center_x, center_c, where it is off the axis;
    x_least, x_most, c_least, c_most, area, inside_radius of contours; least, most where sides differ;
    inside_corners: how many sharp ones the cutter cannot reach into; corner_reach: the largest R of a cutter that
    reaches each wall beside them; reach_beyond: the largest R that leaves nothing in the bar of a corner just outside;
    stands_inside: how many pieces stand within what is cleared; regular_by_x: by what X is to be multiplied to make it
    regular.

    odd: the sides that differ from the others. row: of its first block. is_regular: False where what has the name of a
    regular polygon is none. is_open: nobody knows what the part is like beyond its ends. mixed:
    the rows of the blocks whose X regular_by_x is of, none where it is of all.
    """

    name: str
    inside: bool
    values: dict[str, float]
    odd: tuple[OddSide, ...] = ()
    row: int = -1
    is_regular: bool = True
    is_open: bool = False
    mixed: tuple[int, ...] = ()

    @property
    def middle(self) -> complex:
        """The point off the axis about which it is, or the middle of what it reaches to [mm]."""
        values = self.values
        if "x_least" in values:
            return complex(values["x_least"] + values["x_most"], values["c_least"] + values["c_most"]) / 2
        return complex(values.get("center_x", 0.0), values.get("center_c", 0.0))


def polygon_name(sides: int) -> str:
    """The name of a regular polygon."""
    return POLYGONS.get(sides, f"{sides}-sided")


def turned_by(direction: complex, count: int) -> float:
    """The direction of what looks the same `count` times in a turn [deg], the least above 0."""
    step = 360 / count
    turned = math.degrees(cmath.phase(direction)) % step
    return 0.0 if min(turned, step - turned) < math.degrees(SAME_DIRECTION) / 4 else turned


def each_flat(normal: Points, out: Floats) -> dict[str, float]:
    """How far each of several uneven flats is from the middle, and its direction from 0; as values of a shape."""
    flats = sorted((turned_by(direction, 1), distance) for direction, distance in zip(normal, out, strict=True))
    values: dict[str, float] = {}
    for number, (turned, distance) in enumerate(flats, 1):
        values |= {f"distance_{number}": float(distance), f"turned_{number}": turned}
    return values


def off_axis(center: complex) -> dict[str, float]:
    """Where the middle of a shape is, if it is off the axis."""
    return {} if abs(center) <= SAME else {"center_x": float(center.real), "center_c": float(center.imag)}
