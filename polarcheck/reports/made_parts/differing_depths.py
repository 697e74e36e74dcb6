"""Depths of one section that make different shapes of one contour: by how much, and where."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec
import numpy as np

from polarcheck.foundation.finding import MadeShape
from polarcheck.geometry.shapes.shape import SAME
from polarcheck.parts.depth_areas import farthest, in_common
from polarcheck.rules.wording.part import Sizes

#: Passes of one contour have at least this share of their outline in common.
_IN_COMMON = 0.25


class Area(msgspec.Struct, frozen=True):
    """The area that stands at one depth, or that is cleared there: its Z [mm], and the polygon (shapely, mm)."""

    z: float
    polygon: Any
    is_cleared: bool = False


def with_differences(entries: Sequence[MadeShape], areas: Sequence[Area], sizes: Sizes) -> Iterator[MadeShape]:
    """
    The entries of a section; where passes of one contour differ, the first entry of a depth says by how much.

    They are compared with what most depths make, or else the deepest one.
    """
    by_z = {round(area.z, 6): area for area in areas if not np.isnan(area.z)}
    groups = dict.fromkeys(tuple(entry.depths) for entry in entries if entry.depths and min(entry.depths) in by_z)
    usual = max(groups, key=lambda depths: (len(depths), -min(depths)), default=())
    names = {depths: {entry.shape for entry in entries if tuple(entry.depths) == depths} for depths in groups}
    seen = {usual}
    for entry in entries:
        depths = tuple(entry.depths)
        text = ""
        if depths in groups and depths not in seen:
            seen.add(depths)
            compared, usual_area = by_z[min(depths)], by_z[min(usual)]
            is_pass = names[depths] == names[usual] or in_common(compared.polygon, usual_area.polygon) >= _IN_COMMON
            if compared.is_cleared == usual_area.is_cleared and is_pass:
                text = _in_words(compared, usual_area, sizes)
        yield msgspec.structs.replace(entry, text=f"{entry.text}; {text}") if text else entry


def _in_words(area: Area, usual: Area, sizes: Sizes) -> str:
    """`cuts up to 8.660 deeper than at Z-6.000, at x 0.000 c -17.321`."""
    text = []
    more, less = (area, usual) if area.is_cleared else (usual, area)
    for said, (size, point) in (
        ("cuts up to {} deeper", farthest(more.polygon, less.polygon)),
        ("leaves up to {} more", farthest(less.polygon, more.polygon)),
    ):
        if size > 2 * SAME:
            where = f"at x {sizes(point.real)} c {sizes(point.imag)}"
            text.append(f"{said.format(sizes(size))} than at Z{sizes(usual.z)}, {where}")
    return " and ".join(text)
