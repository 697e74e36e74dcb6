"""Depths of passes round one contour: those in step, and one that is not, with the Z that it would have."""

from __future__ import annotations

import math

import pytest
from cases import looped
from programs import report_of, tables_of

pytestmark = pytest.mark.ci

BLOCKS = "Z{}\nG42 X{} C0 F{}\nG3 I-{}\nG1 G40 X{}\n"
#: Size of X, F, radius and X of the approach: of mm and of inch.
UNITS = {"G21": (1.0, "20.", "200", "10.", "60."), "G20": (25.4, "1.", "8.", ".5", "3.")}


def off(levels: list[float], code: str, turning: str = "", machine: str = "fanuc") -> dict[int, float]:
    """The passes that are off by the number of their Z, and the Z that each would have; a Citizen's Z turned over."""
    scale, across, feed, radius, away = UNITS[code]
    sense = -1 if machine == "citizen" else 1
    passes = "".join(BLOCKS.format(f"{sense * z / scale:.5f}", across, feed, radius, away) for z in levels)
    text = f"O1\n{turning}{code} G98 T0101\nG0 X{away} Z{sense * 0.2} C0\nG12.1\nG1 X{away} F{feed}\n{passes}"
    text += f"Z{sense * 0.2}\nG13.1\n"
    tables = tables_of(text, machine, f"1:radius={4 / scale:.5f}")
    depths = tables["pass_depths"]
    lines = tables["trace"].blocks.line
    return {(int(lines[row]) - turning.count("\n") - 2) // 4: sense * z for row, z in depths.expected.items()}


@pytest.mark.nightly
@looped("code", UNITS)
@looped(
    ("levels", "expected"),
    [
        ([-2, -4, -6, -8], {}),
        ([-2, -40, -6, -8], {2: -4}),
        ([-20, -4, -6, -8], {1: -2}),
        ([-2, -4, -60, -8], {3: -6}),
        # The last one: none says that it should be higher, but the steps before it.
        ([-2, -4, -6, -80], {4: -8}),
        ([-2, -4, -6, -9], {}),
        ([-2, -4, -40], {3: -6}),
        ([-2, -20, -6], {2: -4}),
        # A spring pass; a last step that is smaller; the first one on its way through air.
        ([-2, -4, -6, -6], {}),
        ([-2, -4, -6, -6.5], {}),
        ([-2, -4, -5, -8], {}),
        # Twice at one depth is one pass.
        ([-2, -4, -4, -8], {}),
        ([-2, -4, -4, -6, -80], {5: -8}),
        # Up again.
        ([-2, -4, -3, -8], {3: -6}),
    ],
)
def test_a_pass_that_is_out_of_step(levels: list[float], expected: dict[int, float], code: str) -> None:
    for machine in ("fanuc", "citizen"):
        assert off(levels, code, machine=machine) == pytest.approx(expected, abs=0.001)


@looped(
    ("levels", "expected"),
    [
        ([-11.95, -3.9], {1: -1.95}),
        ([-33.75, -7.5], {1: -3.75}),
        # Z-39 behind Z-19.5 would be as much in step as Z-1.95 before Z-3.9.
        ([-19.5, -3.9], {1: math.nan}),
        # Two grooves: no digit is wrong.
        ([-10, -5], {}),
        ([-6, -2], {}),
    ],
)
def test_of_two_passes_the_digits_show_which_is_out_of_step(levels: list[float], expected: dict[int, float]) -> None:
    assert off(levels, "G21") == pytest.approx(expected, nan_ok=True)


def test_a_pass_that_cannot_go_below_the_turning_is_in_step() -> None:
    """Of Z-1.95 before Z-3.9, and Z-39 behind Z-19.5, the second lies far below the spigot that is turned."""
    turning = "T0202\nG97 S900 M3\nG0 X30. Z2. G99\nG1 Z-12. F.2\nX50.\nG0 Z50.\nM5\n"
    assert off([-19.5, -3.9], "G21", turning) == pytest.approx({1: -1.95})


LEAD = "G1 Z{}\nG42 X44. C-10. F80\nG2 X24. C0 R10.\n"
ROUND = "G1 C9.\nX-24. C9.\nC-9.\nX24.\nC0\n"
OUT = "G2 X44. C10. R10.\nG1 G40 X70. F800\n"


def lines_off(text: str) -> dict[int, float]:
    tables = tables_of(text, "fanuc", "1:radius=4")
    depths, lines = tables["pass_depths"], tables["trace"].blocks.line
    return {int(lines[row]): z for row, z in depths.expected.items()}


def test_leads_of_the_first_and_the_last_pass_are_no_other_contour() -> None:
    text = (
        f"O1\nG98 T0101\nG0 X80. Z2. C0\nG12.1\nG1 X70. F800\n{LEAD}{ROUND}G1 Z-4.\n{ROUND}G1 Z-6.\n{ROUND}{OUT}G13.1\n"
    )
    assert lines_off(text.format("-2.")) == {}
    assert lines_off(text.format("-22.")) == {6: -2.0}


@looped(
    ("depths", "expected"),
    [
        (["-4.", "-4.", "-4.", "-4."], {}),
        (["-4.", "-4.", "-4.", "-40."], {3: -4.0}),
        (["-4.25", "-42.5", "-4.25", "-4.25"], {1: -4.25}),
        # Another depth, which is no slip of the pen; and two of each.
        (["-4.", "-4.", "-4.", "-6."], {}),
        (["-4.", "-4.", "-40.", "-40."], {}),
    ],
)
def test_one_contour_in_several_sections_has_one_depth(depths: list[str], expected: dict[int, float]) -> None:
    sections = "".join(
        f"G0 C{90 * number}.\nG0 X70. Z2.\nG12.1\n{LEAD.format(z)}{ROUND}{OUT}Z2.\nG13.1\n"
        for number, z in enumerate(depths)
    )
    off_by_line = lines_off(f"O1\nG98 T0101\n{sections}M30\n")
    size = sections.count("\n") // len(depths)
    assert {(line - 3) // size: z for line, z in off_by_line.items()} == expected


#: A contour that is called at several depths; by machine what X is in diameters.
_CALLED = ["G42 X{0} C0 F200", "C{2}", "X-{0}", "C-{2}", "X{0}", "C0", "G40 X{1}"]
_LATHES = {"fanuc-30i": 1.0, "mitsubishi-m700": 0.5}


def idle_depths(machine: str, depths: list[str], without: int) -> list[str]:
    """The blocks that are told where the call of a contour is lost at one of these depths."""
    share = _LATHES[machine]
    contour = [line.format(f"{20 * share}", f"{60 * share}", "10.") for line in _CALLED]
    calls = [line for at, z in enumerate(depths) for line in (f"Z{z} F300", *(["M98 P2"] if at != without else []))]
    head = ["O1", "T0101", "G98 G97 S2500 M13", f"G0 X{60 * share} Z2. C0", "G12.1", f"G1 X{60 * share} C0 F900"]
    lines = [*head, *calls, "Z2.", "G13.1", "M30", "O2", *contour, "M99"]
    findings = report_of("\n".join(lines) + "\n", machine, "1:radius=4").findings
    assert {finding.rule for finding in findings if finding.severity != "note"} <= {"nearly-regular-contour"}
    return [lines[finding.line - 1] for finding in findings if finding.severity != "note"]


@looped("machine", _LATHES)
@looped(
    ("depths", "without", "told"),
    [
        (["-2.", "-4.", "-6."], 9, []),
        (["-2.", "-4.", "-6."], 1, ["Z-4. F300"]),
        (["-2.", "-4.", "-6."], 2, ["Z-6. F300"]),
        (["-1.5", "-3.", "-4.5", "-6."], 2, ["Z-4.5 F300"]),
        # The first depth is one to which the tool may go fast; one between others may be on its way.
        (["-2.", "-4.", "-6."], 0, []),
        (["-2.", "-3.", "-6."], 1, []),
        (["-2.", "-4."], 1, []),
    ],
)
def test_a_depth_at_which_nothing_is_cut(machine: str, depths: list[str], without: int, told: list[str]) -> None:
    assert idle_depths(machine, depths, without) == told
