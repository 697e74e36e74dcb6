"""Angles in the mode, and what goes wrong around it: in programs that are sound but for one thing."""

from __future__ import annotations

import pytest
from programs import report_of

MM = "O1\nG21 G40 G97 G98 G18\nT0101\n"
INCH = MM.replace("G21", "G20")


def found(blocks: str, machine: str = "fanuc", *tools: str, head: str = MM) -> list[tuple[str, str, str]]:
    """The block, the rule and the message of each finding; `/` separates blocks, which stand behind the head."""
    program = f"{head}{blocks}/M30\n".replace("/", "\n")
    return [(finding.block, finding.rule, finding.message) for finding in report_of(program, machine, *tools).findings]


def said(blocks: str, machine: str = "fanuc", *tools: str, head: str = MM) -> list[tuple[str, str]]:
    return [(block, rule) for block, rule, _ in found(blocks, machine, *tools, head=head)]


TURN = "G0 X50. Z2. C0/G12.1/G1 X40. F200./{}/X50./G13.1"


@pytest.mark.parametrize(
    ("steps", "head"),
    [
        ("C72./C144./C216./C288./C360.", MM),
        ("C72./C144./C216./C288./C360.", INCH),
        ("C-50./C-110./C-250./C-360.", MM),
        ("H72./H72./H72./H72./H72.", MM),
        ("C36./C72./C108./C144./C180.", MM),
        ("/".join(f"X{40 + step % 2}. C{step * 10}." for step in range(1, 721)), MM),
        ("/".join(f"C{step / 2}" for step in range(1, 721)), MM),
        ("#1=5./WHILE[#1LE360.]DO1/C#1/#1=#1+5./END1", MM),
    ],
)
def test_a_steady_way_to_360_is_an_angle(steps: str, head: str) -> None:
    assert [rule for _, rule in said(TURN.format(steps), head=head)] == ["degrees-in-polar"]


@pytest.mark.parametrize(
    "steps",
    [
        # A flat, in steps.
        "/".join(f"C{length}." for length in range(-20, 21, 4)),
        # The outer part of the section reaches as far.
        "X500./C60./C120./C180./X40./C0",
    ],
)
def test_a_flank_is_no_angle(steps: str) -> None:
    assert said(TURN.format(steps)) == []


def test_a_drilling_cycle_says_that_its_c_is_an_angle_again() -> None:
    blocks = "G0 X50. Z2. C0/G12.1/G1 X45. F200/{} X40. C90. Z-10. R2. F100/C180./G80/G13.1"
    for cycle in ("G83", "G81"):
        [(_, rule, message)] = found(blocks.format(cycle))
        assert (rule, message.partition(";")[2]) == (
            "code-not-allowed-in-polar",
            " write it before G12.1 or after G13.1, where its C is an angle again",
        )
    [(_, _, message)] = found(TURN.format("G97 S2000"))
    assert message.endswith("after G13.1")
