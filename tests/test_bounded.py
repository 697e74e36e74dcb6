"""Reading what nobody vouches for: files, pipes, devices and folders, up to a limit."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from cases import looped

from polarcheck.foundation import bounded

needs_pipes = pytest.mark.skipif(sys.platform == "win32", reason="named pipes and devices are files of POSIX")
LIMIT = 3_000_000


def objection(path: str | os.PathLike[str], most: int = LIMIT, **options: bool) -> str:
    with pytest.raises(OSError, match=r".") as caught:
        bounded.read_file(path, most, "no table is", **options)
    return str(caught.value.strerror)


@pytest.mark.parametrize("size", [0, 1, 5, LIMIT - 1, LIMIT])
def test_a_file_up_to_the_limit_is_read_whole(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(os.urandom(size))
    assert bounded.read_file(path, LIMIT, "") == path.read_bytes()


def test_a_larger_file_is_refused_with_the_limit(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"x" * (LIMIT + 1))
    assert objection(path) == "larger than 3 MB; no table is"
    assert objection(path, 1_500_000) == "larger than 1.5 MB; no table is"


@pytest.mark.skipif(not hasattr(os, "truncate") or sys.platform == "win32", reason="files with holes")
def test_a_huge_file_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.touch()
    os.truncate(path, 1 << 40)
    assert objection(path).startswith("larger than 3 MB")


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="files that do not know their size")
def test_a_file_that_does_not_know_its_size() -> None:
    assert bounded.read_file("/proc/self/status", LIMIT, "").startswith(b"Name:")
    assert objection("/proc/self/status", 20).startswith("larger than")


def test_a_file_that_grows_while_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"x" * 10)
    read = os.read

    def grown(descriptor: int, count: int) -> bytes:
        with path.open("ab") as file:
            file.write(b"x" * 10)
        return read(descriptor, count)

    monkeypatch.setattr(os, "read", grown)
    assert objection(path, 1000).startswith("larger than")


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    assert objection(tmp_path) == "is a folder, not a file"


@looped("name", ["a\0b.toml", "\0", "a\ud800.toml" if sys.platform != "win32" else "\0"])
def test_names_that_no_file_can_have(name: str) -> None:
    assert objection(name) == "no file can have this name"


def test_missing_and_endless_names(tmp_path: Path) -> None:
    assert "No such file" in objection(tmp_path / "missing")
    assert objection("x" * 100_000)


@needs_pipes
@looped("pipes", [False, True])
@looped("device", ["/dev/zero", "/dev/null", "/dev/random", "/dev/tty"])
def test_devices_are_refused(device: str, pipes: bool) -> None:
    if Path(device).exists():
        assert objection(device, pipes=pipes) == "is a device, not a file"


@needs_pipes
def test_pipes_are_refused_unless_they_are_asked_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert objection(tmp_path / "pipe") == "is a pipe, not a file"


@pytest.mark.ci
@needs_pipes
def test_a_pipe_that_nobody_writes_to(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert objection(tmp_path / "pipe", pipes=True) == "is a pipe that nobody writes to"


@needs_pipes
@pytest.mark.parametrize(
    ("command", "text"),
    [
        ("printf 'G0 X1.' > pipe", b"G0 X1."),
        (": > pipe", b""),
        ("head -c 3000000 /dev/zero > pipe", bytes(3_000_000)),
    ],
)
def test_a_pipe_is_read_to_its_end(tmp_path: Path, command: str, text: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded, "_PATIENCE", 60_000)  # a busy machine may start processes slowly
    os.mkfifo(tmp_path / "pipe")
    with subprocess.Popen(["sh", "-c", command], cwd=tmp_path):
        assert bounded.read_file(tmp_path / "pipe", LIMIT, "", pipes=True) == text


@needs_pipes
def test_a_pipe_whose_writer_is_slow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded, "_PATIENCE", 1)
    os.mkfifo(tmp_path / "pipe")
    writer = os.open(tmp_path / "pipe", os.O_RDWR)

    def write() -> None:
        time.sleep(0.3)
        os.write(writer, b"G0 X1.")
        os.close(writer)

    thread = threading.Thread(target=write)
    thread.start()
    assert bounded.read_file(tmp_path / "pipe", LIMIT, "", pipes=True) == b"G0 X1."
    thread.join()


@needs_pipes
def test_a_pipe_without_end_is_read_up_to_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    os.mkfifo(tmp_path / "pipe")
    with subprocess.Popen(["sh", "-c", "exec cat /dev/zero > pipe"], cwd=tmp_path, stderr=subprocess.DEVNULL):
        monkeypatch.setattr(bounded, "_PATIENCE", 60_000)
        assert objection(tmp_path / "pipe", pipes=True) == "larger than 3 MB; no table is"


@needs_pipes
def test_a_file_that_becomes_a_pipe_between_looking_and_opening(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"x")
    opened = os.open

    def exchanged(*arguments: Any, **options: Any) -> int:
        path.unlink()
        os.mkfifo(path)
        return opened(*arguments, **options)

    monkeypatch.setattr(os, "open", exchanged)
    assert objection(path) == "is a pipe, not a file"


def test_nothing_stays_open(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"x" * 10)
    for most in (5, 10):
        if most == 5:
            objection(path, most)
        else:
            bounded.read_file(path, most, "")
    path.unlink()  # which Windows refuses for a file that is open
    if Path("/proc/self/fd").is_dir():
        assert not [fd for fd in Path("/proc/self/fd").iterdir() if os.path.realpath(fd).startswith(str(path))]


def test_a_stream_is_bounded_likewise() -> None:
    assert bounded.read_stream(io.BytesIO(b"x" * LIMIT), LIMIT, "") == b"x" * LIMIT
    with pytest.raises(OSError, match="larger than 3 MB; no table is"):
        bounded.read_stream(io.BytesIO(b"x" * (LIMIT + 1)), LIMIT, "no table is")


@needs_pipes
def test_a_stream_that_trickles() -> None:
    ours, theirs = os.pipe()

    def write() -> None:
        for letter in b"G0X1.":
            os.write(theirs, bytes([letter]))
        os.close(theirs)

    writer = threading.Thread(target=write)
    writer.start()
    with os.fdopen(ours, "rb") as stream:
        assert bounded.read_stream(stream, 5, "") == b"G0X1."
    writer.join()


@needs_pipes
def test_a_stream_that_does_not_want_to_wait_is_waited_for() -> None:
    ours, theirs = os.pipe()
    os.set_blocking(ours, False)

    def write() -> None:
        for part in (b"G0 ", b"X1."):
            time.sleep(0.1)
            os.write(theirs, part)
        os.close(theirs)

    writer = threading.Thread(target=write)
    writer.start()
    with os.fdopen(ours, "rb") as stream:
        assert bounded.read_stream(stream, LIMIT, "") == b"G0 X1."
    writer.join()


@needs_pipes
def test_a_file_that_is_written_to_while_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"x" * 10)
    os.utime(path, (1, 1))
    read = os.read

    def overwritten(descriptor: int, count: int) -> bytes:
        path.write_bytes(b"y" * 10)
        return read(descriptor, count)

    monkeypatch.setattr(os, "read", overwritten)
    assert objection(path) == "was changed while it was read"


@looped(
    ("size", "name"),
    [(999, "999 bytes"), (1500, "1.5 kB"), (512_000_000, "512 MB"), (2 * 10**9, "2 GB")],
)
def test_limits_are_named_in_round_numbers(size: int, name: str) -> None:
    assert bounded.megabytes(size) == name


# ---- folders that files are read from ----


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A folder, with a file and a link that leads out of it; beside it a secret."""
    folder = Path(os.path.realpath(tmp_path)) / "open"
    (folder / "inner").mkdir(parents=True)
    (folder / "inner" / "a.toml").write_bytes(b"a")
    (folder.parent / "secret.toml").write_bytes(b"s")
    (folder.parent / "open-too").mkdir()
    (folder.parent / "open-too" / "b.toml").write_bytes(b"b")
    if sys.platform != "win32":
        (folder / "link.toml").symlink_to(folder.parent / "secret.toml")
        (folder / "own.toml").symlink_to(folder / "inner" / "a.toml")
    return folder


