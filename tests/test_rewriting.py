"""What all commands that rewrite a program share: where the new program goes, what is said of it, the exit code."""

from __future__ import annotations

import json
import os
from pathlib import Path

import click
import jsonschema
import pytest
from click.testing import CliRunner, Result
from polarcheck.errors import MachineError, TooHardError

from polarcheck.commands import Commands
from polarcheck.commands.rewriting import Command, length, rewriting
from polarcheck.files.settings.of_programs import OfPrograms, Options, on_machine, profile_of
from polarcheck.rewrite.schemas import schema
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Decision, Figure, Outcome, Refusal, RefusedError
from polarcheck.rewrite.writing.rewritten_program import in_mm

pytestmark = pytest.mark.usefixtures("own_folder")

PROGRAM = "%\nO1\nG21 G98 G0 X60. C0 T0101\nG12.1\nG1 X40. F100\nC10.\nX60.\nG13.1\nM88\nM30\n%\n"
NEW = PROGRAM.replace("F100", "F90").replace("M88", "(DECIDE)")


def faster(original: Original) -> Outcome:
    """A stand-in for the functions of rewrite/: F90 for F100, and M88 is somebody's decision."""
    if b"G2 " in original.data:
        raise RefusedError([Refusal(5, "an arc \x1b[31m"), Refusal(0, "the whole")] + [Refusal(6, "more")] * 20)
    data = original.data.replace(b"F100", b"F90").replace(b"M88", b"(DECIDE)")
    lines = list(range(1, data.count(b"\n") + 1))
    decisions = [Decision(9, "M88 has no meaning")] if b"M88" in original.data else []
    figures = [
        Figure("largest distance", in_mm(original, 1.0), "mm"),
        Figure("blocks", 12),
        Figure("C rate", 1234.56, "deg/min"),
        Figure("time", float("nan"), "s"),
    ]
    return Outcome(data, lines, decisions, figures, ["line 5: F is lower"])


def call(*arguments: str | Path, source: str | bytes | None = None) -> Result:
    @click.group(cls=Commands, commands={})
    def main() -> None:
        """Stand in for the command line."""

    @main.command()
    @rewriting(length("--chord-error", default=0.005, text="how far"))
    def slow(chord_error: float | None) -> Command:
        """Slow a program down."""
        return Command("unroll", "slowed down", lambda settings: faster)

    return CliRunner().invoke(main, ["slow", *map(str, arguments)], input=source, prog_name="polarcheck")


@pytest.fixture
def program() -> Path:
    Path("a.nc").write_text(PROGRAM)
    return Path("a.nc")


# ---- where the new program goes ----


def test_the_new_program_is_printed_and_what_was_done_is_said_beside_it(program: Path) -> None:
    result = call(program)
    assert (result.exit_code, result.stdout) == (1, NEW)
    assert result.stderr.splitlines() == [
        "polarcheck: a.nc: slowed down, from 11 lines to 11",
        "polarcheck: a.nc: largest distance: 1.0000 mm",
        "polarcheck: a.nc: blocks: 12",
        "polarcheck: a.nc: C rate: 1235 deg/min",
        "polarcheck: a.nc: time: not known",
        "polarcheck: a.nc: line 5: F is lower",
        "polarcheck: a.nc:9: to decide: M88 has no meaning",
        "polarcheck: a.nc: 1 to decide before it runs; a comment in the new program marks each",
    ]
    assert program.read_text() == PROGRAM
    assert call(program, "-q").stderr.splitlines() == result.stderr.splitlines()[-2:]


def test_nothing_to_decide_ends_with_0(program: Path) -> None:
    program.write_text(PROGRAM.replace("M88\n", "").replace("G21", "G20"))
    result = call(program, "-o", "new.nc")
    assert (result.exit_code, result.stdout) == (0, "")
    assert "polarcheck: a.nc: slowed down, from 10 lines to 10: new.nc\n" in result.stderr
    assert "largest distance: 25.4000 mm" in result.stderr
    assert Path("new.nc").read_text() == NEW.replace("(DECIDE)\n", "").replace("G21", "G20")


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_bytes_stay_as_they_are(program: Path, ending: str) -> None:
    text = PROGRAM.replace("O1", "O1 (\xc4\x00)").replace("\n", ending).encode("latin-1")
    program.write_bytes(text)
    new = text.replace(b"F100", b"F90").replace(b"M88", b"(DECIDE)")
    assert call(program).stdout_bytes == new
    assert call("-", source=text).stdout_bytes == new
    assert call(program, "--in-place", "--backup").exit_code == 1
    assert (program.read_bytes(), Path("a.nc.orig").read_bytes()) == (new, text)


