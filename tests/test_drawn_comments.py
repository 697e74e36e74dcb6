"""Drawn comments: plain forms of cutters, bars, shapes and depths are read, and look-alikes are not."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import pytest
from cases import looped

from polarcheck.columns.words.comment_reader import StatedShape, bar_in, depth_in, shapes_in
from polarcheck.columns.words.comments import named_tool
from polarcheck.columns.words.radius_comments import radius_in

COUNT = 60
CUTTERS = (
    "EM{0}",
    "EM {0}",
    "EM D{0}",
    "{0}MM EM",
    "D{0} EM",
    "CUTTER {0}",
    "CUTTER: {0}",
    "CUTTER DIA {0}",
    "{0}MM DIA. CUTTER",
    "{0} END MILL",
    "{0}MM ENDMILL",
    "END MILL {0}",
    "END MILL D{0}",
    "END MILL DIA={0}",
    "{0} 4FL CARBIDE END MILL",
    "FLAT END MILL {0}",
    "{0}MM SLOT DRILL",
    "D={0} CR=0. - ZMIN=-5. - FLAT END MILL",
    "FREZA={0}",
    "VHM FRAESER D{0}",
)
#: In front of a cutter, and behind it.
BEFORE = ("", "T5 ", "T0505 - ", "TOOL 3 ", "FINISH ", "#3 ")
BEHIND = ("", " 3 FLUTES", ", HEX 24 AF", " FOR 2 FLATS", " X 50 LONG", " R0.2")
NO_CUTTERS = (
    "BAR DIA {0}",
    "BORING BAR D{0}",
    "{0}MM BORING BAR",
    "DRILL D{0}",
    "{0}MM DRILL",
    "SPOT DRILL {0}",
    "REAMER {0}",
    "TAP M{0}",
    "TOOL {0} END MILL",
    "OP{0} END MILL",
    "STEP {0} CUTTER",
    "MILL {0} FLATS",
    "MILL HEX {0}",
    "MILL D{0} BOSS",
    "DIA {0} BOSS",
    "TURN DIA {0}",
    "CHUCK ON {0} DIA",
    "JAWS D{0}",
    "JAW PRESSURE: {0} BAR",
    "END MILL {0} FLUTES",
    "CUTTER {0} PLACES",
    "CHAMFER MILL {0}",
    "PART 204-104-3170-D{0}",
    "BORE {0} DIA",
    "CNMG D{0}",
    "DEPTH {0}",
    "FASE {0} EM RELACAO AO EIXO",
)
BARS = (
    "BAR DIA {0}",
    "BAR D{0}",
    "BAR: {0}MM",
    "BAR {0}",
    "ROUND BAR {0}",
    "STOCK D{0}",
    "STOCK DIA {0}",
    "STOCK OD {0}",
    "STOCK {0} DIA",
    "RD {0}",
    "MATERIAL: RD {0}",
    "{0}MM BAR",
    "{0} DIA BAR",
    "DIA {0} BAR",
    "BAR DIA {0} X 100",
    "HEX 8 AF FROM BAR DIA {0}",
)
HEX_BARS = ("HEX BAR {0}", "{0} HEX BAR", "HEX {0} BAR", "STOCK HEX {0} AF", "BAR HEX {0}", "HEXAGON BAR {0}MM")
NO_BARS = (
    "{0} BAR",
    "COOLANT {0} BAR",
    "JAW PRESSURE {0} BAR",
    "BORING BAR {0}",
    "{0}MM BORING BAR",
    "BAR PULLER D{0}",
    "BAR {0} LONG",
    "BAR {0} X 20",
    "SQ BAR {0}",
    "STOCK {0}",
    "LEAVE STOCK D{0}",
    "T5 BAR D{0}",
    "CHUCK ON {0} DIA",
    "TUBE STOCK OD {0}",
    "STOCK OD {0} ID 5",
    "HEX {0} AF",
    "EM{0}",
    "3RD {0}",
    "BARCODE {0}",
)
SHAPES = (
    ("HEX {0} AF", "hexagon"),
    ("{0} AF HEX", "hexagon"),
    ("HEX {0}", "hexagon"),
    ("HEXAGON {0} ACROSS FLATS", "hexagon"),
    ("MILL HEX {0}MM", "hexagon"),
    ("SQ {0}", "square"),
    ("SQUARE {0} AF", "square"),
    ("OCTAGON {0} A/F", "octagon"),
    ("FLATS {0}", "flats"),
    ("2 FLATS {0} AF", "flats"),
    ("DIA {0} BOSS", "boss"),
    ("BOSS D{0}", "boss"),
    ("AF {0}", ""),
    ("SW {0}", ""),
    ("{0} ACROSS FLATS", ""),
)
SHAPES_BESIDE = ("", ", EM10", ", DEPTH 5", " 5 DEEP", ", CUTTER 8")
NO_SHAPES = (
    "HEX BAR {0}",
    "HEX {0} BAR",
    "{0} FLATS",
    "FLATS {0} PLACES",
    "SQUARE {0} X 5",
    "HEX SOCKET {0}",
    "HEX KEY {0}",
    "ROUGH HEX {0}",
    "HEX M{0}",
    "HEX {0} DEEP",
    "HEX {0} SIDES",
    "OP{0} HEX",
    "DONE: HEX {0} AF",
    "HEX {0} AF OR SQ 9",
    "HEX 9 AF, SQ {0}",
    "SWITCH {0}",
    "AFTER {0}",
    "BOSS {0}",
)
NO_DEPTHS = (
    "DEPTH OF CUT {0}",
    "CUT DEPTH {0}",
    "DEPTH {0} PER PASS",
    "DRILL {0} DEEP",
    "HOLE {0} DEEP",
    "CHUCK ON 50 X {0} DEEP",
    "KEYWAY 8 WIDE {0} DEEP",
    "FLAT {0} DEEP",
    "THREAD DEPTH {0}",
    "ROUGH DEPTH {0}",
    "DEEPER {0}",
)


def shape_in(comment: str, in_inch: bool) -> StatedShape | None:
    """The one shape that a comment states."""
    shapes = shapes_in(comment, in_inch)
    return shapes[0] if len(shapes) == 1 else None


def draw(seed: int) -> tuple[random.Random, str, float]:
    """A generator, and a size in mm as it is written and as a number; no sixteenth of an inch, and never above 60."""
    generator = random.Random(seed)  # noqa: S311
    value = generator.choice([generator.randint(4, 60), generator.randint(40, 600) / 10, generator.randint(12, 60) / 2])
    written = f"{value:g}"
    return generator, generator.choice([written, f"{written}." if "." not in written else written]), float(value)


@pytest.mark.ci
@looped("seed", range(COUNT))
def test_cutters_are_read(seed: int) -> None:
    generator, written, value = draw(seed)
    for form in CUTTERS:
        before, behind = generator.choice(BEFORE), generator.choice(BEHIND)
        comment = f"{before}{form.format(written)}{behind}"
        radius = radius_in(comment, inch=False)
        # Two numbers beside a name are no plain words: then nothing is read, and never another size.
        assert radius is None or radius == pytest.approx(value / 2), comment
        assert radius_in(form.format(written), inch=False) == pytest.approx(value / 2), form


def not_read(read: Callable[[str, bool], object], forms: tuple[str, ...], written: str) -> None:
    for form in forms:
        for comment in (form.format(written), f"T5 {form.format(written)}", form.format(written).lower()):
            assert read(comment, False) is None, comment


@pytest.mark.ci
@looped("seed", range(COUNT), one_in=3)
def test_look_alikes_are_not_read(seed: int) -> None:
    _, written, _ = draw(seed)
    not_read(radius_in, NO_CUTTERS, written)
    not_read(bar_in, NO_BARS, written)
    not_read(shape_in, NO_SHAPES, written)
    not_read(depth_in, NO_DEPTHS, written)


@looped("seed", range(COUNT))
def test_bars_are_read(seed: int) -> None:
    _, written, value = draw(seed)
    for forms, name in ((BARS, "diameter"), (HEX_BARS, "across_flats")):
        for form in forms:
            bar = bar_in(form.format(written), False)
            assert bar is not None, form
            assert getattr(bar, name) == pytest.approx(value), form


@looped("seed", range(COUNT))
def test_shapes_and_depths_are_read(seed: int) -> None:
    generator, written, value = draw(seed)
    for form, shape in SHAPES:
        comment = form.format(written) + generator.choice(SHAPES_BESIDE)
        size = shape_in(comment, False)
        assert size is not None, comment
        assert (size.shape, size.size) == (shape, pytest.approx(value)), comment
        assert size.is_across_flats == bool(re.search("A.?F|ACROSS|SW", form)), comment
    for form in ("DEPTH {0}", "{0} DEEP", "DEPTH={0}MM", "HEX 24 AF, {0} DEEP", "POCKET {0}MM DEEP"):
        assert depth_in(form.format(written), False) == pytest.approx(value), form


@looped("seed", range(COUNT))
def test_sizes_in_inch(seed: int) -> None:
    generator = random.Random(seed)  # noqa: S311
    below = generator.choice((4, 8, 16, 32))
    above, whole = generator.randrange(1, below, 2), generator.choice(("", "1-", "1 "))
    size = ((1 if whole else 0) + above / below) * 25.4
    written = f"{whole}{above}/{below}"
    unit = generator.choice(("", '"', " INCH"))
    for form in ("{0} END MILL", "END MILL {0}", "{0} DIA. CUTTER", "D{0} EM"):
        if size < 60:
            assert radius_in(form.format(written + unit), inch=generator.random() < 0.5) == pytest.approx(size / 2), (
                form
            )
    if size > 3:
        bar = bar_in(f"BAR DIA {written}{unit}", in_inch=True)
        assert bar is not None
        assert bar.diameter == pytest.approx(size)
        hexagon = shape_in(f"HEX {written}{unit} AF", in_inch=True)
        assert hexagon == StatedShape("hexagon", pytest.approx(size), True)
    assert bar_in(f"{size / 25.4:.4f} BAR", in_inch=True) is not None or size < 3


@looped("seed", range(COUNT))
def test_random_text_costs_no_answer_twice(seed: int) -> None:
    """What is read of a text is the same in lower case, in parentheses, and behind blanks."""
    generator = random.Random(seed)  # noqa: S311
    pieces = (
        "HEX",
        "BAR",
        "EM",
        "D",
        "DIA",
        "12",
        "3/4",
        ".5",
        "AF",
        "T5",
        "MILL",
        "END",
        "-",
        "=",
        ",",
        "DEEP",
        "R",
        '"',
    )
    comment = " ".join(generator.choice(pieces) for _ in range(generator.randint(1, 7)))
    for read in (radius_in, bar_in, shape_in, depth_in):
        expected = repr(read(comment, False))
        assert repr(read(f"( {comment.lower()} )", False)) == expected, (read, comment)
    assert named_tool(comment) in (None, 5)
