"""Called programs are looked for in the folders of the job and nowhere else, whatever lies there."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from cases import looped
from programs import report_of, said

from polarcheck.foundation import bounded
from polarcheck.program.execution import called_programs
from polarcheck.program.execution.called_programs import Library
from polarcheck.program.execution.programs import ProgramName
from polarcheck.program.machines.profiles import load

needs_links = pytest.mark.skipif(sys.platform == "win32", reason="links and pipes need more than files there")
SUB = "G0 X5.\nM99\n"
MAIN = "O1\nM98 P1234\nM30\n"
MISSING = [(2, "subprogram-missing")]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder of the job, beside one that is none of its folders and holds the program that is called."""
    found = tmp_path / "programs"
    found.mkdir()
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "O1234").write_text(SUB, "utf-8")
    (tmp_path / "O1234").write_text(SUB, "utf-8")
    return found


def of(folder: Path, program: str = MAIN) -> list[tuple[int, str]]:
    return said(report_of(program, job={"run": {"subprograms": [str(folder)]}}))


@looped("name", ["O1234", "1234", "o1234.nc", "O01234.NC", "1234.eia"])
def test_a_program_in_the_folder_is_found(folder: Path, name: str) -> None:
    (folder / name).write_text(SUB, "utf-8")
    assert of(folder) == []


def test_what_lies_beside_the_folder_or_below_it_is_not_found(folder: Path) -> None:
    (folder / "below").mkdir()
    (folder / "below" / "O1234").write_text(SUB, "utf-8")
    assert of(folder) == MISSING


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    "name",
    [
        *("../O1234", "../outside/O1234", "..", ".", "...", "/etc/passwd", "//etc/passwd", "~/O1234", "below/O1234"),
        *("..\\O1234", "C:\\O1234", "C:O1234", "\\\\HOST\\O1234", "O1234\0", "../OUTSIDE/o1234", ".././O1234", ""),
        *("%2e%2e/O1234", "file:///etc/passwd", "*", "?1234", "A" * 65, "A" * 100_000, "CON", "NUL"),
    ],
)
def test_names_that_lead_out_of_the_folder(folder: Path, name: str, tmp_path: Path) -> None:
    (folder / "below").mkdir()
    (folder / "below" / "O1234").write_text(SUB, "utf-8")
    shelf = Library([str(folder)], load("fanuc").machine)
    assert shelf.find(ProgramName(None, name)) is None
    absolute = str(tmp_path / "O1234")
    assert shelf.find(ProgramName(None, absolute)) is None
    if name:
        assert (2, "subprogram-missing") in of(folder, f"O1\nM98 <{name}>\nM30\n") or "\0" in name


@needs_links
@pytest.mark.parametrize("target", ["../O1234", "../outside/O1234", "below/../../O1234", "link/O1234", "absolute"])
def test_links_that_lead_out_of_the_folder(folder: Path, target: str, tmp_path: Path) -> None:
    (folder / "below").mkdir()
    (folder / "link").symlink_to(tmp_path / "outside")
    (folder / "O1234.nc").symlink_to(tmp_path / "O1234" if target == "absolute" else target)
    assert (folder / "O1234.nc").read_text("utf-8") == SUB
    assert of(folder) == MISSING


@needs_links
@pytest.mark.parametrize("target", ["own", "below/own", "inner/own", "../programs/own"])
def test_links_that_stay_inside_are_followed(folder: Path, target: str) -> None:
    (folder / "below").mkdir()
    (folder / "own").write_text(SUB, "utf-8")
    (folder / "below" / "own").write_text(SUB, "utf-8")
    (folder / "inner").symlink_to("below")
    (folder / "O1234").symlink_to(target)
    assert of(folder) == []


@needs_links
def test_a_folder_that_the_job_names_by_a_link_is_one_of_its_folders(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "named").symlink_to(tmp_path / "outside")
    assert of(tmp_path / "named") == []
    # And what it links to is then the folder: links out of that are not followed.
    (tmp_path / "outside" / "O1234").unlink()
    (tmp_path / "outside" / "O1234").symlink_to(tmp_path / "O1234")
    assert of(tmp_path / "named") == MISSING
    assert of(folder) == MISSING


@needs_links
@pytest.mark.parametrize("kind", ["itself", "pair", "nowhere", "folder", "pipe", "device", "device-link"])
def test_what_is_no_program_is_passed_over(folder: Path, kind: str) -> None:
    path = folder / "O1234"
    if kind == "itself":
        path.symlink_to("O1234")
    elif kind == "pair":
        path.symlink_to("other")
        (folder / "other").symlink_to("O1234")
    elif kind == "nowhere":
        path.symlink_to("gone")
    elif kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "device-link":
        path.symlink_to("/dev/zero")
    else:
        try:
            os.mknod(path, 0o600 | 0o020000, os.makedev(1, 5))
        except PermissionError:
            pytest.skip("only root makes devices")
    assert of(folder) == MISSING
    # It is no reason not to take the next one.
    (folder / "O1234.nc").write_text(SUB, "utf-8")
    assert of(folder) == []


@needs_links
def test_what_cannot_be_read_is_passed_over(folder: Path) -> None:
    (folder / "O1234").write_text(SUB, "utf-8")
    (folder / "O1234").chmod(0)
    if os.access(folder / "O1234", os.R_OK):
        pytest.skip("root reads everything")
    assert of(folder) == MISSING


@pytest.mark.skipif(sys.platform == "win32", reason="files with holes")
def test_a_program_that_is_too_large_is_passed_over(folder: Path) -> None:
    (folder / "O1234").touch()
    os.truncate(folder / "O1234", 1 << 40)
    assert of(folder) == MISSING


