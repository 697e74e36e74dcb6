"""Polygons: regular ones, those that are nearly so, rectangles, crosses, and others; lengths in mm."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, median
from polarcheck.geometry.shapes.corners import Sides, is_at, without_chamfers
from polarcheck.geometry.shapes.shape import SAME, SAME_DIRECTION, OddSide, Shape, off_axis, polygon_name, turned_by
from polarcheck.geometry.shapes.side_rings import Ring, extents_of

#: With more sides than this equal ones stand for a circle.
_MOST_SIDES = 12
#: A side that differs by no more than this share of the size was meant to be as most others are; and where no most
#: agree, sides that differ by no more than this [mm].
_NEARLY, _NEARLY_ALL = 0.03, 0.1
#: How much less than regular along X what becomes regular by doubling or halving its X is.
_MIXED = (2.0, 0.5)
#: Greatest distance of a corner from its place in a regular polygon, for rounded words [mm].
_IN_PLACE = 0.02


class _Fit(msgspec.Struct, frozen=True):
    """A regular polygon laid through sides: its middle, the distance of its sides, the direction of the first [rad]."""

    center: complex
    distance: float
    first: float
    sizes: Floats
    good: Mask


def polygon_of(ring: Ring, sides: Sides) -> Shape | None:
    """The polygon of these sides; None where they bend inwards, unless words mix radius and diameter."""
    if not sides.is_convex:
        uneven = _uneven(ring, sides) if len(sides) >= 5 else None
        return uneven if uneven and "regular_by_x" in uneven.values else None
    plain = _regular(ring, sides)
    if plain is not None and plain.is_regular:
        return plain
    cut = without_chamfers(sides)
    shape = cut and (_regular(ring, cut) or _rectangle(ring, cut))
    return shape or plain or _rectangle(ring, sides) or _uneven(ring, sides)


def circle_of_chords(ring: Ring, sides: Sides) -> Shape | None:
    """A circle of many equal chords."""
    if len(sides) <= _MOST_SIDES or not sides.is_convex or sides.radius.any():
        return None
    corners = sides.start
    lines = np.column_stack((corners.real, corners.imag, np.ones(len(corners))))
    x, c, rest = np.linalg.lstsq(lines, np.abs(corners) ** 2, rcond=None)[0]
    center = complex(x, c) / 2
    radius = float(np.sqrt(rest + abs(center) ** 2))
    if np.abs(np.abs(corners - center) - radius).max() > SAME:
        return None
    values = {"diameter": 2 * radius, "chords": float(len(sides)), **off_axis(center)}
    return Shape("circle", ring.inside, values, row=int(sides.row[0]))


# ---- regular ones ----


def _regular(ring: Ring, sides: Sides) -> Shape | None:
    """A regular polygon, or one of which few sides differ, or all by little."""
    count = len(sides)
    if count > _MOST_SIDES:
        return None
    fit = _fitted(sides)
    if fit is None:
        return None
    turned = turned_by(np.exp(1j * fit.first), count)
    values = {"across_flats": 2 * fit.distance, "sides": float(count), "turned": turned}
    odd = tuple(OddSide(int(sides.row[index]), 2 * float(fit.sizes[index])) for index in np.flatnonzero(~fit.good))
    if odd and np.count_nonzero(fit.good) <= count / 2:
        values |= {"least": 2 * float(fit.sizes.min()), "most": 2 * float(fit.sizes.max())}
        odd = ()
    values |= {**sides.corner_values(turned), **off_axis(fit.center)}
    regular = not odd and "least" not in values
    return Shape(polygon_name(count), ring.inside, values, odd, int(sides.row[0]), regular)


def _fitted(sides: Sides) -> _Fit | None:
    """The regular polygon of which most sides are, or to which all come near."""
    count = len(sides)
    angles = np.unwrap(np.angle(sides.normal))
    first = angles - 2 * np.pi * np.arange(count) / count
    length = np.abs(sides.end - sides.start)
    if np.ptp(first) > max(0.03, float(4 * SAME / length.min())):
        return None
    best = None
    middle = median(first)
    everything = np.ones(count, bool)
    attempts = [(everything, False), (everything, True)]
    if count > 4:
        attempts += [(np.arange(count) != left_out, False) for left_out in range(count)]
    for chosen, on_axis in attempts:
        fit = _laid(sides, middle, chosen, on_axis)
        again = fit.good & chosen
        if again.sum() >= 2:
            fit = _laid(sides, float(np.average(first[again], weights=length[again])), again, on_axis)
        if best is None or np.count_nonzero(fit.good) > np.count_nonzero(best.good):
            best = fit
        if best.good.all():
            break
    assert best is not None
    most = np.count_nonzero(best.good) > count / 2
    slack = _NEARLY * best.distance if most else _NEARLY_ALL
    # Two sides each of four are those of a rectangle.
    is_near = np.abs(best.sizes - best.distance).max() <= slack and (most or count > 4)
    return best if best.good.all() or is_near else None


def _laid(sides: Sides, first: float, chosen: Mask, on_axis: bool) -> _Fit:
    """The polygon through the middles of the chosen sides, its sides in these directions."""
    count = len(sides)
    normal: Points = np.exp(1j * (first + 2 * np.pi * np.arange(count) / count))
    out = (sides.middle * normal.conj()).real
    if on_axis:
        center, distance = 0j, median(out[chosen])
        agree = chosen & is_at(out, distance)
        distance = float(out[agree].mean()) if agree.any() else distance
    else:
        lines = np.column_stack((normal.real, normal.imag, np.ones(count)))[chosen]
        x, c, distance = np.linalg.lstsq(lines, out[chosen], rcond=None)[0]
        center = complex(x, c)
        if abs(center) <= SAME:
            center, distance = 0j, float(out[chosen].mean())
    ends = np.stack([((point - center) * normal.conj()).real for point in (sides.start, sides.end)])
    off = np.abs(ends - distance)
    sizes = np.where(off[0] >= off[1], ends[0], ends[1])
    # The middle says how far out a side is that lies as it should.
    straight = np.abs(ends[0] - ends[1]) <= 2 * SAME
    sizes = np.where(straight, ends.mean(axis=0), sizes)
    return _Fit(center, float(distance), first, sizes, np.asarray(off.max(axis=0) <= SAME))


# ---- others ----


def _rectangle(ring: Ring, sides: Sides) -> Shape | None:
    """Four sides at right angles."""
    length = np.abs(sides.end - sides.start)
    slack = max(SAME_DIRECTION, float(2 * SAME / length.min()))
    if len(sides) != 4 or np.abs(sides.turn - np.pi / 2).max() > slack:
        return None
    normal = sides.normal
    out = (sides.middle * normal.conj()).real
    across = out + np.roll(out, -2)
    long = int(across[0] < across[1])
    along = np.exp(1j * np.angle(normal[long]))
    center = along * complex((out[long] - out[long + 2]) / 2, (out[long + 1] - out[long - 1]) / 2)
    turned = turned_by(along, 2)
    values = {"width": float(across[1 - long]), "length": float(across[long]), "turned": turned}
    values |= {**sides.corner_values(turned), **off_axis(center)}
    return Shape("rectangle", ring.inside, values, row=int(sides.row[0]))


def _uneven(ring: Ring, sides: Sides) -> Shape | None:
    """A convex polygon that is not regular, with the least and the largest of the distances between its sides."""
    count = len(sides)
    if count > _MOST_SIDES:
        return None
    values = {"sides": float(count), **sides.corner_values()}
    normal = sides.normal
    half = count // 2
    opposite = np.abs(np.angle(-normal * np.roll(normal, -half).conj())) if count % 2 == 0 else np.ones(count)
    if (opposite < 10 * SAME_DIRECTION).all():
        out = (sides.middle * normal.conj()).real
        across = (out + np.roll(out, -half))[:half]
        values |= {"least": float(across.min()), "most": float(across.max())}
    mixed, rows = _mixed(sides)
    values |= {**extents_of(ring), "area": ring.area, **mixed}
    name = polygon_name(count) if count > 4 and mixed else "polygon"
    return Shape(name, ring.inside, values, (), int(sides.row[0]), False, mixed=rows)


def _mixed(sides: Sides) -> tuple[dict[str, float], tuple[int, ...]]:
    """
    What X has to be taken by to make a regular polygon of it, where words mix radius and diameter: that of all words,
    or of some; then the rows of the blocks that end there, too.
    """
    for share in _MIXED:
        fit = _fitted(_with_x(sides, np.full(len(sides), share)))
        if fit is not None and fit.good.all():
            return {"regular_by_x": share, "across_flats": 2 * fit.distance}, ()
    if sides.radius.any() or sides.chamfer.any():
        return {}, ()
    for share in _MIXED:
        for taken in _where_regular(sides.end, share):
            fit = _fitted(_with_x(sides, np.where(taken, share, 1.0)))
            if fit is not None and fit.good.all():
                return {"regular_by_x": share, "across_flats": 2 * fit.distance}, tuple(sides.row[taken].tolist())
    return {}, ()


def _with_x(sides: Sides, share: Floats) -> Sides:
    """The sides with X of the corner behind each so many times as large."""
    end = _points_of(sides.end.real * share, sides.end.imag)
    before = np.roll(share, 1)
    return Sides(_points_of(sides.start.real * before, sides.start.imag), end, sides.row, sides.radius, sides.chamfer)


def _where_regular(corner: Points, share: float) -> list[Mask]:
    """
    Masks of corners, not all of them, whose X times `share` makes the polygon regular about the center; the fewest
    first.
    """
    count = len(corner)
    scaled = _points_of(corner.real * share, corner.imag)
    turn = np.exp(2j * np.pi * np.arange(count) / count)
    # Whichever corner is right as it is, or with its X otherwise, tells where all the others are.
    regular = (
        np.concatenate([corner, scaled])[:, None]
        * turn[(np.arange(count) - np.arange(count)[:, None]) % count][np.tile(np.arange(count), 2)]
    )
    as_written = np.abs(corner - regular) <= _IN_PLACE
    fits = (as_written | (np.abs(scaled - regular) <= _IN_PLACE)).all(axis=1) & as_written.any(axis=1)
    masks = [~row for row in as_written[fits] if not row.all()]
    return sorted(masks, key=lambda taken: int(taken.sum()))


def _points_of(x: Floats, c: Floats) -> Points:
    """Points of these coordinates."""
    return np.asarray(x + 1j * c)


def cross_of(ring: Ring, sides: Sides) -> Shape | None:
    """A plus: two arms at right angles, as wide as each other or not."""
    if len(sides) != 12 or sides.radius.any():
        return None
    length = np.abs(sides.end - sides.start)
    slack = max(SAME_DIRECTION, float(2 * SAME / length.min()))
    right = np.abs(np.abs(sides.turn) - np.pi / 2).max() <= slack
    ends = np.flatnonzero((sides.turn > 0) & (np.roll(sides.turn, 1) > 0))
    if not right or len(ends) != 4 or (np.diff(ends) != 3).any():
        return None
    out = (sides.middle * sides.normal.conj()).real[ends]
    wide = length[ends]
    along = sides.normal[ends[0]]
    across = out[:2] + out[2:]
    if np.ptp(wide[::2]) > SAME or np.ptp(wide[1::2]) > SAME:
        return None
    center = along * complex((out[0] - out[2]) / 2, (out[1] - out[3]) / 2)
    long = int(across[0] < across[1])
    values = {"length": float(across[long]), "width": float(wide[long::2].mean())}
    values |= {"other_length": float(across[1 - long]), "other_width": float(wide[1 - long :: 2].mean())}
    values |= {"turned": turned_by(along * 1j**long, 2), **off_axis(center)}
    return Shape("cross", ring.inside, values, row=int(sides.row[0]))
