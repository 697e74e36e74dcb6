"""What SECURITY.md promises of files, connections and processes: commands run beneath an audit hook of Python."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import pytest
from programs import ROOT

from polarcheck.commands import NAMES

HEXAGON = (ROOT / "sample_programs" / "hexagon.nc").read_text("utf-8")
RADIUS = ("--tool", "1:radius=4")
COMMA = "G98 T0101\nG0 X60. C0\nG12.1\nG1 G42 X30. F100\nC8,660\nG40 X60.\nG13.1\n"
JOB = '[tools.1]\nradius = 4.0\n\n[run]\nsubprograms = ["subs"]\n'
MANIFEST = """\
title = "A post"

[controls.lathe]
machine = "fanuc-30i"

[tools.1]
radius = 4.0

[feature.contour]

[[case]]
feature = "contour"
control = "lathe"
program = "a.nc"
golden = "golden/contour.jsonl"
"""
#: Runs each command of standard input within one process, and writes what each has opened, made or started.
DRIVER = """
import json, os, sys

events = None

def note(event, arguments):
    if events is None:
        return
    if event == "open" and isinstance(arguments[0], (str, bytes, os.PathLike)):
        path, mode, flags = os.fsdecode(arguments[0]), arguments[1] or "", arguments[2] or 0
        if set(mode) & set("wax+") or flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            events.append(["write", os.path.abspath(path)])
    elif event in ("os.rename", "os.link", "os.symlink"):
        events.append(["write", os.path.abspath(os.fsdecode(arguments[1]))])
    elif event == "os.mkdir" and os.path.isdir(arguments[0]):
        pass
    elif event in ("os.mkdir", "os.remove", "os.rmdir", "os.truncate", "os.chmod"):
        events.append(["write", os.path.abspath(os.fsdecode(arguments[0]))])
    elif event in ("socket.bind", "socket.connect", "socket.getaddrinfo", "socket.sendto"):
        events.append(["network", repr(arguments[1])])
    elif event in ("subprocess.Popen", "os.exec", "os.posix_spawn", "os.system", "webbrowser.open"):
        events.append(["process", str(arguments[0])])

sys.addaudithook(note)
from click.testing import CliRunner
from polarcheck.commands import main

seen = []
for arguments in json.load(sys.stdin):
    events = []
    result = CliRunner().invoke(main, arguments)
    noted, events = events, None
    seen.append({"status": result.exit_code, "output": result.output, "events": noted})
json.dump(seen, sys.stdout)
"""
#: The name of a file beside the one that it is to become.
_BESIDE = re.compile(r"\..*\.(?:new|orig)\Z|cache-key\.[0-9a-f]{16}\Z")


class Run(NamedTuple):
    """
    What a command did.

    status: its exit code.
    written: paths of files and folders that it made, replaced or removed, in the folder of the run; `~` is the home.
    network, processes: what it asked the system for.
    """

    status: int
    written: set[str]
    network: list[str]
    processes: list[str]


def runs(folder: Path, commands: Sequence[Sequence[str]]) -> list[Run]:
    """Run commands in one process, one after the other."""
    home = folder / "home"
    home.mkdir(exist_ok=True)
    work = folder / "work"
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("POLARCHECK", "XDG"))}
    process = subprocess.run(
        [sys.executable, "-B", "-c", DRIVER],
        input=json.dumps([list(command) for command in commands]),
        capture_output=True, text=True, check=True, cwd=work,
        env=environment | {"HOME": str(home), "LOCALAPPDATA": str(home), "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    return [
        Run(
            entry["status"],
            {
                _name(Path(path), work, home)
                for kind, path in entry["events"]
                if kind == "write" and path != os.devnull and not _BESIDE.match(Path(path).name)
            },
            [what for kind, what in entry["events"] if kind == "network"],
            [what for kind, what in entry["events"] if kind == "process"],
        )
        for entry in json.loads(process.stdout)
    ]


def _name(path: Path, work: Path, home: Path) -> str:
    if path.is_relative_to(work):
        return path.relative_to(work).as_posix()
    return f"~/{path.relative_to(home).as_posix()}" if path.is_relative_to(home) else str(path)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a job, a subprogram, a manifest and programs, and a home."""
    files: Mapping[str, str] = {
        "a.nc": HEXAGON, "comma.nc": COMMA, "subs/O9001": "O9001\nM99\n", "polarcheck.toml": JOB, "post.toml": MANIFEST,
    }  # fmt: skip
    for name, text in files.items():
        path = tmp_path / "work" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    return tmp_path


