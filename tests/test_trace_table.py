"""What `polarcheck trace` shows on a terminal: the numbers of its CSV, aligned, and no more than there is room for."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner

from polarcheck.commands import main
from polarcheck.reports.pages.aligned import Column, table

SAMPLES = Path(__file__).parent.parent / "sample_programs"
HEXAGON, DEPTHS = str(SAMPLES / "hexagon.nc"), str(SAMPLES / "three_depths.nc")
ARCS = """G21 G98 G40 T0808
G0 X60. C0
G12.1
G1 G42 X30. F100
G3 X0 C15. R15.
G1 X-30. (\x1b[31m RED \u202e)
G40 X-70.
G13.1
M30
"""


def run(*arguments: str) -> str:
    result = CliRunner().invoke(main, ["trace", *arguments])
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.fixture
def on_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("polarcheck.commands.trace.is_terminal", lambda stream: True)
    monkeypatch.setenv("LINES", "24")


def shown(text: str) -> list[dict[str, str]]:
    """The rows of a table by the names in its head: numbers end where their name does, words begin there."""
    head, units, *lines = text.splitlines()
    spans = [(found[0], *found.span()) for found in re.finditer(r"\S+", head)]
    rows = []
    for line in lines:
        row = {}
        for word in re.finditer(r"\S+", line[: len(head)]):
            name = next((name for name, first, last in spans if word.end() == last or word.start() == first), None)
            assert name, (line, word)
            row[name] = word[0]
        rows.append(row)
    assert units.split()[0] == "mm" or "mm/min" in units
    return rows


@pytest.mark.ci
@looped("path", [(), ("--path", "tool"), ("--path", "programmed")], one_in=2)
def test_the_table_has_the_numbers_of_the_csv(path: tuple[str, ...], tmp_path: Path) -> None:
    arcs = tmp_path / "arcs.nc"
    arcs.write_text(ARCS)
    for program in (DEPTHS, str(arcs)):
        asked = (*path, "--tool", "8:radius=4", program)
        rows = shown(run("--format", "table", *asked))
        expected = list(csv.DictReader(io.StringIO(run("--format", "csv", *asked))))
        assert len(rows) == len(expected) > 3
        told = set[str]()
        for row, all_of_it in zip(rows, expected, strict=True):
            told |= row.keys()
            for name, value in row.items():
                if re.fullmatch(r"-?[\d.]+", value):
                    assert float(value) == pytest.approx(
                        float(all_of_it[name]), abs=0.5 * 10 ** -len(value.partition(".")[2]) + 1e-9
                    )
                    assert not re.fullmatch(r"-0\.?0*", value)
                else:
                    assert value in (all_of_it[name] or "?", "?" if name == "feed" else "")
        assert {"line", "feed", "c_feed", "nearest"} <= told
        assert told <= expected[0].keys()


def test_what_says_nothing_is_left_out(tmp_path: Path) -> None:
    plain = tmp_path / "plain.nc"
    plain.write_text("G21 G98\nG0 X60. Z2. C0\nG12.1\nG1 X30. F100\nC10.\nX60.\nG13.1\nM30\n")
    head = run("--format", "table", str(plain)).splitlines()[0].split()
    assert not {"side", "tool", "offset_number", "radius", "program", "depth", "f"}.intersection(head)
    assert {"line", "x", "z", "c", "plane_x", "c_feed"}.issubset(head)
    assert run("--format", "table", "--path", "tool", str(SAMPLES.parent / "docs" / "trace.md")) == ""


@pytest.mark.nightly
@pytest.mark.usefixtures("on_terminal")
def test_a_terminal_shows_what_there_is_room_for(monkeypatch: pytest.MonkeyPatch) -> None:
    before = 0
    for columns in (20, 40, 60, 80, 100, 132, 250):
        monkeypatch.setenv("COLUMNS", str(columns))
        lines = run("--path", "tool", DEPTHS).splitlines()
        assert max(map(len, lines)) <= columns
        count = len(lines[0].split())
        assert count >= max(before, 2)
        before = count
    assert count == len(run("--path", "tool", "--format", "table", DEPTHS).splitlines()[0].split())
    assert any(line.endswith("M30") for line in run(HEXAGON).splitlines())


@pytest.mark.usefixtures("on_terminal")
def test_the_head_stands_on_each_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LINES", "13")
    lines = run(HEXAGON).splitlines()
    heads = [number for number, line in enumerate(lines) if line.startswith("line")]
    assert heads == [0, 12, 24]
    assert not run("--format", "csv", HEXAGON).startswith("line ")


def test_into_a_pipe_it_is_csv_as_ever() -> None:
    assert run(HEXAGON) == run("--format", "csv", HEXAGON)
    assert run(HEXAGON).startswith("line,program,")


def test_nothing_of_a_program_acts(tmp_path: Path) -> None:
    program = tmp_path / "hostile.nc"
    program.write_text(ARCS)
    text = run("--format", "table", "--tool", "8:radius=4", str(program))
    assert r"(\x1b[31m RED \u202e)" in text
    assert "\x1b" not in text
    assert "\u202e" not in text


def test_the_first_rows_stand_there_before_the_others_are_made() -> None:
    asked = list[int]()

    def text(row: int) -> str:
        asked.append(row)
        return "G1"

    values = np.arange(200_000) / 7
    first = next(table([Column("x", "mm", 0, values)], text, 80, None))
    assert len(asked) < 1000
    assert first.splitlines()[1] == "       mm"
    assert first.splitlines()[2] == "    0.000  G1"


def test_numbers_of_any_size_are_aligned() -> None:
    values = np.array([1e300, -1e-9, np.nan, np.inf, -123456.7894, 999999999.9996])
    lines = "".join(table([Column("x", "mm", 0, values)], lambda row: "", None, None)).splitlines()
    assert [line.strip() for line in lines[2:]] == ["1.000e+300", "0.000", "?", "inf", "-123456.789", "1000000000.000"]
    assert len({len(line) for line in lines}) == 1
