"""What a program makes, in the words and numbers of a drawing."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec

from polarcheck.foundation.errors import enumerated
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.geometry.shapes.shape import SAME, Shape


class Sizes(msgspec.Struct, frozen=True):
    """How lengths are shown: in inch, with four digits behind the point, or in mm with three."""

    inch: bool

    def __call__(self, value: float) -> str:
        """A length [mm]."""
        shown = round(value / MM_PER_INCH, 4) if self.inch else round(value, 3)
        # A rounded -0.0 would show as -0.000.
        return f"{shown + 0.0:.{4 if self.inch else 3}f}"

    def area(self, value: float) -> str:
        """An area [mm2]."""
        return f"{value / MM_PER_INCH**2:.4f} inch2" if self.inch else f"{value:.1f} mm2"


class Manner(msgspec.Struct, frozen=True):
    """
    How a shape is told.

    short: without areas, inside radii and distances from the axis.
    from_c0: angles and places count from C0 of the part, else from C at the begin of the section, which is not known.
    switch: the code that begins the section.
    """

    short: bool = False
    from_c0: bool = True
    switch: str = "G12.1"


_PLAIN = Manner()


def shape_in_words(shape: Shape, line_of: Callable[[int], int], sizes: Sizes, how: Manner = _PLAIN) -> str:
    """
    A shape as a note on a drawing: `hexagon, 27.000 across flats, corners R0.500, turned by 30 deg`.

    line_of: the line of a row of the program.
    """
    value = shape.values
    words = _TOLD.get(shape.name)
    told = words(shape, sizes) if words else _polygon(shape, line_of, sizes)
    told += _corners(value, sizes)
    if shape.name != "circle" and "turned" in value and (how.from_c0 or not how.short):
        told += _turned(shape)
    places = _off_axis(value, shape, sizes, how.short)
    if (
        shape.name in ("contour", "polygon", "groove")
        or "regular_by_x" in value
        or ("x_least" in value and not shape.is_regular)
    ):
        places += _extents(value, sizes, how.short)
    told += places
    if shape.is_open and shape.name == "contour":
        told.append("open: beyond its ends the part is not known")
    if not how.from_c0 and (places if how.short else _has_direction(shape)):
        from_c = f"from C at {how.switch}, which is not known"
        is_turned = bool(value.get("turned")) and told[-1].startswith("turned")
        told = [*told[:-1], f"{told[-1]} {from_c}"] if is_turned else [*told, f"C at {how.switch} is not known"]
    text = ", ".join(told)
    if "stands_inside" in value:
        return f"cleared round it: {text}"
    return f"pocket: {text}" if shape.inside and not shape.is_open and shape.name != "groove" else text


def _has_direction(shape: Shape) -> bool:
    """It is not the same however the part is turned."""
    return shape.name != "circle" or "center_x" in shape.values


def angle_in_words(angle: float) -> str:
    """C as a word: C22.5, C120."""
    return f"C{round(angle, 3) + 0.0:g}"


_Told = list[str]


def _circle(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    chords = [f"in {value['chords']:.0f} straight lines"] if "chords" in value else []
    return [f"circle {sizes(value['diameter'])}", *chords]


def _polygon(shape: Shape, line_of: Callable[[int], int], sizes: Sizes) -> _Told:
    value = shape.values
    if "across_flats" not in value or "regular_by_x" in value:
        return _uneven(shape, line_of, sizes)
    count, across = int(value["sides"]), value["across_flats"]
    told = [shape.name, f"{sizes(across)} across flats"]
    if shape.odd:
        told = [f"{count} flats", f"{count - len(shape.odd)} at {sizes(across / 2)}"]
        told += [f"one at {sizes(odd.size / 2)} (line {line_of(odd.row)})" for odd in shape.odd]
    elif "least" in value:
        told = [f"{shape.name}, not quite regular", f"{sizes(value['least'])} to {sizes(value['most'])} across flats"]
    if count % 2 and not shape.odd:
        told.append("sizes are twice the distance of a side from the middle")
    if "corner_diameter" in value:
        told.append(f"corners round at {sizes(value['corner_diameter'])}")
    return told


def _uneven(shape: Shape, line_of: Callable[[int], int], sizes: Sizes) -> _Told:
    value = shape.values
    told = [f"polygon with {value['sides']:.0f} sides"] if shape.name == "polygon" else [shape.name, "not regular"]
    if "least" in value:
        told.append(f"{sizes(value['least'])} to {sizes(value['most'])} across flats")
    if "regular_by_x" in value:
        how = "doubled" if value["regular_by_x"] > 1 else "halved"
        lines = [line_of(row) for row in shape.mixed]
        of_lines = f" of line{'s' if len(lines) > 1 else ''} {', '.join(map(str, lines))}" if lines else ""
        told.append(
            f"with X{of_lines} {how} it would be regular and {sizes(value['across_flats'])} across flats "
            "(words that mix radius and diameter)"
        )
    return told


def _rectangle(shape: Shape, sizes: Sizes) -> _Told:
    return [f"rectangle {sizes(shape.values['length'])} x {sizes(shape.values['width'])}"]


def _round_with_flats(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    count = int(value["flats"])
    told = [f"round {sizes(value['diameter'])} with {'one flat' if count == 1 else f'{count} flats'}"]
    if "apart" in value:
        told[0] += f" {sizes(value['apart'])} apart"
    middle = "center of the circle" if "center_x" in value else "center"
    if "turned_1" in value:
        return [*told, _each(value, middle, sizes)]
    if "distance" in value and "apart" not in value:
        told[0] += f", {_away(value['distance'], middle, sizes)}"
    return told


def _each(value: Mapping[str, float], middle: str, sizes: Sizes) -> str:
    """`12.000 at 0 deg and 14.000 at 90 deg from the center`: uneven flats one by one."""
    numbers = range(1, int(value["flats"]) + 1)
    angles = [_degrees(value[f"turned_{number}"]) for number in numbers]
    if "distance" in value:
        return f"{_away(value['distance'], middle, sizes)} at {enumerated(angles)} deg"
    distances = [value[f"distance_{number}"] for number in numbers]
    beyond = ["" if distance >= 0 else f" beyond the {middle}" for distance in distances]
    flats = [
        f"{sizes(abs(distance))}{far} at {angle} deg"
        for distance, far, angle in zip(distances, beyond, angles, strict=True)
    ]
    return f"{enumerated(flats)} from the {middle}"


def _flats(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    count = int(value["flats"])
    if "apart" in value:
        told = [f"flats {sizes(value['apart'])} apart"]
        told += [] if "distance" in value else [_each(value, "center", sizes)]
        return told + ([f"an arc R{sizes(value['joined'])} from one to the other"] if "joined" in value else [])
    if count == 1:
        return [f"flat {_away(value['distance'], 'center', sizes)}"]
    return [f"{count} flats", _each(value, "center", sizes)]


def _away(distance: float, middle: str, sizes: Sizes) -> str:
    """How far a flat or a bottom is from the middle; beyond it where the part does not reach that far."""
    return f"{sizes(abs(distance))} {'from' if distance >= 0 else 'beyond'} the {middle}"


def _slot(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    if "length" not in value:
        return [f"slot {sizes(value['width'])} wide", "open at both ends"]
    kind = "slot" if shape.inside else "oblong"
    return [f"{kind} {sizes(value['width'])} x {sizes(value['length'])}", f"ends R{sizes(value['radius'])}"]


def _keyway(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    end = f"round end R{sizes(value['radius'])}" if "radius" in value else "square end"
    bottom = f"its bottom {_away(value['distance'], 'center', sizes)}"
    return [f"keyway {sizes(value['width'])} wide", bottom, end]


def _round_with_keyway(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    count, is_key = int(value["keyways"]), (value["distance"] > value["diameter"] / 2) != shape.inside
    name, end = ("key", "top") if is_key else ("keyway", "bottom")
    which = f"a {name}" if count == 1 else f"{count} {name}s"
    middle = "center of the circle" if "center_x" in value else "center"
    its = f"{'its' if count == 1 else 'their'} {end} {_away(value['distance'], middle, sizes)}"
    told = [f"round {sizes(value['diameter'])} with {which} {sizes(value['width'])} wide", its]
    return told + ([f"round end R{sizes(value['radius'])}"] if "radius" in value else [])


def _cam(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    return [f"cam R{sizes(value['radius'])} and R{sizes(value['radius_small'])}", f"{sizes(value['apart'])} apart"]


def _cross(shape: Shape, sizes: Sizes) -> _Told:
    value = shape.values
    one = f"{sizes(value['length'])} x {sizes(value['width'])}"
    other = f"{sizes(value['other_length'])} x {sizes(value['other_width'])}"
    return [f"cross, arms {one}" if one == other else f"cross, arms {one} and {other}"]


def _contour(shape: Shape, sizes: Sizes) -> _Told:
    return ["contour"]


def _groove(shape: Shape, sizes: Sizes) -> _Told:
    return [f"groove {sizes(shape.values['width'])} wide"]


_TOLD: Mapping[str, Callable[[Shape, Sizes], _Told]] = {
    "circle": _circle,
    "rectangle": _rectangle,
    "round with flats": _round_with_flats,
    "flats": _flats,
    "slot": _slot,
    "keyway": _keyway,
    "round with keyway": _round_with_keyway,
    "cam": _cam,
    "cross": _cross,
    "groove": _groove,
    "contour": _contour,
}


def _corners(value: Mapping[str, float], sizes: Sizes) -> _Told:
    if "corners_round" in value:
        kinds = (
            ("corners_round", f"R{sizes(value['corner_radius'])}"),
            ("corners_chamfered", f"chamfered {sizes(value['corner_chamfer'])}"),
            ("corners_sharp", "sharp"),
        )
        (first, *more) = [f"{value[key]:.0f} {text}" for key, text in kinds if value[key]]
        number, _, text = first.partition(" ")
        return [", ".join([f"{number} corner{'s' * (number != '1')} {text}", *more])]
    for name, mark in (("corner_radius", "R"), ("corner_chamfer", "chamfered ")):
        if name not in value:
            continue
        if "corner_least" not in value:
            return [f"corners {mark}{sizes(value[name])}"]
        words = [f"{mark}{sizes(size)}" if size else "sharp" for size in (value["corner_least"], value[name])]
        each = [value[f"corner_{number}"] for number in range(1, int(value.get("sides", 4)) + 1) if "corner_1" in value]
        counts = [sum(abs(size - value[key]) <= 2 * SAME for size in each) for key in ("corner_least", name)]
        if each and sum(counts) == len(each):
            return [f"{counts[1]} corner{'s' * (counts[1] > 1)} {words[1]}, {counts[0]} {words[0]}"]
        return [f"corners from {words[0]} to {words[1]}"]
    return []


def _turned(shape: Shape) -> _Told:
    turned = _degrees(shape.values["turned"])
    return [f"turned by {turned} deg"] if turned != "0" and "turned_1" not in shape.values else []


def _degrees(angle: float) -> str:
    # Words with three digits turn a side of some millimetres by some thousandths of a degree.
    return f"{angle:.2f}".rstrip("0").rstrip(".")


def _off_axis(value: Mapping[str, float], shape: Shape, sizes: Sizes, short: bool) -> _Told:
    if "center_x" not in value:
        return []
    x, c = value["center_x"], value["center_c"]
    what = "its middle line" if shape.is_open else "center"
    if short:
        return [f"{what} at x {sizes(x)} c {sizes(c)}"]
    return [f"{what} {sizes(abs(complex(x, c)))} off the axis (x {sizes(x)}, c {sizes(c)})"]


def _extents(value: Mapping[str, float], sizes: Sizes, short: bool) -> _Told:
    told = []
    if "x_least" in value:
        told.append(f"x from {sizes(value['x_least'])} to {sizes(value['x_most'])}")
        told.append(f"c from {sizes(value['c_least'])} to {sizes(value['c_most'])}")
    if short:
        return told
    if value.get("inside_radius"):
        told.append(f"smallest inside radius {sizes(value['inside_radius'])}")
    elif "inside_radius" in value:
        told.append("inside corners sharp")
    if "area" in value:
        told.append(f"area {sizes.area(value['area'])}")
    return told
