"""
Whether the metal that a program leaves is the part, by areas: the slow and plain way, sharing no code with polarcheck.

    judged(plan, program, 0.02)     # Verdict(differs, ...)

tests/metal_simulation.py runs the blocks and gives what the cutters sweep down to each Z; the features of the plan say
what must stand there and what must be gone.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple

import shapely  # type: ignore[import-untyped]
from drawn_parts import Feature, Plan, points_of, turned_area
from metal_simulation import Outcome, metal_at, simulate
from setter_programs import Program

_THIN = 0.02  # [mm] slabs that are thinner are rounding
_TURNS = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6)  # [deg] a part without `turned` may lie so


class Judgement(NamedTuple):
    """
    What is wrong with the metal.

    extra: area that should be gone [mm2]. missing: that should stand [mm2]. z: where more of it is [mm]. place: a point
    there. events: of the simulation, as alarms.
    """

    extra: float
    missing: float
    z: float
    place: complex
    events: frozenset[str]

    @property
    def differs(self) -> bool:
        return max(self.extra, self.missing) > 1e-3


def judged(plan: Plan, program: Program, allowed: float) -> Judgement:
    """What differs by more than a length [mm]."""
    outcome = simulate(program)
    events = outcome.events
    worst = Judgement(0.0, 0.0, 0.0, 0j, events)
    for z in _levels(plan, outcome):
        metal = metal_at(outcome, z)
        extra, missing = _apart(plan, outcome, metal, z, allowed)
        if max(extra.area, missing.area) > max(worst.extra, worst.missing):
            spot = (extra if extra.area > missing.area else missing).representative_point()
            worst = Judgement(extra.area, missing.area, z, complex(spot.x, spot.y), events)
    return worst


def _levels(plan: Plan, outcome: Outcome) -> list[float]:
    """The middles of the slabs between all depths."""
    depths = {round(sweep.z, 2) for sweep in outcome.sweeps if sweep.z < -1e-6}
    depths |= {round(feature.z, 2) for feature in plan.features} | {0.0}
    return [(low + high) / 2 for low, high in pairwise(sorted(depths)) if high - low > _THIN]


def _apart(plan: Plan, outcome: Outcome, metal: Any, z: float, allowed: float) -> tuple[Any, Any]:
    surely = outcome.bar if is_bar_known(plan) else _bar(plan)
    pairs = []
    for stands in _readings(plan, outcome.bar, z):
        pairs += [_difference(metal, turned_area(stands, turn), surely, allowed) for turn in _turns(plan)]
    return min(pairs, key=lambda pair: max(pair[0].area, pair[1].area))


def _readings(plan: Plan, bar: Any, z: float) -> list[Any]:
    """What should stand; of a closed curve of a drawing, either side may be the part."""
    drawings: dict[str, list[Feature]] = {}
    for number, feature in enumerate(plan.features):
        if feature.z < z:
            drawings.setdefault(feature.keys.get("drawing", str(number)), []).append(feature)
    readings = [bar]
    for features in drawings.values():
        area = shapely.intersection_all([feature.stands() for feature in features])
        sides = [area]
        if features[0].is_drawn and features[0].form.contour().closed:
            sides.append(bar.difference(area))
        readings = [reading.intersection(side) for reading in readings for side in sides]
    return readings


def _difference(metal: Any, stands: Any, bar: Any, allowed: float) -> tuple[Any, Any]:
    """What is too much and too little, without what is thinner than half of what is allowed."""
    extra, missing = metal.intersection(bar).difference(stands), stands.difference(metal)
    if extra.buffer(-allowed / 4).is_empty:
        extra = shapely.Polygon()
    if missing.buffer(-allowed / 4).is_empty:
        missing = shapely.Polygon()
    return extra.difference(stands.buffer(allowed)), missing.intersection(stands.buffer(-allowed))


def _turns(plan: Plan) -> list[float]:
    """The angles by which the part may be turned a little, since it does not say `turned` [deg]."""
    if any(feature.is_drawn or "turned" in feature.keys for feature in plan.features):
        return [0.0]
    return [sign * turn for turn in _TURNS for sign in (1, -1)][1:]


def is_bar_known(plan: Plan) -> bool:
    """Whether the program, the job or a [[part]] says it."""
    return "bar" in plan.program().evidence or any("diameter" in one.keys for one in plan.features if not one.is_round)


def _bar(plan: Plan) -> Any:
    """What is surely there where nobody says the bar: it holds all that is closed."""
    reach = 0.0
    for feature in plan.features:
        contour, values = feature.form.contour(), feature.form.values
        if contour.closed:
            reach = max(reach, *(abs(point) for point in points_of(contour)))
        elif feature.form.kind == "flat" and len(feature.angles) > 2:
            reach = max(reach, values["distance"] / math.cos(math.pi / len(feature.angles)))
        else:
            wall = values.get("distance", 0.65 * values.get("width", 2 * abs(contour.start.imag)))
            reach = max(reach, min(plan.bar / 2, 1.15 * wall))
    return shapely.Point(0, 0).buffer(reach, quad_segs=90)
