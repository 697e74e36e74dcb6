"""Parts drawn again from the words of `polarcheck part` are what the cutters leave."""

from __future__ import annotations

import cmath
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from contour_families import FAMILIES, program_of
from contour_verdicts import compare
from drawn_contours import contour
from programs import tables_of
from redrawn_parts import Mismatch, mismatches
from test_samples import NAMES, SAMPLES, settings

from polarcheck.foundation.finding import MadeShape
from polarcheck.program.machines.job import Job, Stock, Tool
from polarcheck.reports.made_parts.part_report import made_by
from polarcheck.rules.tables import Tables

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
SHARE, MANY = 4, 12


def differences(tables: Tables, made: list[MadeShape], bar: float = np.nan, all_moves: bool = True) -> list[Mismatch]:
    return list(mismatches(tables, made, bar, all_moves))


@pytest.mark.ci
@looped("path", SAMPLES, ids=NAMES, one_in=20)
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


@pytest.mark.nightly
@looped("family", FAMILIES, one_in=13)
def test_words_of_a_family_are_what_its_cutters_leave(family: str) -> None:
    assert [(seed, found) for seed in range(SHARE) if (found := of_family(family, seed))] == []


@pytest.mark.nightly
@pytest.mark.parametrize("family", FAMILIES)
def test_words_of_many_programs_are_what_their_cutters_leave(family: str) -> None:
    assert [(seed, found) for seed in range(SHARE, MANY) if (found := of_family(family, seed))] == []


HEAD = "G21 G98 G40 T0808\nG0 X80. Z2. C0\nG12.1\nG1 Z-2. F300\n"


def told(body: str, radius: float, stock: float = 0, head: str = HEAD) -> tuple[list[MadeShape], list[Mismatch]]:
    """What is told of a program, and what of it is not what the cutter leaves; on its way to G41 it cuts nothing."""
    job = {"stock": {"diameter": stock}} if stock else {}
    tables = tables_of(f"{head}{body}\nG13.1\nM30\n", "fanuc", f"8:radius={radius}", job=job)
    made = made_by(tables)
    return made, differences(tables, made, stock or np.nan, all_moves=False)


def left(made: list[MadeShape]) -> list[str]:
    return [one.text for shape in made for one in shape.left_standing]


def test_a_wall_that_a_line_between_loops_crosses_is_one_wall() -> None:
    """The line from the start of the keyway straight along X crosses its other wall."""
    body = "G42 X-73.890 C-6.193 F200\nX-10.556 C2.396\nG2 X-6.688 C-4.734 I.967 J-3.565\nG1 X-70.022 C-13.323\n"
    made, wrong = told(body + "G40 X-81.125 C-11.002", 2.885, 62.892, HEAD.replace("X80.", "X-81.125"))
    assert ([one.shape for one in made], wrong) == (["keyway"], [])


@pytest.mark.ci
@looped("unit", [1.0, 25.4])
@looped(("radius", "stands"), [(1.5, False), (4.0, True)])
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


def keyed(count: int, turned: float, center: complex = 0j) -> str:
    """A shaft of R20 with keyways 6 wide down to 15 from its center, as blocks from G42 to G40."""

    def words(point: complex, start: complex | None = None) -> str:
        place = f"X{2 * point.real:.3f} C{point.imag:.3f}"
        if start is None:
            return place
        return f"{place} I{center.real - start.real:.3f} J{center.imag - start.imag:.3f}"

    first = center + cmath.rect(20, math.radians(turned) - math.pi / count)
    away = center + cmath.rect(50, math.radians(turned) - math.pi / count)
    blocks, here = [f"G1 {words(away)} F200", f"G42 {words(first)}"], first
    for number in range(count):
        direction = cmath.rect(1, math.radians(turned) + math.tau * number / count)
        rim = math.sqrt(20**2 - 3**2)
        one, two, three, four = (center + direction * complex(*at) for at in ((rim, -3), (15, -3), (15, 3), (rim, 3)))
        blocks += [f"G3 {words(one, here)}", f"G1 {words(two)}", words(three), words(four)]
        here = four
    return "\n".join([*blocks, f"G3 {words(first, here)}", f"G1 G40 {words(away)}"])


@pytest.mark.ci
@looped(("count", "turned", "center"), [(1, 0.0, 0j), (4, 30.0, 0j), (1, 90.0, 3 - 2j)])
def test_a_shaft_with_keyways_is_no_round_with_flats(count: int, turned: float, center: complex) -> None:
    made, wrong = told(keyed(count, turned, center), 2.0)
    assert ([one.shape for one in made], wrong) == (["round with keyway"], [])
    sizes = {"diameter": 40, "keyways": count, "width": 6, "distance": 15, "turned": turned}
    assert {name: made[0].values[name] for name in sizes} == pytest.approx(sizes, abs=0.01)
    words = "a keyway 6" if count == 1 else "4 keyways 6"
    assert words in made[0].text.replace("5.999", "6.000")
    assert left(made) == [f"R2.000 of the cutter in {2 * count} inside corners"]


