"""
Programs with one fault each, to put what a checker finds beside the time that it takes.

The program without a fault mills a face with rounded corners in polar coordinate interpolation, as FANUC lathes with a
diameter X take it; offset 1 is a cutter of 4 mm radius. The faults are those that the manuals of the mode name.

A checker names a fault for the right reason where its output has the words that belong to it, and the program without
the fault gets no such words.
"""

from __future__ import annotations

from typing import NamedTuple

#: As --tool takes it.
TOOL = "1:radius=4,nose=0"
GOOD = """%
O1001 (SQUARE WITH ONE ROUND CORNER)
G21 G98 G40
T0101
M5
G28 H0
G97 S3000 M13
G0 X90. Z2. C0
G12.1
G1 X80. C0 F1500
Z-5. F300
G42 X40. F200
C10.
G3 X20. C20. R10.
G1 X-40.
C-20.
X40.
C0
G40 X80. F1500
Z2.
G13.1
G0 X100. Z50.
M30
%
"""


class Fault(NamedTuple):
    """
    What is written in place of what, the rule of polarcheck that it breaks, and what says so (regular expression).

    says: of the output of any checker, in any case of letters.
    """

    meant: str
    written: str
    rule: str
    says: str


FAULTS = {
    "G0 in the mode": Fault("G1 X-40.\n", "G0 X-40.\nG1\n", "rapid-in-polar", r"rapid|g0?0\b.*(polar|g12\.1)"),
    "G13.1 missing": Fault("G13.1\n", "", "polar-never-left", r"g13\.1|never left|not cancel+ed|polar"),
    "G12.1 missing": Fault("G12.1\n", "", "polar-never-entered", r"g13\.1|g12\.1|polar"),
    "G12.1 twice": Fault("Z-5. F300\n", "G12.1\nZ-5. F300\n", "polar-entered-twice", r"twice|already|again"),
    "G40 missing before G13.1": Fault(
        "G40 X80.", "X80.", "polar-switched-in-offset-mode", r"g40|compensation.*(cancel|still|active|on)"
    ),
    "G41 for G42": Fault("G42", "G41", "side-of-compensation-mirrored", r"g41|g42|side|goug"),
    "start-up in an arc": Fault(
        "G42 X40. F200\nC10.\nG3 X20.",
        "X40. F200\nC10.\nG42 G3 X20.",
        "start-up-on-arc",
        r"g42.*arc|arc.*(g42|start)|(first|entry).*(arc|straight)",
    ),
    "start-up shorter than R": Fault(
        "G1 X80. C0", "G1 X44. C0", "start-up-shorter-than-radius", r"short|entry move|radius"
    ),
    "another tool in the mode": Fault("G1 X-40.\n", "T0202\nG1 X-40.\n", "offset-changed-in-polar", r"tool|offset"),
    "no F": Fault("F1500\nZ-5. F300\nG42 X40. F200", "\nZ-5.\nG42 X40.", "feed-missing-in-polar", r"feed"),
    "G99 in the mode": Fault("G21 G98", "G21 G99", "feed-per-revolution-in-polar", r"g99|revolution"),
    "F too high near the center": Fault(
        "C-20.\nX40.\nC0\n", "C-1.\nX0.4\nX40. F9000\nC0 F200\n", "c-feed-above-limit", r"feed|rate|center"
    ),
    "Z beside C": Fault("C-20.\n", "C-20. Z-6.\n", "z-with-plane-axis", r"\bz\b.*(plane|polar|axis)"),
    "R too small": Fault("R10.", "R5.", "arc-radius-too-small", r"radius|arc"),
    "end of the arc off its circle": Fault("R10.", "I-19. K0", "arc-end-off-circle", r"arc|circle|radius"),
    "G42 moved to an inside arc smaller than R": Fault(
        "C10.\nG3 X20. C20. R10.\nG1 X-40.",
        "C10.\nG2 X36. C12. R2.\nG1 C20.\nX-40.",
        "inside-arc-smaller-than-radius",
        r"radius|goug|concave|interfer",
    ),
    "G17 in the mode": Fault(
        "G1 X-40.\n", "G17\nG1 X-40.\n", "plane-selected-in-polar", r"plane|g17.*(mode|polar|g12)"
    ),
    "G41 behind G42": Fault("C-20.\n", "G41 C-20.\n", "side-changed-in-offset-mode", r"g41|side|compensation|comp on"),
}
