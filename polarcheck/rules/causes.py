"""
Which findings follow from which: one mistake is one finding, and what would not be there without it is listed under it.

A rule says what its finding makes doubtful, and how far (`doubts`). What a rule judges is taken from the tables that it
compares. Its finding follows from one that makes doubtful what it rests on. Rules that judge the same subject do not
follow each other, unless the cause stands in a row above; where two of them say the same thing twice, the one that
follows names the other (`follows`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

#: What is doubtful, and the span (SPANS) within which it is; UNIT for the one in which a subject is judged.
Doubt = tuple[str, str]
UNIT: Final = "unit"

#: The subject of a rule, by the tables that it compares; the first of these counts. A rule without any of them judges
#: words and states, which no finding makes doubtful.
SUBJECT_OF_TABLE: Final = {
    "infeed": "infeed",
    "overcuts": "metal",
    "slots": "metal",
    "coverage": "metal",
    "uncompensated_cuts": "metal",
    "deviations": "metal",
    "mirrored": "side",
    "center": "move",
    "travel": "move",
    "tool_center": "compensation",
    "ramps": "compensation",
    "arcs": "arc",
    "tangency": "side",
}
#: The span in which each subject is judged (a wrong arc costs its own rate of C, but all of the contour), and what the
#: subject rests on. A move is judged by itself: travel, a ramp on an arc. The speed of C is that of a move, and a rate
#: follows from it; a shape and an outline are of a contour. A size is of a bar, a cutter or F, a stock what a bar
#: loses, a rapid a move through it, a reach how far the cuts of a section go: their rules name them, as do those of
#: words and of where the mode is on. An offset is in force from one block of a section to another.
SUBJECTS: Final = {
    "arc": ("block", ("position", "arc")),
    "move": ("block", ("position", "arc", "move")),
    "speed": ("block", ("position", "arc", "move", "speed")),
    "rate": ("block", ("position", "arc", "move", "speed", "rate")),
    "side": ("compensation", ("position", "arc")),
    "shape": ("loop", ("size", "position")),
    "outline": ("loop", ("position", "arc", "compensation")),
    "compensation": ("loop", ("position", "arc", "compensation")),
    "metal": ("loop", ("position", "arc", "compensation", "metal")),
    "infeed": ("section", ("position", "arc", "compensation", "metal")),
    "stock": ("section", ("size", "position", "arc", "compensation", "metal")),
    "rapid": ("block", ("size", "rapid")),
    "plunge": ("block", ("size", "rapid")),
    "reach": ("section", ("size", "position", "arc")),
    "size": ("program", ("size", "word")),
    "word": ("block", ("word",)),
    "mode": ("program", ("mode",)),
    "offset": ("section", ("offset",)),
}
#: All that may be doubtful, and what of it leaves the part as it is.
DOUBTFUL: Final = frozenset(what for _, rests_on in SUBJECTS.values() for what in rests_on)
BESIDE_PART: Final = frozenset({"speed", "rate", "rapid", "word", "mode", "offset"})

#: X or the second axis is another than the one that the section was written for, or there is none.
SECTION_READ_OTHERWISE: Final = (("position", "section"),)
#: There is no such arc.
NO_SUCH_ARC: Final = (("arc", UNIT),)
#: There is no such arc, and its end may be what is wrong, so that the next move begins elsewhere.
END_IN_DOUBT: Final = (*NO_SUCH_ARC, ("position", "X before"), ("position", "C before"))
#: Rules whose findings say that the sections, or the words themselves, are others than were meant, so that nobody knows
#: what else would be found.
READ_OTHERWISE: Final = (
    "wrong-axis-address-in-polar",
    "diameter-radius-mixed",
    "second-axis-never-programmed",
    "linear-axis-never-programmed",
    "polar-never-left",
    "polar-never-entered",
    "polar-code-of-another-control",
    "comment-not-closed",
    "other-dialect",
)
#: What stands in a block of its own in the mode and cannot: without it there would be fewer blocks without movement.
OUT_OF_PLACE: Final = (
    "plane-selected-in-polar",
    "origin-shifted-in-polar",
    "offset-changed-in-polar",
    "code-not-allowed-in-polar",
    "spindle-code-in-polar",
    "tool-length-offset-in-polar",
    "polar-entered-twice",
    "incremental-word-of-other-code-system",
    "unknown-code",
    "rapid-in-polar",
)
#: What is wrong with a contour, be it in the pass that differs from the others or in the one it is compared with.
FAULTS_OF_CONTOUR: Final = (
    *OUT_OF_PLACE,
    "arc-end-off-circle",
    "arc-radius-too-small",
    "arc-without-center",
    "arc-center-on-path",
    "arc-off-polar-plane",
    "arc-sense-reversed",
    "arc-not-tangent",
    "arc-word-without-arc",
    "bad-number",
    "contour-crosses-itself",
    "contour-at-two-depths",
    "contour-not-closed",
    "c-feed-above-limit",
    "circle-center-doubled",
    "contour-already-cut-into",
    "full-circle-by-radius",
    "incremental-contour-not-closed",
    "inside-arc-smaller-than-radius",
    "interference",
    "movement-missing-in-offset-mode",
    "nearly-regular-contour",
    "negative-arc-radius",
    "no-offset-intersection",
    "number-without-point",
    "overcut",
    "path-through-center",
    "rapid-through-stock",
    "side-of-compensation-mirrored",
    "side-repeated-in-offset-mode",
    "slot-narrower-than-cutter",
    "start-up-sweeps-contour",
    "uncompensated-cut-into-part",
    "vacant-variable",
    "variable-never-set",
    "wrong-axis-address-in-polar",
    "z-with-plane-axis",
)
#: What leaves other metal than a contour says, or says that the contour is another one.
FAULTS_OF_METAL: Final = (
    "arc-sweep-above-limit",
    "c-angle-without-effect",
    "c-elsewhere-at-entry",
    "cancel-shorter-than-radius",
    "cancel-without-start-up",
    "compensation-without-contour",
    "cut-in-air",
    "degrees-in-polar",
    "diameter-radius-mixed",
    "material-left",
    "pass-depth-differs",
    "pass-ends-inside-bar",
    "passes-differ",
    "polar-never-entered",
    "radius-contradicts-comment",
    "rapid-through-part",
    "start-up-after-contour",
    "start-up-off-contour",
    "start-up-shorter-than-radius",
    "tool-contradicts-comment",
)


def subject_of(parameters: Iterable[str]) -> str:
    """What a rule judges that compares these tables; "" for words and states."""
    compared = {*parameters}
    return next((subject for table, subject in SUBJECT_OF_TABLE.items() if table in compared), "")
