"""
The control and the lathe as data: every key of a profile, its type and what it means.

What a key means stands in the docstring of its class and, in the same words, at its line in fanuc.toml.
"""

import math
import re
from collections.abc import Callable
from typing import Annotated, Literal, TypeAlias, TypeVar

import msgspec

from polarcheck.foundation.errors import RuleError
from polarcheck.program.machines.axis_table import INCREMENTS, MOST_NAMED, address_number, axis_of, check_axes
from polarcheck.program.machines.code_lists import GCodes, GCodeSystem, expanded, is_code
from polarcheck.program.machines.feed_keys import WithRotary
from polarcheck.program.machines.m_codes import MCodes, PowerOn
from polarcheck.program.machines.macro_keys import Macro
from polarcheck.program.machines.offset_calls import Offsets
from polarcheck.program.machines.parameters import Meaning
from polarcheck.program.machines.polar_keys import Polar
from polarcheck.program.machines.value_checks import (
    Address,
    AddressOrNone,
    AxisAddress,
    AxisLetterOrNone,
    AxisName,
    CharacterOrNone,
    CornerAddress,
    Count,
    Length,
    MarkOrNone,
    NotNegative,
    Plain,
    Positive,
    SpindleWord,
    SwitchWord,
    ascend,
)
from polarcheck.program.machines.value_types import MOST


