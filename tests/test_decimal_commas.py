"""A decimal comma is one finding in every language, and the number is read as it was meant; arguments keep commas."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, trace_of

pytestmark = pytest.mark.ci

MODES = {
    "okuma-osp": ("G137 C0", "Y", "G136", "M2"),
    "siemens-transmit": ("TRANSMIT", "Y", "TRAFOOF", "M30"),
    "siemens-iso": ("G12.1", "C", "G13.1", "M30"),
    "fagor-8055t": ("G16 XC", "C", "G18", "M30"),
    "mazak-integrex": ("G12.1", "C", "G13.1", "M30"),
    "fanuc": ("G12.1", "C", "G13.1", "M30"),
}


def program(machine: str, block: str) -> str:
    on, axis, off, end = MODES[machine]
    return f"O1\nT0101\nG94 G0 X40. C0 Z5.\n{on}\nG1 X20. {axis}3. F200\n{block}\nG1 X30.\n{off}\n{end}\n"


def strays(machine: str, block: str) -> list[str]:
    """The messages about the block."""
    return [one.message for one in report_of(program(machine, block), machine, "1:radius=4").findings if one.line == 6]


@looped(
    ("machine", "block", "length"),
    [
        *((machine, f"{axis}12,5", 12.5) for machine, (_, axis, _, _) in MODES.items()),
        ("okuma-osp", "Y=12,5", 12.5),
        ("okuma-osp", "Y = -12,5", -12.5),
        ("okuma-osp", "VC1=12,5 Y=VC1", 12.5),
        ("okuma-osp", "NAB Y=VC2*0+12,5", np.nan),
        ("siemens-transmit", "Y=12,5", 12.5),
        ("siemens-transmit", "N10 R1=12,5 Y=R1 ; 1,5 DEEP", 12.5),
        ("siemens-transmit", "Y=AC(12,5)", 12.5),
        ("siemens-transmit", "Y=IC(-0,5)", 2.5),
        ("siemens-iso", "C=12,5", 12.5),
    ],
    one_in=4,
)
def test_it_is_one_finding_and_is_read_as_a_point(machine: str, block: str, length: float) -> None:
    assert [one.partition(" point: write ")[0] for one in strays(machine, block)] == [", is no decimal"]
    trace = trace_of(program(machine, block), machine, "1:radius=4")
    np.testing.assert_allclose(trace.path.end[trace.blocks.line == 6][-1].imag, length)


@looped(
    ("machine", "block"),
    [("mazak-integrex", "C=12,5"), ("fagor-8055t", "C=12,5"), ("fanuc", "#1=12,5"), ("fanuc", "X[20] C1,5")],
)
def test_where_the_language_has_no_such_word_it_is_the_same_finding(machine: str, block: str) -> None:
    assert ", is no decimal point: write" in strays(machine, block)[0]


@looped(
    ("machine", "block"),
    [
        ("okuma-osp", "Y=ATAN2[1,2]"),
        ("okuma-osp", "VC1=MOD[17,5]"),
        ("okuma-osp", "PS LC,[0,0],[26,9],0"),
        ("siemens-transmit", 'MSG("1,5 MM")'),
        ("siemens-transmit", "R1=ATAN2(1,2)"),
        ("siemens-transmit", "SETM(1,2)"),
        ("siemens-transmit", "Y5 ;10,5 MM"),
        ("fanuc", "#1=ATAN[1,2]"),
        ("fanuc", "G1 C3. ,R1. (1,5 MM)"),
    ],
    one_in=4,
)
def test_a_comma_between_arguments_or_in_a_comment_is_none(machine: str, block: str) -> None:
    assert not [one for one in strays(machine, block) if one.startswith(",")]
    assert "stray-character" not in {rule for _, rule in said(report_of(program(machine, block), machine))}


@looped("separator", [" ", ""])
def test_where_all_points_are_commas_those_at_the_end_of_a_number_are_points_too(separator: str) -> None:
    blocks = ["G42 X30, C-8,66 F250,", "C8,66", "X15,5 C16,", "G3 X-15, C16, R20,", "G1 C-8,66", "X30,", "G40 X60,"]
    section = ["O1", "T0101", "G98 G0 X60, C0 Z5,", "G12.1", "G1 Z-2, F300,", *blocks, "Z2,", "G13.1", "M30"]
    report = report_of("\n".join(section).replace(" ", separator) + "\n", "fanuc", "1:radius=4")
    assert {rule for _, rule in said(report)}.isdisjoint({"corner-word-in-polar", "arc-without-center"})
    assert [rule for _, rule in said(report)].count("stray-character") == 1


def test_a_chamfer_behind_a_number_without_a_point_is_one() -> None:
    corners = "O1\nT0101\nG98 G0 X60. C0 Z5.\nG12.1\nG1 X40. F200\nC20,R3.\nX-40.\nG13.1\nM30\n"
    assert (6, "corner-word-in-polar") in said(report_of(corners, "fanuc", "1:radius=4"))
