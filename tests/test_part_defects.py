"""
Sound parts are no other parts, parts with a defect are, and the generator and the judge know which is which.

A small share of what benchmarks/part_defects.py draws.
"""

from __future__ import annotations

import math
import sys
from typing import Any

import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from drawn_parts import FAMILIES, NAMES, Feature, drawn_plan
from part_judge import judged
from part_slips import KINDS, drawn_defect, drawn_sound
from programs import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import part_defects

BAR = shapely.Point(0, 0).buffer(60, quad_segs=64)


def area_of(keys: dict[str, Any], features: Feature) -> Any:
    """What may stand by a [[part]] with sharp corners that says its angle: half planes, or a circle."""
    shape, center = keys["shape"], keys.get("center", [0.0, 0.0])
    if shape == "circle":
        area = shapely.Point(center).buffer(keys["diameter"] / 2, quad_segs=64)
        return BAR.difference(area) if keys.get("inside") else area
    sides = next((sides for sides, name in NAMES.items() if name == shape), keys.get("sides", keys.get("count", 1)))
    flats = keys.get("across_flats", keys.get("across_corners", 0.0) * math.cos(math.pi / sides))
    apothem = keys.get("distance", flats / 2)
    area = BAR
    for number in range(sides):
        half = shapely.box(-1000, -1000, apothem, 1000)
        area = area.intersection(
            shapely.affinity.translate(
                shapely.affinity.rotate(half, keys["turned"] + 360 / sides * number, origin=(0, 0)), *center
            )
        )
    return area


@pytest.mark.nightly
@looped("family", ["triangle", "hexagon", "dodecagon", "polygon", "circle", "circle aside", "flat", "flats"], one_in=2)
def test_the_keys_of_a_part_say_what_its_feature_is(family: str) -> None:
    for seed in range(12):
        (feature,) = drawn_plan(seed, family).features
        if (
            ("turned" in feature.keys or "circle" in family)
            and not feature.form.corner
            and not feature.form.values.get("small")
        ):
            apart = shapely.symmetric_difference(area_of(feature.keys, feature), feature.stands().intersection(BAR))
            assert apart.buffer(-0.01).is_empty, (seed, feature.keys)


@looped("family", FAMILIES[::4], one_in=12)
def test_a_sound_program_makes_its_part(family: str) -> None:
    plan, program = drawn_sound(1, family)
    assert not judged(plan, program, plan.allowed).differs


@pytest.mark.ci
@looped("kind", list(KINDS)[::3], one_in=9)
def test_a_defect_of_each_kind_can_be_drawn(kind: str) -> None:
    defect = drawn_defect(3, (kind,))
    assert defect is not None
    assert not judged(defect.plan, defect.sound, defect.plan.allowed).differs


@pytest.mark.nightly
@looped("number", range(6), one_in=6)
def test_nothing_is_said_of_a_sound_part(number: int) -> None:
    result = part_defects.sound_of(number, FAMILIES[number::6], None)
    assert (result.verdict, result.says) == ("pass", ())


@pytest.mark.nightly
@looped("number", [0, 3, 4], one_in=3)
def test_a_defect_is_said(number: int) -> None:
    result = part_defects.defect_of(number, tuple(KINDS)[number::6], None)
    assert result is not None
    assert result.verdict in ("part", "other"), result
