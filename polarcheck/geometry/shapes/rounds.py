"""Shapes that are round or end round: circles, rounds with flats, slots, cams; lengths in mm."""

from __future__ import annotations

import numpy as np

from polarcheck.geometry.shapes.shape import SAME, SAME_DIRECTION, Shape, each_flat, off_axis, polygon_name, turned_by
from polarcheck.geometry.shapes.side_rings import Ring

#: How far a line may be from the circle that it touches [mm].
_TANGENT = 3 * SAME


def round_of(ring: Ring) -> Shape | None:
    """A circle, or one with flats; None for anything else."""
    arc = ~ring.is_line
    if not ring.closed or not arc.any() or (ring.sweep[arc] < 0).any():
        return None
    center = complex(np.average(ring.center[arc], weights=ring.length[arc]))
    radius = float(np.average(ring.radius[arc], weights=ring.length[arc]))
    off = np.abs(ring.center[arc] - center) + np.abs(ring.radius[arc] - radius)
    # Ends inside of the circle are those of a keyway, or of flats that cut each other off.
    ends = np.abs(np.concatenate([ring.start, ring.end]) - center) - radius
    if off.max() > 2 * SAME or np.abs(ends).max() > 3 * SAME:
        return None
    values = {"diameter": 2 * radius, **off_axis(center)}
    row = int(ring.row[0])
    if arc.all():
        whole = abs(float(ring.sweep.sum()) - 2 * np.pi) * radius < 2 * SAME
        return Shape("circle", ring.inside, values, row=row) if whole else None
    return _with_flats(ring, center, values)


def _with_flats(ring: Ring, center: complex, values: dict[str, float]) -> Shape:
    flats = np.flatnonzero(ring.is_line)
    normal = ring.normal[flats]
    out = ((ring.start[flats] - center) * normal.conj()).real
    count = len(flats)
    even = np.abs(np.angle(normal * normal[0].conjugate() * np.exp(-2j * np.pi * np.arange(count) / count)))
    slack = max(SAME_DIRECTION, float(2 * SAME / ring.length[flats].min()))
    equal = bool(np.ptp(out) <= 2 * SAME and even.max() <= slack)
    row = int(ring.row[flats[0]])
    values = {**values, "flats": float(count), "turned": turned_by(normal[0], count if equal else 1)}
    if count > 2 and equal:
        corners = values.pop("diameter")
        values |= {"across_flats": 2 * float(out.mean()), "corner_diameter": corners, "sides": float(count)}
        return Shape(polygon_name(count), ring.inside, values, row=row)
    if count == 2 and even.max() <= slack:
        values["apart"] = float(out.sum())
    if np.ptp(out) <= 2 * SAME:
        values["distance"] = float(out.mean())
    else:
        values |= {"least": float(out.min()), "most": float(out.max())}
    if not equal:
        values |= each_flat(normal, out)
    return Shape("round with flats", ring.inside, values, row=row)


def two_rounds_of(ring: Ring) -> Shape | None:
    """A slot with round ends, or a cam: two circles and the lines that touch both."""
    arcs = np.flatnonzero(~ring.is_line)
    if not ring.closed or len(ring) != 4 or len(arcs) != 2 or arcs[1] - arcs[0] != 2 or (ring.sweep[arcs] < 0).any():
        return None
    lines = np.flatnonzero(ring.is_line)
    for line in lines.tolist():
        for arc in arcs.tolist():
            within = ((ring.start[line] - ring.center[arc]) * ring.normal[line].conjugate()).real
            if abs(within - ring.radius[arc]) > _TANGENT:
                return None
    head, tail = (complex(ring.center[arc]) for arc in arcs)
    radius = ring.radius[arcs]
    row = int(ring.row[lines[0]])
    if abs(radius[0] - radius[1]) <= 2 * SAME:
        out = ((ring.start[lines] + ring.end[lines]) / 2 * ring.normal[lines].conj()).real
        values = {"width": float(out.sum()), "length": abs(tail - head) + float(radius.sum())}
        values |= {"radius": float(radius.mean()), "turned": turned_by(tail - head, 2), **off_axis((head + tail) / 2)}
        return Shape("slot", ring.inside, values, row=row)
    if radius[0] < radius[1]:
        head, tail = tail, head
    values = {"radius": float(radius.max()), "radius_small": float(radius.min()), "apart": abs(tail - head)}
    values |= {"turned": turned_by(tail - head, 1), **off_axis(head)}
    return Shape("cam", ring.inside, values, row=row)
