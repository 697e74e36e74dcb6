"""The modal states of a lathe control and the codes that set them, as data, per G-code system."""

from __future__ import annotations

import enum

MM_PER_INCH = 25.4


class Motion(enum.IntEnum):
    """What a block does with its axis words."""

    NONE = -1
    RAPID = 0
    LINE = 1
    CW = 2
    CCW = 3
    CYCLE = 9


class Side(enum.IntEnum):
    """Cutter compensation: tool left or right of the programmed path, seen along the travel."""

    OFF = 40
    LEFT = 41
    RIGHT = 42


class Units(enum.IntEnum):
    """Of lengths and feeds in the program."""

    INCH = 20
    MM = 21


class FeedMode(enum.IntEnum):
    """What F means; valued like the codes of systems B and C."""

    INVERSE_TIME = 93
    PER_MINUTE = 94
    PER_REVOLUTION = 95


class Distance(enum.IntEnum):
    """What axis words mean in systems B and C."""

    ABSOLUTE = 90
    INCREMENTAL = 91


#: Codes of group 01 that move in ways not simulated: involutes, threads, cycles.
_CYCLES_OF_ALL = ("G2.2", "G3.2", "G2.4", "G3.4", "G6.2", "G34", "G35", "G36")

_MOTION: dict[str, int] = {"G0": Motion.RAPID, "G1": Motion.LINE, "G2": Motion.CW, "G3": Motion.CCW}

_OF_ALL: dict[str, dict[str, int]] = {
    "plane": {"G17": 17, "G18": 18, "G19": 19},
    "side": {"G40": Side.OFF, "G41": Side.LEFT, "G42": Side.RIGHT},
    "speed": {"G96": 96, "G97": 97},
    "work_offset": {f"G{number}": number for number in range(54, 60)} | {"G54.1": 54},
    "drilling": {"G80": 0} | {f"G{number}": number for number in range(81, 90)} | {"G83.1": 83, "G83.5": 83},
    "scaling": {"G51": 51, "G50": 0},
    "rotation": {"G68.1": 68, "G69.1": 0},
    "mirror": {"G68": 68, "G69": 0, "G51.1": 51, "G50.1": 0},
    "modal_call": {"G66": 66, "G66.1": 66, "G67": 0},
}

#: Group -> code -> state, for the G-code systems of FANUC lathes (parameter 3401#6, #7).
MODAL_GROUPS: dict[str, dict[str, dict[str, int]]] = {
    "A": _OF_ALL
    | {
        "motion": _MOTION | dict.fromkeys((*_CYCLES_OF_ALL, "G32", "G90", "G92", "G94"), Motion.CYCLE),
        "units": {"G20": Units.INCH, "G21": Units.MM},
        "feed_mode": {"G93": FeedMode.INVERSE_TIME, "G98": FeedMode.PER_MINUTE, "G99": FeedMode.PER_REVOLUTION},
    },
    "B": _OF_ALL
    | {
        "motion": _MOTION | dict.fromkeys((*_CYCLES_OF_ALL, "G33", "G77", "G78", "G79"), Motion.CYCLE),
        "units": {"G20": Units.INCH, "G21": Units.MM},
        "feed_mode": {"G93": FeedMode.INVERSE_TIME, "G94": FeedMode.PER_MINUTE, "G95": FeedMode.PER_REVOLUTION},
        "distance": {"G90": Distance.ABSOLUTE, "G91": Distance.INCREMENTAL},
    },
    "C": _OF_ALL
    | {
        "motion": _MOTION | dict.fromkeys((*_CYCLES_OF_ALL, "G33", "G20", "G21", "G24"), Motion.CYCLE),
        "units": {"G70": Units.INCH, "G71": Units.MM},
        "feed_mode": {"G93": FeedMode.INVERSE_TIME, "G94": FeedMode.PER_MINUTE, "G95": FeedMode.PER_REVOLUTION},
        "distance": {"G90": Distance.ABSOLUTE, "G91": Distance.INCREMENTAL},
    },
}

_TAKES_AXIS_WORDS = (
    *("G4", "G10", "G10.9", "G22", "G27", "G28", "G30", "G30.1", "G31", "G37", "G51", "G50.2", "G51.2", "G52", "G53"),
    *("G65", "G66", "G66.1", "G68", "G68.1", "G7.1", "G107", "G72", "G73", "G74", "G75", "G76"),
)
#: Codes whose axis words are not end points of a move: dwell, offsets, references, shifts, calls, cycles.
TAKES_AXIS_WORDS: dict[str, tuple[str, ...]] = {
    "A": (*_TAKES_AXIS_WORDS, "G50", "G70", "G71"),
    "B": (*_TAKES_AXIS_WORDS, "G92", "G70", "G71"),
    "C": (*_TAKES_AXIS_WORDS, "G92", "G77", "G78"),
}

#: The code that sets the work coordinate of the present position (and, with S, the highest spindle speed).
COORDINATE_SETTING = {"A": "G50", "B": "G92", "C": "G92"}
