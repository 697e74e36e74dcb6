"""Frames as data: what belongs to the words that shift and turn the coordinates of a program (g_codes.frame_...)."""

import msgspec

from polarcheck.program.machines.values import AddressOrNone


class Frames(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Coordinate systems of the program, shifted and turned by words whose lists stand in [g_codes].

    angle_word: address of the angle about the axis across the plane; else it is that of Z; empty without frames
    ended_by_switch: whether what switches the polar mode on or off ends the frame in force
    """

    angle_word: AddressOrNone
    ended_by_switch: bool
