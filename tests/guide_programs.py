"""
The programs of the builder's guide to G12.1 (document 000), and the same in mm.

SAMPLE is its sample program, METHOD_A and METHOD_B are its two ways to mill two flats; the guide leaves the retract of
these open (G0 X_ Z_ M35). SAMPLE gives the path of the cutter center, so that R is 0; METHOD_A and METHOD_B the part.
"""

from __future__ import annotations

import re

import document_programs

SAMPLE = f"%\nO0001\n{document_programs.SAMPLE.text}M30\n%\n"
METHOD_A, METHOD_B = (
    f"%\nO0002\n{printed.text}M30\n%\n" for printed in (document_programs.METHOD_A, document_programs.METHOD_B)
)

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
