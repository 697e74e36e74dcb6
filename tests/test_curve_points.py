"""Curves of many short lines: a point off the curve is told with its word, and corners, steps and notches are not."""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Sequence

import pytest
from programs import report_of

RULE = "nearly-regular-contour"


def ellipse(count: int = 72) -> list[complex]:
    return [complex(20 * math.cos(turn), 14 * math.sin(turn)) for turn in _turns(count)]


def cam(count: int = 90) -> list[complex]:
    return [cmath.rect(20 + 3 * math.cos(2 * turn), turn) for turn in _turns(count)]


def hexagon(pieces: int = 12) -> list[complex]:
    """The sides of a hexagon, each divided into pieces that are as long."""
    corners = [cmath.rect(20, math.radians(60 * number)) for number in range(7)]
    sides = itertools.pairwise(corners)
    return [start + (end - start) * piece / pieces for start, end in sides for piece in range(pieces)] + corners[:1]


def rounded_square(pieces: int = 9) -> list[complex]:
    """A square with rounded corners of chords, whose straight sides are one block each."""
    corners = [(12 + 12j) * 1j**number for number in range(4)]
    return [
        corner + cmath.rect(5, math.radians(90 * (number + piece / pieces)))
        for number, corner in enumerate(corners)
        for piece in range(pieces + 1)
    ] + [17 + 12j]


def drop(count: int = 60) -> list[complex]:
    """A circle that ends in one sharp point."""
    return [*(cmath.rect(14, turn) for turn in _turns(count)[5:-5]), 24 + 0j, cmath.rect(14, _turns(count)[5])]


def _turns(count: int) -> list[float]:
    return [2 * math.pi * number / count for number in range(count + 1)]


def blocks_of(points: Sequence[complex]) -> list[str]:
    return [f"X{2 * point.real:.3f} C{point.imag:.3f}" for point in points]


def said_of(blocks: Sequence[str], machine: str = "fanuc-30i") -> list[tuple[int, str]]:
    """The words that are written instead, by the number of the block."""
    head = ["T0101", "G98 G97 S2500 M13", "G0 X100. C0. Z2.", "G12.1", "G1 Z-4. F300", "G42 X60. C-8. F160"]
    program = "\n".join([*head, *blocks, "G40 X100.", "G13.1", ""])
    findings = [found for found in report_of(program, machine, "1:radius=2").findings if found.rule == RULE]
    return [(found.line - len(head) - 1, str(found.values["word_needed"])) for found in findings]


@pytest.mark.ci
@pytest.mark.parametrize("points", [ellipse(), cam(), hexagon(), rounded_square(), drop(), ellipse(24), hexagon(6)])
def test_no_point_of_a_sound_curve_is_off_it(points: list[complex]) -> None:
    assert not said_of(blocks_of(points))


@pytest.mark.ci
@pytest.mark.parametrize("number", [1, 9, 40, 71])
def test_a_point_off_the_curve_is_told_with_the_number_that_is_meant(number: int) -> None:
    blocks = blocks_of(ellipse())
    words = blocks[number].split()
    for index, word in enumerate(words):
        digit = str((int(word[-3]) + 3) % 10)
        wrong = [*words[:index], word[:-3] + digit + word[-2:], *words[index + 1 :]]
        changed = [*blocks[:number], " ".join(wrong), *blocks[number + 1 :]]
        ((block, needed),) = said_of(changed)
        assert block == number
        assert math.isclose(float(needed[1:]), float(word[1:]))


def test_a_point_off_the_curve_that_no_slip_explains_may_be_a_notch() -> None:
    points = ellipse()
    assert not said_of(blocks_of([*points[:30], points[30] * 0.93, *points[31:]]))


def test_a_word_that_is_missing_in_a_curve_is_about_where_the_curve_goes_on() -> None:
    blocks = blocks_of(cam())
    number = 21
    lost = [*blocks[:number], blocks[number].split()[0], *blocks[number + 1 :]]
    ((block, needed),) = said_of(lost)
    assert block == number
    assert abs(float(needed[1:]) - float(blocks[number].split()[1][1:])) < 0.05


def test_a_word_of_the_block_before_is_told() -> None:
    blocks = blocks_of(ellipse())
    x, c = (blocks[number].split()[index] for number, index in ((8, 0), (9, 1)))
    assert [block for block, _ in said_of([*blocks[:9], f"{x} {c}", *blocks[10:]])] == [9]


@pytest.mark.ci
def test_points_off_a_curve_in_many_places_are_teeth() -> None:
    row = [f"X{50 if number % 12 == 6 else 40}. C{number / 2 - 15:.1f}" for number in range(60)]
    assert not said_of(row)
    assert [block for block, _ in said_of([*row[:10], *(f"X40. {block.split()[1]}" for block in row[10:])])] == [6]
