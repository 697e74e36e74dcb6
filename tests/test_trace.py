"""What `polarcheck trace` prints is a contract."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner, Result

from polarcheck import __version__
from polarcheck.commands import main
from polarcheck.reports.pages import json_schema

SAMPLES = Path(__file__).parent.parent / "sample_programs"
KEYS = [
    *("line", "section", "kind", "start", "end", "center", "z", "path", "radius", "feed", "x_axis", "c_axis"),
    *("nearest", "c_feed", "x_feed", "c_acceleration", "x_acceleration", "time"),
]


def call(*arguments: str, code: int = 0, **environment: str) -> Result:
    result = CliRunner().invoke(main, ["trace", *arguments], env=environment)
    assert result.exit_code == code, result.output
    return result


def run(*arguments: str, **environment: str) -> str:
    return call(*arguments, **environment).stdout


def moves(*arguments: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in run("--format", "jsonl", *arguments).splitlines()]


@looped("path", ["tool", "programmed"])
def test_moves_have_the_fields_of_the_contract(path: str) -> None:
    table = moves("--path", path, str(SAMPLES / "turning-center" / "two_flats_b.nc"))
    assert table
    for move in table:
        assert list(move) == KEYS
        assert move["kind"] in ("line", "cw", "ccw")
        assert (move["center"] is None) == (move["kind"] == "line")


def test_the_two_flats_of_the_guide() -> None:
    """1.0 inch across the flats, cutter of 1/2 inch, so that its center runs at 0.75 inch: 19.05 mm."""
    table = moves("--path", "tool", str(SAMPLES / "turning-center" / "two_flats_b.nc"))
    flat = next(move for move in table if move["line"] == 15)
    assert flat["start"] == pytest.approx([19.05, 0.4153 * 25.4])
    assert flat["nearest"] == pytest.approx(19.05)
    assert flat["feed"] == pytest.approx(127.0)
    assert flat["c_feed"] == pytest.approx(np.degrees(127.0 / 19.05))
    programmed = moves("--path", "programmed", str(SAMPLES / "turning-center" / "two_flats_b.nc"))
    assert next(m for m in programmed if m["line"] == 15)["nearest"] == pytest.approx(12.7)


def test_machine_axes_follow_the_plane() -> None:
    table = moves("--path", "tool", str(SAMPLES / "shrinking_passes.nc"))
    assert table
    for move in table:
        for point, x, c in zip(
            (move["start"], move["end"]),
            move["x_axis"],
            move["c_axis"],
            strict=True,
        ):
            assert x >= 0
            turned = x * np.exp(1j * np.radians(c))
            assert turned == pytest.approx(complex(*point), abs=1e-5)


def test_the_executed_table_as_csv_and_json_lines() -> None:
    name = str(SAMPLES / "hexagon.nc")
    rows = list(csv.DictReader(io.StringIO(run(name))))
    objects = moves(name)
    assert len(rows) == len(objects)
    assert [int(row["line"]) for row in rows] == [found["line"] for found in objects]
    assert {row["side"] for row in rows} == {"G40", "G42"}
    assert {row["radius"] for row in rows[2:]} == {"4.0"}


def test_moves_as_csv_have_a_column_for_each_coordinate() -> None:
    rows = list(csv.DictReader(io.StringIO(run("--path", "tool", str(SAMPLES / "hexagon.nc")))))
    assert {"start_x", "start_c", "x_axis_from", "c_axis_to", "time"} <= set(rows[0])


def test_the_page_of_the_trace_names_each_field_once() -> None:
    page = (SAMPLES.parent / "docs" / "trace.md").read_text("utf-8")
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| `")]
    assert sorted(name.strip(" `") for row in rows for name in row.split(",")) == sorted(KEYS)


# ---- whose path it is ----

#: Straight in, along a face with both ramps in it, and out; inch on one control, mm on the other.
FACES = {
    "fanuc": "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X50. Z2. C0\nG12.1\nG1 X44. F200\nZ-3.\nG42 X30.\nC20.\nX-30.\nC0\n"
    "G40 X-44.\nZ2.\nG13.1\nM30\n",
    "haas-lathe": "%\nO1\nG20 G40 G97 G98 G18\nT0808\nG0 X3. Z0.1 C0\nG112\nG1 X2.8 F10.\nZ-0.1\nG41 X2.\nY-1.\n"
    "X-2.\nY0\nG40 X-2.8\nZ0.1\nG113\nM30\n%\n",
}
OFFSET_LINES = {"fanuc": [8, 9, 10, 11, 12], "haas-lathe": [9, 10, 11, 12, 13]}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(folder: Path, text: str, name: str = "a.nc") -> str:
    (folder / name).write_text(text, "utf-8")
    return str(folder / name)


@looped(("machine", "remedy"), [("fanuc", "1:radius"), ("haas-lathe", "8:radius")])
def test_without_the_radius_moves_in_offset_mode_are_the_programmed_ones_and_say_so(
    folder: Path, machine: str, remedy: str
) -> None:
    name = written(folder, FACES[machine])
    options = ("--machine", machine, "--format", "jsonl", name)
    result = call("--path", "tool", *options, code=1)
    table = [json.loads(line) for line in result.stdout.splitlines()]
    shown = [move["line"] for move in table if move["path"] == "programmed"]
    assert shown == OFFSET_LINES[machine]
    assert {move["path"] for move in table} == {"tool", "programmed"}
    assert {move["radius"] for move in table} == {None}
    for move in table:
        unknown = move["path"] == "programmed"
        assert [move[key] is None for key in ("nearest", "c_feed", "x_feed", "x_acceleration")] == [unknown] * 4
    assert result.stderr.count("\n") == 1
    assert f"no radius for T0{remedy[0]}0{remedy[0]}: " in result.stderr
    assert f"give --tool {remedy}=... or --offsets FILE" in result.stderr
    # The programmed path is what was asked for here, and nothing is missing.
    programmed = call("--path", "programmed", *options)
    assert programmed.stderr == ""
    assert {json.loads(line)["path"] for line in programmed.stdout.splitlines()} == {"programmed"}


@looped(("machine", "tool", "radius"), [("fanuc", "1:radius=4", 4.0), ("haas-lathe", "8:radius=.25", 6.35)])
def test_with_the_radius_all_moves_are_the_tools(folder: Path, machine: str, tool: str, radius: float) -> None:
    name = written(folder, FACES[machine])
    result = call("--machine", machine, "--tool", tool, "--path", "tool", "--format", "jsonl", name)
    assert result.stderr == ""
    assert "null" not in result.stdout.replace('"center":null', "")
    for move in map(json.loads, result.stdout.splitlines()):
        assert (move["path"], move["radius"]) == ("tool", pytest.approx(radius))


def test_a_radius_that_is_0_is_known(folder: Path) -> None:
    table = moves("--tool", "1:radius=0", "--path", "tool", written(folder, FACES["fanuc"]))
    assert {(move["path"], move["radius"]) for move in table} == {("tool", 0.0)}


def test_all_that_is_missing_is_told_in_one_line(folder: Path) -> None:
    one, tail = FACES["fanuc"].split("T0101\n")
    two = tail.replace("M30\n", "")
    text = f"{one}T0101\n{two}T0303\n{two}T0300\n{two}M30\n"
    result = call("--path", "tool", written(folder, text), code=1)
    assert result.stderr == (
        "polarcheck: warning: no radius for T0101, T0303, no tool offset is in force at line 32: what is run with G41 "
        "or G42 is shown as programmed, not as the tool runs; give --tool 1:radius=... --tool 3:radius=... "
        "or --offsets FILE, call one with T\n"
    )


def test_without_compensation_no_radius_is_asked_for(folder: Path) -> None:
    text = FACES["fanuc"].replace("G42 ", "").replace("G40 X-44.", "X-44.")
    result = call("--path", "tool", "--format", "jsonl", written(folder, text))
    assert result.stderr == ""
    assert {json.loads(line)["path"] for line in result.stdout.splitlines()} == {"tool"}


def test_an_offset_cancel_has_the_radius_that_it_takes_back(folder: Path) -> None:
    text = FACES["fanuc"].replace("G40 X-44.", "G40 X-44. T0100")
    table = moves("--tool", "1:radius=4", "--path", "tool", written(folder, text))
    assert next(move for move in table if move["line"] == 12)["radius"] == 4.0


# ---- Z ----


def test_z_goes_from_where_the_block_before_has_left_it(folder: Path) -> None:
    text = FACES["fanuc"].replace("C20.\n", "C20. Z-5.\n")
    table = moves("--path", "programmed", written(folder, text))
    assert [move["z"] for move in table] == [[2.0, 2.0], [-3.0, -3.0], [-3.0, -5.0], *[[-5.0, -5.0]] * 3]


def test_z_that_is_not_known_is_null(folder: Path) -> None:
    text = FACES["fanuc"].replace("X50. Z2. C0", "X50. C0")
    assert moves("--tool", "1:radius=4", "--path", "tool", written(folder, text))[0]["z"] == [None, None]


def test_z_of_a_block_that_is_several_moves_goes_as_the_way_does(folder: Path) -> None:
    """Round an acute corner the control adds a line, which belongs to the latter block."""
    text = FACES["fanuc"].replace("G42 X30.\nC20.\nX-30.\nC0\n", "G42 X30. C-20.\nC20.\nX-20. C-15. Z-8.\n")
    table = [
        move for move in moves("--tool", "1:radius=4", "--path", "tool", written(folder, text)) if move["line"] == 10
    ]
    assert len(table) > 1
    way = [abs(complex(*move["end"]) - complex(*move["start"])) for move in table]
    done = np.concatenate(([0], np.cumsum(way))) / sum(way)
    for move, begin, end in zip(table, done[:-1], done[1:], strict=True):
        assert move["z"] == pytest.approx([-3 - 5 * begin, -3 - 5 * end], abs=1e-5)


# ---- offsets and programs from other files, the environment ----


def test_radii_come_from_an_offset_table(folder: Path) -> None:
    table = written(folder, "%\nG10 P10001 X0 Z0 R4. Q0\n%\n", "offsets.txt")
    name = written(folder, FACES["fanuc"])
    assert run("--path", "tool", "--offsets", table, name) == run("--path", "tool", "--tool", "1:radius=4", name)


def test_called_programs_are_run_and_their_moves_stand_at_the_call(folder: Path) -> None:
    (folder / "subs").mkdir()
    head, contour, tail = FACES["fanuc"].partition("G42 X30.\nC20.\nX-30.\nC0\nG40 X-44.\n")
    written(folder / "subs", f"%\nO7001\n(CONTOUR)\n(OF A FACE)\n{contour}M99\n%\n", "O7001")
    name = written(folder, f"{head}M98 P7001\n{tail}")
    taken = moves("--subprograms", "subs", "--tool", "1:radius=4", "--path", "tool", name)
    assert [move["line"] for move in taken] == [6, 8, 8, 8, 8, 8]
    whole = moves("--tool", "1:radius=4", "--path", "tool", written(folder, FACES["fanuc"], "b.nc"))
    assert [move["end"] for move in taken] == [move["end"] for move in whole]
    rows = moves("--subprograms", "subs", name)
    assert max(row["line"] for row in rows) == 11


def test_what_the_environment_says_to_check_does_not_disturb(folder: Path) -> None:
    name = written(folder, FACES["fanuc"])
    said = {"POLARCHECK_FORMAT": "concise", "POLARCHECK_BLOCK_SKIP": "both"}
    assert run(name, **said) == run(name)
    assert run(name, POLARCHECK_FORMAT="jsonl") == run(name, "--format", "jsonl")
    assert run(name, "--format", "csv", POLARCHECK_FORMAT="jsonl") == run(name)


# ---- one document, and golden files ----

#: The same program, renumbered and commented.
RENUMBERED = "".join(
    f"N{10 * number} {line}\n({number})\n\n" if line[0] not in "O" else f"{line}\n(MADE ANEW)\n"
    for number, line in enumerate(FACES["fanuc"].splitlines())
)
WITH_R = ("--tool", "1:radius=4")


def document(*arguments: str, code: int = 0) -> dict[str, Any]:
    made: dict[str, Any] = json.loads(call("--format", "json", *arguments, code=code).stdout)
    return made


def test_json_is_one_document_with_the_moves_of_json_lines(folder: Path) -> None:
    name = written(folder, FACES["fanuc"])
    made = document(*WITH_R, name)
    head = {key: made[key] for key in made if key not in ("units", "moves")}
    assert head == {"schema": 1, "version": __version__, "path": name, "machine": "fanuc", "requested": "tool"}
    assert made["moves"] == moves(*WITH_R, "--path", "tool", name)
    assert set(made["units"]) <= set(KEYS)
    assert (made["units"]["start"], made["units"]["c_feed"]) == ("mm", "deg/min")
    assert document("--path", "programmed", name)["requested"] == "programmed"


@pytest.mark.parametrize(
    "arguments",
    [(), ("--golden",), ("--path", "programmed", "--golden")],
    ids=["tool", "golden", "programmed"],
)
def test_the_document_fits_its_schema(folder: Path, arguments: tuple[str, ...]) -> None:
    check = jsonschema.Draft202012Validator(json_schema.schema("trace"))
    made = document(*WITH_R, *arguments, written(folder, FACES["fanuc"]))
    check.validate(made)
    changed = [{"units": {}}, {"schema": 2}, {"requested": "both"}, {"moves": [{"line": 1}]}]
    changed += [{"moves": [{**made["moves"][0], **move}]} for move in ({"kind": "arc"}, {"start": [1.0]})]
    assert not any(check.is_valid({**made, **change}) for change in changed)


def test_a_program_without_moves_gives_a_document_without_moves(folder: Path) -> None:
    assert document(written(folder, "O1\nM30\n"))["moves"] == []


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    "path", [(), ("--path", "tool"), ("--path", "programmed")], ids=["blocks", "tool", "programmed"]
)
@pytest.mark.parametrize("form", ["json", "jsonl", "csv"])
def test_a_golden_file_survives_renumbering_and_comments(folder: Path, form: str, path: tuple[str, ...]) -> None:
    options = (*WITH_R, *path, "--format", form)
    names = [written(folder, FACES["fanuc"], "a.nc"), written(folder, RENUMBERED, "b.nc")]
    plain, golden = ([run(*options, *more, name) for name in names] for more in ((), ("--golden",)))
    assert plain[0] != plain[1]
    assert golden[0] == golden[1]
    assert 'line":' not in golden[0].replace('"kind":"line"', "")
    assert run(*options, "--golden", written(folder, FACES["fanuc"].replace("C20.", "C21."))) != golden[0]


def test_a_golden_file_is_never_a_table_for_people(folder: Path) -> None:
    name = written(folder, FACES["fanuc"])
    for options in (("--format", "table"), ("--show", "path")):
        assert "--golden" in call(*options, "--golden", name, code=2).stderr


@pytest.mark.ci
@looped("form", [("--path", "tool"), ("--path", "tool", "--format", "table"), ("--format", "json")])
def test_the_exit_code_says_that_the_radius_is_not_known(folder: Path, form: tuple[str, ...]) -> None:
    name = written(folder, FACES["fanuc"])
    assert "no radius for T0101" in call(*form, name, code=1).stderr
    assert call(*form, *WITH_R, name).stderr == ""
    assert call("--path", "programmed", name).stderr == ""


def test_the_machine_is_its_id(folder: Path) -> None:
    (folder / "lathes").mkdir()
    machine = written(folder / "lathes", "inherits = 'fanuc-30i'\n", "nl2000.toml")
    name = written(folder, FACES["fanuc"])
    assert document(*WITH_R, "--machine", machine, name)["machine"] == "nl2000"
