"""
The example programs of the five documents as they are printed, and their wrong and right twins.

A twin is made by edits: {block: what stands in its place}. What it must say stands in its own comments, as in the
sample programs: (expect: rapid-in-polar).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class Printed(NamedTuple):
    """A program, the machine of its document, tools as `--tool` takes them, changes of the machine, the job."""

    text: str
    machine: str
    tools: tuple[str, ...] = ()
    changes: Mapping[str, Any] = {}
    job: Mapping[str, Any] = {}

    def edited(self, edits: Mapping[str, str]) -> str:
        """
        The program with the first block of each of these texts replaced.

        A replacement of several lines puts blocks before or behind; an empty one deletes the block. The key "" stands
        for the head of the program.
        """
        lines = self.text.split("\n")
        for block, instead in edits.items():
            if not block:
                lines[0:0] = instead.split("\n")
                continue
            at = lines.index(block)
            lines[at : at + 1] = instead.split("\n") if instead else []
        return "\n".join(lines)


_HEAD = """N100 (MILL TWO FLATS)
G40 G13.1
T0101
M5
M35
G28 H0
G97 S1000 M33
G0 Z.1 C0
X1.8
"""
_FLAT = """G12.1
G1 G98 C0.4153 F20.
G1 G41 X1.0 F5.
Z - .375 (depth of cut)
C-0.4153
"""
_RETRACT = "G13.1\nG0 Z0.1\n"
_END = "G0 X5. Z5. M35\nM1\n"
#: Builder's guide to G12.1 on turning centers, method A. The guide leaves the last position open: G0 X_ Z_ M35.
METHOD_A = Printed(
    f"{_HEAD}{_FLAT}G40 X1.8 F20.\n{_RETRACT}G0 C180.\n{_FLAT}G40 X1.8 F20.\n{_RETRACT}{_END}",
    "turning-center",
    ("1:radius=.25", "1:nose=0"),
)
#: Method B of the same guide.
METHOD_B = Printed(
    f"{_HEAD}{_FLAT}G2 X-1.0 R.650 F60.\nG1 C0.4153 F5.\nG40 X-1.8\n{_RETRACT}{_END}",
    "turning-center",
    ("1:radius=.25", "1:nose=0"),
)
#: The sample program of the same guide, the path of the tool center: R is 0.
SAMPLE = Printed(
    """M5
M35
G40
G13.1
G30 U0 W0
G28 H0
T0808 (3/4" DIA. CUTTER)
G97 S2000 M33
G0Z.1 C0 M8
X2.15
G12.1
G1 G98 C.5339 F60.
G1 G41 X1.75F7. (1)
Z-.88
G1 C-.5339 (2)
G2 X-1.75 R1.025 F60. (3)
G1 C.5339 F7. (4)
G1 G40 X-2.15 F60.
G13.1
G99 G0 X2.5
Z.1 M35
G30 U0 W0. M9
M1
""",
    "turning-center",
    ("8:radius=0", "8:nose=0"),
)
#: FANUC B-62764EN/01 p. 51 and 52 print no program: a square with rounded corners in the words of these pages.
FANUC = Printed(
    """O0001
G98 G40 G97
T0101
G54 G0 X120. C0 Z5.
G12.1
G42 G1 X40. F200
C10.
G3 X20. C20. R10.
G1 X-40.
C-10.
G3 X-20. C-20. I10. J0
G1 X40.
C0
G40 X120.
G13.1
G0 Z100.
M30
""",
    "fanuc-16i",
    ("1:radius=5", "1:nose=0"),
)
#: First example of the description of G12.1 with P, Q, E (GSK type): once round; the dots are its own.
GSK_1 = Printed(
    """O0001;
N10 T0202
.....;
N100 G00 X150. C0 Z0;
N110 G12.1;
N120 G42 G01 X80. F200;
N130 C20.0;
N140 G03 X40.0 C40.0 R20.0;
N150 G01 X-40.0;
N160 G03 X-80.0 C20.0 R20.0;
N170 G01 C-20.0;
N180 G03 X-40.0 C-40.0 R20.0;
N190 G01 X40.0;
N200 G03 X80.0 C-20.0 R20.0;
N210 G01 C0;
N220 G40 X150.0;
N230 G13.1;
N240 Z100.0;
.....;
N500 M30;
""",
    "gsk-988",
    ("2:radius=10", "2:nose=0"),
)
#: Second example of the same description: the infeed cycle.
GSK_2 = Printed(
    """O0002;
N000 T0202;
N100 G00 X348 C30;
N110 G12.1 E8;
N120 G42 G01 X300 C0 F2000;
N130 C80.0;
N140 G03 X220.0 C120.0 R40.0;
N150 G01 X-220.0;
N160 G03 X-300.0 C80.0 R40.0;
N170 G01 C-80.0;
N180 G03 X-220.0 C-120.0 R40.0
N190 G01 X220.0;
N200 G03 X300.0 C-80.0 R40.0;
N210 G01 C0;
N220 G40 X300.0;
N230 G13.1;
N240 M30
""",
    "gsk-988",
    ("2:radius=10", "2:nose=0"),
)
#: Mitsubishi M700V p. 73 prints no program: that of p. 77 of the same chapter, X a radius.
M700V = Printed(
    """O0001
G17 G90 G94 G40 G97
T0101
G0 X40. C0 Z5.
G12.1
G1 G42 X20. F2000
C10.
G3 X10. C20. R10.
G1 X-20.
C-10.
G3 X-10. C-20. I10. J0
G1 X20.
C0
G40 X40.
G13.1
G0 Z100.
M30
""",
    "mitsubishi-m700",
    ("1:radius=5", "1:nose=0"),
)
#: The shape that the builder's guide shows in its head, a rectangle with rounded corners, in the words of the guide.
RECTANGLE = Printed(
    """M5
M35
G40
G13.1
G28 H0
T0101 (1/2" DIA. CUTTER)
G97 S2000 M33
G0 Z.1 C0
X3.
G12.1
G1 G98 Z-.25 F10.
G41 X1.5
C-.25
G2 X1. C-.5 R.25
G1 X-1.
G2 X-1.5 C-.25 I0 J.25
G1 C.25
G2 X-1. C.5 R.25
G1 X1.
G2 X1.5 C.25 R.25
G1 C0
G40 X3.
G13.1
G99 G0 X3.5
Z.1 M35
M1
""",
    "turning-center",
    ("1:radius=.25", "1:nose=0"),
)