def test_a_folder_takes_a_file_of_the_same_name(program: Path) -> None:
    Path("new").mkdir()
    assert call(program, "-o", "new").exit_code == 1
    assert Path("new/a.nc").read_text() == NEW
    assert call("-", "-o", "new", "--stdin-filename", "b.nc", source=PROGRAM).exit_code == 1
    assert Path("new/b.nc").read_text() == NEW
    result = call("-", "-o", "new", source=PROGRAM)
    assert (result.exit_code, result.stderr) == (
        2,
        "polarcheck: -o new: a folder; name the file, or give --stdin-filename\n",
    )
    assert call(program, "-o", "made/in/b.nc").exit_code == 1
    assert Path("made/in/b.nc").read_text() == NEW
    assert call(program, "-o", "a.nc/b.nc").stderr == "polarcheck: a.nc: File exists\n"


def test_no_file_is_overwritten_by_mistake(program: Path) -> None:
    os.link(program, "twin.nc")
    Path("link.nc").symlink_to("a.nc")
    for other in ("a.nc", "./a.nc", "twin.nc", "link.nc", "."):
        for force in ((), ("--force",)):
            result = call(program, "-o", other, *force)
            assert (result.exit_code, result.stdout) == (2, "")
            assert result.stderr.endswith("is read by this run; name another file\n")
    Path("twin.nc").unlink()
    Path("there.nc").write_text("M30\n")
    result = call(program, "-o", "there.nc")
    assert (result.exit_code, result.stderr) == (
        2,
        "polarcheck: -o there.nc: it is there already; --force replaces it\n",
    )
    assert call(program, "-o", "there.nc", "--force").exit_code == 1
    assert Path("there.nc").read_text() == NEW
    Path("polarcheck.toml").write_text("units = 'mm'\n")
    assert "is read by this run" in call(program, "-o", "polarcheck.toml", "--force").stderr
    assert program.read_text() == PROGRAM


def test_a_program_is_overwritten_on_demand_and_kept(program: Path) -> None:
    result = call(program, "--in-place")
    assert (result.exit_code, program.read_text()) == (2, PROGRAM)
    assert "give --backup, too, which keeps it as a.nc.orig" in result.stderr.replace("FILE", "a.nc")
    Path("a.nc.orig").write_text("another")
    result = call(program, "--in-place", "--backup")
    assert (result.exit_code, program.read_text()) == (2, PROGRAM)
    assert "a.nc: not written: a.nc.orig is there already, and differs; move it away" in result.stderr
    Path("a.nc.orig").unlink()
    assert call(program, "--in-place", "--backup").exit_code == 1
    assert (program.read_text(), Path("a.nc.orig").read_text()) == (NEW, PROGRAM)
    again = call(program, "--in-place", "--backup")
    assert (again.exit_code, again.stderr.splitlines()[0]) == (0, "polarcheck: a.nc: nothing to change")
    assert again.stdout == ""
    assert json.loads(call(program, "--in-place", "--backup", "--format", "json").stdout)["files"][0]["written"] is None
    assert Path("a.nc.orig").read_text() == PROGRAM


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("a.nc", "--diff", "-o", "b.nc"), "--diff shows what would change, and writes nothing: leave out -o"),
        (("a.nc", "--diff", "--in-place"), "writes nothing: leave out --in-place"),
        (("a.nc", "--diff", "--format", "json"), "writes nothing: leave out --format json"),
        (("a.nc", "-o", "b.nc", "--in-place"), "--in-place writes over the program: leave out -o"),
        (("-", "--in-place", "--backup"), "--in-place: expected a file, found standard input"),
        (("a.nc", "-o", ""), "-o: expected the name of a file or folder"),
        (("gone.nc",), "gone.nc: No such file"),
        (("a.nc", "--chord-error", "0"), "0: expected a length above 0 and up to 1, such as 0.005"),
        (("a.nc", "--chord-error", "nan"), "nan: expected a length above 0"),
        (("a.nc", "--machine", "okma-osp"), "did you mean okuma-osp?"),
        (("a.nc", "--max-size", "10"), "--max-size SIZE raises the limit"),
    ],
)
def test_what_cannot_be_done_is_one_line(program: Path, arguments: tuple[str, ...], message: str) -> None:
    result = call(*arguments, source="")
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr
    assert result.stderr.count("\n") == 1


def test_options_without_effect_are_warnings(program: Path) -> None:
    assert "warning: --force does nothing without -o\n" in call(program, "--force").stderr