QUIET: Mapping[str, Sequence[Sequence[str]]] = {
    "baseline": (),
    "certify": (("certify", "post.toml"),),
    "check": (
        ("check", "--no-cache", "--jobs", "1", "."),
        ("check", "--no-cache", "--diff", "comma.nc"),
        ("check", "--no-cache", "--show-files", "."),
    ),
    "compare": (("compare", "a.nc", "comma.nc"),),
    "compensate": (("compensate", "a.nc"), ("compensate", "a.nc", "--center")),
    "completion": (("completion", "bash"),),
    "config": (("config", "show", "a.nc"),),
    "convert": (("convert", "a.nc", "--to", "haas-lathe"), ("convert", "a.nc", "--to", "okuma-osp", "--diff")),
    "explain": (("explain", "rapid-in-polar"),),
    "feeds": (("feeds", "a.nc"),),
    "init": (),
    "machines": (("machines",), ("machines", "fanuc"), ("machines", "check", "polarcheck.toml")),
    "part": (("part", "a.nc"),),
    "plot": (),
    "roll": (("roll", "a.nc"),),
    "rules": (("rules",),),
    "schema": (("schema",),),
    "server": (),
    "trace": (("trace", "a.nc"),),
    "unroll": (("unroll", "a.nc"), ("unroll", "a.nc", "--format", "json")),
}


@pytest.mark.nightly
def test_a_command_that_is_not_asked_for_a_file_writes_none(folder: Path) -> None:
    """No file, no connection, no process; `plot` and `init` are there to write, `server` is for editors."""
    assert tuple(QUIET) == NAMES
    commands = [command for of_name in QUIET.values() for command in of_name]
    for command, run in zip(commands, runs(folder, commands), strict=True):
        assert (command, run.written, run.network, run.processes) == (command, set(), [], [])
        assert run.status in (0, 1, 2), command


@pytest.mark.ci
def test_what_is_written_is_what_was_asked_for(folder: Path) -> None:
    cases: Mapping[Sequence[str], set[str]] = {
        ("check", "--no-cache", "a.nc", "-o", "json:a.json"): {"a.json"},
        ("plot", "a.nc", "-o", "a.html"): {"a.html"},
        ("baseline", "create", "."): {"polarcheck-baseline.json"},
        ("baseline", "update", "."): {"polarcheck-baseline.json"},
        ("check", "--no-cache", "--fix", "--unsafe-fixes", "--backup", "comma.nc"): {"comma.nc", "comma.nc.orig"},
        ("unroll", "a.nc", "-o", "new/"): {"new", "new/a.nc"},
        ("convert", "a.nc", "--to", "haas-lathe", "-o", "haas.nc"): {"haas.nc"},
        ("compensate", "a.nc", "--center", "--in-place", "--backup"): {"a.nc", "a.nc.orig"},
        ("machines", "new", "lathe3", "--from", "fanuc-30i"): {"lathe3.toml"},
        ("certify", "post.toml", "-o", "json:post.json", "--update"): {
            "post.json", "golden", "golden/contour.jsonl",
        },
        ("certify", "init", "suite"): {"suite"},
    }  # fmt: skip
    for (command, expected), run in zip(cases.items(), runs(folder, list(cases)), strict=True):
        top = {name for name in run.written if not name.startswith("suite/")}
        assert (command, top) == (command, expected)
        assert (run.network, run.processes) == ([], []), command


@pytest.mark.nightly
def test_a_check_writes_its_cache_and_the_key_of_it(folder: Path) -> None:
    """Beside the job file, and in the folder of caches of the user; the second run writes no more."""
    first, second, elsewhere = runs(
        folder,
        [("check", "a.nc"), ("check", "a.nc"), ("check", "a.nc", "--cache-dir", "kept")],
    )
    beside = {name for name in first.written if not name.startswith("~")}
    assert beside
    assert {Path(name).parts[0] for name in beside} == {".polarcheck_cache"}
    assert {name for name in first.written if name.startswith("~")} <= {
        "~/.cache", "~/.cache/polarcheck", "~/.cache/polarcheck/cache-key", "~/polarcheck", "~/polarcheck/cache-key",
        "~/Library", "~/Library/Caches", "~/Library/Caches/polarcheck", "~/Library/Caches/polarcheck/cache-key",
    }  # fmt: skip
    assert not second.written - {".polarcheck_cache"}
    assert {Path(name).parts[0] for name in elsewhere.written} == {"kept"}


@pytest.mark.ci
def test_git_is_the_only_process(folder: Path) -> None:
    for arguments in (
        ["init", "-q"],
        ["add", "."],
        ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "a"],
    ):
        subprocess.run(["git", *arguments], cwd=folder / "work", check=True)
    (run,) = runs(folder, [("check", "--no-cache", "--diff-base", "HEAD", ".")])
    assert run.status == 0
    assert {Path(process).stem for process in run.processes} == {"git"}
    assert (run.written, run.network) == (set(), [])


@pytest.mark.nightly
def test_a_picture_writes_the_list_of_fonts_of_matplotlib(folder: Path) -> None:
    (run,) = runs(folder, [("plot", "a.nc", "--png", "a.png")])
    assert "a.png" in run.written
    assert all(
        name.startswith("~") and "matplotlib" in name for name in run.written - {"a.png", "~/.cache", "~/.config"}
    )
    assert set(run.processes) <= {"fc-list", "system_profiler"}
    assert run.network == []
