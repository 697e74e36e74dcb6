"""What the benchmarks compare with: programs with one fault each, and the same path for readers of mill programs."""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

import pytest
from cases import looped
from programs import ROOT, report_of, said

sys.path.insert(0, str(ROOT / "benchmarks"))

import compare_rs274
import generate
import measuring
import peers
import stages
from measuring import exponent, measured, table
from peer_faults import FAULTS, GOOD, TOOL
from xy_twin import tool_table, twin

pytestmark = pytest.mark.ci


def test_the_program_without_a_fault_passes() -> None:
    report = report_of(GOOD, "fanuc", TOOL)
    assert (report.verdict, said(report)) == ("pass", [])


@pytest.mark.nightly
@looped("name", FAULTS, one_in=12)
def test_one_fault_is_found_for_the_right_reason(name: str) -> None:
    fault = FAULTS[name]
    assert GOOD.count(fault.meant) >= 1
    report = report_of(GOOD.replace(fault.meant, fault.written, 1), "fanuc", TOOL)
    assert [rule for _, rule in said(report)] == [fault.rule]
    told = report.findings[0]
    assert re.search(fault.says, f"{told.rule} {told.message}", re.IGNORECASE)


TURNED = "%\nO0001 (X)\nN1 T0404 (MILL)\nN2 G28 U0 W0\nN3 G97 S2000 M33\nN4 G98\nN5 G12.1\nN6 G1 G42 X34.827 C0.217\n"
TURNED += "N7 G3 X34.665 C1.296 R10.14\nN8 G1 G40 X42.\nN9 G13.1\n%\n"


def test_the_twin_has_the_same_blocks_on_a_mill() -> None:
    assert twin(TURNED).splitlines() == [
        *("%", "", "N1 T4 M6", "N2", "N3 S2000", "N4 G94", "N5 G17", "N6 G1 X17.4135 Y0.217"),
        *("N7 G3 X17.3325 Y1.296 R10.14", "N8 G1 X21.", "N9 G18", "%"),
    ]
    compensated = twin(TURNED, compensated=True).splitlines()
    assert (compensated[7], compensated[9]) == ("N6 G1 G42 D4 X17.4135 Y0.217", "N8 G1 G40 X21.")
    assert twin(TURNED, sinumerik=True).splitlines()[8] == "N7 G3 X17.3325 Y1.296 CR=10.14"
    assert tool_table(2.0).splitlines()[3] == "T4 P4 D0.157480"


@pytest.mark.nightly
def test_a_long_step_is_milled_in_several_sections(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(generate, "LONGEST_SECTION", 3000)
    text = generate.program(20_000).decode()
    lines = text.splitlines()
    assert len(lines) == 20_002
    begins = [number for number, line in enumerate(lines) if "G12.1" in line]
    ends = [number for number, line in enumerate(lines) if "G13.1" in line]
    assert len(begins) == len(ends) > 6
    assert max(end - begin for begin, end in zip(begins, ends, strict=True)) <= 3000
    found = report_of(text, "fanuc", *(f"{number}:radius=2,nose=0" for number in range(4, 13)))
    assert said(found) == []


def test_processes_are_measured_in_turn() -> None:
    commands = {"one": [sys.executable, "-c", "pass"], "other": [sys.executable, "-c", "raise SystemExit(3)"]}
    taken = measured(commands, 1)
    assert [one.status for one in taken.values()] == [0, 3]
    assert all(one.cpu > 0 and one.clock > 0 and one.peak > 1e6 for one in taken.values())


def test_what_is_slow_runs_less_often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measuring, "run", lambda command: measuring.Taken(1.0, float(command[0]), 1, 0))
    taken = measured({"quick": ["1"], "slow": ["60"]}, 7)
    assert [one.runs for one in taken.values()] == [7, 3]


def test_what_needs_memory_runs_in_another_process() -> None:
    assert measuring.apart(os.getpid) != os.getpid()
    assert measuring.apart(int, "7") == 7


def test_a_table_is_one_of_markdown() -> None:
    assert table(["reader", "s"], [["one", "2"]]) == "| reader | s |\n| --- | ---: |\n| one | 2 |\n"


@looped(("power", "expected"), [(1, 1.0), (2, 2.0), (0, 0.0)])
def test_the_exponent_is_that_of_the_growth(power: int, expected: float) -> None:
    assert exponent([1e3, 1e4, 1e6], [5 * size**power for size in (1e3, 1e4, 1e6)]) == pytest.approx(expected)


