"""Offsets as data: how a program calls those of tools, which P, L and variables are R, nose type and X of which."""

from typing import Annotated, Literal

import msgspec

from polarcheck.program.machines.value_checks import AddressOrNone, Ranges


class Offsets(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How tool offsets are called, and offsets that a program sets by itself: by data input, whose lists stand in
    [g_codes], and by system variables.

    called_by: last-digits of T; edge: T the tool, D its edge; tool-change: T beside M6 is tool and offset; or d-word
    edge_after_tool: edge that a T without D calls: its number, 0 for none, -1 for the number that was in force
    called_in_polar: where a program may call another one in the polar mode: never, or without-compensation
    allowance_word: address of what is added to R while cutter compensation is in force; or none
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

    called_by: Literal["last-digits", "edge", "tool-change", "d-word"]
    edge_after_tool: Annotated[int, msgspec.Meta(ge=-1, le=99_999)]
    called_in_polar: Literal["never", "without-compensation"]
    allowance_word: AddressOrNone
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
