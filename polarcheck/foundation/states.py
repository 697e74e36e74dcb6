"""The modal states of a lathe control, and which code list of the machine sets each of them."""

from __future__ import annotations

import enum
from typing import TypeVar

MM_PER_INCH = 25.4
_States = TypeVar("_States", bound=type[enum.IntEnum])


def plain(states: _States) -> _States:
    """
    Make the names of an enum give its plain numbers.

    NumPy takes 6 us to see that a member of an enum is a number, four times the comparison of a small column with one.
    """
    for name, member in states.__members__.items():
        type.__setattr__(states, name, int(member))
    return states


@plain
class Motion(enum.IntEnum):
    """The motion that a block makes of its axis words."""

    UNKNOWN = -2
    NONE = -1
    RAPID = 0
    LINE = 1
    CW = 2
    CCW = 3
    CYCLE = 9


@plain
class Side(enum.IntEnum):
    """Cutter compensation: tool left or right of the programmed path, seen along the travel."""

    OFF = 40
    LEFT = 41
    RIGHT = 42


@plain
class Corner(enum.IntEnum):
    """How cutter compensation goes round an outer corner; where codes say it, valued like those."""

    LINES = 0
    ARC = 450
    INTERSECTION = 451


@plain
class Units(enum.IntEnum):
    """The unit of lengths and feeds in the program."""

    INCH = 20
    MM = 21


@plain
class FeedMode(enum.IntEnum):
    """What F means; valued like the codes of systems B and C."""

    INVERSE_TIME = 93
    PER_MINUTE = 94
    PER_REVOLUTION = 95


@plain
class FeedAxes(enum.IntEnum):
    """What F is along where Z moves beside X and C."""

    AS_MACHINE = 0
    PLANE = 1
    SPACE = 2


@plain
class ArcFeed(enum.IntEnum):
    """Where F is on arcs in cutter compensation."""

    CENTER = 0
    CONTOUR = 1
    INNER_CONTOUR = 2


@plain
class Distance(enum.IntEnum):
    """What axis words mean in systems B and C."""

    ABSOLUTE = 90
    INCREMENTAL = 91


#: A state that is the number of the code itself, without what stands behind its point: 83 for G83 and for G83.5.
OF_CODE = -2

#: Modal group -> code list of the machine (code_lists.py) -> the state that its codes set.
STATES: dict[str, dict[str, int]] = {
    "motion": {
        "rapid": Motion.RAPID,
        "line": Motion.LINE,
        "arc_clockwise": Motion.CW,
        "arc_counterclockwise": Motion.CCW,
        "motion_not_followed": Motion.CYCLE,
        "thread_cutting": Motion.CYCLE,
        "turning_cycle": Motion.CYCLE,
        "threading_cycle": Motion.CYCLE,
        "facing_cycle": Motion.CYCLE,
    },
    "plane": {"plane_xy": OF_CODE, "plane_zx": OF_CODE, "plane_yz": OF_CODE},
    "side": {"compensation_off": Side.OFF, "compensation_left": Side.LEFT, "compensation_right": Side.RIGHT},
    "feed_axes": {
        "feed_on_plane": FeedAxes.PLANE,
        "feed_in_space": FeedAxes.SPACE,
        "feed_as_machine": FeedAxes.AS_MACHINE,
    },
    "arc_feed": {
        "feed_at_center": ArcFeed.CENTER,
        "feed_at_contour": ArcFeed.CONTOUR,
        "feed_at_inner_contour": ArcFeed.INNER_CONTOUR,
    },
    "corner": {"corner_by_arc": Corner.ARC, "corner_by_intersection": Corner.INTERSECTION},
    "units": {"inch": Units.INCH, "mm": Units.MM},
    "feed_mode": {
        "feed_inverse_time": FeedMode.INVERSE_TIME,
        "feed_per_minute": FeedMode.PER_MINUTE,
        "feed_per_revolution": FeedMode.PER_REVOLUTION,
    },
    "distance": {"absolute": Distance.ABSOLUTE, "incremental": Distance.INCREMENTAL},
    "speed": {"constant_surface_speed": OF_CODE, "constant_surface_speed_off": 0},
    "work_offset": {"work_offset": OF_CODE, "work_offset_extended": OF_CODE},
    "drilling": {"drilling_cycle": OF_CODE, "drilling_cycle_off": 0},
    "scaling": {"scaling": OF_CODE, "scaling_off": 0},
    "rotation": {"rotation": OF_CODE, "rotation_off": 0},
    "mirror": {"mirror_image": OF_CODE, "mirror_image_off": 0},
    "modal_call": {"modal_macro_calls": OF_CODE, "modal_macro_calls_each_block": OF_CODE, "modal_macro_cancel": 0},
}
#: The motion of a move that is followed -> its code list; the meaning of F -> its code list.
MOVES = {state: key for key, state in STATES["motion"].items() if state != Motion.CYCLE}
FEED_MODES = {state: key for key, state in STATES["feed_mode"].items()}

#: The lists of codes beside which axis words are no end point of a move: dwell, offsets, references, shifts, calls.
NO_MOVE = (
    "dwell",
    "data_input",
    "reference_check",
    "reference_return",
    "local_shift",
    "frame_shift",
    "frame_shift_added",
    "frame_rotation",
    "frame_rotation_added",
    "frame_not_simulated",
    "machine_coordinates",
    "macro_calls",
    "modal_macro_calls",
    "modal_macro_calls_each_block",
    "repetitive_cycle",
    "coordinate_setting",
    "coordinate_preset",
    "scaling",
    "rotation",
    "mirror_image",
    "axis_words_no_move",
)
#: The lists of codes beside which F is no feed: a time, an argument, the lead of a thread.
NO_FEED = (
    "dwell",
    "data_input",
    "macro_calls",
    "modal_macro_calls",
    "modal_macro_calls_each_block",
    "feed_is_lead",
)
