"""The options --drawing, --drawing-layer and --tolerance of check, part and config show, and `layers` of [[part]]."""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import ezdxf
import pytest
from click.testing import CliRunner, Result
from test_deviations import HEAD, RULE, TAIL, polygon, program
from test_placements import on

from polarcheck.commands import main


def dxf(path: Path, contours: dict[str, list[complex]], scale: float = 1.0) -> Path:
    """A drawing with a contour on each layer [mm], in units of so many mm."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 1 if scale > 1 else 4
    for layer, corners in contours.items():
        points = [(corner.real / scale, corner.imag / scale) for corner in corners]
        document.modelspace().add_lwpolyline(points, close=True, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def run(*words: object) -> Result:
    return CliRunner().invoke(main, [str(word) for word in words])


def two_contours(scale: float = 1.0, turn: float = 0.0) -> str:
    """A hexagon of 27, and a square of 40 below it."""
    hexagon, square = polygon(6, 13.5, turn=turn), polygon(4, 20.0, turn=turn)
    tail = TAIL if scale == 1 else TAIL.replace("X160.", "X6.3")
    first = program(hexagon, scale=scale).replace(tail, "G13.1\n")
    return first + program(square, scale=scale, z=-8.0).removeprefix("O1\n")


VARIANTS = pytest.mark.parametrize(
    ("scale", "turn", "machine"),
    [(1.0, 0.0, "fanuc-30i"), (25.4, 0.0, "fanuc-30i"), (1.0, 0.3, "fanuc-30i"), (1.0, 0.0, "haas-lathe")],
    ids=["mm", "inch", "turned", "haas"],
)


@pytest.mark.nightly
@pytest.mark.one_in(8)
@VARIANTS
@pytest.mark.parametrize("command", ["check", "part"])
def test_several_drawings_are_several_parts(
    tmp_path: Path, command: str, scale: float, turn: float, machine: str
) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(on(machine, two_contours(scale, turn)))
    hexagon = dxf(tmp_path / "hexagon.dxf", {"0": polygon(6, 13.5, turn=turn)}, scale)
    square = dxf(tmp_path / "square.dxf", {"0": polygon(4, 20.0, turn=turn)})
    other = dxf(tmp_path / "other.dxf", {"0": polygon(4, 20.1, turn=turn)})
    words = [command, "--machine", machine, "--tool", f"1:radius={8 / scale:.6f}", path]
    words += ["--select", RULE] if command == "check" else []
    assert run(*words, "--drawing", hexagon, "--drawing", square).exit_code == 0
    result = run(*words, "--drawing", hexagon, "--drawing", other)
    assert result.exit_code == 1
    assert "differs from other.dxf by" in result.stdout
    assert "differs from hexagon.dxf" not in result.stdout


@pytest.mark.nightly
@VARIANTS
def test_the_tolerance_of_the_command_line(tmp_path: Path, scale: float, turn: float, machine: str) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(on(machine, program(polygon(6, 13.5, {2: 0.05}, turn), scale=scale)))
    drawing = dxf(tmp_path / "hexagon.dxf", {"0": polygon(6, 13.5, turn=turn)})
    words = ["check", "--machine", machine, "--tool", f"1:radius={8 / scale:.6f}", path, "--select", RULE]
    job = tmp_path / "polarcheck.toml"
    part = f'[[part]]\nshape = "hexagon"\nacross_flats = {27 / scale}\n'
    for asked in ((job, part), (None, "")):
        if asked[0]:
            job.write_text(asked[1])
        more = [] if asked[0] else ["--drawing", drawing]
        assert run(*words, *more).exit_code == 1
        assert run(*words, *more, "--tolerance", f"{0.04 / scale:.6f}").exit_code == 1
        assert run(*words, *more, "--tolerance", f"{0.06 / scale:.6f}").exit_code == 0
        # What an entry says of itself is nearer; --drawing takes the place of all entries.
        job.write_text(f"{part}tolerance = {0.04 / scale}\n")
        assert run(*words, *more, "--tolerance", f"{0.06 / scale:.6f}").exit_code == (1 if asked[0] else 0)
        job.unlink()


@pytest.mark.nightly
@pytest.mark.one_in(4)
@VARIANTS
def test_layers_by_name(tmp_path: Path, scale: float, turn: float, machine: str) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(on(machine, program(polygon(6, 13.5, turn=turn), scale=scale)))
    contours = {"Contour": polygon(6, 13.5, turn=turn), "Rough": polygon(6, 13.6, turn=turn)}
    drawing = dxf(tmp_path / "part.dxf", contours, scale)
    words = ["check", "--machine", machine, "--tool", f"1:radius={8 / scale:.6f}", path, "--select", RULE]
    assert run(*words, "--drawing", drawing, "--drawing-layer", "CONTOUR").exit_code == 0
    assert run(*words, "--drawing", drawing, "--drawing-layer", "rough").exit_code == 1
    result = run(*words, "--drawing", drawing, "--drawing-layer", "outline")
    said = f"polarcheck: {drawing}: has no layer outline; its layers are 0, Contour, Rough\n"
    assert (result.exit_code, result.stderr) == (2, said)
    job = tmp_path / "polarcheck.toml"
    for layer, code in (("contour", 0), ("Rough", 1), ("outline", 2)):
        job.write_text(f'[[part]]\ndrawing = "part.dxf"\nlayers = ["{layer}"]\n')
        result = run(*words)
        assert result.exit_code == code
    expected = f"polarcheck: {job}:2: drawing: {drawing}: has no layer outline; its layers are 0, Contour, Rough\n"
    assert result.stderr == expected


def test_what_makes_no_sense_is_refused_in_one_line(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(HEAD + TAIL)
    result = run("check", path, "--drawing-layer", "x")
    assert result.exit_code == 2
    assert result.stderr == (
        "polarcheck: --drawing-layer: give the drawing by --drawing, too; a [[part]] has layers of its own\n"
    )
    for value in ("0", "-1", "nan", "inf", "x"):
        result = run("check", path, "--tolerance", value)
        assert result.exit_code == 2
        assert "--tolerance" in result.stderr
    (tmp_path / "polarcheck.toml").write_text('[[part]]\nshape = "circle"\ndiameter = 3.0\nlayers = ["x"]\n')
    result = run("check", path)
    assert result.stderr.endswith("polarcheck.toml:4: part.1.layers: a drawing has layers, a shape has none\n")


@pytest.mark.nightly
def test_a_tolerance_that_nothing_takes_is_said(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(program(polygon(6, 13.5)))
    warning = (
        "polarcheck: warning: --tolerance: nothing is compared; give a --drawing, or a [[part]] in polarcheck.toml\n"
    )
    drawing = dxf(tmp_path / "part.dxf", {"Contour": polygon(6, 13.5)})
    for command in ("check", "part"):
        assert run(command, path, "--tool", "1:radius=4", "--tolerance", "0.1").stderr == warning
        assert run(command, path, "--tool", "1:radius=4", "--tolerance", "0.1", "--drawing", drawing).stderr == ""


@pytest.mark.nightly
def test_one_file_with_two_layers_is_two_parts(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(two_contours())
    dxf(tmp_path / "part.dxf", {"Six": polygon(6, 13.5), "Four": polygon(4, 20.1), "Old": polygon(5, 20.0)})
    entries = "".join(f'[[part]]\ndrawing = "part.dxf"\nlayers = ["{layer}"]\n' for layer in ("SIX", "FOUR"))
    (tmp_path / "polarcheck.toml").write_text(f"[tools.1]\nradius = 8.0\n{entries}")
    result = run("part", path)
    assert "agrees with part.dxf (SIX) within" in result.stdout
    assert "differs from part.dxf (FOUR) by" in result.stdout.replace("\n             ", " ")


def test_config_show_says_where_they_come_from(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(HEAD + TAIL)
    drawing = dxf(tmp_path / "part.dxf", {"A": [10 * cmath.exp(1j * math.pi * turn / 2) for turn in range(4)]})

    def shown(*words: object) -> dict[str, str]:
        lines = run("config", "show", path, *words).stdout.splitlines()
        return {line.split()[0]: line.partition("#")[2].strip() for line in lines if line.startswith("part.")}

    assert shown("--drawing", drawing, "--drawing", drawing, "--drawing-layer", "a", "--tolerance", "0.1") == {
        f"part.{number}.{key}": f"command line {option}"
        for number in (1, 2)
        for key, option in (("drawing", "--drawing"), ("tolerance", "--tolerance"), ("layers", "--drawing-layer"))
    }
    job = tmp_path / "polarcheck.toml"
    circle = '[[part]]\nshape = "circle"\ndiameter = 3.0\n'
    job.write_text(f"{circle}tolerance = 0.1\n{circle}")
    origins = shown("--tolerance", "0.2")
    assert origins["part.1.tolerance"] == f"{job}:4"
    assert origins["part.2.tolerance"] == "command line --tolerance"
