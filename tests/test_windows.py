"""What Windows does otherwise, simulated as far as that can be: code pages, drives, wildcards, what Python lacks."""

from __future__ import annotations

import errno
import os
import select
import signal
import subprocess
import sys
from pathlib import Path, PureWindowsPath
from types import SimpleNamespace
from typing import Any

import pytest
from polarcheck.errors import OutputError
from test_cli import IMPORTED_FROM, RAPID, call, check, make

from polarcheck.commands import main, output, overwriting, signals, wildcards
from polarcheck.foundation import bounded, memory
from polarcheck.program.reading import files, walking

pytestmark = pytest.mark.usefixtures("own_folder")

needs_posix = pytest.mark.skipif(sys.platform == "win32", reason="simulates Windows on a system of another kind")

#: Of Western Europe and its consoles, of the United States, of Japan and of China.
CODE_PAGES = ("cp1252", "cp850", "cp437", "cp932", "cp936")
NAME = "Fräser_ü_漢.nc"


# ---- code pages ----


def run(page: str, *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of a process whose streams have a code page."""
    told = {**os.environ, "PYTHONPATH": IMPORTED_FROM, "PYTHONUTF8": "0", "PYTHONIOENCODING": page}
    command = [sys.executable, "-m", "polarcheck", *arguments]
    done = subprocess.run(command, env=told, capture_output=True, stdin=subprocess.DEVNULL, timeout=60)
    return done.returncode, done.stdout.decode(page), done.stderr.decode(page)


def held(text: str, page: str) -> str:
    """A text with what a code page does not have spelled out."""
    return text.encode(page, "backslashreplace").decode(page)


@pytest.mark.ci
@pytest.mark.one_in(5)
@pytest.mark.parametrize("page", CODE_PAGES)
def test_people_are_told_in_every_code_page_and_files_are_utf_8(page: str) -> None:
    Path(NAME).write_bytes(f"O0001(FRÄSER Ø8 ÖL 漢)\n{RAPID.replace('G0 C5.', 'G0 C5. (Ä 漢)')}".encode())
    reports = ("-o", "json:out.json", "-o", "text:out.txt")
    code, shown, errors = run(page, "check", NAME, "fehlt_ü_漢.nc", "--select", "rapid-in-polar", *reports)
    assert code == 2
    assert f"at   {held(NAME, page)}:5:1\n" in shown.replace("\r\n", "\n")
    assert f"5 | {held('G0 C5. (Ä 漢)', page)}" in shown
    assert errors.startswith(f"polarcheck: {held('fehlt_ü_漢.nc', page)}: ")
    assert len(errors.splitlines()) == 1
    for name in ("out.json", "out.txt"):
        assert NAME in Path(name).read_bytes().decode("utf-8")


class Console:
    """A console of Windows: it takes characters; bytes would be shown in its code page."""

    encoding = "utf-8"
    errors = "strict"

    def __init__(self) -> None:
        self.shown = ""

    def write(self, text: str) -> int:
        assert isinstance(text, str)
        self.shown += text
        return len(text)

    def flush(self) -> None:
        pass

    def isatty(self) -> bool:
        return True


def test_a_console_is_shown_characters(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output, "ON_WINDOWS", True)
    monkeypatch.setattr(sys, "stdout", console := Console())
    assert output.show('{"path": "Fräser.nc"}\n'.encode())
    assert console.shown == '{"path": "Fräser.nc"}\n'


@pytest.mark.parametrize(("on_windows", "expected"), [(True, True), (False, False)])
def test_a_reader_that_has_gone_is_an_invalid_argument_on_windows(
    on_windows: bool, expected: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(output, "ON_WINDOWS", on_windows)
    assert output.nobody_reads(OSError(errno.EINVAL, "Invalid argument")) == expected
    assert output.nobody_reads(BrokenPipeError())
    assert not output.nobody_reads(OSError(errno.ENOSPC, "No space left on device"))


# ---- paths ----


def outputs(*written: str) -> list[tuple[str, Path]]:
    command = main.get_command(SimpleNamespace(), "check")  # type: ignore[arg-type]  # the context is not asked for
    assert command is not None
    found: list[tuple[str, Path]] = command.make_context("check", ["x.nc", *written]).params["outputs"]
    return found


@pytest.mark.parametrize(
    "path",
    ["C:\\out\\report.json", "C:report.json", "\\\\server\\share\\report.json", "//server/share/my report.json", "a:b"],
)
def test_a_report_goes_to_a_drive_or_a_share(path: str) -> None:
    assert outputs("-o", f"json:{path}") == [("json", Path(path))]


def test_a_drive_is_no_format() -> None:
    make(a__nc=RAPID)
    result = check("a.nc", "-o", "C:\\out.json")
    assert result.exit_code == 2
    assert "expected FORMAT:FILE" in result.stderr


def test_paths_are_shown_with_slashes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files.os, "sep", "\\")
    assert files.display_path("programs\\sub\\O1.nc") == "programs/sub/O1.nc"
    assert files.display_path("\\\\server\\share\\O1.nc") == "//server/share/O1.nc"
    assert files.display_path("C:\\O1.nc") == "C:/O1.nc"


def test_folders_of_subprograms_come_from_the_environment_with_the_separator_of_the_system() -> None:
    Path("one two").mkdir()
    Path("two").mkdir()
    make(a__nc="M98 P77\nM30\n")
    Path("two/O77.nc").write_text("O77\nM99\n")
    both = os.pathsep.join(["one two", "two"])
    assert check("a.nc", "--select", "subprogram-missing", POLARCHECK_SUBPROGRAMS=both).exit_code == 0


class OfWindows(type(Path())):  # type: ignore[misc]  # the class of paths here
    """A path whose drive is read as Windows reads it."""

    @property
    def drive(self) -> str:
        return PureWindowsPath(*self.parts).drive


@pytest.mark.parametrize("path", ["C:\\x.nc", "C:x.nc", "\\\\server\\share\\x.nc", "\\x.nc", "sub/../../x.nc"])
def test_a_drive_leads_out_of_a_folder(path: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded, "Path", OfWindows)
    with pytest.raises(OSError, match="lies outside the folder"):
        bounded.read_file(path, 100, "", below=Path.cwd())


@needs_posix
def test_without_steps_from_folder_to_folder_no_link_leads_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    for folder in (inside, outside):
        folder.mkdir()
        (folder / "O1.nc").write_text(folder.name)
    (inside / "link.nc").symlink_to(outside / "O1.nc")
    (inside / "folder").symlink_to(outside)
    (inside / "own.nc").symlink_to(inside / "O1.nc")
    monkeypatch.setattr(os, "supports_dir_fd", set[Any]())
    assert bounded.read_file("O1.nc", 100, "", below=inside) == b"inside"
    assert bounded.read_file("own.nc", 100, "", below=inside) == b"inside"
    for name in ("link.nc", "folder/O1.nc"):
        with pytest.raises(OSError, match="lies outside the folder"):
            bounded.read_file(name, 100, "", below=inside)


# ---- drives that number nothing ----


@pytest.fixture
def unnumbered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files and folders have no numbers of their own, as on some network drives."""
    stat = Path.stat

    def without_number(path: Path, **options: Any) -> os.stat_result:
        found = list(stat(path, **options))
        found[1] = 0
        return os.stat_result(found)

    monkeypatch.setattr(Path, "stat", without_number)


@pytest.mark.usefixtures("unnumbered")
def test_every_folder_of_such_a_drive_is_walked() -> None:
    for name in ("a/b", "c"):
        Path(name).mkdir(parents=True)
    make(**{"a/b/one__nc": "M30", "c/two__nc": "M30"})
    assert [files.display_path(path) for path in walking.walk(".", walking.EXTENSIONS, print)] == [
        "a/b/one.nc",
        "c/two.nc",
    ]


@pytest.mark.usefixtures("unnumbered")
def test_a_report_beside_programs_of_such_a_drive_is_written() -> None:
    make(a__nc=RAPID, report__txt="of yesterday")
    assert check("a.nc", "-o", "concise:report.txt").exit_code == 1
    assert Path("report.txt").read_text() != "of yesterday"


def test_a_report_is_not_written_over_a_program_named_in_another_case(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(overwriting.os.path, "normcase", str.lower)
    with pytest.raises(OutputError, match="two reports would be written"):
        overwriting.refuse([Path("Report.txt"), Path("REPORT.TXT")], [])


# ---- wildcards ----


def test_wildcards_name_files_in_order() -> None:
    make(b__nc="", a__nc="", c__txt="")
    Path("sub").mkdir()
    make(**{"sub/d__nc": ""})
    assert wildcards.expanded(["check", "*.nc"]) == ["check", "a.nc", "b.nc"]
    assert wildcards.expanded(["[ab].nc", "?.txt"]) == ["a.nc", "b.nc", "c.txt"]
    found = wildcards.expanded(["**/*.nc"])
    assert [name.replace(os.sep, "/") for name in found] == ["a.nc", "b.nc", "sub/d.nc"]


def test_a_file_with_brackets_in_its_name_is_itself() -> None:
    make(**{"part[1]__nc": "", "part1__nc": ""})
    assert wildcards.expanded(["part[1].nc"]) == ["part[1].nc"]
    assert wildcards.expanded(["part*.nc"]) == ["part1.nc", "part[1].nc"]


def test_what_no_file_matches_stays_and_so_do_options() -> None:
    make(a__nc="")
    kept = ["--set", "x=[1]", "-o", "json:*.nc", "--exclude=*.nc", "O[12].nc", "$HOME", "%PATH%"]
    assert wildcards.expanded(kept) == kept


def test_a_tilde_is_the_folder_of_the_user(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(name, os.fspath(tmp_path))
    make(a__nc="")
    assert wildcards.expanded(["~/*.nc"]) == [os.path.join(tmp_path, "a.nc")]  # noqa: PTH118


@pytest.mark.ci
@pytest.mark.parametrize(("on_windows", "said"), [(True, "2 files checked"), (False, "?.nc: No such file")])
def test_only_on_windows_the_command_expands_them(
    on_windows: bool, said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make(a__nc=RAPID, b__nc=RAPID)
    monkeypatch.setattr("polarcheck.commands.ON_WINDOWS", on_windows)
    monkeypatch.setattr(sys, "argv", ["polarcheck", "check", "?.nc", "--format", "text"])
    with pytest.raises(SystemExit) as ended:
        main.main(None, "polarcheck")
    assert ended.value.code == (1 if on_windows else 2)
    assert said in "".join(capsys.readouterr())


# ---- what the Python of Windows lacks ----


def test_memory_without_bounds_of_the_system_is_not_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "resource", None)
    memory.keep_within_memory()
    monkeypatch.delattr(os, "sysconf", raising=False)
    memory.keep_within_memory()


@needs_posix
def test_a_file_is_read_without_what_posix_alone_has(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=RAPID, b__nc="M98 P1\nM30\n")
    Path("subs").mkdir()
    Path("subs/O1.nc").write_text("O1\nM99\n")
    for name in ("O_NONBLOCK", "O_NOCTTY", "O_NOFOLLOW", "O_DIRECTORY", "sysconf", "set_blocking"):
        monkeypatch.delattr(os, name)
    monkeypatch.setattr(bounded, "_FLAGS", os.O_RDONLY)
    monkeypatch.setattr(os, "supports_dir_fd", set[Any]())
    monkeypatch.delattr(select, "poll")
    monkeypatch.setitem(sys.modules, "resource", None)
    assert check("a.nc", "--select", "rapid-in-polar", "-o", "json:o.json").exit_code == 1
    assert check("b.nc", "--subprograms", "subs", "--select", "subprogram-missing").exit_code == 0
    assert call("trace", "a.nc").exit_code == 0
    assert Path("o.json").exists()


@needs_posix
def test_a_pipe_is_read_without_waiting_for_its_writer_where_nothing_can_wait(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ours, theirs = os.pipe()
    os.write(theirs, b"M30\n")
    os.close(theirs)
    monkeypatch.delattr(select, "poll")
    try:
        assert bounded.read_file(f"/dev/fd/{ours}", 100, "", pipes=True) == b"M30\n"
    finally:
        os.close(ours)


@needs_posix
def test_ctrl_break_ends_as_a_signal_to_end_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signal, "SIGBREAK", signal.SIGUSR1, raising=False)
    before = {number: signal.getsignal(number) for number in (signal.SIGUSR1, signal.SIGTERM)}
    try:
        signals.listen()
        with pytest.raises(signals.Terminated):
            signal.raise_signal(signal.SIGUSR1)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def test_a_report_that_another_program_holds_open_is_one_line_and_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Windows replaces no file that is open, nor takes one away that is read only."""
    make(a__nc=RAPID, report__txt="of yesterday")
    Path("report.txt").chmod(0o444)
    unlink = Path.unlink

    def held_open(path: Path, target: Path) -> Path:
        raise PermissionError(errno.EACCES, "Access is denied")

    def writable_only(path: Path, missing_ok: bool = False) -> None:
        if not path.stat().st_mode & 0o200:
            raise PermissionError(errno.EACCES, "Access is denied")
        unlink(path, missing_ok)

    monkeypatch.setattr(Path, "replace", held_open)
    monkeypatch.setattr(Path, "unlink", writable_only)
    result = check("a.nc", "-o", "concise:report.txt", "--select", "rapid-in-polar")
    assert (result.exit_code, result.stderr) == (2, "polarcheck: report.txt: Access is denied\n")
    assert sorted(path.name for path in Path().iterdir()) == ["a.nc", "report.txt"]
    assert Path("report.txt").read_text() == "of yesterday"
