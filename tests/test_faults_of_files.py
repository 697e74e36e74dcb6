"""What can be wrong with a path that is given, and with what it leads to: nothing of it stops the other files."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from click.testing import CliRunner, Result
from polarcheck.errors import SourceError

import polarcheck
from polarcheck.commands import main
from polarcheck.files.batch import tasks as batch
from polarcheck.files.settings import job_files
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.foundation import bounded
from polarcheck.program.reading import files, walking
from polarcheck.program.reading.excerpt import visible

IMPORTED_FROM = os.fspath(Path(polarcheck.__file__).parent.parent)
RAPID = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5.\nG1 C-5.\nG13.1\n"
RAPID_ONLY = ("--select", "rapid-in-polar")
#: Ends what hangs [s].
PATIENCE = 120

of_posix = pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and links are files of POSIX")
of_linux = pytest.mark.skipif(sys.platform != "linux", reason="names of any bytes, folders of any depth")

pytestmark = pytest.mark.usefixtures("own_folder")


def make(*paths: str, text: str = RAPID) -> None:
    for path in paths:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_text(text, "utf-8", newline="")


def call(*arguments: str, **environment: str) -> Result:
    return CliRunner().invoke(main, list(arguments), env=environment)


def check(*paths: str, **environment: str) -> tuple[int, list[str], list[str]]:
    """The exit code, the files that were checked, and what was told of the others."""
    result = call("check", *RAPID_ONLY, "--format", "json", *paths, **environment)
    return result.exit_code, checked(result.stdout), result.stderr.splitlines()


def checked(report: str | bytes) -> list[str]:
    """The files of a JSON report, each with the one finding that its program has."""
    whole = json.loads(report)
    found = [file for file in whole["files"] if file["verdict"] != "unreadable"]
    assert all(file["reason"] for file in whole["files"] if file["verdict"] == "unreadable")
    assert whole["summary"]["unreadable"] == len(whole["files"]) - len(found)
    assert [[finding["rule"] for finding in file["findings"]] for file in found] == [["rapid-in-polar"]] * len(found)
    return [file["path"] for file in found]


def in_shell(command: str, shell: str = "sh", **environment: str) -> subprocess.CompletedProcess[bytes]:
    """A command line in which `polarcheck` is this one; it may take 4 GB."""
    variables = {**os.environ, "PYTHONPATH": IMPORTED_FROM, "PYTHON": sys.executable, **environment}
    line = f'ulimit -v 4000000; polarcheck() {{ "$PYTHON" -m polarcheck "$@"; }}; {command}'
    return subprocess.run([shell, "-c", line], env=variables, capture_output=True, timeout=PATIENCE, check=False)


CHECK = f"polarcheck check {' '.join(RAPID_ONLY)} --format json"


# ---- size ----


def test_a_larger_file_is_named_and_the_others_are_checked() -> None:
    make("a.nc", "c.nc")
    make("b.nc", text=RAPID + "M30\n")
    size = str(len(RAPID))
    told = f"polarcheck: b.nc: larger than {size} bytes; --max-size SIZE raises the limit"
    assert check("a.nc", "b.nc", "c.nc", "--max-size", size) == (2, ["a.nc", "c.nc"], [told])
    assert check(".", POLARCHECK_MAX_SIZE=size) == (2, ["a.nc", "c.nc"], [told])


def test_a_trace_is_bounded_likewise() -> None:
    make("a.nc")
    assert call("trace", "a.nc", "--max-size", f"{len(RAPID)}").exit_code == 0
    result = call("trace", "a.nc", "--max-size", f"{len(RAPID) - 1}B")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("polarcheck: a.nc: larger than ")


@pytest.mark.skipif(sys.platform == "win32", reason="files with holes")
@pytest.mark.parametrize(
    ("asked", "named"),
    [
        ((), "64 MB"),
        (("--max-size", "2G"), "2 GB"),
        (("--max-size", "512MB"), "512 MB"),
        (("--max-size", "100k"), "100 kB"),
        (("--max-size", "4096"), "4.096 kB"),
        (("--max-size", " 1.5 gib "), "1.610612736 GB"),
        (("--max-size", ".5Mi"), "524.288 kB"),
    ],
)
def test_sizes_are_written_as_one_writes_them(asked: tuple[str, ...], named: str) -> None:
    Path("a.nc").touch()
    os.truncate("a.nc", 3_000_000_000)
    assert check("a.nc", *asked)[2] == [f"polarcheck: a.nc: larger than {named}; --max-size SIZE raises the limit"]


@looped("size", ["0", "", "-1", "x", "5X", "1e3", "0.1", "nan", "1,5M", "9" * 5000])
def test_what_is_no_size_is_told(size: str) -> None:
    make("a.nc")
    result = call("check", "a.nc", "--max-size", size)
    assert result.exit_code == 2
    assert result.stderr.startswith("polarcheck: Invalid value for '--max-size': ")
    assert "expected a size above 0, such as 512MB" in result.stderr


@pytest.mark.nightly
@of_posix
@pytest.mark.parametrize(
    ("redirected", "names"),
    [
        ("cat /dev/zero | {check} a.nc - p /dev/fd/7 7< q", ["-", "p", "/dev/fd/7"]),
        ("{check} a.nc /dev/stdin < /dev/zero", ["/dev/stdin"]),
    ],
)
def test_what_never_ends_is_read_up_to_the_limit(redirected: str, names: list[str]) -> None:
    make("a.nc")
    pipes = "mkfifo p q; cat /dev/zero > p & cat /dev/zero > q & " * (len(names) > 1)
    ended = in_shell(pipes + redirected.format(check=f"{CHECK} --max-size 20MB"))
    assert (ended.returncode, checked(ended.stdout)) == (2, ["a.nc"])
    told = [f"polarcheck: {name}: larger than 20 MB; --max-size SIZE raises the limit" for name in names]
    assert ended.stderr.decode().splitlines() == told


# ---- what is no file ----


@of_posix
def test_devices_sockets_and_pipes_without_a_writer_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    make("a.nc")
    os.mkfifo("p.nc")
    Path("link.nc").symlink_to("/dev/zero")
    monkeypatch.setattr(bounded, "_PATIENCE", 1)
    with socket.socket(socket.AF_UNIX) as made:
        made.bind("s.nc")
        assert check("link.nc", "/dev/null", "s.nc", "p.nc", "a.nc") == (
            2,
            ["a.nc"],
            [
                "polarcheck: link.nc: is a device, not a file",
                "polarcheck: /dev/null: is a device, not a file",
                "polarcheck: s.nc: is a socket, not a file",
                "polarcheck: p.nc: is a pipe that nobody writes to",
            ],
        )
        assert check(".") == (1, ["a.nc"], [])
    for path in ("/dev/zero", "p.nc", "."):
        assert call("trace", path).exit_code == 2


@pytest.mark.nightly
@of_posix
@pytest.mark.parametrize(
    ("redirected", "names"),
    [
        ("cat a.nc | {check} - p /dev/fd/7 /dev/fd/8 7< q 8< a.nc", ["-", "p", "/dev/fd/7", "/dev/fd/8"]),
        ("{check} /dev/stdin < a.nc", ["/dev/stdin"]),
    ],
)
def test_what_the_shell_hands_over_is_read_to_its_end(redirected: str, names: list[str]) -> None:
    make("a.nc")
    pipes = "mkfifo p q; cat a.nc > p & cat a.nc > q & " * (len(names) > 1)
    ended = in_shell(pipes + redirected.format(check=CHECK))
    assert (ended.returncode, ended.stderr, checked(ended.stdout)) == (1, b"", names)


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("bash") is None or sys.platform == "win32", reason="needs bash")
def test_process_substitution_is_read_to_its_end() -> None:
    make("a.nc")
    ended = in_shell(f"{CHECK} <(cat a.nc) <(sleep 0.1; cat a.nc) a.nc", "bash")
    paths = checked(ended.stdout)
    assert (ended.returncode, ended.stderr, len(paths), paths[-1]) == (1, b"", 3, "a.nc")


@pytest.mark.ci
@of_posix
def test_standard_input_may_be_closed() -> None:
    make("a.nc")
    ended = in_shell(f"{CHECK} - /dev/stdin a.nc <&-")
    assert (ended.returncode, checked(ended.stdout)) == (2, ["a.nc"])
    told = [f"polarcheck: {name}: standard input is closed" for name in ("-", "/dev/stdin")]
    assert ended.stderr.decode().splitlines() == told


# ---- what changes meanwhile ----


def planned(*paths: str) -> tuple[list[batch.Task], list[str]]:
    told: list[str] = []
    return batch.plan(paths, OfPrograms(Options()), (), told.append, pytest.fail), told


@pytest.mark.ci
@of_posix
def test_a_file_that_is_gone_when_its_turn_comes() -> None:
    make("f/a.nc", "f/b.nc", "f/c.nc", "f/d.nc")
    tasks, told = planned("f")
    Path("f/b.nc").unlink()
    Path("f/c.nc").unlink()
    Path("f/c.nc").mkdir()
    found = batch.gather(batch.one_by_one(tasks), told.append, lambda bug: pytest.fail(str(bug)))
    assert [file.path for file in found.files if file.verdict != "unreadable"] == ["f/a.nc", "f/d.nc"]
    assert told == ["f/b.nc: No such file or directory", "f/c.nc: is a folder, not a file"]


@of_posix
def test_a_folder_that_is_gone_when_its_turn_comes() -> None:
    make("f/a.nc", "f/sub/b.nc", "f/z.nc")
    told: list[str] = []
    walk = walking.walk("f", walking.EXTENSIONS, told.append)
    assert Path(next(walk)).name == "a.nc"
    shutil.rmtree("f/sub")
    assert [Path(path).name for path in walk] == ["z.nc"]
    assert told == ["f/sub: No such file or directory"]


@of_posix
def test_a_file_that_has_become_a_pipe_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("a").write_text(RAPID, "utf-8")
    opened = os.open

    def exchanged(*arguments: Any) -> int:
        Path("a").unlink()
        os.mkfifo("a")
        return opened(*arguments)

    monkeypatch.setattr(os, "open", exchanged)
    assert not walking.is_program("a", walking.EXTENSIONS)


def in_pieces(monkeypatch: pytest.MonkeyPatch, meanwhile: Any) -> None:
    """Files come in pieces of 10 bytes; something happens once, behind the first of them."""
    read = os.read
    left = [meanwhile]

    def read_some(descriptor: int, count: int) -> bytes:
        piece = read(descriptor, min(count, 10))
        if left:
            left.pop()()
        return piece

    monkeypatch.setattr(os, "read", read_some)


@of_posix
def test_a_file_that_is_replaced_is_the_old_one(monkeypatch: pytest.MonkeyPatch) -> None:
    make("a.nc")
    make("new", text=RAPID.lower())
    in_pieces(monkeypatch, lambda: Path("new").replace("a.nc"))
    assert files.read_program("a.nc") == RAPID.encode()
    assert files.read_program("a.nc") == RAPID.lower().encode()


@pytest.mark.parametrize("mode", ["a", "w", "r+"])
def test_a_file_that_is_written_to_is_told(mode: str, monkeypatch: pytest.MonkeyPatch) -> None:
    make("a.nc", "b.nc")
    os.utime("a.nc", (1, 1))

    def written() -> None:
        with Path("a.nc").open(mode, encoding="utf-8") as file:
            file.write("G4 X1.\n")

    in_pieces(monkeypatch, written)
    assert check("a.nc", "b.nc") == (2, ["b.nc"], ["polarcheck: a.nc: was changed while it was read"])


# ---- what cannot be reached ----


@contextlib.contextmanager
def without_rights() -> Iterator[None]:
    """As root one may read everything; this is done as somebody else."""
    is_root = os.geteuid() == 0
    Path.cwd().chmod(0o755)
    if is_root:
        os.seteuid(65534)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)


@of_posix
def test_what_may_not_be_read_is_told_in_a_line() -> None:
    make("f/a.nc", "f/b.nc", "f/shut/c.nc", "shut/d.nc")
    for path in ("f/b.nc", "f/shut", "shut"):
        Path(path).chmod(0)
    try:
        with without_rights():
            found = check("f", "f/b.nc", "shut", "shut/d.nc")
    finally:
        for path in ("f/shut", "shut"):
            Path(path).chmod(0o755)
    denied = [f"polarcheck: {path}: Permission denied" for path in ("f/shut", "shut", "f/b.nc", "shut/d.nc")]
    assert found == (2, ["f/a.nc"], denied)


@pytest.mark.ci
@of_posix
def test_links_that_lead_nowhere_are_told_in_a_line() -> None:
    make("f/a.nc")
    for name, target in (("self.nc", "self.nc"), ("one.nc", "gone"), ("two.nc", "gone"), ("round", ".")):
        Path("f", name).symlink_to(target)
    missing, endless = "No such file or directory", os.strerror(40 if sys.platform == "linux" else 62)
    told = [
        f"polarcheck: f/one.nc: {missing}",
        f"polarcheck: f/self.nc: {endless}",
        f"polarcheck: f/two.nc: {missing}",
        f"polarcheck: f/self.nc/b.nc: {endless}",
        f"polarcheck: f/one.nc/b.nc: {missing}",
        "polarcheck: f/a.nc/b.nc: Not a directory",
    ]
    assert check("f", "f/round", "f/self.nc/b.nc", "f/one.nc/b.nc", "f/a.nc/b.nc") == (2, ["f/a.nc"], told)


@contextlib.contextmanager
def nested(folder: str, depth: int) -> Iterator[None]:
    """A program in the innermost of folders; they are taken away again, since few tools can."""
    top = Path.cwd()
    for _ in range(depth):
        Path(folder).mkdir()
        os.chdir(folder)
    make("a.nc")
    os.chdir(top)
    try:
        yield
    finally:
        for _ in range(depth):
            os.chdir(folder)
        Path("a.nc").unlink()
        for _ in range(depth):
            os.chdir("..")
            Path(folder).rmdir()


@pytest.mark.nightly
@of_linux
def test_folders_may_be_nested_deeper_than_functions() -> None:
    with nested("d", 1500):
        assert check(".") == (1, ["d/" * 1500 + "a.nc"], [])


@of_linux
def test_folders_nested_deeper_than_a_path_can_say_are_told_in_a_line() -> None:
    make("z.nc")
    with nested("n" * 200, 30):
        status, paths, (told,) = check(".")
    assert (status, paths) == (2, ["z.nc"])
    assert told.startswith(f"polarcheck: {'n' * 200}/")
    assert told.endswith(": File name too long")


def test_a_job_file_is_looked_for_once_in_each_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    depth = 30
    make(*("d/" * count + "a.nc" for count in range(depth + 1)))
    make("d/" * 20 + "polarcheck.toml", text="machine = 'fanuc-16i'\n")
    own, looked = job_files.in_folder, list[Path]()
    monkeypatch.setattr(job_files, "in_folder", lambda folder: looked.append(folder) or own(folder))
    tasks, told = planned(".")
    machines = [task.settings.name for task in sorted(tasks, key=lambda task: len(task.path))]
    assert (machines, told) == (["fanuc"] * 20 + ["fanuc-16i"] * (depth - 19), [])
    assert len(looked) == len(set(looked)) == depth + len(Path.cwd().parts)


@pytest.mark.ci
def test_a_folder_of_many_files_is_walked_in_order() -> None:
    Path("f").mkdir()
    names = [f"O{number:04d}" for number in range(1500)]
    for name in names:
        Path("f", name).touch()
    tasks, told = planned("f", "f")
    assert ([Path(task.path).name for task in tasks], told) == (names, [])
    assert len({id(task.settings) for task in tasks}) == 1


# ---- names ----

NAMES = [
    b"a\xff.nc",
    b"a\\xff.nc",
    b"a\\\\xff.nc",
    b"\xc3\xbc\xff.nc",
    b"nl\n.nc",
    b"tab\t.nc",
    b"\x1b[31m.nc",
    b"-.nc",
]
NAMES += [
    b"\xe2\x80\xae.nc",
    b"   .nc",
    b"n" * 252 + b".nc",
    b"a\xed\xa0\x80.nc",
    b"b\\.nc",
    b"*.nc",
    b"$(x);'\".nc",
    b" ",
]
SHOWN = [r"a\xff.nc", r"a\\xff.nc", r"a\\\\xff.nc", r"ü\xff.nc", "nl\n.nc", "tab\t.nc", "\x1b[31m.nc", "-.nc"]
SHOWN += ["\u202e.nc", "   .nc", "n" * 252 + ".nc", r"a\xed\xa0\x80.nc", r"b\.nc", "*.nc", "$(x);'\".nc", " "]


@pytest.mark.nightly
@of_linux
@pytest.mark.parametrize("locale", ["C.UTF-8", "C"])
def test_names_of_any_bytes_are_checked_and_shown_apart(locale: str) -> None:
    for name in NAMES:
        Path(os.fsdecode(name)).write_text(RAPID, "utf-8")
    utf8 = "0" if locale == "C" else "1"
    ended = in_shell(f"{CHECK} .", LC_ALL=locale, PYTHONUTF8=utf8, PYTHONCOERCECLOCALE="0")
    assert (ended.returncode, ended.stderr) == (1, b"")
    assert checked(ended.stdout) == [shown for _, shown in sorted(zip(NAMES, SHOWN, strict=True))]


@pytest.mark.nightly
@of_linux
def test_names_of_any_bytes_are_checked_where_they_are_given() -> None:
    for name in NAMES:
        Path(os.fsdecode(name)).write_text(RAPID, "utf-8")
    status, paths, told = check("--", *map(os.fsdecode, NAMES))
    assert (status, paths, told) == (1, SHOWN, [])


def test_no_two_paths_are_shown_as_one() -> None:
    letters = ["\\", "x", "f", "ff", "u", "U", "\u00fc", "\udcff", "\udc80", "\ud800", "dcff", "\x1b", "1b"]
    names = [name for count in range(4) for name in map("".join, itertools.product(letters, repeat=count))]
    if sys.platform == "win32":
        names = [name for name in names if "\\" not in name]
    shown = {name: files.display_path(name) for name in dict.fromkeys(names)}
    assert len(set(shown.values())) == len(shown)
    assert all(text.encode() for name, text in shown.items() if name)
    seen = {name: visible(text) for name, text in shown.items()}
    assert len(set(seen.values())) == len(seen)
    assert all(text.isprintable() for text in seen.values())


@pytest.mark.nightly
@looped("name", ["a\0b.nc", "f\0/b.nc", "\0", "a\ud800.nc" if sys.platform != "win32" else "\0"])
def test_names_that_no_file_can_have(name: str) -> None:
    with pytest.raises(SourceError, match="no file can have this name"):
        files.read_program(name)
    make("a.nc")
    tasks, told = planned(name, "a.nc", name)
    assert [
        file.path
        for file in batch.gather(batch.one_by_one(tasks), told.append, lambda bug: pytest.fail(str(bug))).files
        if file.verdict != "unreadable"
    ] == ["a.nc"]
    assert len(told) == 1


@pytest.mark.ci
@looped("name", ["*.nc", "?.nc", "[a].nc", "~/a.nc", "$HOME/a.nc", "%TEMP%", "n" * 300])
def test_a_name_is_taken_as_it_is_written(name: str) -> None:
    make("a.nc")
    status, paths, (told,) = check("a.nc", name)
    assert (status, paths) == (2, ["a.nc"])
    assert told.startswith(f"polarcheck: {name}: ")


@of_posix
def test_the_empty_name_is_told() -> None:
    make("a.nc")
    assert check("", "a.nc") == (2, ["a.nc"], ["polarcheck: '': No such file or directory"])
    assert call("trace", "").stderr == "polarcheck: '': No such file or directory\n"


@of_posix
def test_a_file_whose_name_means_standard_input_is_a_file() -> None:
    make("-", "sub/-", text="%\nO1\n" + RAPID)
    assert check(".", "./-") == (1, ["./-", "sub/-"], [])


def test_what_shows_a_file_in_full_takes_it_for_no_option() -> None:
    make("-q.nc")
    result = call("check", *RAPID_ONLY, "--format", "short", ".")
    assert result.stdout.endswith(f"polarcheck check {' '.join(RAPID_ONLY)} ./-q.nc\n")


# ---- one file, several paths ----


def test_a_file_is_counted_once_under_the_first_of_its_paths(tmp_path: Path) -> None:
    make("a.nc", "sub/b.nc")
    others = ["./a.nc", str(tmp_path / "a.nc"), "sub/../a.nc", "a.nc", ".", "sub", "sub/", "./sub/b.nc"]
    assert check("a.nc", *others) == (1, ["a.nc", "sub/b.nc"], [])
    assert check("./sub/b.nc", "sub/b.nc", "sub") == (1, ["./sub/b.nc"], [])


@of_posix
def test_links_are_the_file_that_they_lead_to_and_hard_links_are_files() -> None:
    make("f/b.nc")
    Path("f/hard.nc").hardlink_to("f/b.nc")
    Path("f/z.nc").symlink_to("b.nc")
    Path("zz.nc").symlink_to("f/z.nc")
    Path("g").symlink_to("f")
    assert check("f", "g", "zz.nc", "g/b.nc", "g/../f/z.nc") == (1, ["f/b.nc", "f/hard.nc"], [])
    assert check("zz.nc", "f") == (1, ["zz.nc", "f/hard.nc"], [])


@of_posix
def test_a_program_that_two_lathes_share_is_checked_for_each() -> None:
    make("programs/a.nc")
    for lathe, machine in (("one", "fanuc-16i"), ("two", "fanuc-30i")):
        make(f"{lathe}/polarcheck.toml", text=f"machine = '{machine}'\n")
        Path(lathe, "a.nc").symlink_to("../programs/a.nc")
        Path(lathe, "b.nc").symlink_to("../programs/a.nc")
    report = json.loads(call("check", *RAPID_ONLY, "--format", "json", "one", "two", "one/../two").stdout)
    found = [(file["path"], file["machine"]) for file in report["files"]]
    assert found == [("one/a.nc", "fanuc-16i"), ("two/a.nc", "fanuc-30i")]


# ---- surroundings ----


@pytest.mark.one_in(4)
@pytest.mark.ci
@of_posix
@pytest.mark.parametrize(
    ("environment", "encoding"),
    [
        ({"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, "utf-8"),
        ({"PYTHONIOENCODING": "cp1252"}, "cp1252"),
        ({"PYTHONIOENCODING": "cp437"}, "cp437"),
        ({"PYTHONIOENCODING": "cp850:strict"}, "cp850"),
    ],
)
def test_text_is_of_the_terminal_and_json_is_utf_8(environment: dict[str, str], encoding: str) -> None:
    make("Stück/ä.nc", text=RAPID.replace("G0 C5.", "G0 C5. (Öse)"))
    of_people = f"polarcheck check {' '.join(RAPID_ONLY)} --format text -o json:o.json"
    in_json = f"{CHECK} Stück" if encoding in ("utf-8", "cp1252") else "cat o.json"
    ended = in_shell(f"{of_people} Stück gön.nc; {in_json}", **environment)
    shown, _, machine_readable = ended.stdout.partition(b"{\n")
    assert "at   Stück/ä.nc:4:1\n" in shown.decode(encoding)
    assert "4 | G0 C5. (Öse)\n" in shown.decode(encoding)
    assert checked(b"{" + machine_readable) == ["Stück/ä.nc"]
    assert checked(Path("o.json").read_bytes()) == ["Stück/ä.nc"]
    assert ended.stderr.decode(encoding) == "polarcheck: gön.nc: No such file or directory\n"


@pytest.mark.ci
@of_posix
def test_what_is_told_of_other_files_can_be_read_where_the_locale_knows_ascii_alone() -> None:
    make("Maß/b.nc")
    make("Maß/polarcheck.toml", text="x = 1\n")
    ended = in_shell(f"{CHECK} Maß", LC_ALL="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0")
    assert ended.stderr.decode().startswith("polarcheck: Maß/polarcheck.toml:1: ")


@pytest.mark.ci
@of_posix
def test_no_folder_for_temporary_files_and_no_home_are_needed() -> None:
    make("a.nc")
    ended = in_shell(f"unset HOME; {CHECK} a.nc -o concise:o.txt", TMPDIR="/nowhere", TEMP="/nowhere", TMP="/nowhere")
    assert (ended.returncode, ended.stderr, checked(ended.stdout)) == (1, b"", ["a.nc"])
    assert Path("o.txt").read_text("utf-8").startswith("a.nc:4:1: error: ")


@pytest.mark.ci
@of_linux
def test_the_working_folder_may_be_gone(tmp_path: Path) -> None:
    make("f/a.nc", "gone/b.nc")
    make("f/polarcheck.toml", text="machine = 'fanuc-16i'\n")
    ended = in_shell(f"cd gone; rm b.nc; rmdir ../gone; {CHECK} {tmp_path}/f/a.nc ../gone/b.nc b.nc")
    assert (ended.returncode, checked(ended.stdout)) == (2, [f"{tmp_path}/f/a.nc"])
    assert json.loads(ended.stdout)["machine"] == "fanuc-16i"
    assert ended.stderr.decode().splitlines() == [
        "polarcheck: ../gone/b.nc: No such file or directory",
        "polarcheck: b.nc: No such file or directory",
    ]


@looped("encoding", ["punycode", "ascii", "utf-8", "idna"])
def test_an_encoding_that_reads_nothing_is_told(encoding: str) -> None:
    Path("a.nc").write_bytes(b"G0 X1.-\xffy\n")
    status, paths, (told,) = check("a.nc", "--encoding", encoding)
    assert (status, paths) == (2, [])
    assert told.startswith("polarcheck: a.nc: ")
    assert told.endswith(f" is not {encoding}")
