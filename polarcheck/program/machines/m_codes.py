"""M codes by what they do, and the codes that are in force when a program begins: keys of [m_codes] and [power_on]."""

import msgspec

from polarcheck.program.machines.value_checks import CodeOrNone

#: Lists of M codes that begin and end a state.
SWITCHED = (
    ("c_axis_on", "c_axis_off"),
    ("c_axis_clamp", "c_axis_unclamp"),
    ("live_tool_on", "live_tool_off"),
    ("spindle_on", "spindle_off"),
    ("sub_c_axis_on", "sub_c_axis_off"),
    ("sub_c_axis_clamp", "sub_c_axis_unclamp"),
    ("sub_spindle_on", "sub_spindle_off"),
)
#: Stops, ends, coolant and the tool change have these numbers everywhere (ISO 6983).
OF_EVERY_LATHE = ("M0-M2", "M6-M9", "M30", "M98", "M99")
#: Lists of M codes that end a program or a block by themselves, whatever stands beside them.
PLAIN_M_CODES = ("tool_change", "optional_stop", "program_end", "stops_reading_ahead")


class PowerOn(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    G codes that are in force when a program begins, as parameters set them; empty where that is not known.

    Of an excerpt nothing is known before its first block. Units are those of control.units.

    motion: rapid traverse or linear interpolation
    plane: plane that is selected
    feed_mode: feed per minute or per revolution
    distance: coordinates or distances, in G-code systems B and C
    """

    motion: CodeOrNone = ""
    plane: CodeOrNone = ""
    feed_mode: CodeOrNone = ""
    distance: CodeOrNone = ""


class MCodes(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    M codes, most of them the builder's; empty where the profile does not know them.

    `M3 P12` is M3 with P12 in its block; M3 with another word, or none, is then what M3 alone stands for.

    c_axis_on: the spindle becomes the C axis
    c_axis_off: the C axis becomes the spindle
    c_axis_clamp: the C axis is clamped, so that it cannot turn
    c_axis_unclamp: the clamp of the C axis is released
    live_tool_on: the live tool turns, where it has codes of its own
    live_tool_off: the live tool stops
    spindle_on: the main spindle turns
    spindle_off: the main spindle stops
    sub_c_axis_on: the sub-spindle becomes the C axis, where it has codes of its own
    sub_c_axis_off: its C axis becomes the sub-spindle
    sub_c_axis_clamp: the C axis of the sub-spindle is clamped
    sub_c_axis_unclamp: the clamp of the C axis of the sub-spindle is released
    sub_spindle_on: the sub-spindle turns
    sub_spindle_off: the sub-spindle stops
    spindle_orientation: the main spindle turns to an angle and stops there
    tool_change: tool change, beside T
    optional_stop: optional stop, as it stands between two tools
    program_end: end of program
    stops_reading_ahead: codes beyond which the control does not read ahead
    """

    c_axis_on: list[str] = []
    c_axis_off: list[str] = []
    c_axis_clamp: list[str] = []
    c_axis_unclamp: list[str] = []
    live_tool_on: list[str] = []
    live_tool_off: list[str] = []
    spindle_on: list[str] = []
    spindle_off: list[str] = []
    sub_c_axis_on: list[str] = []
    sub_c_axis_off: list[str] = []
    sub_c_axis_clamp: list[str] = []
    sub_c_axis_unclamp: list[str] = []
    sub_spindle_on: list[str] = []
    sub_spindle_off: list[str] = []
    spindle_orientation: list[str] = []
    tool_change: list[str]
    optional_stop: list[str]
    program_end: list[str]
    stops_reading_ahead: list[str]

    @property
    def with_words(self) -> list[str]:
        """The codes that ask for another word beside them."""
        return [code for codes in msgspec.structs.astuple(self) for code in codes if " " in code]
