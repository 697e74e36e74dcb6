"""Parts drawn again from the words of `polarcheck part` are what the cutters leave."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from contour_families import FAMILIES, program_of
from contour_verdicts import compare
from programs import tables_of
from redrawn_parts import Mismatch, mismatches
from test_samples import NAMES, SAMPLES, settings

from polarcheck.checking.tables import Tables
from polarcheck.finding import MadeShape
from polarcheck.machines.job import Job, Stock, Tool
from polarcheck.parts.part_report import made_by

#: Samples with a fault by which the tool does something else than the words say, and it.
FAULTY = {
    "arc_off_circle.nc": "an arc ends off its circle",
    "doosan/side_of_the_main_spindle.nc": "the side of compensation is that of another spindle",
    "hurco/radius_forgotten.nc": "arcs do not fit: X is written as a radius",
    "mazak-integrex/diameters_in_radius_mode.nc": "arcs do not fit: X is written as a radius",
    "mitsubishi-m700/feed_from_per_revolution.nc": "the start-up ends at the end of its wall",
    "ramp_too_short.nc": "the start-up is shorter than R and sweeps over the flat",
}
#: Of each family, so many seeds are drawn; and so many more where all tests run.
SHARE, MANY = 4, 40


def differences(tables: Tables, made: list[MadeShape], bar: float = np.nan, all_moves: bool = True) -> list[Mismatch]:
    return list(mismatches(tables, made, bar, all_moves))


@pytest.mark.parametrize("path", SAMPLES, ids=NAMES)
def test_words_of_a_sample_are_what_its_cutters_leave(path: Path) -> None:
    work: dict[str, Any] = settings(path)
    tables = tables_of(path.read_bytes(), **work, path=path.name)
    found = differences(tables, made_by(tables), float(tables["trace"].lengths.stock_diameter[-1]))
    name = NAMES[SAMPLES.index(path)]
    assert bool(found) == (name in FAULTY), found


def of_family(family: str, seed: int) -> list[Mismatch]:
    """What differs in a program of a family, if the reference calls it sound."""
    program = program_of(seed, family=family)
    if compare(program).judged != "sound":
        return []
    bar = np.nan if program.bar is None else program.bar
    tools = {"1": Tool(radius=program.radius, nose=0)}
    tables = tables_of(program.text, job=Job(units="mm", tools=tools, stock=Stock(diameter=bar)))
    # These programs come in through the material; what the reference leaves out is left out here.
    return differences(tables, made_by(tables), bar, all_moves=False)


@pytest.mark.parametrize("family", FAMILIES)
def test_words_of_a_family_are_what_its_cutters_leave(family: str) -> None:
    assert [(seed, found) for seed in range(SHARE) if (found := of_family(family, seed))] == []


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_words_of_many_programs_are_what_their_cutters_leave(family: str) -> None:
    assert [(seed, found) for seed in range(SHARE, MANY) if (found := of_family(family, seed))] == []


HEAD = "G21 G98 G40 T0808\nG0 X80. Z2. C0\nG12.1\nG1 Z-2. F300\n"


def told(body: str, radius: float, stock: float = 0, head: str = HEAD) -> tuple[list[MadeShape], list[Mismatch]]:
    """What is told of a program, and what of it is not what the cutter leaves."""
    job = {"stock": {"diameter": stock}} if stock else {}
    tables = tables_of(f"{head}{body}\nG13.1\nM30\n", "fanuc", f"8:radius={radius}", job=job)
    made = made_by(tables)
    return made, differences(tables, made, stock or np.nan)


def left(made: list[MadeShape]) -> list[str]:
    return [one.text for shape in made for one in shape.left_standing]


def test_a_wall_that_a_line_between_loops_crosses_is_one_wall() -> None:
    """The line from the start of the keyway straight along X crosses its other wall."""
    body = "G42 X-73.890 C-6.193 F200\nX-10.556 C2.396\nG2 X-6.688 C-4.734 I.967 J-3.565\nG1 X-70.022 C-13.323\n"
    made, wrong = told(body + "G40 X-81.125 C-11.002", 2.885, 62.892, HEAD.replace("X80.", "X-81.125"))
    assert ([one.shape for one in made], wrong) == (["keyway"], [])


@pytest.mark.parametrize("unit", [1.0, 25.4])
@pytest.mark.parametrize(("radius", "stands"), [(1.5, False), (4.0, True)])
def test_a_corner_just_outside_the_bar_is_told_where_its_rounding_reaches_in(
    radius: float, stands: bool, unit: float
) -> None:
    def inch(value: float) -> str:
        return f"{value / unit:.4f}"

    lines = [f"G1 X{inch(72)} C{inch(-23)} F200", f"G42 X{inch(53)} C{inch(-9.8)}", f"X{inch(30.8)}"]
    lines += [f"C{inch(9.8)}", f"G40 X{inch(43)} C{inch(22)}"]
    head = HEAD.replace("G21", "G20" if unit > 1 else "G21").replace("X80. Z2.", f"X{inch(80)} Z{inch(2)}")
    made, wrong = told("\n".join(lines), radius / unit, 34.86 / unit, head.replace("Z-2.", f"Z{inch(-2)}"))
    assert [one.shape for one in made] == ["flats"]
    assert (bool(left(made)), wrong) == (stands, [])
    if stands:
        assert "inside corner just outside the bar" in left(made)[0]
        assert made[0].values["reach_beyond"] == pytest.approx(1.636, abs=0.01)


def test_a_cutter_too_large_for_the_walls_beside_inside_corners_is_told() -> None:
    cross = (
        "G42 X60. C0 F200\nC10.\nX20.\nC14.\nX-20.\nC10.\nX-60.\nC-10.\nX-20.\nC-14.\nX20.\nC-10.\nX60.\nC0\nG40 X90."
    )
    made, _ = told(cross, 6.0, head=HEAD.replace("X80.", "X90."))
    assert made[0].shape == "cross"
    assert made[0].values["corner_reach"] == pytest.approx(4.0)
    assert left(made) == [
        "R6.000 of the cutter in 4 inside corners; the walls beside are too short for it: R4.000 would reach them"
    ]
    made, wrong = told(cross, 3.9, head=HEAD.replace("X80.", "X90."))
    assert (left(made), wrong) == (["R3.900 of the cutter in 4 inside corners"], [])
