"""
Sound programs as setters write them are not red, and the simulation that judges slips knows what a slip does.

A small share of what benchmarks/one_slip.py draws.
"""

from __future__ import annotations

import random

import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from metal_simulation import C_LIMIT, differs, levels, metal_at, simulate
from programs import report_of
from setter_dialects import DIALECTS
from setter_programs import FAMILIES, Program, drawn
from single_slips import SLIPS, planted

KINDS = {slip.name: slip for slip in SLIPS}


def errors_of(program: Program) -> list[str]:
    """The rules that report something at or above warning."""
    job = {"stock": {"diameter": program.stock / program.scale}} if program.stock else None
    limits = {"limits": {"c_feed": C_LIMIT}}
    report = report_of(program.text(), program.machine, *program.tools(), changes=limits, job=job)
    return [finding.rule for finding in report.findings if finding.severity != "note"]


def test_there_are_enough_families_and_kinds() -> None:
    assert len(FAMILIES) >= 60
    assert len(SLIPS) >= 30


@pytest.mark.ci
@looped("machine", DIALECTS, one_in=17)
def test_sound_programs_are_silent(machine: str) -> None:
    for seed in range(4):
        program = drawn(seed, machine, "hexagon, single" if seed == 0 else "")
        if program.style.repeats_z:
            continue
        assert errors_of(program) == [], (machine, seed, program.family)


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


@pytest.mark.ci
@looped(
    ("kind", "family"),
    [
        ("R wrong", "cam, depths"),
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
