"""`polarcheck init --part`: what a program makes as [[part]], with which the same program agrees."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from click.testing import CliRunner, Result
from contour_families import Twin, program_of
from programs import ROOT, tables_of
from test_deviations import HEAD, TAIL, is_sound, polygon, program, sound_seeds
from test_placements import on

from polarcheck.commands import main
from polarcheck.parts.job_entry import NoEntryError, job_entry
from polarcheck.reports.made_parts.part_report import made_by


def run(*words: object) -> Result:
    return CliRunner().invoke(main, [str(word) for word in words])


def entries(text: str) -> list[dict[str, Any]]:
    return list(tomllib.loads(text).get("part", []))


def milled(*blocks: str) -> str:
    return HEAD + "\n".join(blocks) + "\n" + TAIL


# ---- what is written ----

FLAT = "G1 X80. C-30. F300/Z-1./G42 X18. C-25./C25./G40 X80. C30."
BOTH = "G1 X60. C10. F300/Z-1./G42 X40./X-40./G40 X-60./G1 C-10./G42 X-40./X40./G40 X60."
SLOT = "G1 X80. C0. F300/Z-1./G41 X60. C3./X-60./G40 X-80. C0./G41 X-60. C-3./X60./G40 X80. C0."
ROUND_ENDS = "G42 X20. C-5. F100/G3 X20. C5. R5./G1 X-20./G3 X-20. C-5. R5./G1 X0/X20./G40 X20. C-30."
CHAMFERS = "G42 X20. C0 F100/C8./X16. C10./X-16./X-20. C8./C-8./X-16. C-10./X16./X20. C-8./C0/G40 X60."

CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "hexagon": (
        program(polygon(6, 13.5, turn=0.25)),
        {"shape": "hexagon", "across_flats": 27.0, "turned": 14.324, "z": -3.0},
    ),
    "triangle": (program(polygon(3, 9.0)), {"shape": "triangle", "across_flats": 18.0, "turned": 0.0, "z": -3.0}),
    "hendecagon": (program(polygon(11, 20.0)), {"shape": "hendecagon", "across_flats": 40.0, "turned": 0.0, "z": -3.0}),
    "pocket": (
        program(polygon(4, 20.0), "G41"),
        {"shape": "square", "across_flats": 40.0, "turned": 0.0, "inside": True, "z": -3.0},
    ),
    "circle": (
        milled("G1 X80. C5. F300", "Z-1.", "G42 X30. C5.", "G3 X30. C5. I-12. J0", "G1 G40 X80."),
        {"shape": "circle", "diameter": 24.0, "center": [3.0, 5.0], "z": -1.0},
    ),
    "chamfers": (
        milled("G1 X60. C0 F300", "Z-1.", *CHAMFERS.split("/")),
        {"shape": "square", "across_flats": 20.0, "chamfer": 2.0, "turned": 0.0, "z": -1.0},
    ),
    "boss with round ends": (
        milled("G1 X20. C-30. F300", "Z-1.", *ROUND_ENDS.split("/")),
        {"shape": "rectangle", "width": 10.0, "length": 30.0, "corner_radius": 5.0, "turned": 0.0, "z": -1.0},
    ),
    "one flat": (milled(*FLAT.split("/")), {"shape": "flat", "distance": 9.0, "turned": 0.0, "z": -1.0}),
    "two flats": (
        milled(*BOTH.split("/")),
        {"shape": "flats", "count": 2, "across_flats": 20.0, "turned": 90.0, "z": -1.0},
    ),
    "slot": (milled(*SLOT.split("/")), {"shape": "slot", "width": 6.0, "turned": 0.0, "z": -1.0}),
}


@pytest.mark.one_in(30)
@pytest.mark.ci
@pytest.mark.parametrize("machine", ["fanuc-30i", "siemens-iso", "haas-lathe"])
@pytest.mark.parametrize("name", CASES)
def test_the_entry_of_a_shape_and_its_program_agree(tmp_path: Path, name: str, machine: str) -> None:
    text, expected = CASES[name]
    path = tmp_path / "O1.NC"
    path.write_text(on(machine, text))
    options = ["--machine", machine, "--tool", "1:radius=2"]
    result = run("init", "--part", path, *options)
    assert (result.exit_code, result.stderr) == (0, "")
    assert entries(result.stdout) == [{**expected, "files": ["O1.NC"]}]
    (tmp_path / "polarcheck.toml").write_text(result.stdout)
    agrees(path, *options)


def agrees(path: Path, *options: object) -> None:
    """The part is compared, and agrees within 0.01 mm."""
    (file,) = json.loads(run("part", path, *options, "--format", "json").stdout)["files"]
    assert [finding for finding in file["findings"] if finding["rule"] == "part-differs-from-drawing"] == []
    assert [one["reason"] for one in file["not_evaluated"] if "compared with nothing" in one["reason"]] == []
    assert file["compared"]
    assert max(one["largest"] for one in file["compared"]) <= 0.01


@pytest.mark.nightly
def test_lengths_are_in_the_units_of_the_job_file_or_of_the_program(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(program(polygon(6, 12.7), scale=25.4))
    job = tmp_path / "polarcheck.toml"
    for units, radius, across, z in (("", 0.1, 1.0, -0.1181), ('units = "mm"\n', 2.54, 25.4, -3.0)):
        job.write_text(units)
        result = run("init", "--part", path, "--tool", f"1:radius={radius}")
        (entry,) = entries(result.stdout)
        assert (entry["across_flats"], entry["z"]) == (across, pytest.approx(z, abs=2e-4))
        job.write_text(units + result.stdout)
        agrees(path, "--tool", f"1:radius={radius}")


@pytest.mark.nightly
def test_the_bar_bounds_flats_and_cuts_corners_off(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    job = tmp_path / "polarcheck.toml"
    stock = "[stock]\ndiameter = {}\n"
    for text, diameter, expected in (
        (milled(*FLAT.split("/")), 30.0, {"shape": "flat", "distance": 9.0, "diameter": 30.0}),
        (milled(*BOTH.split("/")), 32.0, {"shape": "flats", "count": 2, "across_flats": 20.0, "diameter": 32.0}),
        (program(polygon(6, 13.5)), 30.0, {"shape": "flats", "count": 6, "across_flats": 27.0, "diameter": 30.0}),
        (program(polygon(6, 13.5)), 32.0, {"shape": "hexagon", "across_flats": 27.0}),
    ):
        path.write_text(text)
        job.write_text(stock.format(diameter))
        result = run("init", "--part", path, "--tool", "1:radius=10")
        (entry,) = entries(result.stdout)
        assert {key: entry[key] for key in entry if key not in ("turned", "z", "files")} == expected
        job.write_text(stock.format(diameter) + result.stdout)
        agrees(path, "--tool", "1:radius=10")


@pytest.mark.nightly
def test_each_section_has_its_entry_and_each_file_its_name(tmp_path: Path) -> None:
    first, second = program(polygon(6, 13.5)), program(polygon(4, 20.0), z=-8.0)
    both = first.replace(TAIL, "G13.1\n") + second.removeprefix("O1\n")
    paths = [tmp_path / "O1[a].NC", tmp_path / "O2.NC"]
    for path, text in zip(paths, (both, first), strict=True):
        path.write_text(text)
    result = run("init", *(word for path in paths for word in ("--part", path)), "--tool", "1:radius=8")
    assert [(entry["shape"], entry.get("section"), entry["files"]) for entry in entries(result.stdout)] == [
        ("hexagon", 1, ["O1[[]a].NC"]),
        ("square", 2, ["O1[[]a].NC"]),
        ("hexagon", None, ["O2.NC"]),
    ]
    (tmp_path / "polarcheck.toml").write_text(result.stdout)
    for path in paths:
        agrees(path, "--tool", "1:radius=8")


INDEXED = "G1 X80. C-40. F300/Z-3./G41 X24. C-32./C32./G40 X80. C40./Z5."


def indexed(angles: list[float]) -> str:
    """A flat 12 from the center at each of these angles of C."""
    head, end = HEAD.removesuffix("G12.1\n"), TAIL.removeprefix("G13.1\n")
    blocks = INDEXED.replace("G41", "G42").replace("/", "\n")
    return head + "".join(f"G0 X160. C{angle:g}\nG12.1\n{blocks}\nG13.1\n" for angle in angles) + end


@pytest.mark.nightly
@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("angles", "expected"),
    [
        ([30.0], {"shape": "flat", "distance": 12.0, "turned": 30.0}),
        ([0.0, 180.0], {"shape": "flats", "count": 2, "across_flats": 24.0, "turned": 0.0}),
        ([10.0, 130.0, 250.0], {"shape": "triangle", "across_flats": 24.0, "turned": 10.0}),
        ([45.0 * number for number in range(8)], {"shape": "octagon", "across_flats": 24.0, "turned": 0.0}),
    ],
    ids=["one", "two", "three", "eight"],
)
@pytest.mark.parametrize("machine", ["fanuc-30i", "siemens-iso", "haas-lathe"])
def test_sections_that_make_one_shape_have_one_entry(
    tmp_path: Path, angles: list[float], expected: dict[str, Any], machine: str
) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(on(machine, indexed(angles)))
    options = ["--machine", machine, "--tool", "1:radius=8"]
    result = run("init", "--part", path, *options)
    assert entries(result.stdout) == [{**expected, "z": -3.0, "files": ["O1.NC"]}]
    (tmp_path / "polarcheck.toml").write_text(result.stdout)
    agrees(path, *options)
    # The last one forgotten, or at another angle.
    for other in (angles[:-1], [*angles[:-1], angles[-1] + 10]):
        path.write_text(on(machine, indexed(other)))
        assert run("check", path, *options, "--select", "part-differs-from-drawing").exit_code == (1 if other else 0)


@pytest.mark.nightly
def test_where_c_is_not_known_the_angle_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(program(polygon(6, 13.5)).replace("Z2. C0", "Z2. C#500"))
    result = run("init", "--part", path, "--tool", "1:radius=4")
    assert entries(result.stdout) == [{"shape": "hexagon", "across_flats": 27.0, "z": -3.0, "files": ["O1.NC"]}]
    (tmp_path / "polarcheck.toml").write_text(result.stdout)
    agrees(path, "--tool", "1:radius=4")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (program([complex(20, -9), complex(20, 12), complex(-12, 18), complex(-15, -11)]), "a polygon is no shape of"),
        (program(polygon(6, 13.5, {2: 0.05})), "its sides or corners differ from each other"),
        (milled("G0 X200.", "Z-1."), "not known"),
    ],
    ids=["polygon", "odd", "nothing"],
)
def test_what_no_part_says_is_a_comment(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(text)
    result = run("init", "--part", path, "--tool", "1:radius=2")
    assert result.exit_code == 0
    assert entries(result.stdout) == []
    assert said in result.stdout
    assert all(not line or line.startswith("# ") for line in result.stdout.splitlines())


def test_beside_what_no_part_says_an_entry_is_a_comment(tmp_path: Path) -> None:
    """A hexagon, and a pocket of four walls in it at the same depth."""
    blocks = program([complex(6, -4), complex(7, 6), complex(-6, 5), complex(-5, -5)], "G41")
    blocks = blocks[len(HEAD) : -len(TAIL)].replace("Z-3.0000", "Z-3.")
    path = tmp_path / "O1.NC"
    path.write_text(program(polygon(6, 13.5)).removesuffix(TAIL) + blocks + TAIL)
    result = run("init", "--part", path, "--tool", "1:radius=1")
    assert entries(result.stdout) == []
    assert '#[[part]]\n#shape = "hexagon"\n' in result.stdout
    assert "a polygon is no shape of [[part]]" in result.stdout


# ---- the command ----


@pytest.mark.nightly
def test_it_writes_no_file_and_is_appended(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(program(polygon(6, 13.5)))
    job = tmp_path / "polarcheck.toml"
    job.write_text("[tools.1]\nradius = 4.0\n")
    result = run("init", "--part", path)
    assert result.exit_code == 0
    assert [entry.name for entry in sorted(tmp_path.iterdir())] == ["O1.NC", "polarcheck.toml"]
    job.write_text(job.read_text() + result.stdout)
    agrees(path)
    # A slip in a block that is made later is told.
    path.write_text(path.read_text().replace("C7.79423", "C7.69423", 1))
    assert run("check", path, "--select", "part-differs-from-drawing").exit_code == 1


def test_options_without_a_meaning_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "O1.NC"
    path.write_text(program(polygon(6, 13.5)))
    for words, said in (
        (["--part", path, tmp_path], "FOLDER cannot be combined with --part, which writes no file"),
        (["--part", path, "--no-schema"], "--schema cannot be combined with --part, which writes no file"),
        ([tmp_path, "--tool", "1:radius=4"], "--tool is for --part"),
        ([tmp_path, "--no-config"], "--no-config is for --part"),
    ):
        result = run("init", *words)
        assert (result.exit_code, result.stderr) == (2, f"polarcheck: {said}\n")
    assert run("init", "--part", tmp_path / "O2.NC").exit_code == 2
    assert [entry.name for entry in tmp_path.iterdir()] == ["O1.NC"]


# ---- there and back ----


def again(text: str, radius: float, machine: str = "fanuc-30i") -> None:
    """What is made, asked for."""
    tool = f"1:radius={radius:.6f}"
    parts = []
    for made in made_by(tables_of(text, machine, tool)):
        try:
            parts.append(job_entry(made, None, inch="G20" in text))
        except NoEntryError:
            # What else lies there would differ from the others.
            return
    tables = tables_of(text, machine, tool, job={"part": parts})
    assert not [*tables["deviations"].missing()]
    # Of the contours alone: some of these programs leave ribs beside them, or cut into them where the tool comes.
    results = tables["contour_comparisons"].all
    assert results
    assert max(one.difference.largest for one in results if not one.is_superseded) <= 0.01


@pytest.mark.ci
@looped("seed", sound_seeds(2), one_in=78)
@looped("twin", [Twin(), Twin(turn=0.7), Twin(inch=True)], ids=["plain", "turned", "inch"])
def test_programs_of_all_families_agree_with_what_they_make(seed: int, twin: Twin) -> None:
    one = program_of(seed, twin)
    if is_sound(one):
        again(one.text, one.radius / 25.4 if "G20" in one.text else one.radius)


#: Samples that do not make the whole of what they seem to: a flat that ends inside the bar.
INCOMPLETE = ("feed_from_per_revolution",)
SAMPLES = sorted((ROOT / "sample_programs").rglob("*.nc"))


@pytest.mark.one_in(18)
@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_each_sample_agrees_with_what_it_makes(tmp_path: Path, path: Path) -> None:
    result = run("init", "--part", path)
    assert result.exit_code == 0
    text = "".join(line for line in result.stdout.splitlines(keepends=True) if not line.startswith("files = "))
    parts = entries(result.stdout)
    assert all(line.startswith("#") for line in text.splitlines() if line and not parts)
    nearest = next(folder for folder in path.parents if (folder / "polarcheck.toml").exists())
    (tmp_path / "polarcheck.toml").write_text(f'extend = "{(nearest / "polarcheck.toml").as_posix()}"\n{text}')
    (file,) = json.loads(run("part", path, "--config", tmp_path / "polarcheck.toml", "--format", "json").stdout)[
        "files"
    ]
    differing = [finding for finding in file["findings"] if finding["rule"] == "part-differs-from-drawing"]
    assert bool(differing) == (path.stem in INCOMPLETE)
    # Areas agree within the tolerance, contours nearly.
    assert all(one["largest"] <= one["tolerance"] for one in file["compared"] if one["agrees"])
