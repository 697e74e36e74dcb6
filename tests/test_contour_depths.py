"""Contours of which one part is cut at one depth and the rest at another."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

HEAD = "O1\nG21 G98 T0101\nG0 X100. Z2. C0\nG12.1\nG1 Z1. F200\n"
TAIL = "Z2.\nG13.1\n"
#: A square, its first and last point in the middle of a side.
SQUARE = ["G42 X40. C0", "C20.", "X-40.", "C-20.", "X40.", "C0"]


def square(depth: str, step: str = "", at: int = 3) -> str:
    """A contour at a depth; step: Z in front of its block of this number."""
    blocks = [*SQUARE[:at], *([step] if step else []), *SQUARE[at:]]
    return "\n".join([depth, *blocks, "G40 X100."]) + "\n"


def stepped(text: str) -> list[str]:
    """The blocks of the findings."""
    program = HEAD + text + TAIL
    lines = program.splitlines()
    report = report_of(program, "fanuc", "1:radius=3", only=["contour-at-two-depths"])
    return [lines[line - 1] for line, _ in said(report)]


@pytest.mark.ci
@looped("at", [2, 3, 4])
@looped("before", ["", square("Z-1."), square("Z-1.") + square("Z-2.")], ids=["", "one", "two"])
def test_a_step_is_found_behind_contours_that_have_none(before: str, at: int) -> None:
    assert stepped(before + square("Z-3.", "Z-5.", at) + square("Z-6.")) == ["Z-5."]


def test_each_contour_with_a_step_is_one_finding() -> None:
    assert stepped(square("Z-1.", "Z-3.") + square("Z-4.") + square("Z-5.", "Z-7.")) == ["Z-3.", "Z-7."]


@looped(
    "text",
    [
        square("Z-1.") + square("Z-3."),
        # Two rounds at two depths without leaving the contour.
        "\n".join(["Z-1.", *SQUARE, "Z-3.", *SQUARE[1:], "G40 X100.", ""]),
        # Over what stands there, and down again.
        "\n".join(["Z-3.", *SQUARE[:3], "Z1.", "C-20.", "Z-3.", *SQUARE[4:], "G40 X100.", ""]),
        # Halves of two contours, each open, with the tool off the part between them.
        "\n".join(["Z-1.", *SQUARE[:3], "G40 C60.", "Z-3.", "G42 X-40. C20.", "C-20.", "G40 X100.", ""]),
    ],
    ids=["each at its depth", "two rounds", "a hop", "two flats"],
)
def test_a_depth_for_each_contour_is_no_step(text: str) -> None:
    assert stepped(text) == []
