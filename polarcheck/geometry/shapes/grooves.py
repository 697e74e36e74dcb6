"""What a cutter leaves whose center runs along a path: what stands inside a closed one, a slot along a straight one."""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Floats
from polarcheck.geometry.outline import Outline
from polarcheck.geometry.plane import arc_sweep
from polarcheck.geometry.shapes.shape import SAME, Shape, off_axis, turned_by
from polarcheck.geometry.shapes.shapes import shapes_of

#: The sizes of a shape that lose R on both sides, and those that lose it once, where a cutter runs round it.
_BOTH = ("diameter", "across_flats", "width", "length", "apart", "least", "most", "corner_diameter")
_ONCE = ("corner_radius", "radius", "radius_small", "distance", "corner_least")
#: A loop within another one that encloses at least this share of it is meant [share].
_MOST = 0.7
#: Shapes that stay what they are when all their sides move inwards.
_KEPT = ("circle", "rectangle", "round with flats", "slot")


def closed_part(path: Outline) -> Outline | None:
    """What of one way is a loop: from a point to where it comes back to it, without leads; None where it does not."""
    keys = np.round(np.concatenate([path.start, path.end]) / SAME)
    _, number = np.unique(keys, return_inverse=True)
    begins, ends = number[: len(path)], number[len(path) :]
    last = np.full(int(number.max(initial=-1)) + 1, -1)
    last[ends] = np.arange(len(path))
    count = last[begins] - np.arange(len(path)) + 1
    closes = np.flatnonzero(count > 0)
    if not len(closes):
        return None
    # Of loops that enclose the same, with leads or without, the shortest.
    until = np.append(0, np.cumsum(_areas(path)))
    area = np.abs(until[closes + count[closes]] - until[closes])
    large = closes[area >= _MOST * area.max()]
    first = int(large[np.argmin(count[large])])
    loop = path[np.arange(first, first + int(count[first]))]
    return Outline(loop.start, loop.end, loop.center, loop.kind, loop.row, loop.chain * 0, np.array([True]))


def _areas(path: Outline) -> Floats:
    """Of the moves of a loop, the sum is what it encloses [mm2]."""
    sweep = arc_sweep(path.start, path.end, path.center, path.kind)
    bows = np.where(path.is_arc, np.nan_to_num(path.radius) ** 2 * (sweep - np.sin(sweep)), 0.0)
    return np.asarray(((path.start.conj() * path.end).imag + bows) / 2)


def left_inside(loop: Outline, radius: float) -> Shape | None:
    """What stands inside a closed path of a cutter's center; None where nothing does, or nobody can say its sizes."""
    (shape,) = shapes_of(loop)
    shape = shape._replace(inside=False)
    values = dict(shape.values)
    if shape.odd or "corner_chamfer" in values or not (shape.name in _KEPT or "across_flats" in values):
        return None
    if not shape.is_regular:
        return None
    values |= {name: values[name] - 2 * radius for name in _BOTH if name in values and name != "apart"}
    values |= {name: max(values[name] - radius, 0.0) for name in _ONCE if name in values}
    if "apart" in values:
        values["apart"] -= 2 * radius
    values = {name: value for name, value in values.items() if name != "corner_radius" or value > SAME}
    values.pop("inside_corners", None)
    if min(values.get(name, np.inf) for name in _BOTH) <= SAME:
        return None
    return shape._replace(values=values)


def cleared(loop: Outline, radius: float) -> Shape | None:
    """The pocket that a closed path clears of which nothing stands inside, where it is round; else None."""
    (shape,) = shapes_of(loop)
    if shape.name != "circle":
        return None
    return shape._replace(inside=True, values={**shape.values, "diameter": shape.values["diameter"] + 2 * radius})


def slot_along(path: Outline, radius: float) -> Shape | None:
    """The slot that a straight path cuts; None for a bent one."""
    start, end = complex(path.start[0]), complex(path.end[-1])
    way = end - start
    if path.is_arc.any() or abs(way) <= SAME:
        return None
    aside = np.abs(((path.end - start) * np.conj(way / abs(way))).imag)
    if aside.max() > SAME:
        return None
    values = {"width": 2 * radius, "length": abs(way) + 2 * radius, "radius": radius}
    values |= {"turned": turned_by(way, 2), **off_axis((start + end) / 2)}
    return Shape("slot", True, values, row=int(path.row[0]))
