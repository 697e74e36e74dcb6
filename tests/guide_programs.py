"""
The programs of the builder's guide to G12.1 (document 000), and the same in mm.

SAMPLE is its sample program, METHOD_A and METHOD_B are its two ways to mill two flats; the guide leaves the retract of
these open (G0 X_ Z_ M35). SAMPLE gives the path of the cutter center, so that R is 0; METHOD_A and METHOD_B the part.
"""

from __future__ import annotations

import re

SAMPLE = """%
O0001
M5
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
M30
%
"""
_HEAD = """%
O0002
N100 (MILL TWO FLATS)
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
Z-.375 (depth of cut)
C-0.4153
"""
_END = "G0 X5. Z5. M35\nM1\nM30\n%\n"
METHOD_A = f"{_HEAD}{_FLAT}G40 X1.8 F20.\nG13.1\nG0 Z0.1\nG0 C180.\n{_FLAT}G40 X1.8 F20.\nG13.1\nG0 Z0.1\n{_END}"
METHOD_B = f"{_HEAD}{_FLAT}G2 X-1.0 R.650 F60.\nG1 C0.4153 F5.\nG40 X-1.8\nG13.1\nG0 Z0.1\n{_END}"

#: Each with the cutter that it was written for.
PROGRAMS = {
    "sample": (SAMPLE, "8:radius=0", "8:nose=0"),
    "method A": (METHOD_A, "1:radius=.25", "1:nose=0"),
    "method B": (METHOD_B, "1:radius=.25", "1:nose=0"),
}

_LENGTH = re.compile(r"(?<![A-Z#\"/])([XZCRIJUWHF])(-?\d*\.\d*)")


def in_mm(program: str) -> str:
    """A program in inch as one in mm, but for its comments; C0, C180. and H0 outside the mode are angles."""
    lines, in_mode = [], False
    for line in program.splitlines():
        written, _, comment = line.partition("(")
        in_mode = (in_mode or "G12.1" in line) and "G13.1" not in line
        lengths = "XZCRIJUWHF" if in_mode else "XZRIJUWF"
        lines.append(
            _LENGTH.sub(lambda word, of=lengths: _scaled(word, of), written) + (f"({comment}" if comment else "")
        )
    return "\n".join(lines).replace("\nM5\n", "\nG21\nM5\n", 1) + "\n"


def _scaled(word: re.Match[str], lengths: str) -> str:
    if word[1] not in lengths:
        return word[0]
    return f"{word[1]}{float(word[2]) * 25.4:.5f}".rstrip("0")


def without(program: str, line: str, number: int = 0) -> str:
    """A program without a line, the first or a later one that is the same."""
    lines = program.splitlines(keepends=True)
    at = [index for index, text in enumerate(lines) if text == f"{line}\n"][number]
    return "".join(lines[:at] + lines[at + 1 :])
