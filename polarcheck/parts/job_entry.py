"""What a program makes as a [[part]] of a job file: the same shape with the same numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from polarcheck.foundation.errors import JobError
from polarcheck.foundation.finding import MadeShape
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.machines.job import from_table
from polarcheck.program.machines.part_keys import SIDES

#: Names of regular polygons by their number of sides.
_NAMES = {count: name for name, count in SIDES.items()}
#: Digits of lengths behind the point, in inch and in mm, and of angles.
_DIGITS, _ANGLE_DIGITS = {True: 4, False: 3}, 3
#: A circle of chords that leave it by more than this is none [mm].
_CHORDS = 0.005
#: A bar that reaches less than this beyond the corners leaves them as they are [mm].
_BEYOND = 0.01


class NoEntryError(Exception):
    """The reason why no [[part]] says what is made."""


class _Keys(NamedTuple):
    """
    The keys of a shape.

    shape: the shape of [[part]].
    lengths: its lengths [mm].
    counts: its numbers of sides or flats.
    """

    shape: str
    lengths: dict[str, float]
    counts: Mapping[str, int] = MappingProxyType({})


def job_entry(part: MadeShape, bar: float | None, *, inch: bool) -> dict[str, Any]:
    """
    The keys of a [[part]] with which a shape agrees.

    bar: diameter of the stock [mm], None if unknown.
    inch: the lengths of the entry are in inch, else in mm.

    Raises NoEntryError for what [[part]] has no shape for.
    """
    value = part.values
    if part.shape not in _SHAPES:
        raise NoEntryError("not known" if part.shape is None else f"a {part.shape} is no shape of [[part]]")
    if part.odd or not part.is_regular or not value.keys().isdisjoint(_UNEVEN):
        raise NoEntryError("its sides or corners differ from each other")
    keys = _SHAPES[part.shape](part, math.nan if bar is None else bar)
    entry: dict[str, Any] = {"shape": keys.shape, **keys.counts}
    entry |= {key: _length(length, inch) for key, length in keys.lengths.items()}
    # From an angle of C that is not known nothing can be compared.
    is_known = all(section.angle is not None for section in part.sections)
    if "turned" in value and keys.shape != "circle" and is_known:
        entry["turned"] = round(value["turned"], _ANGLE_DIGITS) + 0.0
    if "center_x" in value:
        entry["center"] = [_length(value[key], inch) for key in ("center_x", "center_c")]
    if part.inside and keys.shape != "slot":
        entry["inside"] = True
    if part.z is not None:
        entry["z"] = _length(part.z, inch)
    try:
        from_table({"part": [entry]}, "")
    except JobError as error:
        raise NoEntryError(str(error).removeprefix(": part.1").lstrip(".: ")) from None
    return entry


def _length(value: float, inch: bool) -> float:
    return round(value / MM_PER_INCH if inch else value, _DIGITS[inch]) + 0.0


#: Values of what has sides, flats or corners that differ, or flats at unequal angles.
_UNEVEN = {"least", "corner_least", "regular_by_x", "turned_1"}


def _circle(part: MadeShape, bar: float) -> _Keys:
    diameter, chords = part.values["diameter"], part.values.get("chords", math.inf)
    if diameter / 2 * (1 - math.cos(math.pi / chords)) > _CHORDS:
        raise NoEntryError(f"it is a circle in {chords:.0f} straight lines")
    return _Keys("circle", {"diameter": diameter})


def _polygon(part: MadeShape, bar: float) -> _Keys:
    count, across = int(part.values["sides"]), part.values["across_flats"]
    corners = _corners(part)
    diameter = part.values.get("corner_diameter", bar)
    # Corners that the bar cuts off are those of flats on a round.
    if not part.inside and not corners and across < diameter < across / math.cos(math.pi / count) - _BEYOND:
        return _Keys("flats", {"across_flats": across, "diameter": diameter}, {"count": count})
    return _Keys(_NAMES[count], {"across_flats": across, **corners})


def _rectangle(part: MadeShape, bar: float) -> _Keys:
    return _Keys("rectangle", {"width": part.values["width"], "length": part.values["length"], **_corners(part)})


def _corners(part: MadeShape) -> dict[str, float]:
    names = {"corner_radius": "corner_radius", "corner_chamfer": "chamfer"}
    return {key: part.values[name] for name, key in names.items() if name in part.values}


def _flats(part: MadeShape, bar: float) -> _Keys:
    value = part.values
    count, distance = int(value["flats"]), value.get("distance", math.nan)
    if not distance > 0 or "joined" in value:
        raise NoEntryError("its flats are joined by an arc" if distance > 0 else "it reaches beyond the center")
    diameter = value.get("diameter", bar)
    on_round = {"diameter": diameter} if diameter > 2 * distance + _BEYOND else {}
    if count == 1:
        return _Keys("flat", {"distance": distance, **on_round})
    return _Keys("flats", {"across_flats": 2 * distance, **on_round}, {"count": count})


def _slot(part: MadeShape, bar: float) -> _Keys:
    value = part.values
    if part.inside:
        return _Keys("slot", {key: value[key] for key in ("width", "length") if key in value})
    # A boss with round ends.
    return _Keys("rectangle", {**{key: value[key] for key in ("width", "length")}, "corner_radius": value["radius"]})


#: What makes the keys of each shape by its name in MadeShape; keyways, cams, grooves and free contours have none.
_SHAPES: Mapping[str | None, Callable[[MadeShape, float], _Keys]] = {
    "circle": _circle,
    **dict.fromkeys((*SIDES, "11-sided"), _polygon),
    "rectangle": _rectangle,
    "round with flats": _flats,
    "flats": _flats,
    "slot": _slot,
}
