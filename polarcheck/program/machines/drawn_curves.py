"""
The points of the lines and curves of a DXF file; lengths in units of the drawing, points x + 1j*c.

Each function takes an entity that ezdxf has read, and imports ezdxf late.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.machines.chains import chord_count

#: No drawing of a part has curves of more points.
MOST_POINTS = 400_000
#: No lathe and no sheet reaches farther from the axis [mm].
_FARTHEST = 1e5
#: No arc has a radius of more than this multiple of that distance.
_FLATTEST = 1e6
#: How far chords may deviate from their curves, and how far apart two ends at one point may be [mm].
_SAGITTA, _GAP = 2e-4, 0.01
#: What is shorter than this share of the distance between ends at one point has no length.
_NO_LENGTH = 1e-4
#: Parameters of an ellipse that differ by less are the same [rad].
_SAME_PARAMETER = 1e-9
#: A survey foot of the United States [mm]: 1200/3937 m.
_SURVEY_FOOT = 1_200_000 / 3937
#: Units by $INSUNITS (Autodesk, DXF reference, header variables): the name of each, and its length [mm].
_UNITS = {
    1: ("inches", MM_PER_INCH),
    2: ("feet", 12 * MM_PER_INCH),
    3: ("miles", 63_360 * MM_PER_INCH),
    4: ("mm", 1.0),
    5: ("cm", 10.0),
    6: ("m", 1e3),
    7: ("km", 1e6),
    8: ("microinches", 1e-6 * MM_PER_INCH),
    9: ("mils", 1e-3 * MM_PER_INCH),
    10: ("yards", 36 * MM_PER_INCH),
    11: ("angstroms", 1e-7),
    12: ("nanometers", 1e-6),
    13: ("microns", 1e-3),
    14: ("dm", 100.0),
    15: ("dam", 1e4),
    16: ("hm", 1e5),
    17: ("gigameters", 1e12),
    18: ("astronomical units", 1.495978707e14),
    19: ("light years", 9.4607304725808e18),
    20: ("parsecs", 3.0856775814913673e19),
    21: ("US survey feet", _SURVEY_FOOT),
    22: ("US survey inches", _SURVEY_FOOT / 12),
    23: ("US survey yards", 3 * _SURVEY_FOOT),
    24: ("US survey miles", 5280 * _SURVEY_FOOT),
}
#: Flag of a vertex of a polyline: a control point of its spline frame, which is no point of the curve.
_OF_FRAME = 16


class NoDrawingError(Exception):
    """The reason why a file shows no part."""


class Fineness(NamedTuple):
    """
    How finely the curves of a drawing are read; lengths in its units.

    scale: mm per unit, NaN where the drawing does not say. units: their name, empty where it does not. sagitta:
    greatest distance of chords from their curve. gap: greatest distance of two ends at one point. farthest: greatest
    distance of points from the origin.
    """

    scale: float
    units: str
    sagitta: float
    gap: float
    farthest: float

    @property
    def least(self) -> float:
        """What is no longer than this has no length."""
        return self.gap * _NO_LENGTH

    @property
    def of_units(self) -> str:
        """The units for a message, where they are neither mm nor unknown."""
        return f"; its units are {self.units}" if self.units and self.scale != 1 else ""

    def too_far(self) -> NoDrawingError:
        """The error for points beyond `farthest`."""
        beyond = f"farther than {_FARTHEST:g} mm from its origin, the spindle axis"
        return NoDrawingError(f"shows what is {beyond}{self.of_units}")


def fineness_of(number: int) -> Fineness:
    """
    How finely a drawing of these units ($INSUNITS) is read; 0 for none. Raises NoDrawingError for a number that no DXF
    file has.
    """
    if number and number not in _UNITS:
        raise NoDrawingError(f"has $INSUNITS {number}, which is no unit of a DXF file")
    units, scale = _UNITS.get(number, ("", math.nan))
    unit = scale if number else 1.0
    # Without units the chords are short enough for inches.
    return Fineness(scale, units, _SAGITTA / (scale if number else MM_PER_INCH), _GAP / unit, _FARTHEST / unit)


def points_of(entity: Any, fineness: Fineness) -> Iterator[complex]:
    """
    The points of a curve, without those that repeat the point before: one at most of a curve without length. Raises
    NoDrawingError for points too far from the origin.
    """
    last = complex(math.inf)
    for point in _vertices(entity, fineness):
        position = complex(point[0], point[1])
        if not abs(position) <= fineness.farthest:
            raise fineness.too_far()
        if abs(position - last) > fineness.least:
            yield position
            last = position


def is_flat(entity: Any, fineness: Fineness) -> bool:
    """An ellipse one of whose axes has no length; ezdxf cannot flatten it."""
    if entity.dxftype() != "ELLIPSE":
        return False
    major = math.hypot(*entity.dxf.major_axis)
    return bool(min(major, major * abs(entity.dxf.ratio)) <= fineness.least)


def drop_frame(polyline: Any) -> None:
    """Remove the control points of a spline from a POLYLINE that holds the points of the curve as well."""
    if polyline.dxftype() == "POLYLINE":
        polyline.vertices[:] = [vertex for vertex in polyline.vertices if not vertex.dxf.flags & _OF_FRAME]


def _vertices(entity: Any, fineness: Fineness) -> Iterable[Any]:
    kind = entity.dxftype()
    if kind == "LINE":
        return entity.dxf.start, entity.dxf.end
    if kind in ("ARC", "CIRCLE"):
        radius = abs(entity.dxf.radius)
        if radius > _FLATTEST * fineness.farthest:
            raise fineness.too_far()
        sweep = (entity.dxf.end_angle - entity.dxf.start_angle) % 360 or 360 if kind == "ARC" else 360
        count = chord_count(math.radians(sweep), radius, fineness.sagitta) if radius else 0
        if count > MOST_POINTS:
            raise fineness.too_far()
        if not radius:
            return ()
        first = entity.dxf.start_angle if kind == "ARC" else 0
        return entity.vertices(first + sweep * number / count for number in range(count + 1))  # type: ignore[no-any-return]
    corners = (
        [entity.dxf.center, entity.dxf.major_axis]
        if kind == "ELLIPSE"
        else [*entity.control_points, *entity.fit_points]
    )
    if not all(abs(coordinate) <= fineness.farthest for corner in corners for coordinate in list(corner)[:2]):
        raise fineness.too_far()
    return _ellipse(entity, fineness) if kind == "ELLIPSE" else _spline(entity, fineness)


def _ellipse(entity: Any, fineness: Fineness) -> Iterable[Any]:
    """The points of an ellipse or a part of it; one that ends at the parameter where it begins is whole."""
    start, end = entity.dxf.start_param, entity.dxf.end_param
    if abs(math.remainder(end - start, math.tau)) > _SAME_PARAMETER:
        return entity.flattening(fineness.sagitta)  # type: ignore[no-any-return]
    whole = entity.construction_tool()
    whole.start_param, whole.end_param = 0.0, math.tau
    return whole.flattening(fineness.sagitta)  # type: ignore[no-any-return]


def _spline(entity: Any, fineness: Fineness) -> Iterable[Any]:
    """
    The points of a spline, which runs from knots[degree] to knots[count of control points]: only one that is clamped
    has no knots beyond these.
    """
    from ezdxf.math import BSpline

    class OnDomain(BSpline):
        """A spline whose knots are those of its domain: `flattening` runs over all of them."""

        def knots(self) -> Any:
            return super().knots()[self.degree : self.count + 1]

    poles = [complex(pole[0], pole[1]) for pole in entity.control_points or entity.fit_points]
    if all(abs(pole - poles[0]) <= fineness.least for pole in poles):
        return ()
    if not len(entity.control_points):
        # A curve cannot be fitted through one point twice in a row.
        fit = list(entity.fit_points)
        entity.fit_points = [
            point
            for number, (point, pole) in enumerate(zip(fit, poles, strict=True))
            if not number or abs(pole - poles[number - 1]) > fineness.least
        ]
    tool = entity.construction_tool()
    whole = OnDomain(tool.control_points, tool.order, tool.knots(), tool.weights() or None)
    return whole.flattening(fineness.sagitta)
