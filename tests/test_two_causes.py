"""
One slip in a drawn section is one finding, and two slips that have nothing to do with each other are two.

A small share of what benchmarks/two_slips.py draws.
"""

from __future__ import annotations

import random

import pytest
from cases import looped
from drawn_sections import Section
from drawn_slips import SLIPS, Slip, gives_two_findings, loops, pairs, planted, rules_of, sound_sections
from programs import report_of

pytestmark = pytest.mark.nightly

#: Two of each family, on all controls.
DRAWN = sound_sections(12, 1)


def test_the_drawn_sections_are_sound() -> None:
    assert len(DRAWN) > 9


@looped("slip", SLIPS, ids=lambda slip: slip.name, one_in=20)
def test_one_slip_is_one_finding(slip: Slip) -> None:
    draw = random.Random(5)  # noqa: S311
    written = [
        (number, one, planted(slip, one, draw.randrange(len(loops(one))), draw)) for number, one in enumerate(DRAWN)
    ]
    with_slip: list[tuple[int, float, Section]] = [(number, one.stock, two) for number, one, two in written if two]
    assert with_slip
    for number, diameter, section in with_slip:
        found = rules_of(number, section, stock=diameter if slip.name == "approach inside the bar" else None)
        assert len(found) == 1, (section.family, found)


def test_two_slips_are_two_findings() -> None:
    found = [gives_two_findings(numbered) for numbered in enumerate(pairs(DRAWN, 40, 1))]
    known = [one for one in found if one is not None]
    assert len(known) > 33
    assert sum(known) >= len(known) - 1


@looped("machine", ["fanuc", "gsk-988", "siemens-iso"])
def test_an_if_that_a_control_does_not_know_is_one_finding(machine: str) -> None:
    is_siemens = machine.startswith("siemens")
    head = "G0 X80." if is_siemens else "#1=6\nIF [#1 GT 5]\nG0 X80."
    report = report_of(f"O1\nG21 G40 G97\n{head}\nELSE\nG0 X70.\nENDIF\nM30\n", machine)
    assert [found.rule for found in report.findings] == ["loop-unbalanced" if is_siemens else "macro-syntax"]


@looped(
    ("machine", "blocks", "rule"),
    [
        ("fanuc", "#2=FOO+1\n#3=FOO*2", "macro-syntax"),
        ("fanuc", "FOO(1)\nFOO(2)", "bad-number"),
        ("okuma-osp", "X=FOO\nZ=FOO", "vacant-variable"),
        ("fanuc", "G1 X#101 F100\nZ#101", "vacant-variable"),
    ],
)
def test_a_name_that_is_not_known_is_one_finding(machine: str, blocks: str, rule: str) -> None:
    report = report_of(f"O1\nG21 G40 G97\n{blocks}\nM30\n", machine)
    assert [(found.rule, found.count) for found in report.findings if found.severity != "note"] == [(rule, 2)]
    other = report_of(f"O1\nG21 G40 G97\n{blocks.replace('FOO', 'BAR', 1).replace('#101', '#102', 1)}\nM30\n", machine)
    assert [found.rule for found in other.findings if found.severity != "note"] == [rule, rule]