def test_files_are_read_from_some_folders_alone(workspace: Path) -> None:
    with bounded.only_below([workspace]):
        assert bounded.read_file(workspace / "inner" / "a.toml", LIMIT, "") == b"a"
        assert bounded.read_file(workspace / "inner" / ".." / "inner" / "a.toml", LIMIT, "") == b"a"
        for outside in ("../secret.toml", "../open-too/b.toml", "inner/../../secret.toml"):
            assert objection(workspace / outside) == "lies outside the folders that are open"
            assert not bounded.may_read(workspace / outside)
    with bounded.only_below([]):
        assert objection(workspace / "inner" / "a.toml") == "lies outside the folders that are open"
    assert bounded.read_file(workspace.parent / "secret.toml", LIMIT, "") == b"s"
    assert bounded.may_read(workspace.parent)


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_links_do_not_lead_out_of_them(workspace: Path) -> None:
    with bounded.only_below([workspace]):
        assert bounded.read_file(workspace / "own.toml", LIMIT, "") == b"a"
        assert objection(workspace / "link.toml") == "lies outside the folders that are open"
        assert not bounded.may_read(workspace / "link.toml")


def test_a_thread_has_folders_of_its_own(workspace: Path) -> None:
    read: list[bytes] = []
    with bounded.only_below([workspace]):
        other = threading.Thread(
            target=lambda: read.append(bounded.read_file(workspace.parent / "secret.toml", LIMIT, "")),
        )
        other.start()
        other.join()
    assert read == [b"s"]
