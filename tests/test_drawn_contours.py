"""Drawn contours of lines and arcs are sound, and one slip in one of them is one finding."""

from __future__ import annotations

import random

import pytest
from drawn_contour_slips import SLIPS
from drawn_contours import Drawn, contour
from programs import report_of

SEEDS = range(36)
#: What a drawn contour may come near by chance: the center of C.
_BY_CHANCE = {"path-through-center", "path-near-center", "c-feed-above-limit"}


def rules_of(drawn: Drawn, blocks: list[str] | None = None) -> list[str]:
    """The rules that report something at or above warning."""
    report = report_of(drawn.text(blocks), drawn.machine, *drawn.tools)
    return [finding.rule for finding in report.findings if finding.severity != "note"]


DRAWN = [drawn for drawn in map(contour, SEEDS) if not _BY_CHANCE & set(rules_of(drawn))]


@pytest.mark.parametrize("drawn", DRAWN, ids=lambda drawn: f"{drawn.family}-{drawn.machine}")
def test_a_drawn_contour_is_sound(drawn: Drawn) -> None:
    assert rules_of(drawn) == []


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_in_a_contour_is_one_finding(name: str) -> None:
    slip, silent = SLIPS[name]
    found = []
    for number, drawn in enumerate(DRAWN):
        blocks = drawn.blocks()
        changed = None if drawn.family in silent else slip(drawn, [*blocks], random.Random(number))  # noqa: S311
        if changed is not None and changed != blocks:
            found.append(rules_of(drawn, changed))
    assert found
    assert sum(map(bool, found)) >= 0.95 * len(found), found
    assert sum(len(rules) > 1 for rules in found) <= 0.12 * len(found), found
