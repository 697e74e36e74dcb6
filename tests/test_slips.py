"""
Sound programs as setters write them are not red, and what judges slips knows what a slip does, and what tells of it.

A small share of what benchmarks/slips.py draws.
"""

from __future__ import annotations

import random
import sys
from collections import Counter

import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from metal_simulation import differs, levels, metal_at, simulate
from milled_shapes import lobes, shifted
from programs import ROOT
from setter_dialects import DIALECTS
from setter_programs import FAMILIES, drawn
from single_slips import LEADS, SLIPS, planted
from slip_answers import Value, report_on, said_of, written
from slip_witnesses import witness

sys.path.insert(0, str(ROOT / "benchmarks"))

import slips

KINDS = {slip.name: slip for slip in SLIPS}


def test_there_are_enough_families_and_kinds() -> None:
    assert len(FAMILIES) >= 60
    assert len({slip.name for slip in SLIPS}) >= 140


@pytest.mark.nightly
@looped("machine", DIALECTS, one_in=17)
def test_sound_programs_are_silent(machine: str) -> None:
    for seed in range(4):
        program = drawn(seed, machine, "hexagon, single" if seed == 0 else "", LEADS[seed + 1])
        if program.style.repeats_z:
            continue
        assert said_of(report_on(program)) == [], (machine, seed, program.family)


@looped("machine", ["fanuc-30i", "haas-lathe", "siemens-transmit", "okuma-osp", "siemens-iso", "citizen"])
def test_the_simulation_leaves_what_is_programmed(machine: str) -> None:
    program = drawn(5, machine, "hexagon, single")
    outcome = simulate(program)
    ring = metal_at(outcome, levels(outcome)[-1]).exterior
    assert 2 * ring.distance(shapely.Point(0, 0)) == pytest.approx(program.size, abs=0.01)


@looped("seed", range(0, 150, 15), one_in=12)
def test_a_sound_program_has_no_event(seed: int) -> None:
    outcome = simulate(drawn(seed))
    assert outcome.sweeps
    assert not outcome.events
    assert not differs(outcome, outcome)


@pytest.mark.nightly
@looped(
    ("kind", "family"),
    [
        ("R: another digit", "cam, depths"),
        ("depth missing", "hexagon, single"),
        ("retract missing", "pocket, single"),
        ("index missing", "keyway, indexed"),
        ("G41 forgotten", "octagon, depths"),
    ],
    one_in=5,
)
def test_slips_are_found_that_do_something(kind: str, family: str) -> None:
    draw = random.Random(kind)  # noqa: S311
    programs = [drawn(seed, family=family) for seed in range(8)]
    assert sum(planted(KINDS[kind], program, draw) is not None for program in programs) >= 2


@pytest.mark.ci
@looped(
    ("family", "old", "new", "says"),
    [
        ("square, subprogram", "X-21.5 C7.75", "X-25.1 C7.75", "regular"),
        ("free_polygon, single", "X-40.26 C3.87", "X-41.26 C3.87", ""),
        ("free_polygon, single", "G41 G1 X32.45", "G41 G1 X42.45", "closed"),
        ("hexagon, single", "X-2.5 C17.465 I-1.25", "X-5. C17.465 I-2.5", "tangent"),
    ],
)
def test_what_tells_of_a_slip(family: str, old: str, new: str, says: str) -> None:
    program = drawn(3, "fanuc-30i", family)
    (index,) = [i for i, line in enumerate(program.lines) if old in line.text]
    changed = program.changed(index, program.lines[index].text.replace(old, new))
    assert witness(program, simulate(program), simulate(changed)) == says


@pytest.mark.ci
def test_words_are_written_as_they_are_told() -> None:
    program = drawn(3, "fanuc-30i", "hexagon, single", "extension")
    index = next(i for i, line in enumerate(program.lines) if line.role == "contour")
    for value, text in (
        (Value(("X9.",), (index + 1,), is_block=False), "X9."),
        (Value(("G3",), (index + 1,), is_block=False), "G3 "),
        (Value(("X9.", "C8."), (index + 1,), is_block=True), "X9. C8."),
    ):
        assert text in written(program, value)[index].text


@pytest.mark.nightly
def test_slips_are_told_once_and_the_remedy_repairs() -> None:
    """What a small run reaches; the page on benchmarks has the large one."""
    total = sum((one.row for one in slips.judged(len(SLIPS), 1)), Counter[str]())
    assert total["slips"] > 140
    assert total["spoken"] >= 0.9 * total["slips"]
    assert total["several"] <= 0.06 * total["spoken"]
    assert total["there"] >= 0.75 * total["spoken"]
    assert total["repairs"] >= 0.75 * total["named"]


@pytest.mark.nightly
def test_two_slips_are_both_told() -> None:
    found = slips.pairs(10, 1)
    assert sum(pair.told == 2 for pair in found) >= 8


@looped("seed", range(12))
def test_arcs_at_a_distance_end_on_circles_about_their_centers(seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311 - contours that can be drawn again
    drawn_one = lobes(draw, lambda least, most: round(draw.uniform(least, most), 1))
    aside = shifted(drawn_one, 2.5)
    ends, ends_aside = drawn_one.points(), aside.points()
    for index, piece in enumerate(drawn_one.pieces):
        assert piece.center is not None
        sizes = [abs(point - piece.center) for point in (ends[index], *ends_aside[index : index + 2])]
        assert [size - sizes[0] for size in sizes[1:]] == pytest.approx([2.5, 2.5])
