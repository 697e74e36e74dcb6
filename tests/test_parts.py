"""[[part]] in a job file: keys that fit no shape, units, several files, where each value comes from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from cases import looped
from click.testing import CliRunner
from polarcheck.errors import JobError

from polarcheck.commands import main
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.program.machines.job import from_table
from polarcheck.program.machines.part_keys import SIDES, Part

HEXAGON = {"shape": "hexagon", "across_flats": 27.0}


@looped(
    ("part", "key", "said"),
    [
        ({}, "", "expected drawing = a DXF file, or shape = triangle, square, pentagon"),
        ({"shape": "hexagon"}, "", "the shape hexagon needs across_flats or across_corners"),
        ({"shape": "hexagn"}, ".shape", "expected triangle, square"),
        ({**HEXAGON, "diameter": 3.0}, ".diameter", "no key of the shape hexagon, which has across_flats,"),
        ({**HEXAGON, "across_corners": 30.0}, ".across_corners", "the shape hexagon has across_flats or across_corn"),
        ({**HEXAGON, "corner_radius": 1.0, "chamfer": 1.0}, ".chamfer", "a corner has corner_radius or chamfer, not"),
        ({**HEXAGON, "corner_radius": 14.0}, ".corner_radius", "expected 13.5 at most, found 14"),
        ({**HEXAGON, "tolerance": 0.0}, ".tolerance", "expected a number above 0"),
        ({**HEXAGON, "center": [1.0]}, ".center", "expected a list of numbers, of length 2"),
        ({"shape": "square", "across_flats": 20.0, "chamfer": 11.0}, ".chamfer", "expected 10 at most, found 11"),
        ({"shape": "rectangle", "width": 6.0}, "", "the shape rectangle needs length"),
        ({"shape": "polygon", "across_flats": 6.0}, "", "the shape polygon needs sides"),
        ({"shape": "slot", "width": 6.0, "length": 5.0}, ".length", "a slot is at least as long as it is wide"),
        ({"shape": "slot", "width": 6.0, "corner_radius": 1.0}, ".corner_radius", "a slot without length goes through"),
        ({"shape": "flats", "across_flats": 30.0, "diameter": 29.0}, ".diameter", "a round of this diameter has no"),
        ({"drawing": "a.dxf", "width": 3.0}, ".width", "a part has a drawing or a shape, not both"),
        ({"drawing": "a.dxf", "shape": "circle"}, ".shape", "a part has a drawing or a shape, not both"),
    ],
)  # fmt: skip
def test_what_fits_no_shape_is_told_with_its_key(part: dict[str, Any], key: str, said: str) -> None:
    with pytest.raises(JobError) as raised:
        from_table({"part": [HEXAGON, part]}, "polarcheck.toml")
    assert str(raised.value).startswith(f"polarcheck.toml: part.2{key}: {said}")


@looped(("name", "count"), SIDES.items())
def test_a_name_is_a_number_of_sides(name: str, count: int) -> None:
    (part,) = from_table({"part": [{"shape": name, "across_flats": 2.0}]}, "").part
    assert part.count_of_sides == count


def job_files(folder: Path, *texts: str) -> Path:
    """polarcheck.toml with the first text, which extends the others, one after the other."""
    for number, text in enumerate(texts):
        extend = f'extend = "{number + 1}.toml"\n' if number + 1 < len(texts) else ""
        (folder / (f"{number}.toml" if number else "polarcheck.toml")).write_text(extend + text)
    return folder / "O1.NC"


def parts_of(path: Path) -> list[Part]:
    return list(OfPrograms(Options())(str(path)).job.part)


def test_lengths_are_converted_where_a_file_over_it_has_other_units(tmp_path: Path) -> None:
    below = 'units = "inch"\n[[part]]\nshape = "circle"\ndiameter = 1.0\ncenter = [0.5, 0.0]\n'
    above = 'units = "mm"\n[[part]]\nshape = "circle"\ndiameter = 30.0\nsection = 2\n'
    one, other = parts_of(job_files(tmp_path, above, below))
    assert (one.diameter, one.center, one.section) == (25.4, (12.7, 0.0), None)
    assert (other.diameter, other.section) == (30.0, 2)


def test_units_that_nobody_knows_are_told(tmp_path: Path) -> None:
    path = job_files(tmp_path, 'units = "mm"\n', '[[part]]\nshape = "circle"\ndiameter = 30.0\n')
    with pytest.raises(JobError, match=r"units: part of .*1\.toml.* has those of each program; give units there, too"):
        parts_of(path)


def test_patterns_say_which_programs_are_meant(tmp_path: Path) -> None:
    text = '[[part]]\nshape = "circle"\ndiameter = 30.0\nfiles = ["O1*"]\n[[part]]\nshape = "circle"\ndiameter = 20.0\n'
    assert [part.diameter for part in parts_of(job_files(tmp_path, text))] == [30.0, 20.0]
    assert [part.diameter for part in parts_of(tmp_path / "O2.NC")] == [20.0]


def test_a_wrong_key_is_told_with_its_line_and_a_right_one_with_its_origin(tmp_path: Path) -> None:
    path = job_files(
        tmp_path, '[[part]]\nshape = "circle"\ndiameter = 30.0\n\n[[part]]\nshape = "circle"\nwidth = 3.0\n'
    )
    result = CliRunner().invoke(main, ["config", "show", str(path)])
    job = tmp_path / "polarcheck.toml"
    expected = f"polarcheck: {job}:7: part.2.width: no key of the shape circle, which has diameter, center or inside\n"
    assert (result.exit_code, result.stderr) == (2, expected)
    job.write_text(job.read_text().replace("width", "diameter"))
    shown = CliRunner().invoke(main, ["config", "show", str(path)]).stdout
    assert [line.split() for line in shown.splitlines() if line.startswith("part.2.diameter")] == [
        ["part.2.diameter", "=", "3.0", "#", f"{job}:7"]
    ]
