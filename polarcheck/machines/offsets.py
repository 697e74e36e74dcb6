"""Offsets that a program sets by itself, as data: which P, L and variables are R, nose type and X of which offset."""

from typing import Annotated

import msgspec

from polarcheck.machines.values import Ranges


class Offsets(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Offsets that a program sets by itself: by data input, whose lists stand in [g_codes], and by system variables.

    geometry_from: P of data input without L above which it is geometry, and wear below; 0 where L must stand there
    geometry: numbers of L by which data input sets the geometry of a tool
    wear: numbers of L by which data input sets the wear of a tool
    radius_alone: those of them for radii alone: in a program with one of them, R beside the others is a length
    radius_geometry_variables: ranges of system variables that are R of the geometry, of offset 1 and the following
    radius_wear_variables: ranges of system variables that are R of the wear
    nose_variables: ranges of system variables that are the nose type
    x_geometry_variables: ranges of system variables that are X of the geometry
    x_wear_variables: ranges of system variables that are X of the wear
    work_shift_variable: system variable that is X of the work shift; 0 for none
    work_offset_variable: system variable that is X of the external work offset; those of the work offsets follow
    work_offset_extended_variable: system variable that is X of the first of the further work offsets; the others follow
    work_offset_step: how much higher the variable of each following work offset is
    """

    geometry_from: Annotated[int, msgspec.Meta(ge=0)]
    geometry: list[int]
    wear: list[int]
    radius_alone: list[int]
    radius_geometry_variables: Ranges
    radius_wear_variables: Ranges
    nose_variables: Ranges
    x_geometry_variables: Ranges
    x_wear_variables: Ranges
    work_shift_variable: Annotated[int, msgspec.Meta(ge=0)]
    work_offset_variable: Annotated[int, msgspec.Meta(ge=0)]
    work_offset_extended_variable: Annotated[int, msgspec.Meta(ge=0)]
    work_offset_step: Annotated[int, msgspec.Meta(ge=1)]


def place_in(ranges: Ranges, variable: int) -> int:
    """The number of the offset that a variable is of, from 1; 0 where it stands in none of the ranges."""
    return next((variable - first + 1 for first, last in ranges if first <= variable <= last), 0)


def steps_above(variable: int, first: int, step: int) -> int:
    """How many steps a variable is above the first one of its kind; -1 where it is none of them."""
    count, rest = divmod(variable - first, step)
    return count if first and not rest else -1
