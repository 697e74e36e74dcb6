"""No output takes the place of a file that its run has read, by whatever name, and however the run came to read it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from polarcheck.errors import OutputError
from programs import ROOT
from test_certify import certify
from test_cli import call
from test_deviations import polygon, program
from test_drawing_options import dxf

from polarcheck.foundation import record
from polarcheck.program.reading import files

pytestmark = [
    pytest.mark.usefixtures("own_folder"),
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such links"),
]

CALLER = "O0001\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P9000\nG13.1\nM30\n"
CALLED = "O9000\nG1 C5.\nM99\n"


def contents() -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in sorted(Path().rglob("*")) if path.is_file()}


def refused(*words: str) -> str:
    """The one line of a command that refuses, and changes nothing."""
    before = contents()
    result = call(*words)
    assert result.exit_code == 2, result.output
    assert {name: data for name, data in contents().items() if name in before} == before
    lines: list[str] = [line for line in result.stderr.splitlines() if "; name another file" in line]
    assert len(lines) == 1, result.output
    return lines[0].removeprefix("polarcheck: ")


def with_names(name: str) -> dict[str, str]:
    """The file itself, and other names that lead to it, each with what is said of the file."""
    Path("linked").symlink_to(os.path.dirname(name) or ".")  # noqa: PTH120
    Path("link.out").symlink_to(name)
    os.link(name, "twin.out")
    itself = "it is read by this run"
    beside = f"{Path(name).name}, which is read by this run"
    through = f"linked/{Path(name).name}"
    return {name: itself, f"./{name}": "read by this run", "link.out": beside, "twin.out": beside, through: beside}


# ---- what a manifest names ----


@pytest.fixture
def post() -> None:
    shutil.copytree(ROOT / "docs" / "certify", ".", dirs_exist_ok=True)
    dxf(Path("c2.dxf"), {"0": polygon(6, 13.5)})
    Path("table.out").write_text("%\nG10 L10 P1 R4.\n%\n")
    Path("job").write_text("strict = false\n")
    manifest = Path("post.toml").read_text()
    case = '[[case]]\nname = "more"\nfeature = "contour"\ncontrol = "lathe-7"\nprogram = "fanuc/contour.nc"\n'
    case += 'config = "job"\noffsets = "table.out"\n[[case.part]]\ndrawing = "c2.dxf"\n'
    Path("post.toml").write_text(f"{manifest}\n{case}")


@pytest.mark.ci
@pytest.mark.one_in(4)
@pytest.mark.parametrize("case", [(), ("--case", "more"), ("--case", "contour/lathe-8")])
@pytest.mark.parametrize("name", ["c2.dxf", "table.out", "job", "golden/indexing.jsonl"])
def test_a_certificate_takes_the_place_of_nothing_that_its_manifest_names(
    post: None, name: str, case: tuple[str, ...]
) -> None:
    for output, said in with_names(name).items():
        assert said in refused("certify", "post.toml", *case, "-o", f"json:{output}")


@pytest.mark.nightly
def test_a_golden_trace_that_is_not_there_yet_is_that_of_the_update(post: None) -> None:
    Path("golden/indexing.jsonl").unlink()
    said = "-o golden/indexing.jsonl: is a golden trace of the manifest; name another file"
    assert refused("certify", "post.toml", "--update", "-o", "json:./golden/indexing.jsonl") == said
    assert certify("post.toml", "--update", "-o", "json:new.json").exit_code in (0, 1)
    assert Path("golden/indexing.jsonl").stat().st_size > 100
    assert certify("post.toml", "--update", "-o", "json:new.json").exit_code in (0, 1)


# ---- what a job names ----


def with_job() -> None:
    for folder in ("jobs", "subs/v", "extended"):
        Path(folder).mkdir(parents=True)
    texts = {
        "jobs/polarcheck.toml": 'extend = "../extended/base.job"\noffsets = "../table"\nbaseline = "../known.json"\n'
        'machine = "./lathe"\n[run]\nsubprograms = ["../subs"]\n[[part]]\ndrawing = "../c2.dxf"\n',
        "extended/base.job": "strict = false\n",
        "jobs/lathe": 'inherits = "parent"\n',
        "jobs/parent": 'inherits = "fanuc-30i"\n',
        "table": "%\nG10 L10 P8 R4.\n%\n",
        "jobs/a.nc": CALLER,
        "jobs/b.nc": CALLER,
        "subs/v/face.txt": CALLED,
    }
    for name, text in texts.items():
        Path(name).write_text(text)
    Path("subs/O9000").symlink_to("v/face.txt")
    dxf(Path("c2.dxf"), {"0": polygon(6, 13.5)})
    assert call("baseline", "create", "jobs", "-o", "known.json", "--no-config").exit_code == 0


#: Commands that write beside what they read; {} is the output.
WRITING: dict[str, tuple[str, ...]] = {
    "check": ("check", "jobs", "-o", "json:{}"),
    "html": ("check", "jobs/a.nc", "-o", "html:{}"),
    "two processes": ("check", "jobs", "-o", "json:{}", "--jobs", "2"),
    "plot": ("plot", "jobs/a.nc", "-o", "{}"),
    "convert": ("convert", "jobs/a.nc", "--to", "haas-lathe", "--force", "-o", "{}"),
    "unroll": ("unroll", "jobs/a.nc", "--tool", "8:radius=4", "--force", "-o", "{}"),
    "roll": ("roll", "jobs/a.nc", "--force", "-o", "{}"),
    "compensate": ("compensate", "jobs/a.nc", "--force", "-o", "{}"),
}
INPUTS = ("extended/base.job", "jobs/lathe", "jobs/parent", "table", "known.json", "c2.dxf", "jobs/a.nc")


@pytest.mark.one_in(8)
@pytest.mark.nightly
@pytest.mark.parametrize("name", INPUTS)
@pytest.mark.parametrize("command", WRITING)
def test_no_command_takes_the_place_of_what_settles_how_it_runs(command: str, name: str) -> None:
    with_job()
    for output, said in with_names(name).items():
        assert said in refused(*(word.format(output) for word in WRITING[command]))


@pytest.mark.one_in(3)
@pytest.mark.nightly
@pytest.mark.parametrize("options", [(), ("--jobs", "2"), ("--no-cache",)])
def test_what_only_the_check_finds_stays_too(options: tuple[str, ...]) -> None:
    """A link leads from the folder of subprograms to the called file, which has no name of a program."""
    with_job()
    Path("twin.out").hardlink_to("subs/v/face.txt")
    for output in ("subs/v/face.txt", "twin.out"):
        for _ in range(2):  # the second time the cache knows the outcome
            assert "read by this run" in refused("check", "jobs", "-o", f"json:{output}", *options)
    assert call("check", "jobs", "-o", "json:new.json", *options).exit_code in (0, 1)
    assert Path("new.json").exists()


@pytest.mark.nightly
def test_a_report_of_last_time_is_written_anew() -> None:
    with_job()
    for _ in range(2):
        assert call("check", "jobs", "-o", "json:r.json", "-o", "text:jobs/REPORT").exit_code in (0, 1)
    assert Path("r.json").stat().st_size > 100


@pytest.mark.ci
def test_standard_input_is_read_too() -> None:
    Path("given").write_text(CALLER)
    with Path("given").open() as given:
        words = [sys.executable, "-m", "polarcheck", "check", "-", "-o", "json:given"]
        result = subprocess.run(words, stdin=given, capture_output=True, text=True, check=False)
    assert (result.returncode, Path("given").read_text()) == (2, CALLER)
    assert "which is read by this run" in result.stderr


@pytest.mark.ci
def test_the_summary_of_a_step_is_appended_to_no_file_of_the_run() -> None:
    with_job()
    before = contents()
    result = call("check", "jobs/a.nc", "--format", "github", "--no-cache", GITHUB_STEP_SUMMARY="table")
    assert result.exit_code == 2
    assert "GITHUB_STEP_SUMMARY: table: it is " in result.stderr
    assert contents() == before


@pytest.mark.nightly
def test_a_baseline_a_fix_and_a_new_program_in_place_are_written() -> None:
    with_job()
    assert call("baseline", "update", "jobs", "-q").exit_code == 0
    assert call("baseline", "prune", "jobs", "-o", "known.json", "-q").exit_code == 0
    Path("c.nc").write_text(program(polygon(6, 13.5)).replace("G12.1", "G12.1 (X"))
    assert call("check", "c.nc", "--fix").exit_code in (0, 1)
    call("convert", "jobs/b.nc", "--to", "haas-lathe", "--in-place", "--backup")
    assert Path("jobs/b.nc.orig").read_text() == CALLER


# ---- the record ----


@pytest.mark.parametrize("leads", [os.link, os.symlink, shutil.move])
def test_a_file_is_known_by_what_it_is(leads: Callable[[str, str], None]) -> None:
    Path("a").write_text("1")
    Path("b").write_text("2")
    with record.recorded() as read:
        files.read_program("a")
        assert read.same_file("b") is None
        assert read.same_file("./a") == "a"
        leads("a", "c")
        if Path("a").exists():
            assert read.same_file("c") == "a"
            with pytest.raises(OutputError, match="c: it is a, which is read by this run"):
                files.write(Path("c"), "3")
        files.write(Path("b"), "3")
    files.write(Path("c"), "3")


def test_a_number_that_another_file_has_meanwhile_is_no_sign() -> None:
    Path("a").write_text("1")
    with record.recorded() as read:
        files.read_program("a")
        assert read.same_file("x") is None
        number = Path("a").stat().st_ino
        Path("a").rename("moved")
        assert Path("moved").stat().st_ino == number
        Path("a").write_text("new")
        assert read.same_file("moved") is None


def test_what_is_remembered_is_recorded_again() -> None:
    known: record.Remembered[str, bytes] = record.Remembered()
    Path("a").write_text("1")
    for _ in range(2):
        with record.recorded() as outer, record.recorded() as inner:
            assert known.get("x", lambda: files.read_program("a")) == b"1"
        assert [*outer.paths] == [*inner.paths] == ["a"]
