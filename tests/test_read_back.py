"""A rewritten program read back: the way of the tool on the part, with the mode and without it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import job_of, machine_of, tables_of

from polarcheck.checking.settings import Settings
from polarcheck.geometry.comparison.path_deviation import path_deviation
from polarcheck.rewrite.compare.compared_sections import FedPath
from polarcheck.rewrite.compensate import centering, compensating
from polarcheck.rewrite.compensate.centering import centered
from polarcheck.rewrite.compensate.compensating import Compensating, compensated
from polarcheck.rewrite.roll import rolling
from polarcheck.rewrite.roll.rolling import Rolling, rolled
from polarcheck.rewrite.unroll import unrolling
from polarcheck.rewrite.unroll.unrolling import Unrolling
from polarcheck.rewrite.unroll.unrolling import unrolled as unrolled_by
from polarcheck.rewrite.writing.original import Original, read
from polarcheck.rewrite.writing.outcome import RefusedError
from polarcheck.rewrite.writing.part_paths import path_on_part
from polarcheck.rewrite.writing.reading_back import read_back
from polarcheck.rules.tables import Tables

pytestmark = pytest.mark.ci

HEXAGON = """\
G98
T0808
G0 X60. Z2. C{angle}
G12.1
G1 Z-2. F500.
G42 X31.1769 F200.
C9.
X0. C18.
X-31.1769 C9.
C-9.
X0. C-18.
X31.1769 C-9.
C4.
G40 X60.
G13.1
M30
"""


def polar_part(tables: Tables) -> FedPath:
    """The path within the section."""
    section = tables["trace"].mode.sections
    path = path_on_part(tables)
    return path[(path.row >= section.enter[0]) & (path.row < section.last[0])]


def unrolled(path: FedPath, angle: float, step: float) -> str:
    """The path as plain X and C blocks, by points at this distance."""
    blocks = ["G98", f"G0 X60. Z2. C{angle:.4f}", "G1 Z-2. F500."]
    turn = np.exp(-1j * np.radians(angle))
    at = angle
    for start, end in zip(path.start.tolist(), path.end.tolist(), strict=True):
        count = max(int(abs(end - start) / step), 1)
        for share in np.arange(1, count + 1) / count:
            point = (start + (end - start) * share) * turn
            at += (np.degrees(np.angle(point)) + angle - at + 180) % 360 - 180
            blocks.append(f"G1 X{2 * abs(point):.5f} C{at:.5f}")
    return "\n".join([*blocks, "M30", ""])


@pytest.mark.nightly
@looped("angle", [0.0, 30.0])
def test_points_in_steps_are_the_same_way_on_the_part_up_to_their_chords(angle: float) -> None:
    tables = tables_of(HEXAGON.format(angle=f"{angle}"), "fanuc", "8:radius=4,nose=0")
    path = polar_part(tables)
    # A line at the distance d from the center is r = d / cos(t); a straight piece of X and C leaves it by
    # ds^2 / 8 (1 + cos^2 a) sin a / d, which is largest where it is nearest to the center.
    nearest = 31.1769 / 2 + 4
    for step in (2.0, 0.2):
        largest = step**2 / 8 / nearest
        new = path_on_part(tables_of(unrolled(path, angle, step)))
        deviation = path_deviation(path, new[new.row >= 2], 0.0001)
        assert 0.6 * largest < deviation.largest < 1.6 * largest


def original_of(text: str, machine: str = "fanuc", *tools: str) -> Original:
    settings = Settings(
        machine, machine_of(machine), job_of(*tools or ("8:radius=4,nose=0",), job={"program_units": "mm"}), (), {}
    )
    return read("a.nc", text.encode(), settings)


def differences(old: Original, text: str, machine: str = "fanuc", decided: Collection[int] = ()) -> list[str]:
    """What differs in a program that has the lines of the original."""
    settings = Settings(machine, machine_of(machine), old.settings.job, (), {})
    result = read_back(old, text.encode(), settings, range(1, text.count("\n") + 2), decided)
    return [f"{each.line}: {each.text}" for each in result.differences]


@looped(
    ("was", "becomes", "said"),
    [
        ("C9.", "C9.01", "8: the path differs by 0.0"),
        ("F200.", "F210.", "6: F200 mm/min has become F210 mm/min"),
        ("Z-2.", "Z-2.1", "14: the path differs by 0.1 mm"),
        ("C30.", "C31.", "4: C at the beginning of the section was 30 and is 31"),
        ("G42", "G41", "7: the path differs by"),
        ("G4 P500", "G4 P600", "16: G4 P500"),
        ("M8", "", "17: M8 is missing"),
        ("G0 X70. C90.", "G0 X70. C91.", "18: the path differs by C alone"),
    ],
    one_in=8,
)
def test_what_differs_has_the_line_of_the_original(was: str, becomes: str, said: str) -> None:
    text = HEXAGON.format(angle="30.").replace("M30", "G4 P500\nM8\nG0 X70. C90.\nM30")
    found = differences(original_of(text), text.replace(was, becomes, 1))
    assert any(each.startswith(said) for each in found), found
    assert not differences(original_of(text), text)


#: Two sections, and what stands before, between and behind them.
AROUND = """\
%
O1
G21 G98 G40
T0808
M13 S3000
M68
G28 H0
G0 X60. Z2. C0
G12.1
G1 Z-2. F500
{first}
M8
{second}
Z2.
G13.1
G4 P500
G1 X70. F300
G0 X60. C0
G12.1
G1 Z-3. F500
{first}
{second}
Z2.
G13.1
M9
G0 X100. Z50.
M5
M30
%
"""
HALVES = {
    "plain": ("X36. C0 F150\nC18.", "X-36.\nC-18.\nX36.\nC0"),
    "left": ("G42 X36. C0 F150\nC18.", "X-36.\nC-18.\nX36.\nC0\nG40 X60."),
}
WORK = {
    "unroll": (unrolling, lambda original: unrolled_by(original, Unrolling(feed="per-minute")), "left"),
    "compensate": (compensating, lambda original: compensated(original, Compensating("left")), "plain"),
    "center": (centering, centered, "left"),
    "roll": (rolling, lambda original: rolled(original, Rolling(feed="per-minute")), "left"),
}
#: Each is a list of replacements.
FAULTS = [
    [("\nM8\n", "\n")],
    [("\nM8\n", "\n"), ("Z2. C0\n", "Z2. C0\nM8\n")],
    [("M13", "M14")],
    [("S3000", "S300")],
    [("M68", "")],
    [("G28 H0", "")],
    [("P500", "P600")],
    [("T0808", "T0809")],
    [("Z-3.", "Z-3.01")],
    [("F300", "F400")],
    [("F150", "F250")],
]


#: roll writes F anew, and lengths up to its tolerance.
CASES = [(name, faults) for name in WORK for faults in (FAULTS[1:8:2] if name == "roll" else FAULTS)]


@pytest.mark.nightly
@looped(("name", "faults"), CASES, one_in=13)
def test_a_rewriter_writes_nothing_where_an_order_a_depth_or_f_is_lost(
    name: str, faults: list[tuple[str, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    module, work, form = WORK[name]
    first, second = HALVES[form]
    original = original_of(AROUND.format(first=first, second=second), "fanuc-30i", "8:radius=4,nose=0", "9:radius=4")
    if name == "roll":
        original = original_of(WORK["unroll"][1](original).data.decode(), "fanuc-30i")
    real = module.with_edits
    assert work(original).data

    def wrong(*arguments: Any) -> tuple[bytes, list[int]]:
        data, origin = real(*arguments)
        for was, becomes in faults:
            assert was.encode() in data
            data = data.replace(was.encode(), becomes.encode(), 1)
        return data, origin

    with monkeypatch.context() as patch:
        patch.setattr(module, "with_edits", wrong)
        with pytest.raises(RefusedError):
            work(original)
