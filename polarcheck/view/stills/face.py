"""Draws the view onto the face: X to the right, C up, labels in the units of the program."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import FuncFormatter, MultipleLocator

from polarcheck.view.picture_data import Mark, Points, Role, SectionPicture
from polarcheck.view.stills.numbering import Entry, labels
from polarcheck.view.stills.palette import (
    ABOVE,
    BAR,
    BAR_EDGE,
    CENTER,
    DRAWING,
    INK,
    LEFT,
    PART,
    PART_EDGE,
    PLAIN,
    SEVERITIES,
    SHADES,
    UNKNOWN,
    coloring,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

#: The words for the moves of a role, in the order of the legend.
_NAMES: dict[Role, str] = {
    "cut": "path of the tool center",
    "corner": "path of the tool center",
    "positioning": "positioning",
    "start up": "start-up",
    "cancel": "offset cancel",
    "unknown": "path, cutter not known",
}
_DASHES: dict[str, tuple[float, ...]] = {
    "positioning": (4, 2.5),
    "start up": (5, 1.5, 1, 1.5),
    "cancel": (5, 1.5, 1, 1.5),
    "unknown": (1, 1.5),
}
#: The distance of two ticks is one of these times a power of ten.
_STEPS = (1, 2, 5, 10)
#: About so many ticks stand on an axis.
_TICKS = 8


class Window(NamedTuple):
    """
    What a picture shows.

    x0, c0, x1, c1: its edges [mm].
    scale: how many mm of the plane one mm of the picture is.
    """

    x0: float
    c0: float
    x1: float
    c1: float
    scale: float


def draw_face(axes: Axes, section: SectionPicture, window: Window, entries: Sequence[Entry], *, small: bool) -> None:
    """
    Draw a section.

    small: a detail, with labels on a few ticks and without directions.
    """
    axes.set_xlim(window.x0, window.x1)
    axes.set_ylim(window.c0, window.c1)
    axes.set_aspect("equal", adjustable="box")
    _set_ticks(axes, section, window, small=small)
    if section.bar:
        axes.add_patch(PathPatch(_area(section.bar), facecolor=BAR, edgecolor="none", zorder=1))
    for part in section.parts[-1:]:
        for polygon in part.polygons:
            edge = PART_EDGE if part.known_outside else "none"
            axes.add_patch(PathPatch(_area(polygon), facecolor=PART, edgecolor=edge, linewidth=0.6, zorder=2))
    _draw_surroundings(axes, section)
    for drawing in section.drawing:
        for line in (*([*ring, *ring[:1]] for ring in drawing.rings), *drawing.lines):
            axes.plot(*zip(*line, strict=True), color=DRAWING, linewidth=1.8, alpha=0.45, zorder=3)
    _draw_path(axes, section.programmed)
    _draw_tool(axes, section)
    for mark in section.marks:
        _draw_mark(axes, mark)
    if not small:
        _draw_ends(axes, section)
    _draw_labels(axes, window, entries, () if small else _ends(section))


def legend(section: SectionPicture) -> list[Artist]:
    """Return a sample of each thing that is drawn, for the legend."""
    samples: list[Artist] = []
    if any(part.polygons for part in section.parts[-1:]):
        samples.append(Patch(facecolor=PART, edgecolor=PART_EDGE, label="finished part"))
    if section.bar:
        samples.append(Patch(facecolor=BAR, label="bar"))
    elif section.stock is not None:
        samples.append(_sample("stock", color=BAR_EDGE, dashes=(4, 2)))
    if section.drawing:
        samples.append(_sample("part asked for", color=DRAWING, width=1.8, alpha=0.45))
    if any(x is not None for x in section.programmed.x):
        samples.append(_sample("programmed contour", width=0.7))
    usual = SHADES[4] if coloring(section).bounds else PLAIN
    drawn = {section.moves.role[move] for move in section.tool.move if move is not None}
    for role, name in _NAMES.items():
        if role in drawn and name not in [sample.get_label() for sample in samples]:
            width = 1.0 if role == "positioning" else 1.8
            color = UNKNOWN if role == "unknown" else usual
            samples.append(_sample(name, color=color, width=width, dashes=_DASHES.get(role, ())))
    for kind, color, hatch, label in (
        ("overcut", ABOVE, "/////", "cut too much"),
        ("left", LEFT, "\\\\\\\\\\", "left standing"),
    ):
        if any(mark.kind == kind for mark in section.marks):
            samples.append(Patch(facecolor="none", edgecolor=color, hatch=hatch, label=label))
    return samples


def _sample(
    label: str, *, color: str = INK, width: float = 1.0, dashes: Sequence[float] = (), alpha: float = 1
) -> Line2D:
    line = Line2D([], [], color=color, linewidth=width, alpha=alpha, label=label)
    if dashes:
        line.set_dashes(dashes)
    return line


# ---- axes ----


def _set_ticks(axes: Axes, section: SectionPicture, window: Window, *, small: bool) -> None:
    count = 3 if small else _TICKS
    for axis, factor, span in (
        (axes.xaxis, (2 if section.diameter else 1) / section.scale, window.x1 - window.x0),
        (axes.yaxis, 1 / section.scale, window.c1 - window.c0),
    ):
        step = _step(span * factor, count)
        digits = max(-int(np.floor(np.log10(step) + 1e-9)), 0)
        axis.set_major_locator(MultipleLocator(step / factor))
        axis.set_major_formatter(FuncFormatter(_formatter(factor, digits)))
    axes.tick_params(labelsize=6 if small else 7, width=0.5, length=2.5, pad=1.5)
    axes.grid(color="#e4e4e4", linewidth=0.5)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_linewidth(0.6)
    if not small:
        measured = "diameter" if section.diameter else "radius"
        axes.set_xlabel(f"X [{section.units}, {measured}]", fontsize=7.5, labelpad=2)
        axes.set_ylabel(f"C [{section.units}]", fontsize=7.5, labelpad=2)


def _formatter(factor: float, digits: int) -> Callable[[float, int | None], str]:
    def formatted(value: float, _: int | None = None) -> str:
        text = f"{value * factor:.{digits}f}"
        return text.removeprefix("-") if not float(text) else text

    return formatted


def _step(span: float, count: int) -> float:
    """Return a round distance of ticks, of which about `count` lie in a span."""
    requested = max(span, 1e-9) / count
    power = 10.0 ** np.floor(np.log10(requested))
    return float(min((step * power for step in _STEPS), key=lambda step: abs(np.log(step / requested))))


# ---- what is drawn ----


def _area(rings: Iterable[Sequence[tuple[float, float]]]) -> Path:
    """Return rings as one area; the outside runs counterclockwise and the holes run clockwise."""
    points: list[tuple[float, float]] = []
    codes: list[int] = []
    for index, ring in enumerate(rings):
        if len(ring) < 3:
            continue
        path = ring if (_turn(ring) > 0) == (index == 0) else ring[::-1]
        points += [*path, path[0]]
        codes += [int(Path.MOVETO), *[int(Path.LINETO)] * (len(path) - 1), int(Path.CLOSEPOLY)]
    return Path(points or np.zeros((0, 2)), codes or None)


def _turn(ring: Sequence[tuple[float, float]]) -> float:
    """Return twice the area, positive if the ring runs counterclockwise [mm2]."""
    corners = np.array([complex(*point) for point in ring])
    return float((corners.conj() * np.roll(corners, -1)).imag.sum())


def _draw_surroundings(axes: Axes, section: SectionPicture) -> None:
    if section.stock is not None:
        dashed = (0, (4, 2))
        axes.add_patch(
            Circle(
                (0, 0), section.stock / 2, fill=False, edgecolor=BAR_EDGE, linewidth=0.9, linestyle=dashed, zorder=2.5
            )
        )
    if section.keep_out is not None:
        axes.add_patch(Circle((0, 0), section.keep_out, facecolor=ABOVE, alpha=0.15, edgecolor=ABOVE, zorder=2.5))
    axes.plot([0, 1e6], [0, 0], color=CENTER, linewidth=0.6, dashes=(10, 2, 2, 2), zorder=2.6)
    axes.plot([0], [0], marker="+", markersize=9, markeredgewidth=0.9, color=INK, zorder=7)


def _draw_path(axes: Axes, path: Points) -> None:
    x, c = _column(path.x), _column(path.c)
    axes.plot(x, c, color=INK, linewidth=0.6, solid_joinstyle="round", zorder=4)


def _draw_tool(axes: Axes, section: SectionPicture) -> None:
    """Draw the path of the tool center, in one collection for each style and color."""
    groups: dict[tuple[str, str], list[list[tuple[float, float]]]] = {}
    for role, color, line in _stretches(section):
        groups.setdefault((role, color), []).append(line)
    for (role, color), lines in sorted(groups.items()):
        width = 2.2 if color == ABOVE else 1.0 if role == "positioning" else 1.6
        style = (0.0, tuple(length * 1.0 for length in _DASHES[role])) if role in _DASHES else "solid"
        collection = LineCollection(
            lines, colors=color, linewidths=width, linestyles=[style], capstyle="butt", joinstyle="round",
            zorder=5.5 if color == ABOVE else 5,
        )  # fmt: skip
        axes.add_collection(collection, autolim=False)


def _stretches(section: SectionPicture) -> Iterator[tuple[str, str, list[tuple[float, float]]]]:
    """Yield role, color and points of each stretch of the path that is drawn alike."""
    tool, moves = section.tool, section.moves
    colors = coloring(section).moves
    line: list[tuple[float, float]] = []
    style = ("", "")
    for index in range(1, len(tool.x)):
        x, c, move = tool.x[index], tool.c[index], tool.move[index]
        before_x, before_c = tool.x[index - 1], tool.c[index - 1]
        if x is None or c is None or move is None or before_x is None or before_c is None:
            continue
        now = "cut" if moves.role[move] == "corner" else moves.role[move], colors[move]
        if now != style or not line or line[-1] != (before_x, before_c):
            if line:
                yield (*style, line)
            style, line = now, [(before_x, before_c)]
        line.append((x, c))
    if line:
        yield (*style, line)


def _draw_mark(axes: Axes, mark: Mark) -> None:
    color, hatch = (ABOVE, "/////") if mark.kind == "overcut" else (LEFT, "\\\\\\\\\\")
    for ring in mark.rings:
        axes.add_patch(
            PathPatch(_area([ring]), facecolor="none", edgecolor=color, hatch=hatch, linewidth=0.7, zorder=6)
        )


def _ends(section: SectionPicture) -> list[tuple[float, float]]:
    """Return the first and the last point of the path; nothing if it is not known."""
    path = section.tool if section.tool.x else section.programmed
    points = [(x, c) for x, c in zip(path.x, path.c, strict=True) if x is not None and c is not None]
    return [points[0], points[-1]] if points else []


def _draw_ends(axes: Axes, section: SectionPicture) -> None:
    for point, (text, marker, down) in zip(_ends(section), (("start", "o", 4), ("end", "s", -9)), strict=False):
        axes.plot(*point, marker=marker, markersize=5, markerfacecolor="none", markeredgecolor=INK, zorder=7)
        axes.annotate(text, point, (4, down), textcoords="offset points", fontsize=7, color=INK, zorder=8)


def _draw_labels(axes: Axes, window: Window, entries: Sequence[Entry], ends: Sequence[tuple[float, float]]) -> None:
    """Draw a cross at each place of a finding, and its number beside it, away from the middle."""
    visible = [
        entry._replace(places=[point for point in entry.places if _is_within(point, window)]) for entry in entries
    ]
    middle = complex(window.x0 + window.x1, window.c0 + window.c1) / 2
    for (x, c), text, kind in labels(visible, 4.0 * window.scale):
        color = SEVERITIES.get(kind, LEFT)
        away = complex(x, c) - middle
        away = away / abs(away) if abs(away) > 2 * window.scale else complex(0.7, 0.7)
        if any(abs(complex(x, c) - complex(*end)) < 6 * window.scale for end in ends):
            away = complex(-0.7, 0.7)  # their words are on the right
        axes.plot([x], [c], marker="x", markersize=6, markeredgewidth=1.6, color=color, zorder=9)
        axes.annotate(
            text, (x, c), (13 * away.real, 13 * away.imag), textcoords="offset points", fontsize=7.5, color="white",
            fontweight="bold", ha="center", va="center", zorder=10,
            bbox={"boxstyle": "round,pad=0.25,rounding_size=0.5", "facecolor": color, "edgecolor": "white"},
            arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 2},
        )  # fmt: skip


def _is_within(point: tuple[float, float], window: Window) -> bool:
    return window.x0 <= point[0] <= window.x1 and window.c0 <= point[1] <= window.c1


def _column(values: Iterable[float | None]) -> list[float]:
    return [np.nan if value is None else value for value in values]
