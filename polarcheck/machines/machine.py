"""The control and the lathe as data: every key of a profile, its type and what it means."""

import math
import re
from typing import Literal, TypeAlias

import msgspec

from polarcheck.machines.parameters import Meaning

#: First and last number of each range.
Ranges: TypeAlias = list[tuple[int, int]]

_FLOW_CODE = re.compile(r"[GM](?:0|[1-9]\d*)(?:\.[1-9])?")


def _is_code(text: str) -> bool:
    return text[:1] == "G" and text[1:].replace(".", "", 1).isdecimal()


class Control(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How the control reads a program.

    x: what X words are outside the polar mode. motion_codes: codes of other numbers, by what they mean (G101 = "G1").
    native_words: words of the control's own language, and the text of the same length or shorter that is read in their
    place (TRANSMIT = "G12.1"). x_radius_words, x_diameter_words: what makes X a radius or a diameter from then on, a
    code alone ("G7") or with another word ("G10.9 X0").
    """

    g_code_system: Literal["A", "B", "C"]
    units: Literal["mm", "inch"]
    least_increment: float
    least_increment_inch: float
    number_without_point: Literal["least-increment", "whole-unit"]
    digit_limit: int
    word_limit: int
    m_code_limit: int
    line_comments: str
    offset_digits: int
    known_codes: list[str]
    unknown_codes_are_errors: bool
    x: Literal["diameter", "radius"]
    motion_codes: dict[str, str] = {}
    native_words: dict[str, str] = {}
    x_radius_words: list[str] = []
    x_diameter_words: list[str] = []

    def __post_init__(self) -> None:
        for word, text in self.native_words.items():
            if not word or len(text) > len(word):
                raise ValueError(f"native_words: {text!r} has no room in the place of {word!r}")
        for name, meant in self.motion_codes.items():
            if not _is_code(name) or meant not in ("G0", "G1", "G2", "G3"):
                raise ValueError(f"motion_codes: {name} = {meant!r}: expected a G code and one of G0, G1, G2, G3")


class Polar(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    The polar mode.

    x, virtual_axis_is: what words of the linear and of the virtual axis are in the mode. center_words: of arcs, along
    the linear and along the virtual axis. linear_axis, rotary_axis: their numbers, as P and Q beside G12.1 name them.
    infeed_word: beside G12.1, the depth of each cut of a cycle that goes round the contour; empty where there is none.
    other_on: what begins the polar mode of other controls, by which a program for them is known.
    """

    on: list[str]
    off: list[str]
    switch_words: list[str]
    virtual_axis: str
    virtual_axis_increment: str
    other_virtual_axis: list[str]
    other_virtual_axis_of: str = ""
    other_on: list[str] = []
    x: Literal["diameter", "radius"]
    virtual_axis_is: Literal["radius", "diameter"]
    center_words: tuple[str, str]
    linear_axis: int
    rotary_axis: int
    infeed_word: str
    allowed_codes: list[str]
    plane_before: list[str]
    main_spindle_must_stop: bool

    @property
    def other_center_word(self) -> str:
        """The address of arc centers that is of no axis of the polar plane."""
        return next(word for word in ("K", "I", "J") if word not in self.center_words)


class CircularInterpolation(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Circular interpolation."""

    tolerance: float
    radius_word: str
    sweep_limit: float


class Compensation(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Cutter compensation."""

    start_up: Literal["A", "B", "C"]
    start_up_moving: Literal["A", "B"]
    read_ahead: int
    interference: Literal["alarm", "erase"]
    tangent_tolerance: float
    nose_types: list[int]
    overcut_tolerance: float


class Limits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    What the lathe can do; NaN where the profile does not know. mm, deg, min; accelerations in deg/s2; X as radius.

    automatic_override: the control slows down where C would turn faster than override_share [%] of c_feed.
    """

    c_feed: float = math.nan
    c_feed_suspicious: float
    c_acceleration: float = math.nan
    polar_feed: float = math.nan
    automatic_override: bool = False
    override_share: float
    keep_out: float = math.nan
    x_minimum: float = math.nan
    x_maximum: float = math.nan
    z_minimum: float = math.nan
    z_maximum: float = math.nan


class Feed(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Feeds that the builder recommends [mm/min]; NaN where it does not."""

    cutting_minimum: float = math.nan
    cutting_maximum: float = math.nan
    positioning_minimum: float = math.nan
    positioning_maximum: float = math.nan
    inheritance: Literal["modal", "per-minute-only"] = "modal"


class MCodes(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The builder's M codes; empty where the profile does not know them."""

    c_axis_on: list[str] = []
    c_axis_off: list[str] = []
    live_tool_on: list[str] = []
    live_tool_off: list[str] = []
    spindle_on: list[str] = []
    spindle_off: list[str] = []
    program_end: list[str]
    stops_reading: list[str]


class Macro(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Custom macro and calls.

    local_variables: ranges, first and last number, of local variables, of which each macro call has its own
    common_variables: ranges of common variables that are vacant at power-on
    retained_variables: ranges of common variables that outlive the power-off: not known until a program assigns them
    system_variables: ranges of system variables: offsets, positions, modal states, signals; not known unless given
    read_only_variables: ranges of system variables that a program cannot assign; nor can it #0, which is always vacant
    clock_variables: ranges of system variables that count on by themselves: not known even after an assignment
    alarm_variables: system variables by which a program ends itself with an alarm: #3000 = 1 (MESSAGE)
    stop_variables: system variables by which a program stops with a message until cycle start: #3006 = 1 (MESSAGE)
    subprogram_calls: codes that call a subprogram by its number in P or its <NAME>; M198 that of another device
    macro_calls: codes that call a macro once; the other words of the block are its arguments
    modal_macro_calls: codes after which each block that moves an axis calls the macro
    modal_macro_calls_each_block: modal calls that take the words of each block as arguments, G codes too
    modal_macro_cancel: codes that end a modal call
    program_returns: codes that return from a called program
    computed_increments: address -> what a computed value is rounded to there; elsewhere to the least input increment
    bracket_levels: most levels of brackets in an expression, those of functions included
    loop_numbers: highest number of DO and END
    loop_levels: most loops inside each other
    subprogram_levels: most levels of subprogram calls
    macro_levels: most levels of macro calls
    repeats_in_p: whether P of a subprogram call with more than four digits has the repeats before the last four
    second_arguments: whether a macro call takes I J K up to ten times: argument specification II
    signed_angles: whether ATAN gives -180 to 180 and ASIN -90 to 90, else 0 to 360 and 270 to 90
    largest_number: a result above it overflows
    given: variable -> its value, as the job or the machine knows it
    """

    local_variables: Ranges
    common_variables: Ranges
    retained_variables: Ranges
    system_variables: Ranges
    read_only_variables: Ranges
    clock_variables: Ranges
    alarm_variables: list[int]
    stop_variables: list[int]
    subprogram_calls: list[str]
    macro_calls: list[str]
    modal_macro_calls: list[str]
    modal_macro_calls_each_block: list[str]
    modal_macro_cancel: list[str]
    program_returns: list[str]
    computed_increments: dict[str, float]
    bracket_levels: int
    loop_numbers: int
    loop_levels: int
    subprogram_levels: int
    macro_levels: int
    repeats_in_p: bool
    second_arguments: bool
    signed_angles: bool
    largest_number: float
    given: dict[int, float] = {}

    def __post_init__(self) -> None:
        for code in self.flow_codes:
            if not _FLOW_CODE.fullmatch(code):
                raise ValueError(f"{code!r}: expected a G or M code as in G66.1 or M98, without leading zeros")
        for address, increment in self.computed_increments.items():
            if not re.fullmatch("[A-Z]", address) or not increment > 0:
                raise ValueError(f"computed_increments: {address} = {increment}: expected a letter and a value above 0")

    @property
    def macro_call_codes(self) -> frozenset[str]:
        """The codes that call a macro with arguments, once or modally."""
        return frozenset((*self.macro_calls, *self.modal_macro_calls, *self.modal_macro_calls_each_block))

    @property
    def call_codes(self) -> frozenset[str]:
        """The codes that call a program."""
        return self.macro_call_codes | frozenset(self.subprogram_calls)

    @property
    def flow_codes(self) -> frozenset[str]:
        """The codes that call a program, end a modal call, or return."""
        return self.call_codes | frozenset((*self.modal_macro_cancel, *self.program_returns))


class Machine(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    A lathe: the merged profile. severities: rule -> error, warning, note or off. alarms: rule -> alarm. notes: what is
    not known, or why a rule is silent. meanings: control parameter -> the values that it sets. parameters: those of the
    user's own control, as it shows them (parameters.py).
    """

    title: str
    control: Control
    polar: Polar
    arcs: CircularInterpolation
    compensation: Compensation
    limits: Limits
    feed: Feed
    m_codes: MCodes
    macro: Macro
    alarms: dict[str, str] = {}
    severities: dict[str, Literal["error", "warning", "note", "off"]] = {}
    notes: list[str] = []
    meanings: dict[str, Meaning] = {}
    parameters: dict[str, int | float | str] = {}