def test_a_folder_that_disappears(folder: Path) -> None:
    (folder / "O1234").write_text(SUB, "utf-8")
    shelf = Library([str(folder)], load("fanuc").machine)
    (folder / "O1234").unlink()
    folder.rmdir()
    assert shelf.find(ProgramName(1234, None)) is None
    assert of(folder) == MISSING


def test_a_file_that_disappears_after_the_folder_was_listed(folder: Path) -> None:
    (folder / "O1234").write_text(SUB, "utf-8")
    shelf = Library([str(folder)], load("fanuc").machine)
    assert shelf.find(ProgramName(1, None)) is None
    (folder / "O1234").unlink()
    assert shelf.find(ProgramName(1234, None)) is None


@needs_links
@pytest.mark.parametrize("part", ["file", "folder"])
def test_a_link_put_in_its_place_while_it_is_opened_leads_nowhere(
    folder: Path, part: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "below").mkdir()
    (folder / "below" / "own").write_text(SUB, "utf-8")
    (folder / "O1234").symlink_to("below/own")
    (tmp_path / "outside" / "own").write_text(SUB, "utf-8")
    read = bounded.read_file
    exchanged = []

    def exchanging(*arguments: object, **options: object) -> bytes:
        """Between looking where the link leads and opening it somebody puts a link to the outside there."""
        if part == "file":
            (folder / "below" / "own").unlink()
            (folder / "below" / "own").symlink_to(tmp_path / "outside" / "own")
        else:
            (folder / "below").rename(folder / "away")
            (folder / "below").symlink_to(tmp_path / "outside")
        exchanged.append(part)
        return read(*arguments, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(called_programs.bounded, "read_file", exchanging)
    assert of(folder) == MISSING
    assert exchanged


# ---- several files for one call ----


@pytest.fixture
def more(tmp_path: Path) -> Path:
    """A second folder of the job."""
    found = tmp_path / "more"
    found.mkdir()
    return found


def reasons(*folders: str | Path) -> list[str]:
    report = report_of(MAIN, job={"run": {"subprograms": list(folders)}})
    return [entry.reason for entry in report.not_evaluated if entry.matters]


def test_a_program_in_two_folders_leaves_open_which_one_is_called(folder: Path, more: Path) -> None:
    (folder / "O1234").write_text(SUB, "utf-8")
    (more / "1234.NC").write_text("G0 X6.\nM99\n", "utf-8")
    said_of = "which differ: which of them the control calls is not known, and {} is checked; keep one of them"
    (reason,) = reasons(str(folder), str(more))
    assert reason.startswith(f"O1234 is in {folder}/O1234 and {more}/1234.NC, {said_of.format(f'{folder}/O1234')}")
    (reason,) = reasons(str(more), str(folder))
    assert reason.startswith(f"O1234 is in {more}/1234.NC and {folder}/O1234, ")
    (folder / "1234.nc").write_text("G0 X7.\nM99\n", "utf-8")
    (reason,) = reasons(str(folder))
    assert reason.startswith(f"O1234 is in {folder}/1234.nc and {folder}/O1234, ")


@pytest.mark.parametrize("content", [SUB, SUB.replace("\n", "\r\n") + "\r\n"])
def test_a_copy_is_the_same_program(folder: Path, more: Path, content: str) -> None:
    (folder / "O1234").write_text(SUB, "utf-8")
    (more / "O1234").write_text(content, "utf-8", newline="")
    assert reasons(str(folder), str(more)) == []


def test_a_backup_is_taken_last_and_never_beside_another(folder: Path) -> None:
    (folder / "O1234.BAK").write_text("G0 X6.\nM99\n", "utf-8")
    shelf = Library([str(folder)], load("fanuc").machine)
    assert [place.path.name for place in shelf.places(ProgramName(1234, None))] == ["O1234.BAK"]
    (folder / "O1234.NC").write_text(SUB, "utf-8")
    shelf = Library([str(folder)], load("fanuc").machine)
    assert [place.path.name for place in shelf.places(ProgramName(1234, None))] == ["O1234.NC"]
    assert reasons(str(folder)) == []


def test_many_candidates_are_not_all_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(20):
        (folder / f"O1234.{chr(97 + number)}").write_text(SUB, "utf-8")
    read = []
    original = called_programs._read_inside
    monkeypatch.setattr(called_programs, "_read_inside", lambda *where: (read.append(where), original(*where))[1])
    assert len(Library([str(folder)], load("fanuc").machine).places(ProgramName(1234, None))) == 1
    assert len(read) < 10


def test_a_program_of_the_file_itself_has_no_rival(folder: Path, more: Path) -> None:
    for number, where in enumerate((folder, more)):
        (where / "O1234").write_text(f"G0 X{number}.\nM99\n", "utf-8")
    job = {"run": {"subprograms": [str(folder), str(more)]}}
    report = report_of(MAIN + "O1234\n" + SUB, job=job)
    assert not [entry for entry in report.not_evaluated if entry.matters]
    # A call whose number is computed, and a folder that was brought to another machine.
    (reason,) = (entry.reason for entry in report_of("O1\n#1=1234\nM98 P#1\nM30\n", job=job).not_evaluated)
    assert reason.startswith("O1234 is in ")
    moved = [called_programs.MovedFolder(str(folder), "subs"), called_programs.MovedFolder(str(more), "more")]
    places = Library(moved, load("fanuc").machine).places(ProgramName(1234, None))
    assert [place.title for place in places] == ["subs/O1234", "more/O1234"]
