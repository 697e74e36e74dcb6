"""What is told of paths without cutter compensation: sizes by construction, and what shapely widens by itself."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from polarcheck.errors import TooHardError
from programs import tables_of

from polarcheck.foundation.arrays import Points, Rows
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import arc_sweep
from polarcheck.geometry.polygons import cleared as geometry_of_paths
from polarcheck.geometry.polygons.cleared import cleared
from polarcheck.geometry.segments import Curves, Segments
from polarcheck.reports.made_parts.part_report import made_by

HEAD = "G21 G98 G40 T0808\nG0 X120. Z2. C0\nG12.1\n"
END = "\nG1 Z2.\nG13.1\nM30\n"


def texts(*paths: str, radius: float = 4, bar: float = 0) -> list[str]:
    """What is told of paths at Z-2; the first words of each go there in the air."""
    body = "".join(
        f"G1 Z2. F300\n{begin}\nZ-2.\n{rest}\n" for begin, _, rest in (path.partition("\n") for path in paths)
    )
    job = {"stock": {"diameter": bar}} if bar else {}
    return [one.text for one in made_by(tables_of(HEAD + body + END, "fanuc", f"8:radius={radius}", job=job))]


def round_path(sides: int, across: float, turned: float = 0.0) -> str:
    """A path round a regular polygon that stands across flats so far from each other, with R4 [mm]."""
    out = (across / 2 + 4) / math.cos(math.pi / sides)
    points = [cmath.rect(out, math.radians(turned) + 2 * math.pi * k / sides) for k in range(sides + 1)]
    return "\n".join(f"X{2 * at.real:.3f} C{at.imag:.3f}" for at in points)


SQUARE = "X20. C0\nC10.\nX-20.\nC-10.\nX20.\nC0"
CASES = {
    "a boss, its sides not as far out as each other": (
        ("X38. C0\nC10.\nX-38.\nC-10.\nX38.\nC0",),
        ["rectangle 30.000 x 12.000", "groove 8.000 wide, x from -23.000 to 23.000, c from -14.000 to 14.000, area "],
    ),
    "a hexagon": ((round_path(6, 27),), ["hexagon, 27.000 across flats, turned by 30 deg", "groove 8.000 wide, "]),
    "a bend": (
        ("X0 C0\nX40.\nC20.",),
        # Two slots of 8 x 28 have a quarter of a circle and a square of R in common, and three quarters round it.
        ["groove 8.000 wide, x from -4.000 to 24.000, c from -4.000 to 24.000, area 366.8 mm2"],
    ),
    "a slot": (("X0 C5.\nX40.",), ["pocket: slot 8.000 x 28.000, ends R4.000, center 11.180 off the axis"]),
    "a pocket cleared in two rounds": (
        (SQUARE, "X8. C0\nC4.\nX-8.\nC-4.\nX8.\nC0"),
        ["pocket: square, 28.000 across flats, corners R4.000"],
    ),
    "a round pocket": (("X6. C0\nG3 X6. C0 I-3. J0\nG1",), ["pocket: circle 14.000"]),
    "a pin in a round pocket": (
        ("X20. C0\nG3 X20. C0 I-10. J0\nG1", "X30. C0\nG3 X30. C0 I-15. J0\nG1"),
        ["circle 12.000", "pocket: circle 38.000"],
    ),
    "two slots that cross": (
        ("X-60. C0\nX60.", "X0 C-30.\nC30."),
        ["groove 8.000 wide, x from -34.000 to 34.000, c from -34.000 to 34.000, area "],
    ),
    "two slots apart": (
        ("X0 C10.\nX40.", "X0 C-10.\nX40."),
        [
            f"pocket: slot 8.000 x 28.000, ends R4.000, center 14.142 off the axis (x 10.000, c {c}.000)"
            for c in (10, -10)
        ],
    ),
}  # fmt: skip


@pytest.mark.nightly
@looped("name", CASES)
def test_what_is_told_of_paths(name: str) -> None:
    paths, expected = CASES[name]
    found = texts(*paths)
    assert len(found) == len(expected), found
    for text, begin in zip(found, expected, strict=True):
        assert text.startswith(begin), found
        assert text.endswith("; to Z-2.000")


def test_a_side_that_is_off_is_told() -> None:
    """Of the square path one side is 0.05 mm farther out, and so is the side of what stands."""
    found = texts(SQUARE.replace("C-10.", "C-10.05"))
    assert found[0].startswith("4 flats, 3 at 6.000, one at 6.050 (line "), found


def test_what_runs_out_of_the_bar_is_open() -> None:
    assert texts("X-60. C0\nX60.", bar=40) == ["slot 8.000 wide, open at both ends; to Z-2.000"]
    flats = texts("X39. C-30.\nC30.", "X-39. C30.\nC-30.", bar=40)
    assert flats == ["flats 31.000 apart; to Z-2.000"]


def test_the_way_in_the_air_and_a_ramp_clear_nothing() -> None:
    body = "G1 X90. C20. F300\nX40. C0 Z-2.\nX0" + END
    found = [one.text for one in made_by(tables_of(HEAD + body, "fanuc", "8:radius=4"))]
    place = "center 10.000 off the axis (x 10.000, c 0.000)"
    assert found == [f"pocket: slot 8.000 x 28.000, ends R4.000, {place}; to Z-2.000"]


def test_without_an_offset_it_is_said_how_one_is_called() -> None:
    text = HEAD.replace("T0808", "T0000") + "G1 X30. Z-2. F100\nX-30." + END
    (found,) = made_by(tables_of(text, "fanuc"))
    assert found.text == ("not known: the path is that of the tool, and R of T0000 is not known: call T0808 before it")


@pytest.mark.one_in(6)
@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(6))
def test_the_outline_lies_at_r_from_the_path(seed: int) -> None:
    """Random ways of lines and arcs: each point of each element, and the area, against a finer buffer of shapely."""
    random = np.random.default_rng(seed)
    count, radius = 12, 3.0
    points = np.round(random.uniform(-30, 30, count + 1) + 1j * random.uniform(-30, 30, count + 1), 3)
    start, end = points[:-1], points[1:]
    kind = random.choice([Motion.LINE, Motion.CW, Motion.CCW], count).astype(np.int16)
    aside = random.uniform(-1.5, 1.5, count)
    center = np.where(kind == Motion.LINE, np.nan, (start + end) / 2 + 1j * (end - start) * aside)
    path = Curves(start, end, center, kind, np.zeros(count, int), np.arange(count))
    dense = shapely.union_all([
        shapely.linestrings([(at.real, at.imag) for at in sampled(*one, 400)])
        for one in zip(start, end, center, kind, strict=True)
    ])  # fmt: skip
    found = cleared(path, radius)
    outline = found.outline
    assert outline.closed.all()
    on = np.concatenate(
        [sampled(*one, 9) for one in zip(outline.start, outline.end, outline.center, outline.kind, strict=True)]
    )
    off = np.abs(shapely.distance(dense, shapely.points(on.real, on.imag)) - radius)
    assert off.max() < 0.005
    within = np.diff(outline.chain) == 0
    assert np.abs(outline.end[:-1] - outline.start[1:])[within].max() < 1e-6
    # The elements enclose what is cleared, clockwise.
    sweep = arc_sweep(outline.start, outline.end, outline.center, outline.kind)
    bows = np.where(outline.is_arc, np.nan_to_num(outline.radius) ** 2 * (sweep - np.sin(sweep)), 0)
    area = -float(((outline.start.conj() * outline.end).imag + bows).sum()) / 2
    assert area == pytest.approx(dense.buffer(radius, quad_segs=256).area, rel=2e-4)


def sampled(start: complex, end: complex, center: complex, kind: int, count: int) -> np.ndarray:  # type: ignore[type-arg]
    """Points of a line or an arc."""
    share = np.linspace(0, 1, count)
    if kind == Motion.LINE:
        return start + share * (end - start)
    one = np.array([start]), np.array([end]), np.array([center]), np.array([kind])
    return center + (start - center) * np.exp(1j * float(arc_sweep(*one)[0]) * share)


def circles(count: int, growth: float = 0.0) -> Curves:
    """Half circles about the center, each round larger than the one before by so much [mm]."""
    radius = np.repeat(20 + growth * np.arange(count), 2)
    start = radius * np.tile([1 + 0j, -1 + 0j], count)
    kind = np.full(2 * count, Motion.CCW, np.int16)
    return Curves(start, -start, np.zeros(2 * count, complex), kind, np.zeros(2 * count, int), np.arange(2 * count))


def test_a_pass_that_is_run_again_is_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The look-up of the nearest chord took 33 s where a circle was run 6,000 times."""
    searched: list[int] = []
    nearest = geometry_of_paths._nearest

    def counted(chords: Segments, points: Points) -> Rows:
        searched.append(len(chords) * len(points))
        return nearest(chords, points)

    monkeypatch.setattr(geometry_of_paths, "_nearest", counted)
    for count in (1, 200):
        cleared(circles(count), 4.0)
    assert searched[0] == searched[1]


def test_a_path_of_too_many_chords_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(geometry_of_paths, "_MOST_CHORDS", 1000)
    assert not cleared(circles(1), 4.0).polygon.is_empty
    with pytest.raises(TooHardError, match=r"a path of \d+ chords at one Z is too long"):
        cleared(circles(10, 0.5), 4.0)