class Writing(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How a program for the control is written; it reads more than that. Blanks stand between the words of a block.

    before: blocks in front of the block that switches the polar mode on
    switch: block that switches it on, with C0 where a direction stands in it
    behind: blocks right behind it
    end: block that switches the polar mode off
    behind_end: blocks right behind that
    rapid_in_mode: G0 is written in the mode; where not, a line by rapid_feed stands in its place
    rapid_feed: F of that line [mm/min]
    feed_point: F is written with a point, without which the control may count parts of a unit
    arcs_by: center, radius: what may be written beside the end of an arc; the first where the program does not decide
    arc_radius: word of the radius of an arc, as R or CR=
    arc_split: largest angle of an arc that is written, within arcs.sweep_limit [deg]
    helices: arcs with Z beside X and the virtual axis are written
    live_tool_speed: word of the speed of the live tool, as S or SB=; empty where it is not known
    corner_codes: G codes of how the tool goes through corners at feed, exact stop or not; beside them axis words move
    subprogram_call: block that calls a subprogram, with its number in the place of #; empty where it is not known
    subprogram_repeats: word beside it of how often the subprogram runs; empty where it is not known
    subprogram_return: block that ends a subprogram; empty where it is not known
    program_head: blocks at the head of a program, with its number in the place of #
    program_end: blocks at its end
    archive_heads: of the first and of a further program where a file has several without O; none where it cannot
    """

    before: list[Plain] = []
    switch: Annotated[Plain, msgspec.Meta(min_length=1)]
    behind: list[Plain] = []
    end: Annotated[Plain, msgspec.Meta(min_length=1)]
    behind_end: list[Plain] = []
    rapid_in_mode: bool = False
    rapid_feed: NotNegative
    feed_point: bool = False
    arcs_by: Annotated[list[Literal["center", "radius"]], msgspec.Meta(min_length=1)]
    arc_radius: Plain
    arc_split: Annotated[float, msgspec.Meta(gt=0, le=360)]
    helices: bool = False
    live_tool_speed: Plain = ""
    corner_codes: list[Plain] = []
    subprogram_call: Plain = ""
    subprogram_repeats: Plain = ""
    subprogram_return: Plain = ""
    program_head: list[Plain] = []
    program_end: list[Plain] = []
    archive_heads: list[Plain] = []


class Frames(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Coordinate systems of the program, shifted and turned by words whose lists stand in [g_codes].

    angle_word: address of the angle about the axis across the plane; else it is that of Z; empty without frames
    ended_by_switch: whether what switches the polar mode on or off ends the frame in force
    """

    angle_word: AddressOrNone
    ended_by_switch: bool


def meanings(table: type) -> dict[str, str]:
    """What each key of a table of the profile or of a job means, in the words of its docstring."""
    texts = [kind.__doc__ or "" for kind in reversed(table.__mro__)]
    return dict(re.findall(r"^ {4}(\w+): (.+)$", "\n".join(texts), re.MULTILINE))


Value = TypeVar("Value")


class Control(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How the control reads a program.

    g_code_system: A, B or C: which of the tables [g_code_system_a] to [g_code_system_c] counts
    units: mm or inch: of a program that selects neither; the basic system, where codes leave F in it
    units_of_lengths_alone: codes of units that change lengths alone: F stays in the units of the basic system
    least_increment: least input increment [mm, deg]
    least_increment_inch: least input increment of lengths [inch]
    number_without_point: whether X10 is ten least increments (least-increment) or ten mm, inch or deg (whole-unit)
    digit_limit: most digits of a number
    word_limit: most words of a block
    m_code_limit: most M codes of a block; 0 where that is not known
    line_comments: character that begins a comment up to the end of the line, beside comments in parentheses; or empty
    parentheses_are_comments: whether ( ) holds a comment; where not, the control stops at text in it
    blanks_in_numbers: whether a blank inside a number is ignored; where not, the control stops at X-10 10
    channel_mark: character before the number of a channel, which parts a file in channels: $ in $2; or empty
    wait_mark: character that begins a wait for another channel, which is a comment: ! in !2L10; or empty
    offset_digits: how many of the last digits of T are the offset number: 2 where T0808 is tool 8 with offset 8
    radius_offset_digits: digits of T before those of the tool that number the offset with R; 0: the tool offset has it
    unknown_codes_are_errors: whether the control stops at a G code that is not among the known codes
    x: diameter or radius: what X words are outside the polar mode
    z_into_part: plus or minus: the sense of Z into the part on the main spindle; empty: turning shows it, else minus
    rotary_rolls_over: whether an angle of the rotary axis outside the mode is reached the shorter way: C350. by -10
    axes: names of the axes in the order of their numbers, which P, Q and parameters count; none where it is not known
    named_axes: axes that are written with = (C2=10.), by the address that each is here; empty where it is not followed
    spindle_words: speeds that are written with = (S3=2000), by the spindle: main, sub, live, or empty if not known
    known_codes: G codes of the control, from the whole list of it; G27-G80 is a range of whole numbers
    motion_codes: codes that move but have another number here, by what they mean: G101 = "G1"
    native_words: words of the control's own language, by the code or address that they are read as: TRANSMIT = "G12.1"
    x_radius_words: what makes X a radius from then on: a code, a code with a word (G10.9 X0), a native word (DIAMOF)
    x_diameter_words: what makes X a diameter from then on
    x_absolute_diameter_words: what makes X a diameter from then on where it is a coordinate, a radius where a distance
    x_without_words: diameter or radius: what X words are outside the mode of a program with none of them; empty: as x
    """

    g_code_system: Literal["A", "B", "C"]
    units: Literal["mm", "inch"]
    units_of_lengths_alone: list[str] = []
    least_increment: Positive
    least_increment_inch: Positive
    number_without_point: Literal["least-increment", "whole-unit"]
    digit_limit: Count
    word_limit: Count
    m_code_limit: Annotated[int, msgspec.Meta(ge=0, le=MOST)]
    line_comments: CharacterOrNone
    parentheses_are_comments: bool = True
    blanks_in_numbers: bool = True
    channel_mark: MarkOrNone
    wait_mark: MarkOrNone
    offset_digits: Annotated[int, msgspec.Meta(ge=1, le=4)]
    radius_offset_digits: Annotated[int, msgspec.Meta(ge=0, le=3)]
    unknown_codes_are_errors: bool
    x: Literal["diameter", "radius"]
    z_into_part: Literal["", "minus", "plus"] = ""
    rotary_rolls_over: bool = False
    axes: list[AxisAddress] = []
    named_axes: dict[AxisName, AxisLetterOrNone] = {}
    spindle_words: dict[SpindleWord, Literal["", "main", "sub", "live"]] = {}
    known_codes: list[str]
    motion_codes: dict[str, str] = {}
    native_words: dict[Plain, Plain] = {}
    x_radius_words: list[SwitchWord] = []
    x_diameter_words: list[SwitchWord] = []
    x_absolute_diameter_words: list[SwitchWord] = []
    x_without_words: Literal["", "diameter", "radius"] = ""

    def __post_init__(self) -> None:
        for word, text in self.native_words.items():
            if not word or len(text) > len(word.replace(" ", "")):
                raise ValueError(f"native_words: {text!r} has no room in the place of {word!r}")
        if self.channel_mark and self.channel_mark == self.wait_mark:
            raise ValueError(f"channel_mark and wait_mark are both {self.channel_mark}; expected two characters")
        if len(self.named_axes) + len(self.spindle_words) > MOST_NAMED:
            raise ValueError(f"named_axes, spindle_words: expected {MOST_NAMED} names at most")
        for name, equivalent in self.motion_codes.items():
            if not is_code(name) or "-" in name or equivalent not in ("G0", "G1", "G2", "G3"):
                raise ValueError(f"motion_codes: {name} = {equivalent!r}: expected a G code and one of G0, G1, G2, G3")


class CircularInterpolation(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Circular interpolation.

    tolerance: how much the radius at the end of an arc may differ from that at its start [mm]
    radius_word: address of the radius of an arc
    larger_arc_word: word of a user task beside the radius of an arc of more than 180 deg; empty without one
    sweep_limit: largest angle of one arc [deg]
    takes_sweep_limit: an arc by radius through exactly that angle is certain
    corner_words: words of arcs that in a straight move are the corner at its end
    made_corners: word -> radius, modal-radius, leg or length (of a chamfer): corners that the control makes in the mode
    """

    tolerance: NotNegative
    radius_word: Address
    larger_arc_word: Plain = ""
    sweep_limit: Annotated[float, msgspec.Meta(gt=0, le=360)]
    takes_sweep_limit: bool = True
    corner_words: list[Address]
    made_corners: dict[CornerAddress, Literal["radius", "modal-radius", "leg", "length"]] = {}

    @property
    def corners_not_made(self) -> list[str]:
        """Words of a corner between two moves that the control does not make in the mode."""
        return [word for word in (",R", ",C") if word not in self.made_corners]


class Compensation(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Cutter compensation.

    start_up: type of start-up and cancel: A, B, or C, where G41 and G40 alone move the tool
    start_up_with_move: type, A or B, of blocks that move, where the type is C
    read_ahead: blocks that the control knows in advance; all but two of them may be without a move
    interference: alarm or erase: what the control does about interference
    tangent_tolerance: turn up to which two blocks are tangent to each other [rad]
    corner: lines, intersection or arc: the way round outer corners where no code says it; lines: as FANUC controls
    corner_arc_above: turn of the contour above which a corner by intersection becomes an arc [deg]; 180: none does
    corner_arc_from: turn of the contour below which a corner by an arc becomes an intersection [deg]
    leaving_cancels: whether G13.1 takes back an offset after whose G40 nothing has moved
    nose_types: nose types, T of the offset table, of a tool whose center is programmed
    overcut_tolerance: how deep the tool may cut into the contour before it is reported [mm]
    """

    start_up: Literal["A", "B", "C"]
    start_up_with_move: Literal["A", "B"]
    read_ahead: Annotated[int, msgspec.Meta(ge=2, le=MOST)]
    interference: Literal["alarm", "erase"]
    tangent_tolerance: Annotated[float, msgspec.Meta(ge=0, le=math.pi / 2)]
    corner: Literal["lines", "intersection", "arc"]
    corner_arc_above: Annotated[float, msgspec.Meta(ge=0, le=180)]
    corner_arc_from: Annotated[float, msgspec.Meta(ge=0, le=180)]
    leaving_cancels: bool
    nose_types: Annotated[list[Annotated[int, msgspec.Meta(ge=0, le=9)]], msgspec.Meta(min_length=1)]
    # Arcs become chords that differ from them by less: at 0 there is no end of them.
    overcut_tolerance: Annotated[float, msgspec.Meta(ge=1e-4, le=1000)]


class Limits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    What the lathe can do; NaN where the profile does not know.

    c_feed: largest cutting feed of the C axis [deg/min]; 100 turns a minute are 36000
    c_feed_harmless: feed of the C axis that every lathe manages, so that its limit does not matter [deg/min]
    c_feed_suspicious: feed of the C axis that is suspicious where its limit is not known [deg/min]
    c_acceleration: largest acceleration of the C axis [deg/s2]
    x_feed: largest cutting feed of X, as a radius [mm/min]
    x_acceleration: largest acceleration of X, as a radius [mm/s2]
    x_rapid: rapid traverse of X, as a radius [mm/min]
    z_rapid: rapid traverse of Z [mm/min]
    c_rapid: rapid traverse of the C axis [deg/min]
    polar_feed: largest F in the polar mode [mm/min]
    polar_feed_clamps: whether the control clamps a higher F at it; else it runs as programmed
    automatic_override: whether the control slows down by itself where C would turn too fast
    override_share: share of the limit of C above which it does so, and which it leaves [%]
    live_tool_speed: highest speed of the live tool [1/min]
    block_time: shortest time of a block; F falls where a series of blocks is shorter [s]
    keep_out: how far the tool center should stay away from the center of C [mm]
    x_minimum: travel limit of X, as a radius [mm]
    x_maximum: travel limit of X, as a radius [mm]
    z_minimum: travel limit of Z [mm]
    z_maximum: travel limit of Z [mm]
    """

    c_feed: Positive = math.nan
    c_feed_harmless: Positive
    c_feed_suspicious: Positive
    c_acceleration: NotNegative = math.nan
    x_feed: Positive = math.nan
    x_acceleration: Positive = math.nan
    x_rapid: Positive = math.nan
    z_rapid: Positive = math.nan
    c_rapid: Positive = math.nan
    polar_feed: Positive = math.nan
    polar_feed_clamps: bool = True
    automatic_override: bool = False
    override_share: Positive
    live_tool_speed: Positive = math.nan
    block_time: Positive = math.nan
    keep_out: NotNegative = math.nan
    x_minimum: Length = math.nan
    x_maximum: Positive = math.nan
    z_minimum: Length = math.nan
    z_maximum: Length = math.nan

    def __post_init__(self) -> None:
        ascend(self, ("x_minimum", "x_maximum"), ("z_minimum", "z_maximum"))


#: What a word of a dwell counts. seconds, hundredths: with a point and without. thousandths: without a point; with one
#: it is not known. thousandths-or-seconds: seconds with a point. as-lengths: seconds with a point; without one least
#: increments, 0.001 s, or seconds, as control.number_without_point says. turns: of the spindle.
DwellUnit: TypeAlias = Literal["seconds", "hundredths", "thousandths", "thousandths-or-seconds", "as-lengths", "turns"]


class Feed(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    Feeds; NaN where the builder recommends none.

    cutting_minimum: lowest F that the builder recommends for cutting [mm/min]
    cutting_maximum: highest F that the builder recommends for cutting [mm/min]
    positioning_minimum: lowest F that the builder recommends for positioning in the polar mode [mm/min]
    positioning_maximum: highest F that the builder recommends for positioning in the polar mode [mm/min]
    carried_into_polar: F from before G12.1 that holds behind it: any (modal) or none per revolution (per-minute-only)
    dwell_words: word of a dwell -> seconds, hundredths, thousandths, thousandths-or-seconds, as-lengths or turns
    dwell_per_revolution: what these words count where feed per revolution is in force: times, or turns of the spindle
    with_rotary: what F can be where X and C move together outside the mode, the first by itself; none if not known
    """

    cutting_minimum: NotNegative = math.nan
    cutting_maximum: Positive = math.nan
    positioning_minimum: NotNegative = math.nan
    positioning_maximum: Positive = math.nan
    carried_into_polar: Literal["modal", "per-minute-only"] = "modal"
    dwell_words: dict[Address, DwellUnit]
    dwell_per_revolution: Literal["times", "turns"]
    with_rotary: list[WithRotary] = []

    def __post_init__(self) -> None:
        ascend(self, ("cutting_minimum", "cutting_maximum"), ("positioning_minimum", "positioning_maximum"))


class Machine(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """
    A lathe: the merged profile.

    title: what messages call it
    alarms: rule -> alarm that the control shows
    alarm_codes: alarm -> the G codes, and lists of G codes, that its text names; at others its number is not proved
    severities: rule -> error, warning, note or off, where the rule itself says otherwise
    notes: what is not known, or why a rule is silent
    known_parameters: control parameter -> the values of this file that it stands for (parameters.Meaning)
    parameters: control parameter -> its value, as the user's own control shows it
    """

    title: str
    control: Control
    polar: Polar
    arcs: CircularInterpolation
    compensation: Compensation
    limits: Limits
    feed: Feed
    power_on: PowerOn
    m_codes: MCodes
    g_codes: GCodes
    g_code_system_a: GCodeSystem
    g_code_system_b: GCodeSystem
    g_code_system_c: GCodeSystem
    macro: Macro
    offsets: Offsets
    frames: Frames
    writing: Writing
    alarms: dict[str, str] = {}
    alarm_codes: dict[str, list[str]] = {}
    severities: dict[str, Literal["error", "warning", "note", "off"]] = {}
    notes: list[str] = []
    known_parameters: dict[str, Meaning] = {}
    parameters: dict[str, int | float | str] = {}

    def __post_init__(self) -> None:
        check_axes(self.axes, self.polar.linear_axis, self.polar.rotary_axis, self.polar.rotary_address)
        virtual = self.polar.virtual_axes
        if virtual == [axis_of(self.axes or [self.polar.linear_address], self.polar.linear_axis)]:
            raise ValueError(f"polar.virtual_axis is {virtual[0]}, which is the linear axis")

    @property
    def axes(self) -> list[str]:
        """The axes in the order of their numbers, by the addresses that they are here; none where it is not known."""
        named = self.control.named_axes
        return [named.get(name) or name for name in self.control.axes]

    def linear_address_of(self, number: float) -> str:
        """
        The address of the linear axis with a number, as P beside G12.1 has it; empty where that is not known, or where
        the virtual axis has the same one.
        """
        axes = self.axes or [self.polar.linear_address]
        name = axis_of(axes, number)
        return name if name in INCREMENTS and name != self.polar.virtual_axis else ""

    @property
    def linear_address(self) -> str:
        """The address of the linear axis where no P beside G12.1 says otherwise; empty where that is not known."""
        return self.linear_address_of(self.polar.linear_axis)

    @property
    def axis_words(self) -> tuple[str, ...]:
        """The addresses that move an axis, absolute and incremental; without those that are written with =."""
        return (*"XYZUVW", *(address for address in self.polar.rotary_words if len(address) == 1))

    def address_number(self, address: str) -> int:
        """
        What the table of executed words has for an address, be it the name of an axis that is written with =: that of
        the address that the axis is here, NOT_NAMED or NO_AXIS for a name that control.named_axes does not have. The
        speeds of control.spindle_words stand behind the axes.
        """
        if len(address) == 1:
            return ord(address)
        named = self.control.named_axes
        return address_number(named.get(address) or address, [*sorted(named), *sorted(self.control.spindle_words)])

    @property
    def live_tool_speeds(self) -> tuple[str, ...]:
        """The speeds of live tools that are written with =, as S3."""
        return tuple(word for word, spindle in self.control.spindle_words.items() if spindle == "live")

    @property
    def has_edges(self) -> bool:
        """Whether tools may be called by a name, or by number and edge."""
        return self.offsets.called_by == "edge" or self.macro.language == "high-level"

    @property
    def system_table(self) -> str:
        """The table of the G-code system in force."""
        return f"g_code_system_{self.control.g_code_system.lower()}"

    @property
    def system(self) -> GCodeSystem:
        """The codes of the G-code system in force."""
        system: GCodeSystem = getattr(self, self.system_table)
        return system

    @property
    def code_tables(self) -> tuple[str, ...]:
        """The tables with lists of G codes: those of the G-code system in force among them."""
        return ("g_codes", "macro", self.system_table)

    def table_of(self, key: str) -> str:
        """The table of a list of codes: that of the G-code system in force where it differs between systems."""
        for table in self.code_tables:
            if key in getattr(self, table).__struct_fields__:
                return table
        raise RuleError(f"there is no list of G codes {key!r}: see [g_codes], [g_code_system_a] and [macro]")

    @property
    def listed_codes(self) -> list[str]:
        """The codes of all lists of [g_codes] and of the G-code system in force: what the control has, too."""
        lists = [*msgspec.structs.astuple(self.g_codes), *msgspec.structs.astuple(self.system)]
        return [code for codes in lists for code in codes if isinstance(code, str)]

    def codes_of_alarm(self, alarm: str) -> list[str]:
        """The codes that the text of an alarm names, one by one; none where it is shown at any."""
        listed = self.alarm_codes.get(alarm, [])
        return expanded(code for name in listed for code in ([name] if is_code(name) else self.codes(name)))

    def codes(self, key: str) -> list[str]:
        """The codes of a list, whichever table it is in, one by one. Raises RuleError for a list that there is not."""
        listed = self.cached(key, lambda: tuple(expanded(getattr(getattr(self, self.table_of(key)), key))))
        return list(listed)

    def cached(self, name: str, make: Callable[[], Value]) -> Value:
        """Return what is computed from the keys, once for each machine: nobody changes these."""
        if name not in self.__dict__:
            self.__dict__[name] = make()
        value: Value = self.__dict__[name]
        return value


class OwnMachine(Machine, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A lathe of the user's own. file: where its values stand, and where others are to be added."""

    file: str