@pytest.mark.ci
def test_many_programs_go_to_a_folder_and_none_stops_the_others(program: Path) -> None:
    Path("jobs/left").mkdir(parents=True)
    for name, text in {"a.nc": PROGRAM, "left/b.nc": PROGRAM, "c.nc": PROGRAM.replace("C10.", "G2 X30. R9.")}.items():
        Path("jobs", name).write_text(text)
    result = call("jobs", "-o", "new")
    assert (result.exit_code, result.stdout) == (2, "")
    assert {str(path): path.read_text() for path in Path("new").rglob("*.nc")} == dict.fromkeys(
        ["new/a.nc", "new/left/b.nc"], NEW
    )
    assert "polarcheck: jobs/c.nc: not slowed down: nothing is written\n" in result.stderr
    assert call("jobs/a.nc", "gone.nc", "jobs/left", "-o", "newer").exit_code == 2
    assert sorted(Path("newer").iterdir()) == [Path("newer/a.nc"), Path("newer/b.nc")]
    report = json.loads(call("jobs", "--format", "json").stdout)
    assert [(file["path"], len(file["refusals"])) for file in report["files"]] == [
        ("jobs/a.nc", 0), ("jobs/c.nc", 22), ("jobs/left/b.nc", 0),
    ]  # fmt: skip
    assert call("jobs", "--diff").stdout.count("--- jobs/") == 2


def test_a_file_that_cannot_be_read_in_its_encoding_stops_no_other(program: Path) -> None:
    Path("bad.nc").write_bytes(b"%\nO1 (\xc4)\nM30\n%\n")
    result = call("bad.nc", "a.nc", "--encoding", "utf-8", "-o", "new/")
    assert result.exit_code == 2
    assert Path("new/a.nc").read_text() == NEW
    report = json.loads(call("bad.nc", "a.nc", "--encoding", "utf-8", "--format", "json").stdout)
    assert [(file["path"], file["lines"]) for file in report["files"]] == [("bad.nc", 0), ("a.nc", PROGRAM.count("\n"))]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("a.nc", "jobs"), "several programs: expected -o FOLDER, --in-place or --diff"),
        (("a.nc", "jobs", "-o", "there"), "-o there: expected a folder for several programs, found a file"),
        (("a.nc", "jobs", "-o", "new"), "-o new/a.nc: two programs would be written to this file"),
    ],
)
def test_many_programs_need_many_files(program: Path, arguments: tuple[str, ...], message: str) -> None:
    Path("jobs").mkdir()
    Path("jobs/a.nc").write_text(PROGRAM)
    Path("there").write_text("")
    result = call(*arguments)
    assert (result.exit_code, result.stderr, Path("new").exists()) == (2, f"polarcheck: {message}\n", False)


def test_a_bug_is_no_program(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(original: Original) -> Outcome:
        raise KeyError("\x1b[31m")

    monkeypatch.setitem(globals(), "faster", wrong)
    result = call(program, "-o", "new.nc")
    assert (result.exit_code, result.stdout, Path("new.nc").exists()) == (3, "", False)
    assert result.stderr.startswith("polarcheck: internal error: KeyError: '\\x1b[31m', in a.nc; run with --debug")


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (TooHardError("takes longer"), "polarcheck: a.nc: takes longer\n"),
        (MemoryError(), "polarcheck: a.nc: there is not enough memory\n"),
    ],
)
def test_a_program_that_takes_too_much_is_named(
    program: Path, monkeypatch: pytest.MonkeyPatch, error: Exception, message: str
) -> None:
    def hard(original: Original) -> Outcome:
        raise error

    monkeypatch.setitem(globals(), "faster", hard)
    result = call(program)
    assert (result.exit_code, result.stdout, result.stderr) == (2, "", message)


# ---- what is said ----


def test_a_diff_shows_and_writes_nothing(program: Path) -> None:
    result = call(program, "--diff")
    assert result.exit_code == 1
    assert result.stdout.startswith("--- a.nc\n+++ a.nc\n@@ -2,10 +2,10 @@\n")
    assert "-G1 X40. F100\n+G1 X40. F90\n" in result.stdout
    assert "to decide: M88" in result.stderr
    assert "\x1b[32m+G1 X40. F90\x1b[0m\n" in call(program, "--diff", "--color", "always").stdout
    assert program.read_text() == PROGRAM
    program.write_text(NEW)
    result = call(program, "--diff")
    assert (result.exit_code, result.stdout) == (0, "")