def test_what_a_reader_repeats_is_no_message(tmp_path: Path) -> None:
    path = tmp_path / "one.nc"
    path.write_text("G1 X1.\nG13.1\n")
    said = "executing\n   12 N..... STRAIGHT_FEED(1)\nG1 X1.\n2 errors, 3 warnings\n  7 warning no G13.1 in line 4"
    assert peers._messages(said, path) == {"executing", "warning no G13.1 in"}


@pytest.mark.nightly
def test_the_page_is_written_without_any_peer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("RS274", "PEERS_PYTHON", "NCTAB", "NCPLOT7PY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(peers, "FAULTS", dict([next(iter(FAULTS.items()))]))
    monkeypatch.setattr(peers, "CASES", {"hexagon": peers.CASES["hexagon"]})
    monkeypatch.setattr(peers, "_MANY", 2)
    monkeypatch.setattr(peers, "_SAMPLES", 2)
    monkeypatch.setattr(peers, "_BLOCKS_OF_MANY", 1000)
    page = tmp_path / "page.md"
    monkeypatch.setattr(sys, "argv", ["peers", "--blocks", "1000", "--rounds", "1", "--quick", "-o", str(page)])
    peers.main()
    text = page.read_text()
    assert "Not installed there, and left out: LinuxCNC rs274, nc-gcode-interpreter, pygcode, nctab, ncplot7py." in text
    assert re.search(r"^\| polarcheck \| 0 \| 1 \| 1 \|$", text, re.MULTILINE)
    for name in ("hexagon", "plot", "60,000 times A", "400 LINEs with gaps"):
        assert re.search(rf"^\| {name} \| \d+\.\d\d \|", text, re.MULTILINE), name
    assert len(re.findall(r"^\| total \|", text, re.MULTILINE)) == 3


def test_one_part_of_the_page_is_printed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(peers.PARTS, "Long lines", lambda asked, folder: f"{asked.rounds} rounds\n")
    monkeypatch.setattr(sys, "argv", ["peers", "--only", "Long lines", "--rounds", "5"])
    peers.main()
    assert capsys.readouterr().out == "5 rounds\n"


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("rs274") is None, reason="there is no LinuxCNC here")
def test_inside_corners_and_arcs_of_random_contours_are_those_of_linuxcnc(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["compare_rs274", "--programs", "300"])
    assert compare_rs274.main() == 0


def test_time_of_libraries_counts_for_the_stages_that_call_them() -> None:
    """Through several functions of libraries, one that calls itself among them, in proportion to the calls."""
    package = ROOT / "polarcheck"
    modules = "columns/path/path", "columns/contour/overcuts"
    trace, overcuts = ((str(package / f"{name}.py"), 1, "column") for name in modules)
    contour, numpy, loaded = (
        (str(package / "geometry" / "contour.py"), 1, "cuts"),
        ("numpy.py", 1, "sort"),
        "<module>",
    )
    module = str(package / "rules" / "rule.py"), 1, loaded
    stats = {
        trace: (1, 1, 1.0, 3.0, {}),
        overcuts: (1, 1, 2.0, 10.0, {}),
        contour: (1, 1, 4.0, 8.0, {overcuts: (1, 1, 4.0, 8.0)}),
        numpy: (2, 3, 8.0, 8.0, {trace: (1, 1, 2.0, 2.0), contour: (1, 1, 6.0, 6.0), numpy: (1, 1, 1.0, 1.0)}),
        module: (1, 1, 16.0, 16.0, {}),
    }
    spent = {stage: time for stage, time in stages.seconds_by_stage(stats).items() if time}
    assert spent == {"columns": 3.0, "faces": 12.0, "start": 16.0}


def test_each_package_and_table_has_a_stage() -> None:
    package = ROOT / "polarcheck"
    for name in stages.OF_TABLE:
        assert [*(package / "columns").glob(f"*/{name}.py")], name
    for name in stages.OF_ROOM:
        assert (package / name).exists() or (package / f"{name}.py").exists(), name
    assert {*stages.OF_ROOM.values(), *stages.OF_TABLE.values()} <= {*stages.STAGES}


@pytest.mark.nightly
def test_a_check_is_profiled(tmp_path: Path) -> None:
    path = tmp_path / "sound.nc"
    path.write_text(GOOD)
    lines = stages.stages(path, "--no-config", "--fail-on", "never").splitlines()
    assert [line.split(" | ")[0].strip("| ") for line in lines[2:]] == [*stages.STAGES, "total"]
