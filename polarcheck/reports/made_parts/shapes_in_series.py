"""Shapes that several sections cut at equal steps of C, as `6 slots, 60 deg apart`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import msgspec
import numpy as np

from polarcheck.foundation.finding import MadeShape
from polarcheck.geometry.shapes.shape import SAME

#: Fewer shapes than these are no series.
_FEWEST = 3
#: More lines than these are given by the first and the last one.
_MOST_LISTED = 8
#: Steps of C that differ by less are equal [deg].
_SAME_STEP = 1e-3
#: What a turn around the axis changes.
_TURNING = ("turned", "center_x", "center_c")
#: Shapes that half a turn leaves the same; regular polygons repeat by their sides, all others after a whole turn.
_HALF_TURN = ("slot", "rectangle")


def in_series(shapes: Sequence[MadeShape]) -> Iterator[MadeShape]:
    """The shapes of a part in their order, each series of equal ones at equal steps of C as one."""
    start = 0
    while start < len(shapes):
        stop = start + 1
        while stop < len(shapes) and _continues(shapes[start:stop], shapes[stop]):
            stop += 1
        if stop - start >= _FEWEST:
            yield _joined(shapes[start:stop])
        else:
            stop = start + 1
            yield shapes[start]
        start = stop


def _continues(series: Sequence[MadeShape], shape: MadeShape) -> bool:
    before = series[-1]
    step = _step(before, shape)
    if step is None or not _is_turned_by(before, shape, step):
        return False
    return len(series) == 1 or abs(step - (_step(*series[-2:]) or 0.0)) <= _SAME_STEP


def _step(first: MadeShape, second: MadeShape) -> float | None:
    """The angle of C from the first to the second [deg], -180 to 180; None where it is not known or 0."""
    if len(first.sections) > 1 or len(second.sections) > 1:
        return None
    angle, next_angle = first.sections[0].angle, second.sections[0].angle
    if angle is None or next_angle is None:
        return None
    return 180 - (180 - next_angle + angle) % 360 or None


def _is_turned_by(first: MadeShape, second: MadeShape, step: float) -> bool:
    """The second shape is the first one to the same depths, turned around the axis by a step [deg]."""
    values, turned = first.values, second.values
    if _without_turn(first) != _without_turn(second) or values.keys() != turned.keys():
        return False
    if any(abs(values[name] - turned[name]) > 2 * SAME for name in values if name not in (*_TURNING, "area")):
        return False
    if "turned" in values:
        period = 180 if first.shape in _HALF_TURN else 360 / values.get("sides", 1)
        off = (turned["turned"] - values["turned"] - step + period / 2) % period - period / 2
        # Words with three digits turn a side of some millimetres by some thousandths of a degree.
        if abs(off) > 0.1:
            return False
    if "center_x" not in values:
        return first.shape == "keyway"
    center, turned_center = (complex(value["center_x"], value["center_c"]) for value in (values, turned))
    return bool(abs(center * np.exp(1j * np.radians(step)) - turned_center) <= 2 * SAME)


def _without_turn(shape: MadeShape) -> tuple[object, ...]:
    """What equal shapes of a series have in common, beside their values."""
    remarks = shape.text.split("; ")[1:]
    # The last one says at which C the section begins.
    return (
        shape.shape,
        shape.inside,
        shape.depths,
        remarks[:-1] if shape.sections[0].angle else remarks,
        shape.odd,
        shape.left_standing,
        shape.needs,
        shape.as_meant,
        shape.is_compared,
        shape.channel,
    )


def _joined(series: Sequence[MadeShape]) -> MadeShape:
    first = series[0]
    # A loop or a called program begins its sections in one line.
    lines = list(dict.fromkeys(str(shape.line) for shape in series))
    listed = ", ".join(lines) if len(lines) <= _MOST_LISTED else f"{lines[0]} to {lines[-1]}"
    name, _, rest = f"{first.shape}".partition(" ")
    plural = f"{name}{'es' if name.endswith('s') else 's'} {rest}".rstrip()
    step = abs(sum(_step(*pair) or 0.0 for pair in pairwise(series))) / (len(series) - 1)
    where = f"by the section{'s' if len(lines) > 1 else ''} of line{'s' if len(lines) > 1 else ''} {listed}"
    text = f"{len(series)} {plural}, {step:.4g} deg apart, the first: {first.text}; {where}"
    return msgspec.structs.replace(first, text=text)
