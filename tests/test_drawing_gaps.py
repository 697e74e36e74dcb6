"""Drawings whose curves do not meet: rings of lines with gaps, and walls that end in the air."""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np
import pytest
from cases import looped
from programs import job_of, report_of
from test_drawing import written

from polarcheck.foundation.finding import FileReport
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.geometry.comparison.gaps import widest_gap
from polarcheck.program.machines import drawing_file

RULE = "part-differs-from-drawing"
Wall = tuple[complex, complex]


def polygon(count: int, radius: float = 20.0) -> list[complex]:
    return [cmath.rect(radius, math.tau * number / count) for number in range(count + 1)]


def walls(corners: Sequence[complex], gap: float) -> list[Wall]:
    """The sides of a polygon, the ends of two of them this far apart."""
    turn = abs(cmath.phase((corners[2] - corners[1]) / (corners[1] - corners[0])))
    short = gap / 2 / math.cos(turn / 2)
    return [
        (start + short * (end - start) / abs(end - start), end - short * (end - start) / abs(end - start))
        for start, end in itertools.pairwise(corners)
    ]


def slots() -> list[Wall]:
    """Eight radial slots, each of two walls."""
    return [
        ((10 + side) * turn, (20 + side) * turn)
        for turn in (cmath.rect(1, math.tau * number / 8) for number in range(8))
        for side in (-3j, 3j)
    ]


def program(corners: Sequence[complex], unit: float = 1.0) -> str:
    """A polygon milled with compensation, in mm or inch."""
    blocks = "\n".join(f"X{2 * corner.real / unit:.5f} C{corner.imag / unit:.5f}" for corner in corners[1:])
    start = f"G{21 if unit == 1 else 20} T0808\nG0 X{80 / unit:.4f} Z{2 / unit:.4f} C0\nG12.1\n"
    start += f"G1 G98 Z{-5 / unit:.4f} F100\n"
    return f"{start}G42 X{2 * corners[0].real / unit:.5f}\n{blocks}\nG40 X{80 / unit:.4f}\nZ{2 / unit:.4f}\nG13.1\n"


def report(folder: Path, text: str, lines: Sequence[Wall], unit: float = 1.0, circle: float = 0.0) -> FileReport:
    def draw(space: object) -> None:
        for start, end in lines:
            space.add_line((start.real / unit, start.imag / unit), (end.real / unit, end.imag / unit))
        if circle:
            space.add_circle((0, 0), circle / unit)

    path = written(folder / "a.dxf", draw, units=4 if unit == 1 else 1)
    job = job_of(f"8:radius={4 / unit}", job={"units": "mm" if unit == 1 else "inch"})
    job = msgspec.structs.replace(job, part=[drawing_file.part_of(path, "a.dxf")])
    return report_of(text, "fanuc-30i", job=job, only=[RULE])


def reasons(found: FileReport) -> list[str]:
    return [entry.reason for entry in found.not_evaluated if entry.rule == RULE and entry.matters]


@pytest.mark.nightly
@looped(("count", "gap"), [(12, 0.001), (12, 0.02), (12, 0.5), (60, 0.02), (60, 0.5), (120, 0.1)])
@looped("unit", [1.0, MM_PER_INCH])
def test_a_ring_with_gaps_is_compared_along_its_curves(tmp_path: Path, count: int, gap: float, unit: float) -> None:
    corners = polygon(count)
    lines = walls(corners, gap)
    sound = report(tmp_path, program(corners, unit), lines, unit)
    assert not sound.findings
    said = reasons(sound)
    assert len(said) == (gap > 0.01)
    assert all("the curves of a.dxf do not meet: gap " in reason for reason in said)
    # One side is 0.1 mm too high.
    slip = [*corners]
    slip[2:4] = [corner + 0.1 * (corners[2] + corners[3]) / abs(corners[2] + corners[3]) for corner in corners[2:4]]
    faulty = report(tmp_path, program(slip, unit), lines, unit)
    (finding,) = faulty.findings
    assert finding.values["largest"] == pytest.approx(0.1, abs=0.005)
    assert not reasons(faulty)


def test_the_gap_is_told_with_its_place(tmp_path: Path) -> None:
    corners = polygon(4)
    lines = walls(corners, 0.001)
    lines[0] = lines[0][0] + cmath.rect(0.4, 3 * math.pi / 4), lines[0][1]
    (reason,) = reasons(report(tmp_path, program(corners), lines))
    assert "do not meet: gap 0.401 mm at X39.716 C0.141" in reason


def test_a_circle_of_the_bar_beside_it_is_not_taken_for_it(tmp_path: Path) -> None:
    corners = polygon(12)
    found = report(tmp_path, program(corners), walls(corners, 0.3), circle=25)
    assert not found.findings
    assert len(reasons(found)) == 1


@looped(
    "curves",
    [
        [(12 - 9j, 12 + 9j), (-12 + 9j, -12 - 9j)],
        [(12 - 9j, 12 + 9j)],
        slots(),
        [(10 - 0.4j, 20 - 0.4j), (10 + 0.4j, 20 + 0.4j)],
        [(10 + 0j, 10.5 + 0j)],
        [(10 + 0j, 20 + 0j), (10j, 20j)],
    ],
    ids=["two flats", "a flat", "eight slots", "a slit", "a short line", "radial lines"],
)
def test_walls_that_end_in_the_air_are_no_ring(curves: list[Wall]) -> None:
    assert widest_gap([np.array(curve) for curve in curves]) is None


@pytest.mark.ci
def test_gaps_narrower_than_what_is_tried_of_the_part_are_left_out(tmp_path: Path) -> None:
    sides = program(polygon(2))
    arcs = sides.replace("\nX-40.", "\nG3 R20. X-40.").replace("\nX40.", "\nR20. X40.").replace("\nG40", "\nG1 G40")
    for gap in (0.02, 0.06):
        ring = walls(polygon(400), gap)
        for text in (arcs, program(polygon(200))):
            found = report(tmp_path, text, ring)
            assert (found.findings, len(reasons(found))) == ([], 1)
            (finding,) = report(tmp_path, text, walls(polygon(400, 19.96), gap)).findings
            assert finding.values["largest"] == pytest.approx(0.04, abs=0.003)


@pytest.mark.nightly
def test_two_flats_drawn_as_lines_are_judged_as_areas(tmp_path: Path) -> None:
    flat = "G12.1\nG1 G98 C-30. F500\nG42 X{size} C-25. F200\nZ-5.\nC25.\nG40 X60. C30.\nZ2.\nG13.1\n"
    lines = [(12 - 9j, 12 + 9j), (-12 + 9j, -12 - 9j)]
    for sizes, count in ((("24.", "24."), 0), (("24.", "24.2"), 1)):
        both = flat.format(size=sizes[0]) + "G0 C180.\n" + flat.format(size=sizes[1])
        found = report(tmp_path, f"T0808\nG0 X60. Z2. C0\n{both}", lines)
        assert len(found.findings) == count
