"""A round bar with one flat has few blocks: the one word that takes its arcs off the bar is told all the same."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from test_slips_of_passes import CANCEL, FORMS, one_finding, passes, said

D_SHAPE = ["G1 G42 X20.", "C13.748", "G3 X-34. C0 R17.", "X20. C-13.748 R17.", "G1 C0", CANCEL]
OFF_CENTER = ["G1 G42 X20.", "C12.", "G3 X-30. C0 R18.", "X20. C-12. R18.", "G1 C0", CANCEL]
LENS = ["G1 G42 X20.", "C12.", "G3 X-24. C0 R17.5", "X20. C-12. R17.5", "G1 C0", CANCEL]


@pytest.mark.parametrize(("form", "machine"), FORMS)
@pytest.mark.parametrize("contour", [D_SHAPE, OFF_CENTER, LENS])
def test_sound_ones_are_told_nothing(form: Callable[[str], str], machine: str, contour: list[str]) -> None:
    assert said(form(passes(contour)), machine) == []


@pytest.mark.parametrize(("form", "machine"), FORMS)
@pytest.mark.parametrize("letter", "XC")
def test_the_point_between_both_arcs_is_told(form: Callable[[str], str], machine: str, letter: str) -> None:
    blocks = form(passes([block.replace("C0 R17", "C1. R17") if letter == "C" else block for block in D_SHAPE]))
    lines = blocks.splitlines()
    if letter == "X":
        lines[10] = re.sub(r"(?<=X)(-?)([1-9])", lambda digit: f"{digit[1]}{int(digit[2]) - 1}", lines[10])
    finding = one_finding("\n".join(lines), machine)
    assert (finding.line, finding.rule) == (11, "nearly-regular-contour")
    assert "would be tangent" in finding.message