def test_extents_of_a_polygon_with_round_corners_are_those_of_its_arcs() -> None:
    """One of its corners is sharp: its sides alone reach less far than its arcs."""
    body = "G42 X40. C0 F200\nC5.\nG3 X20. C15. I-10. J0\nG1 X-30.\nX-50. C-5.\nC-20.\nX30.\nG3 X40. C-15. I0. J5.\n"
    made, wrong = told(body + "G1 C0\nG40 X80.", 2.0)
    assert (made[0].values["x_most"], made[0].values["c_most"]) == (pytest.approx(20), pytest.approx(15))
    assert wrong == []


@pytest.mark.nightly
def test_words_of_drawn_contours_are_what_their_cutters_leave() -> None:
    wrong = []
    for seed in range(80):
        drawn = contour(seed)
        tables = tables_of(drawn.text(), drawn.machine, *drawn.tools)
        wrong += [(seed, drawn.family, one) for one in differences(tables, made_by(tables))]
    assert wrong == []


def flats(*places: tuple[float, float]) -> str:
    """Flats in one section, each by its direction and its distance from the center."""
    blocks = []
    for angle, distance in places:
        direction = cmath.rect(1, math.radians(angle))
        way = [complex(distance + 9, -40), complex(distance, -30), complex(distance, 30), complex(distance + 9, 40)]
        one, two, three, four = (f"X{2 * (direction * at).real:.3f} C{(direction * at).imag:.3f}" for at in way)
        blocks += ["G1 Z2. F300", one, "Z-2.", f"G42 {two}", three, f"G40 {four}"]
    return "\n".join(blocks)


@pytest.mark.ci
@looped("bar", [0, 32])
@looped(
    ("places", "words"),
    [
        (((0, 12), (90, 12)), "2 flats, 12.000 from the center at 0 and 90 deg; to Z-2.000"),
        (((0, 12), (90, 13)), "2 flats, 12.000 at 0 deg and 13.000 at 90 deg from the center; to Z-2.000"),
        (((0, 12), (180, 14)), "flats 26.000 apart, 12.000 at 0 deg and 14.000 at 180 deg from the center; to Z-2.000"),
    ],
)
def test_of_uneven_flats_each_is_told_with_its_direction(
    places: tuple[tuple[float, float], ...], words: str, bar: float
) -> None:
    made, wrong = told(flats(*places), 4.0, bar, HEAD.replace("X80.", "X90."))
    assert ([one.text for one in made], wrong) == ([words], [])


def test_a_slot_between_flats_is_no_third_flat() -> None:
    slot = "G1 Z2.\nX0 C-40.\nZ-2.\nG41 X10. C-30.\nC30.\nG40 X0 C40.\nG41 X-10. C30.\nC-30.\nG40 X0 C-40."
    made, wrong = told(flats((90, 12), (270, 12)) + "\n" + slot, 4.0, 32.0, HEAD.replace("X80.", "X90."))
    assert ([one.text for one in made], wrong) == (
        [
            "flats 24.000 apart, turned by 90 deg; to Z-2.000",
            "slot 10.000 wide, open at both ends, turned by 90 deg; to Z-2.000",
        ],
        [],
    )


def test_of_corners_that_differ_each_is_told() -> None:
    """Counterclockwise from the corner behind the right side: R3, sharp, R3, sharp."""
    body = "G42 X40. C0 F200\nC7.\nG3 X34. C10. I-3. J0\nG1 X-40.\nC-7.\nG3 X-34. C-10. I3. J0\nG1 X40.\nC0\nG40 X80."
    made, wrong = told(body, 2.0)
    assert ([one.text for one in made], wrong) == (
        ["rectangle 40.000 x 20.000, 2 corners R3.000, 2 sharp; to Z-2.000"],
        [],
    )
    assert [made[0].values[f"corner_{number}"] for number in (1, 2, 3, 4)] == pytest.approx([3, 0, 3, 0])


def test_a_piece_between_two_grooves_is_no_flat_of_the_other_pieces() -> None:
    """The path of the tool center, in the shape of a U: a tongue stands inside, and more outside."""
    path = "X70. C3. F200\nX-60.\nC-7.\nX70."
    made, _ = told(f"G1 Z2.\n{path.replace('F200', 'F200 Z2.', 1)}\nZ-2.\n{path}", 3.75, 63.5)
    assert "contour" in [one.shape for one in made]
    assert all("turned_1" not in one.values for one in made)
