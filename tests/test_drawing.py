"""Drawings as ezdxf writes them, read as the curves that they show."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from polarcheck.errors import JobError

from polarcheck.commands import main
from polarcheck.program.machines import drawing_file
from polarcheck.program.machines.chains import joined

Draw = Callable[[Any], object]


def written(path: Path, draw: Draw, version: str = "R2010", units: int | None = 4, form: str = "asc") -> Path:
    """A file with what is drawn in its model space."""
    document = ezdxf.new(version)
    if units is not None:
        document.header["$INSUNITS"] = units
    draw(document.modelspace())
    document.saveas(path, fmt=form)
    return path


def curves(path: Path) -> list[np.ndarray[Any, Any]]:
    return [np.array(curve) for curve in drawing_file.read_drawing(path, "part.dxf").curves]


def area(curve: np.ndarray[Any, Any]) -> float:
    """Within a closed curve."""
    assert curve[0] == curve[-1]
    return abs(float((curve[:-1].conj() * curve[1:]).imag.sum() / 2))


def d_shaft(space: Any) -> None:
    """A round of 30 with a flat 9 from the center, the arc as a bulge: four times the tangent of a quarter of it."""
    half = math.acos(9 / 15)
    ends = [complex(9, -12), complex(9, 12)]
    bulge = math.tan((2 * math.pi - 2 * half) / 4)
    space.add_lwpolyline([(ends[0].real, ends[0].imag, 0, 0, 0), (ends[1].real, ends[1].imag, 0, 0, bulge)], close=True)


#: Circle of 30 less the segment beyond the flat.
D_SHAFT = math.pi * 225 - (225 * math.acos(0.6) - 9 * 12)


@looped(("version", "form"), [("R2000", "asc"), ("R2000", "bin"), ("R2018", "asc"), ("R2018", "bin")])
def test_polylines_with_bulges(tmp_path: Path, version: str, form: str) -> None:
    (curve,) = curves(written(tmp_path / "a.dxf", d_shaft, version, form=form))
    assert area(curve) == pytest.approx(D_SHAFT, abs=0.02)
    assert np.abs(curve).max() == pytest.approx(15)


def test_lines_and_arcs_of_r12_in_any_order(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        half = math.degrees(math.acos(0.6))
        space.add_arc((0, 0), 15, half, 360 - half)
        space.add_line((9, 12.004), (9, 0))
        space.add_line((9, -12), (9, 0.003))

    path = written(tmp_path / "a.dxf", draw, "R12")
    (curve,) = curves(path)
    assert area(curve) == pytest.approx(D_SHAFT, abs=0.1)
    assert math.isnan(drawing_file.read_drawing(path, "").scale)


def test_ellipses_splines_and_blocks(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        space.add_ellipse((0, 0), (40, 0), 0.5)
        circle = [(100 + 10 * math.cos(turn), 10 * math.sin(turn)) for turn in np.linspace(0, 2 * math.pi, 80)]
        space.add_spline(circle)
        block = space.doc.blocks.new("quarter")
        block.add_line((0, 0), (5, 0))
        block.add_arc((0, 0), 5, 0, 90)
        block.add_line((0, 0), (0, 5))
        outer = space.doc.blocks.new("outer")
        outer.add_blockref("quarter", (0, 0), dxfattribs={"xscale": 2, "yscale": 2})
        space.add_blockref("outer", (200, 0), dxfattribs={"rotation": 30})

    found = sorted(area(curve) for curve in curves(written(tmp_path / "a.dxf", draw)))
    assert found == pytest.approx([math.pi * 25, math.pi * 100, math.pi * 800], abs=0.1)


@pytest.mark.parametrize(
    ("units", "scale"), [(1, 25.4), (4, 1.0), (5, 10.0), (6, 1000.0), (0, math.nan), (None, math.nan)]
)
def test_units(tmp_path: Path, units: int | None, scale: float) -> None:
    path = written(tmp_path / "a.dxf", lambda space: space.add_circle((0, 0), 0.5), "R2000", units)
    if units is None:
        text = path.read_text()
        assert "$INSUNITS" in text
        path.write_text(text.replace("$INSUNITS", "$INSUNITZ"))
    found = drawing_file.read_drawing(path, "").scale
    assert found == scale or (math.isnan(found) and math.isnan(scale))


def test_what_is_no_contour_is_passed_over(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        document = space.doc
        document.layers.add("notes").off()
        document.layers.add("old").freeze()
        document.linetypes.add("CENTER", [2.0, 1.25, -0.25, 0.25, -0.25])
        document.layers.add("centers", linetype="CENTER")
        space.add_circle((0, 0), 10)
        for layer in ("notes", "old", "DEFPOINTS", "centers"):
            space.add_circle((0, 0), 20, dxfattribs={"layer": layer})
        space.add_line((-50, 0), (50, 0), dxfattribs={"linetype": "CENTER"})
        space.add_text("30 +0.02", dxfattribs={"layer": "0"})
        space.add_point((0, 0))
        space.add_hatch()

    (curve,) = curves(written(tmp_path / "a.dxf", draw))
    assert area(curve) == pytest.approx(100 * math.pi, abs=0.05)


def layered(space: Any) -> None:
    """Circles of 10, 20, 30 and 40: on a layer, in a block that is inserted there, on one that is off, on 0."""
    for name in ("Contour", "NOTES", "Rough"):
        space.doc.layers.add(name)
    space.doc.layers.get("Rough").off()
    space.add_circle((0, 0), 5, dxfattribs={"layer": "Contour"})
    block = space.doc.blocks.new("inner")
    block.add_circle((0, 0), 10, dxfattribs={"layer": "0"})
    block.add_circle((0, 0), 20, dxfattribs={"layer": "NOTES"})
    space.add_blockref("inner", (0, 0), dxfattribs={"layer": "CONTOUR"})
    space.add_circle((0, 0), 15, dxfattribs={"layer": "Rough"})
    space.add_circle((0, 0), 25)
    space.add_text("x", dxfattribs={"layer": "NOTES"})


@pytest.mark.ci
@looped(
    ("layers", "diameters"),
    [
        ([], [10, 20, 40, 50]),
        (["Contour"], [10, 20]),
        (["CONTOUR"], [10, 20]),
        (["rough"], [30]),
        (["0"], [50]),
        (["notes", "0"], [40, 50]),
    ],
    one_in=3,
)
@looped("version", ["R12", "R2010", "R2018"])
def test_of_named_layers_only_what_lies_on_them_counts(
    tmp_path: Path, version: str, layers: list[str], diameters: list[float]
) -> None:
    path = written(tmp_path / "a.dxf", layered, version)
    found = drawing_file.read_drawing(path, "part.dxf", layers).curves
    assert sorted(2 * abs(curve[0]) for curve in found) == pytest.approx(diameters)


@looped(
    ("layers", "message"),
    [
        (["Contur"], "part.dxf: has no layer Contur; its layers are 0, Contour, NOTES, Rough"),
        (
            ["empty"],
            "part.dxf: shows no line, arc or curve of a part; ignored: 2 on layer Contour, 1 on layer NOTES, "
            "1 on layers that are off, frozen or DEFPOINTS, 1 on layer 0",
        ),
    ],
)
def test_a_layer_that_is_not_there_is_told_with_those_that_are(tmp_path: Path, layers: list[str], message: str) -> None:
    def draw(space: Any) -> None:
        layered(space)
        if layers == ["empty"]:
            space.doc.layers.add("Empty")

    with pytest.raises(JobError) as raised:
        drawing_file.read_drawing(written(tmp_path / "a.dxf", draw), "part.dxf", layers)
    assert str(raised.value) == message


def test_of_many_layers_the_first_are_named(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        for number in range(20):
            space.add_line((0, 0), (1, number), dxfattribs={"layer": f"L{number:02}"})

    with pytest.raises(JobError, match=r"has no layer x; its layers are 0, L00, .*, L10 and 9 more$"):
        drawing_file.read_drawing(written(tmp_path / "a.dxf", draw), "part.dxf", ["x"])


def test_what_was_passed_over_is_told_where_nothing_is_left(tmp_path: Path) -> None:
    path = written(tmp_path / "a.dxf", lambda space: [space.add_text("x"), space.add_text("y")])
    with pytest.raises(JobError, match=r"^part\.dxf: shows no line, arc or curve of a part; ignored: 2 TEXT$"):
        drawing_file.read_drawing(path, "part.dxf")


def bomb(space: Any) -> None:
    """Ten blocks, each ten times in the next one."""
    for number in range(9):
        block = space.doc.blocks.new(f"b{number}")
        for _ in range(10):
            block.add_blockref(f"b{number + 1}", (0, 0))
    space.doc.blocks.new("b9")
    space.add_blockref("b0", (0, 0))


def grid(space: Any) -> None:
    space.doc.blocks.new("b").add_line((0, 0), (1, 0))
    space.add_blockref("b", (0, 0), dxfattribs={"row_count": 30000, "column_count": 30000, "row_spacing": 1})


@pytest.mark.one_in(5)
@pytest.mark.nightly
@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (bomb, "blocks at more than 2000 places"),
        (grid, "blocks at more than 2000 places"),
        (lambda space: space.add_line((0, 0), (1e9, 0)), "farther than 100000 mm from its origin"),
        (lambda space: space.add_ellipse((0, 0), (1e300, 0), 0.5), "farther than 100000 mm from its origin"),
        (lambda space: [space.add_circle((0, 0), 9e4) for _ in range(40)], "more than 400000 points"),
    ],
    ids=["blocks in blocks", "a grid of blocks", "far away", "an endless ellipse", "too many points"],
)
def test_hostile_drawings_are_refused_in_one_line(tmp_path: Path, draw: Draw, said: str) -> None:
    path = written(tmp_path / "a.dxf", draw)
    with pytest.raises(JobError, match=said) as raised:
        drawing_file.read_drawing(path, "part.dxf")
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"G0 X10.\nM30\n",
        b"0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nabc\n",
        b"AutoCAD Binary DXF\r\n\x1a\0" + bytes(range(256)) * 4,
        b"0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n10\nnan\n20\n0\n11\n1\n21\n3\n0\nENDSEC\n0\nEOF\n",
        b"0\nEOF\n",
    ],
    ids=["empty", "a program", "cut off", "binary", "not a number", "no entities"],
)
def test_broken_files_are_told_in_one_line(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "a.dxf"
    path.write_bytes(data)
    with pytest.raises(JobError, match=r"^part\.dxf: .+$") as raised:
        drawing_file.read_drawing(path, "part.dxf")
    assert "\n" not in str(raised.value)


def test_without_ezdxf_the_command_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path / "part.dxf", d_shaft)
    program = tmp_path / "O1.NC"
    program.write_text("%\nO1\nM30\n%\n")
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    result = CliRunner().invoke(main, ["check", "--drawing", str(path), str(program)])
    assert result.exit_code == 2
    said = 'reading a drawing needs ezdxf, which is not installed: pip install "polarcheck[drawing]"'
    assert result.stderr.splitlines() == [f"polarcheck: {path}: {said}"]


def test_where_curves_branch_a_chain_goes_on_as_straight_as_it_can() -> None:
    corners = [10 * complex(math.cos(turn), math.sin(turn)) for turn in np.arange(6) * math.pi / 3]
    sides = [(corners[number - 1], corners[number]) for number in range(6)]
    ring, diagonal = joined([*sides[:3], (corners[0], corners[3]), *sides[3:]], 0.01)
    assert len(ring) == 7
    assert ring[0] == ring[-1]
    assert len(diagonal) == 2


def test_what_is_drawn_twice_counts_once() -> None:
    square = [(0j, 10 + 0j), (10 + 0j, 10 + 10j), (10 + 10j, 0 + 10j), (0 + 10j, 0j)]
    again = [(end, start) for start, end in square]
    (chain,) = joined([*square, *again], 0.01)
    assert len(chain) == 5
    assert chain[0] == chain[-1]


@pytest.mark.nightly
def test_reading_a_drawing_leaves_nothing_behind(tmp_path: Path) -> None:
    """ezdxf would write a list of all fonts into the home folder."""
    path = written(tmp_path / "part.dxf", d_shaft)
    (tmp_path / "home").mkdir()
    module = "polarcheck.program.machines.drawing_file"
    code = f"from {module} import *; print(len(read_drawing(Path({str(path)!r}), '').curves))"
    environment = {key: value for key, value in os.environ.items() if not key.startswith("XDG_")}
    environment |= {"HOME": str(tmp_path / "home"), "USERPROFILE": str(tmp_path / "home")}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "1\n"
    assert not list((tmp_path / "home").iterdir())
