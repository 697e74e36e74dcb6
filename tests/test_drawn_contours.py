"""Drawn contours of lines and arcs are sound, and one slip in one of them is one finding."""

from __future__ import annotations

import functools
import random

import pytest
from cases import looped
from drawn_contour_slips import SLIPS
from drawn_contours import Drawn, contour
from programs import report_of

pytestmark = pytest.mark.nightly

SEEDS = range(36)
#: What a drawn contour may come near by chance: the center of C.
_BY_CHANCE = {"path-through-center", "path-near-center", "c-feed-above-limit"}


def rules_of(drawn: Drawn, blocks: list[str] | None = None) -> list[str]:
    """The rules that report something at or above warning."""
    report = report_of(drawn.text(blocks), drawn.machine, *drawn.tools)
    return [finding.rule for finding in report.findings if finding.severity != "note"]


@functools.cache
def drawn_contour(seed: int) -> tuple[Drawn, list[str]]:
    """A drawn contour, and the rules that report something of it."""
    drawn = contour(seed)
    return drawn, rules_of(drawn)


def clear_of_center() -> list[Drawn]:
    """Those that come near the center of C by no chance; to check them all takes seconds."""
    return [drawn for drawn, rules in map(drawn_contour, SEEDS) if not _BY_CHANCE & set(rules)]


@looped("seed", SEEDS, one_in=12)
def test_a_drawn_contour_is_sound(seed: int) -> None:
    _, rules = drawn_contour(seed)
    assert not rules or _BY_CHANCE & set(rules)


@pytest.mark.nightly
def test_most_drawn_contours_are_clear_of_the_center() -> None:
    assert len(clear_of_center()) > len(SEEDS) / 2


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_in_a_contour_is_one_finding(name: str) -> None:
    slip, silent = SLIPS[name]
    found = []
    for number, drawn in enumerate(clear_of_center()):
        blocks = drawn.blocks()
        changed = None if drawn.family in silent else slip(drawn, [*blocks], random.Random(number))  # noqa: S311
        if changed is not None and changed != blocks:
            found.append(rules_of(drawn, changed))
    assert found
    assert sum(map(bool, found)) >= 0.95 * len(found), found
    assert sum(len(rules) > 1 for rules in found) <= 0.12 * len(found), found
