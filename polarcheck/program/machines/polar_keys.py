"""The polar mode as a lathe has it: the keys of [polar]."""

from typing import Literal, TypeAlias

import msgspec

from polarcheck.program.machines.axis_table import INCREMENTS
from polarcheck.program.machines.value_checks import (
    Address,
    AddressOrNone,
    AxisAddress,
    AxisAddressOrNone,
    AxisNumber,
    Codes,
    Length,
    NumberedWord,
    Plain,
    RotaryAddress,
)

#: A linear axis that is followed in the polar mode.
LinearAddress: TypeAlias = Literal["X", "Y", "Z"]


class Polar(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    The polar mode, from G12.1 to G13.1.

    on: codes that switch it on
    off: codes that switch it off, in the order of those that switch it on
    ended_by: further codes that end it beside what they do elsewhere, as those of other planes
    on_of_other_controls: codes and words that begin the mode on any control, which tell programs for another one
    on_of_other_meaning: those of them that mean something else here, where axis words stand beside them
    on_of_macros: those of them that are builders' macros, too: told where a move in the mode and its end follow
    sub_spindle_plane: as on the main spindle (as-main), sides not known (unknown), axes not followed (not-followed)
    words_beside_switch: addresses and codes that may stand in one block with those that switch; N may always
    not_simulated_beside: those of these addresses that make another mode of it, which is not simulated
    planes_not_simulated: codes that select another plane in the mode, as that of a cylinder, which is not simulated
    rotary_address: address of the rotary axis outside the mode: A, B, C, H, or a name that is written with =, as C2
    rotary_incremental: address of its incremental words; empty where it has none
    off_of_other_modes: codes that begin another mode which those of `off` end as well, as that of a Y axis
    contours_outside: codes that cut contours outside the mode, with C in degrees beside them; they are not simulated
    direction_word: address beside `on` of the C angle at which the first axis of the plane points; empty for none
    virtual_axis: address of the virtual axis (hypothetical axis), a length
    virtual_axis_incremental: address of its incremental words
    virtual_axis_by_word: word beside G12.1 -> the addresses, absolute and incremental, that it gives the virtual axis
    virtual_axis_of_other_controls: addresses, absolute and incremental, that it has elsewhere and that are wrong here
    other_controls: the controls on which it has those addresses, as a message names them
    x: diameter or radius: what X words are in the mode
    virtual_axis_programming: radius or diameter: what words of the virtual axis are
    zero_angle: where the linear axis points: to C at G12.1 (at-switch) or C0 (at-c0, at-c0-reversed: C turns back)
    other_axes: what Z does in one block with X or C: independent of them, together with them, or forbidden
    feed_measures: what F is along where Z moves beside X or C: the way on the plane, or that of X, C and Z in space
    repeated_z: Z beside X or C that names the present Z: allowed, forbidden-in-arcs, or forbidden as any other
    center_words: addresses of arc centers, along the linear and along the virtual axis, by the linear axis
    linear_address: address of the axis with the number 1, where control.axes does not say it: the linear axis
    center_error: way of the tool beside the center of C, along the virtual axis, which the control makes up for [mm]
    linear_axis: number of the linear axis, as P beside G12.1 names it
    rotary_axis: number of the rotary axis, as Q beside G12.1 names it
    infeed_word: address beside G12.1 of the infeed of a cycle that goes round the contour; empty without such a cycle
    allowed_codes: G codes that can be used in the mode, no others
    plane_before: planes of which one must be selected before G12.1 or right behind it; none where it does not matter
    z_of_machine: a block of machine coordinates (G53) with Z alone may stand in the mode
    engaged_behind: the C axis may be engaged behind G12.1, before the first move there
    main_spindle_must_stop: whether a main spindle that turns at G12.1 is a fault
    """

    on: Codes
    off: Codes
    ended_by: list[str] = []
    on_of_other_controls: list[Plain] = []
    on_of_other_meaning: list[Plain] = []
    on_of_macros: list[Plain] = []
    sub_spindle_plane: Literal["as-main", "unknown", "not-followed"]
    words_beside_switch: list[str]
    not_simulated_beside: list[Address] = []
    planes_not_simulated: list[str] = []
    rotary_address: RotaryAddress
    rotary_incremental: AddressOrNone
    off_of_other_modes: list[str] = []
    contours_outside: list[str] = []
    direction_word: AddressOrNone
    virtual_axis: AxisAddress
    virtual_axis_incremental: AddressOrNone
    virtual_axis_by_word: dict[NumberedWord, tuple[AxisAddress, AddressOrNone]] = {}
    virtual_axis_of_other_controls: list[AxisAddressOrNone]
    other_controls: str = ""
    x: Literal["diameter", "radius"]
    virtual_axis_programming: Literal["radius", "diameter"]
    zero_angle: Literal["at-switch", "at-c0", "at-c0-reversed"]
    other_axes: Literal["independent", "together", "forbidden"]
    feed_measures: Literal["plane", "space"]
    repeated_z: Literal["allowed", "forbidden-in-arcs", "forbidden"]
    center_words: dict[LinearAddress, tuple[Address, Address]]
    linear_address: LinearAddress
    center_error: Length
    linear_axis: AxisNumber
    rotary_axis: AxisNumber
    infeed_word: AddressOrNone
    allowed_codes: list[str]
    plane_before: list[str]
    z_of_machine: bool = False
    engaged_behind: bool = False
    main_spindle_must_stop: bool

    @property
    def plane_is_fixed(self) -> bool:
        """The polar plane stands still on the part, whatever the angle of C at G12.1."""
        return self.zero_angle != "at-switch"

    @property
    def c_sense(self) -> int:
        """1 where C grows with the angle of the tool on the polar plane, -1 where it falls with it."""
        return -1 if self.zero_angle == "at-c0-reversed" else 1

    @property
    def rotary_words(self) -> tuple[str, str]:
        """The addresses of the rotary axis outside the mode, absolute and incremental."""
        return self.rotary_address, self.rotary_incremental

    @property
    def axis_addresses(self) -> tuple[str, ...]:
        """The addresses of the rotary axis, and of the virtual one in all its forms; absolute and incremental."""
        virtual = self.virtual_axis, self.virtual_axis_incremental
        pairs = (self.rotary_words, virtual, *self.virtual_axis_by_word.values())
        return tuple(dict.fromkeys(address for pair in pairs for address in pair if address))

    def __post_init__(self) -> None:
        if self.linear_axis == self.rotary_axis:
            raise ValueError(f"linear_axis and rotary_axis are both {self.linear_axis}; expected two axes")
        missing = [axis for axis in INCREMENTS if axis not in self.center_words]
        if missing:
            raise ValueError(f"center_words has no words for the linear axis {missing[0]}")
        # Pairs: an axis may lack incremental words, as haas-lathe's A does, but no absolute ones.
        if "" in self.virtual_axis_of_other_controls[::2]:
            raise ValueError(
                "virtual_axis_of_other_controls: an address is empty; expected pairs as Y, V; V may be empty"
            )

    @property
    def virtual_axes(self) -> list[str]:
        """The addresses that the virtual axis can have: of the machine, and those that a word beside G12.1 chooses."""
        return list(dict.fromkeys((self.virtual_axis, *(pair[0] for pair in self.virtual_axis_by_word.values()))))
