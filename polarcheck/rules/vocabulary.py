"""The names of values in findings: what each of them is, and its unit; a name is the same in every rule."""

from __future__ import annotations

import enum
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from polarcheck.foundation.errors import RuleError


class Kind(enum.Enum):
    """What a value is. The units are those of the whole report, whatever the units of the program."""

    LENGTH = "mm"
    ANGLE = "deg"
    FEED = "mm/min"
    FEED_PER_REVOLUTION = "mm/rev"
    RATE = "deg/min"
    ANGULAR_ACCELERATION = "deg/s2"
    ACCELERATION = "mm/s2"
    TIME = "s"
    SPEED = "rev/min"
    COUNT = "count"
    LINE = "line"
    NUMBER = "number"
    OFFSET = "offset"
    TEXT = "text"

    @property
    def is_whole(self) -> bool:
        """Its values are whole numbers."""
        return self in (Kind.COUNT, Kind.LINE, Kind.NUMBER, Kind.OFFSET)


class Meaning(NamedTuple):
    """
    A name of the vocabulary.

    kind: None for a value that has the kind of the number before it.
    text: what it is.
    """

    kind: Kind | None
    text: str


#: A name that stands for the same in every rule, in the unit of the number that it limits.
LIMIT = "limit"

VOCABULARY: Mapping[str, Meaning] = {
    # Text.
    "axis": Meaning(Kind.TEXT, "address of the axis"),
    "changed_by": Meaning(Kind.TEXT, "the code, word or variable that makes the change"),
    "code": Meaning(Kind.TEXT, "the code at fault; several as `G17, M5`, alternatives as `M3 or M4`"),
    "code_needed": Meaning(Kind.TEXT, "the code that is missing, or to be written instead"),
    "comment": Meaning(Kind.TEXT, "the comment of the program"),
    "drawing": Meaning(Kind.TEXT, "the drawing or the shape that the part is compared with"),
    "expression": Meaning(Kind.TEXT, "the macro expression"),
    "names": Meaning(Kind.TEXT, "names in an allow comment"),
    "other_code": Meaning(Kind.TEXT, "the code that it contradicts"),
    "program": Meaning(Kind.TEXT, "the program that is called"),
    "variable": Meaning(Kind.TEXT, "the macro variable, with its number where that is computed"),
    "word": Meaning(Kind.TEXT, "the word or words at fault, as they are written"),
    "word_needed": Meaning(Kind.TEXT, "the word or words to write instead"),
    # Numbers of a program.
    "number": Meaning(Kind.NUMBER, "the sequence number"),
    "nose": Meaning(Kind.NUMBER, "nose type of the tool offset"),
    "offset": Meaning(Kind.OFFSET, "the tool offset: its number, or tool and edge as `MILL_8/1`"),
    "other_line": Meaning(Kind.LINE, "line of the other block that the message names"),
    "tool": Meaning(Kind.NUMBER, "the tool that is called"),
    "tool_named": Meaning(Kind.NUMBER, "the tool that the comment names"),
    # Counts.
    "blocks": Meaning(Kind.COUNT, "blocks without a move on the plane"),
    "characters": Meaning(Kind.COUNT, "foreign characters in the line"),
    "count": Meaning(Kind.COUNT, "words, comments or blocks of the file that it stands for"),
    "digits": Meaning(Kind.COUNT, "digits of the number"),
    "passes": Meaning(Kind.COUNT, "passes of the infeed cycle"),
    "unfit": Meaning(Kind.COUNT, "passes of the infeed cycle that do not fit"),
    # Lengths.
    "allowance": Meaning(Kind.LENGTH, "distance of a pass of the infeed cycle from the contour"),
    "arc_radius": Meaning(Kind.LENGTH, "radius of the arc"),
    "arc_radius_needed": Meaning(Kind.LENGTH, "radius that the arc must have, or the least one"),
    "chord": Meaning(Kind.LENGTH, "distance from start to end of the arc"),
    "clearance": Meaning(Kind.LENGTH, "clearance that the job asks for, in X as a diameter"),
    "cut_away": Meaning(Kind.LENGTH, "most that is missing on the part"),
    "depth": Meaning(Kind.LENGTH, "how deep the cutter goes into the part or contour"),
    "diameter": Meaning(Kind.LENGTH, "diameter of the cutter"),
    "difference": Meaning(Kind.LENGTH, "distance of two points or radii that should agree"),
    "end_radius": Meaning(Kind.LENGTH, "distance of the end of the arc from its center"),
    "farthest": Meaning(Kind.LENGTH, "the largest of the lengths that look like angles"),
    "gap": Meaning(Kind.LENGTH, "distance of the two ends of the contour"),
    "height": Meaning(Kind.LENGTH, "height of the rib, or thickness of the strip, that stays"),
    "highest_radius": Meaning(Kind.LENGTH, "the largest R for which the contour has room"),
    "infeed": Meaning(Kind.LENGTH, "infeed that the control takes"),
    "largest": Meaning(Kind.LENGTH, "largest difference from the drawing"),
    "length": Meaning(Kind.LENGTH, "length of the ramp on the plane"),
    "length_needed": Meaning(Kind.LENGTH, "length that the ramp needs on the plane"),
    "made": Meaning(Kind.LENGTH, "the size that the program makes"),
    "nearest": Meaning(Kind.LENGTH, "smallest distance of the tool center from the center of C"),
    "plane_c": Meaning(Kind.LENGTH, "second coordinate of the place on the polar plane"),
    "plane_x": Meaning(Kind.LENGTH, "first coordinate of the place on the polar plane, X as a radius"),
    "position": Meaning(Kind.LENGTH, "where the axis would go, X as a radius"),
    "radius": Meaning(Kind.LENGTH, "R of the cutter"),
    "radius_stated": Meaning(Kind.LENGTH, "R of the cutter by the comment"),
    "reach": Meaning(Kind.LENGTH, "how far from the center the rest of the section goes"),
    "shift": Meaning(Kind.LENGTH, "distance of X0 from the spindle axis"),
    "start_radius": Meaning(Kind.LENGTH, "distance of the start of the arc from its center"),
    "stated": Meaning(Kind.LENGTH, "the size that the comment states"),
    "stock": Meaning(Kind.LENGTH, "diameter of the bar"),
    "tolerance": Meaning(Kind.LENGTH, "difference that is allowed"),
    "too_much": Meaning(Kind.LENGTH, "most that is left standing on the part"),
    "width": Meaning(Kind.LENGTH, "room between the walls"),
    "x": Meaning(Kind.LENGTH, "X of the machine, as a radius"),
    "x_wear": Meaning(Kind.LENGTH, "wear in X of the offset table"),
    "x_needed": Meaning(Kind.LENGTH, "X that is needed, as a radius"),
    "z": Meaning(Kind.LENGTH, "Z behind the block, or where the tool is in the way"),
    "z_before": Meaning(Kind.LENGTH, "Z before the block"),
    "z_needed": Meaning(Kind.LENGTH, "Z that would fit"),
    # Angles.
    "c_angle": Meaning(Kind.ANGLE, "angle of C at the switch"),
    "corner": Meaning(Kind.ANGLE, "corner that the contour turns at an end of the arc"),
    "sweep": Meaning(Kind.ANGLE, "angle of the arc"),
    "turned": Meaning(Kind.ANGLE, "by how much the section comes out turned"),
    "between": Meaning(Kind.ANGLE, "angle of C from the section before to this one"),
    # Feeds, rates, times.
    "c_acceleration": Meaning(Kind.ANGULAR_ACCELERATION, "acceleration that C would need"),
    "c_feed": Meaning(Kind.RATE, "rate at which C would turn"),
    "feed": Meaning(Kind.FEED, "F in force"),
    "feed_per_revolution": Meaning(Kind.FEED_PER_REVOLUTION, "F in force, for each turn"),
    "highest_feed": Meaning(Kind.FEED, "the highest F here, as in the message: rounded down to what is allowed"),
    "slowed_feed": Meaning(Kind.FEED, "F that automatic override leaves"),
    "speed": Meaning(Kind.SPEED, "speed of the live tool"),
    "time": Meaning(Kind.TIME, "time of the block"),
    "x_acceleration": Meaning(Kind.ACCELERATION, "acceleration that X would need"),
    # What is allowed.
    LIMIT: Meaning(None, "what the machine, the control or the job allows of the number before it"),
}


def kinds(names: Iterable[str], rule: str = "") -> dict[str, Kind]:
    """
    The kinds of the values of a rule, by name. A limit has the kind of the last number before it; alone, it counts.

    Raises RuleError for a name that the vocabulary does not have.
    """
    found: dict[str, Kind] = {}
    last = Kind.COUNT
    for name in names:
        if name not in VOCABULARY:
            raise RuleError(f"rule {rule}: {name} is no name of rules/vocabulary.py")
        found[name] = VOCABULARY[name].kind or last
        last = last if found[name] in (Kind.TEXT, Kind.OFFSET) else found[name]
    return found