def test_what_is_refused_is_said_with_its_lines_and_nothing_is_written(program: Path) -> None:
    program.write_text(PROGRAM.replace("C10.", "G2 X30. C10. R90."))
    result = call(program, "-o", "new.nc")
    assert (result.exit_code, result.stdout, Path("new.nc").exists()) == (2, "", False)
    lines = result.stderr.splitlines()
    assert lines[:2] == ["polarcheck: a.nc:5: an arc \\x1b[31m", "polarcheck: a.nc: the whole"]
    assert lines[-2:] == ["polarcheck: a.nc: 2 more reasons", "polarcheck: a.nc: not slowed down: nothing is written"]


def test_a_program_for_another_control_is_refused(program: Path) -> None:
    program.write_text(PROGRAM.replace("G12.1", "G112").replace("G13.1", "G113").replace("C10.", "Y10."))
    result = call(program, "--machine", "fanuc-30i")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("polarcheck: a.nc:6: read for fanuc-30i, it means something else: ")


def test_a_program_that_runs_otherwise_with_block_skip_waits_for_a_choice(program: Path) -> None:
    program.write_text(PROGRAM.replace("C10.", "/C10."))
    result = call(program)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "choose with --block-skip on or off" in result.stderr
    assert call(program, "--block-skip", "off").exit_code == 1


def test_json_says_what_comes_of_it(program: Path) -> None:
    valid = jsonschema.Draft202012Validator(schema("rewriting"))
    result = call(program, "--format", "json", "-o", "new.nc")
    report = json.loads(result.stdout)
    valid.validate(report)
    assert (result.exit_code, result.stderr, Path("new.nc").read_text()) == (1, "", NEW)
    file = report["files"][0]
    assert file["written"] == "new.nc"
    assert file["decisions"] == [{"line": 9, "text": "M88 has no meaning"}]
    assert file["figures"][3] == {"name": "time", "value": None, "unit": "s"}
    program.write_text(PROGRAM.replace("C10.", "G2 X30. C10. R90."))
    result = call(program, "--format", "json")
    report = json.loads(result.stdout)
    valid.validate(report)
    file = report["files"][0]
    assert (result.exit_code, file["new_lines"], file["written"]) == (2, None, None)
    assert file["refusals"][:2] == [{"line": 5, "text": "an arc \x1b[31m"}, {"line": None, "text": "the whole"}]


def test_a_terminal_gets_no_character_that_controls_it(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program.write_bytes(PROGRAM.replace("O1", "O1 (\x1b[31m)").replace("\n", "\r\n").encode())
    monkeypatch.setattr("polarcheck.commands.new_programs.is_terminal", lambda stream: True)
    assert call(program).stdout.splitlines()[:3] == ["%", "O1 (\\x1b[31m)", "G21 G98 G0 X60. C0 T0101"]


def test_many_lines_are_counted(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def many(original: Original) -> Outcome:
        return Outcome(b"M30\n", [1, 2], [Decision(0, str(index)) for index in range(25)], [], ["note"] * 25)

    monkeypatch.setitem(globals(), "faster", many)
    lines = call(program).stderr.splitlines()
    assert "polarcheck: a.nc: 5 more notes" in lines
    assert "polarcheck: a.nc: to decide: 19" in lines
    assert "polarcheck: a.nc: 5 more to decide" in lines


def test_a_disk_that_is_full_leaves_no_file(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    result = call(program, "-o", "new.nc")
    assert (result.exit_code, result.stderr) == (2, "polarcheck: new.nc: No space left on device\n")
    assert list(Path().iterdir()) == [program]


# ---- the settings of the other lathe ----


def test_the_other_lathe_gets_the_tools_and_not_the_limits_of_this_one(program: Path) -> None:
    Path("polarcheck.toml").write_text(
        "machine = 'fanuc-30i'\nselect = ['polar']\ntools.1.radius = 4.0\nlimits.c_feed = 77.0\n"
    )
    settings = OfPrograms(Options(changes=("limits.x_feed=99",)))("a.nc")
    other = on_machine(settings, "haas-lathe")
    assert (other.machine_id, other.job.machine) == ("haas-lathe", "haas-lathe")
    assert other.job.tools == settings.job.tools
    assert (settings.machine.limits.c_feed, settings.machine.limits.x_feed) == (77.0, 99.0)
    assert other.machine.limits == profile_of("haas-lathe").machine.limits
    assert len(other.rules) > len(settings.rules)
    with pytest.raises(MachineError, match="did you mean haas-lathe"):
        on_machine(settings, "haas-late")
