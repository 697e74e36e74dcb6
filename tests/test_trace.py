"""What `polarcheck trace` prints is a contract."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from polarcheck.commands import main

SAMPLES = Path(__file__).parent.parent / "sample_programs"
KEYS = ["line", "section", "kind", "start", "end", "center", "feed", "x_axis", "c_axis", "nearest", "c_feed", "time"]


def run(*arguments: str) -> str:
    result = CliRunner().invoke(main, ["trace", *arguments])
    assert result.exit_code == 0, result.output
    return result.stdout


def moves(*arguments: str) -> list[dict[str, object]]:
    return [json.loads(line) for line in run("--format", "jsonl", *arguments).splitlines()]


@pytest.mark.parametrize("path", ["tool", "programmed"])
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
            strict=True,  # type: ignore[arg-type]
        ):
            assert x >= 0
            turned = x * np.exp(1j * np.radians(c))
            assert turned == pytest.approx(complex(*point), abs=1e-5)  # type: ignore[misc]


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


def test_without_the_radius_the_path_of_the_tool_is_the_programmed_one_and_says_so() -> None:
    name = str(SAMPLES / "hexagon.nc")
    unknown = [move for move in moves("--no-config", "--path", "tool", name) if move["c_feed"] is None]
    assert unknown
    assert all(move["nearest"] is None for move in unknown)
    taken = run("--no-config", "--tool", "1:radius=4", "--path", "tool", "--format", "jsonl", name)
    assert "null" not in taken.replace('"center":null', "")
