"""Which files a folder gives, and writing a file whole."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from cases import looped
from polarcheck.errors import PolarcheckError, SourceError

from polarcheck.program.reading import files, walking

HOOKS = Path(__file__).parent.parent / ".pre-commit-hooks.yaml"
BLOCKS = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG13.1\n"

PROGRAMS = [
    "B.NC",
    "1001.EIA",
    "O1234",
    "O0001(SB12 RG FRONT)",
    "O0006-R.MIN",
    "O1234.txt",
    "x.tap",
    "foo.ngc",
    "o12.bak",
]
OTHERS = ["notes.md", "readme.md", "Oval.py", "p.h", "O1", "O123456789.py", "fnc", "a.nc.bak"]


def make(folder: Path, names: dict[str, str]) -> None:
    for name, text in names.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


def walked(folder: Path, wanted: tuple[str, ...] = walking.EXTENSIONS) -> list[str]:
    failures: list[str] = []
    found = [Path(path).relative_to(folder).as_posix() for path in walking.walk(str(folder), wanted, failures.append)]
    assert not failures
    return found


def test_programs_are_found_by_extension_and_o_number_in_order_of_names(tmp_path: Path) -> None:
    make(tmp_path, dict.fromkeys([*PROGRAMS, *OTHERS, "sub/b.nc"], ""))
    assert walked(tmp_path) == sorted([*PROGRAMS, "sub/b.nc"])


def test_hidden_and_installed_folders_are_passed_over(tmp_path: Path) -> None:
    names = [".git/a.nc", ".venv/a.nc", "node_modules/a.nc", "._a.nc", "programs/.old/a.nc", "programs/a.nc"]
    make(tmp_path, dict.fromkeys(names, ""))
    assert walked(tmp_path) == ["programs/a.nc"]


def test_other_extensions_replace_the_usual_ones(tmp_path: Path) -> None:
    make(tmp_path, dict.fromkeys(["a.nc", "b.LST", "c.P-3", "O1234"], ""))
    assert walked(tmp_path, tuple(walking.extensions(["lst", ".p-3 ", ""]))) == ["O1234", "b.LST", "c.P-3"]


@looped(
    "text",
    [
        "%\nO1\n",
        "%O0001(X)\n",
        "O0001\nG0\n",
        ":1234\n",
        "\ufeffO0001\n",
        "\0\0\0%\n",
        "\nN10 G0 X1.\nN20 M30\n",
        BLOCKS,
    ],
)
def test_texts_that_read_as_programs_are_programs(tmp_path: Path, text: str) -> None:
    make(tmp_path, {"flats": text, "flats.txt": text, "flats.dat": text})
    assert walked(tmp_path) == ["flats", "flats.txt"]


@looped("text", ["", "%PDF-1.7\n", "%!PS\n", "Setup of lathe 7\nG12.1 needs M35\n", "A\nB\n", "G0\n", "O\n"])
def test_other_texts_are_not(tmp_path: Path, text: str) -> None:
    make(tmp_path, {"LICENSE": text, "setup.txt": text})
    assert walked(tmp_path) == []


COMMENTS = "".join(f"(COMMENT {number})\n" for number in range(12))


@looped(
    "text",
    [
        COMMENTS + BLOCKS,
        COMMENTS * 40 + BLOCKS,
        "; MADE BY A POST\n" * 15 + "N10 G0 X1.\nN20 G1 Z1.\n",
        "(A) (B);\n" * 11 + BLOCKS,
        "$O1234.MIN%\nX\n",
    ],
)
def test_comments_do_not_hide_a_program_without_ending(tmp_path: Path, text: str) -> None:
    make(tmp_path, {"flats": text, "flats.txt": text})
    assert walked(tmp_path) == ["flats", "flats.txt"]


README = "Programs of lathe 7\n\n(see the binder)\n(G12.1 needs M35)\nG12.1 is on.\n"


@looped("text", [README, f"({README})", COMMENTS, "; key = 1\n" * 20 + "a = 2\nb = 3\n", "(a)\n" * 20000])
def test_comments_alone_make_no_program(tmp_path: Path, text: str) -> None:
    make(tmp_path, {"README": text, "LICENSE.txt": text})
    assert passed_over(tmp_path) == []


def passed_over(folder: Path) -> list[tuple[str, str]]:
    """What a walk does not read, each with the reason; of what it reads the reason is empty."""
    skipped: list[walking.Skipped] = []
    read = list(walking.walk(str(folder), walking.EXTENSIONS, pytest.fail, None, skipped.append))
    found = [(Path(path).relative_to(folder).as_posix(), "") for path in read]
    return sorted([*found, *((Path(one.path).relative_to(folder).as_posix(), one.reason) for one in skipped)])


@pytest.mark.parametrize(
    "name", ["P.SUB", "x.ssb", "a.LIB", "1234.001", "O1234-REV.B", "mill.tpx", "a.NC.bak", "4711.2", "O12-A.5"]
)
def test_a_program_with_another_ending_is_named(tmp_path: Path, name: str) -> None:
    make(tmp_path, {name: BLOCKS, f"sub/{name}": "%\nO1234(X)\nM99\n%\n"})
    assert passed_over(tmp_path) == sorted([(name, "ending"), (f"sub/{name}", "ending")])


@looped(
    ("name", "text"),
    [
        ("a.md", BLOCKS),
        ("a.html", BLOCKS),
        ("polarcheck.toml", "strict = true\n"),
        ("a.pdf", "%PDF-1.7\n"),
        ("a.xyz", "A1\nB2\nC3\n"),
        ("a.tex2", "% a comment\nx1\n"),
        ("a.dat", "1 2 3\n4 5 6\n"),
        ("a.lib", "!<arch>\n\0\1\2"),
        ("a.out", "\x7fELF\2\1\1"),
        ("a.py", "#1 = 2\nG1 = 2\n"),
        ("a.hex", ":10010000214601360121470136007EFE09D2190140\n"),
        ("O1234.orig", BLOCKS),
        ("a.nc~", BLOCKS),
        ("O1234.NC~", BLOCKS),
        ("P.SUB", "Sub AutoOpen()\nEnd Sub\n"),
        ("2026", "minutes of the meeting\n"),
        (".x.nc.swp", BLOCKS),
    ],
)
def test_what_is_no_program_by_its_look_needs_no_word(tmp_path: Path, name: str, text: str) -> None:
    make(tmp_path, {name: text})
    assert passed_over(tmp_path) == []


def test_folders_that_are_not_entered_are_named(tmp_path: Path) -> None:
    make(tmp_path, {".git/a.nc": BLOCKS, ".cam/a.nc": BLOCKS, "node_modules/x/a.nc": BLOCKS, "b.nc": ""})
    assert passed_over(tmp_path) == [(".cam", "folder"), ("b.nc", ""), ("node_modules", "folder")]


def test_sniffing_ends_soon_whatever_the_line(tmp_path: Path) -> None:
    make(tmp_path, {"a.txt": "\n".join("X" + "1" * 4000 + "!" for _ in range(2))})
    assert walked(tmp_path) == []


def test_utf_16_is_sniffed(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_bytes("%\r\nO1\r\n".encode("utf-16"))
    assert walked(tmp_path) == ["a.txt"]


@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
def test_links_in_a_circle_end_and_broken_links_are_kept_to_be_reported(tmp_path: Path) -> None:
    make(tmp_path, {"a/x.nc": ""})
    (tmp_path / "a" / "round").symlink_to(tmp_path)
    (tmp_path / "gone.nc").symlink_to(tmp_path / "nowhere")
    (tmp_path / "self").symlink_to(tmp_path / "self")
    assert walked(tmp_path) == ["a/x.nc", "gone.nc"]
    with pytest.raises(SourceError, match=r"gone\.nc: No such file"):
        files.read_program(str(tmp_path / "gone.nc"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names there")
def test_pipes_in_folders_are_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.nc")
    assert walked(tmp_path) == []


def test_a_folder_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    failures: list[str] = []
    assert list(walking.walk(str(tmp_path / "gone"), walking.EXTENSIONS, failures.append)) == []
    assert failures == [f"{tmp_path / 'gone'}: No such file or directory"]


def test_the_working_folder_gives_plain_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(tmp_path, {"a.nc": "", "sub/b.nc": ""})
    monkeypatch.chdir(tmp_path)
    assert list(walking.walk(".", walking.EXTENSIONS, pytest.fail)) == ["a.nc", str(Path("sub/b.nc"))]


def test_paths_that_are_no_text_are_spelled_out() -> None:
    assert files.display_path(os.fsdecode(b"a\xff.nc")) == "a\\xff.nc"


# ---- writing ----


def test_a_written_file_replaces_the_old_one_and_leaves_nothing_beside(tmp_path: Path) -> None:
    path = tmp_path / "report.json"
    path.write_text("old", "utf-8")
    path.chmod(0o640)
    files.write(path, "n\u00fc\n")
    assert path.read_bytes() == "n\u00fc\n".encode()
    assert list(tmp_path.iterdir()) == [path]
    assert os.name == "nt" or path.stat().st_mode & 0o777 == 0o640


def test_a_failed_write_leaves_the_old_file_and_nothing_beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "report.json"
    path.write_text("old", "utf-8")
    monkeypatch.setattr(Path, "replace", lambda self, target: (_ for _ in ()).throw(OSError(28, "No space left")))
    with pytest.raises(PolarcheckError, match=r"report\.json: No space left"):
        files.write(path, "new")
    assert path.read_text("utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(PolarcheckError, match=r"No such file or directory"):
        files.write(tmp_path / "no" / "report.json", "new")


@pytest.mark.skipif(os.name == "nt", reason="devices have other names there")
def test_devices_and_links_are_written_through(tmp_path: Path) -> None:
    target = tmp_path / "real.json"
    (tmp_path / "link.json").symlink_to(target)
    files.write(tmp_path / "link.json", "new")
    assert target.read_text("utf-8") == "new"
    assert (tmp_path / "link.json").is_symlink()
    files.write(Path(os.devnull), "new")
    assert not Path(os.devnull).is_file()


# ---- the commit hook ----


def hook(key: str) -> str:
    """A key of the first hook in the manifest; one line each, quotes taken off."""
    found = re.search(rf"^[ -] {key}: (.*)$", HOOKS.read_text("utf-8"), re.MULTILINE)
    assert found, key
    return found[1].strip("'")


def test_the_hook_runs_a_command_that_exists() -> None:
    from polarcheck.commands import main

    program, command, *options = hook("entry").split()
    assert program == "polarcheck"
    known = {name for parameter in main.commands[command].params for name in parameter.opts}
    assert set(options) <= known
    assert hook("types") == "[file]"
    assert hook("require_serial") == "true"


def test_the_manifest_is_valid() -> None:
    manifest = pytest.importorskip("pre_commit.clientlib")
    hooks = manifest.load_manifest(str(HOOKS))
    assert [entry["id"] for entry in hooks] == ["polarcheck", "polarcheck-config"]
