"""Archives in git, drawn: jobs, links, submodules, tables and machine files, and one change of each kind in them."""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path

from test_deviations import polygon, program
from test_diff_base import commit, git
from test_drawing_options import dxf

#: A contour with G42 that calls O9001: R of offset 8, the lathe and the called program all show in its report.
CALLER = """O0002
T0808
G98 G97 S2000 M3
G0 X80. C0
G12.1
G1 G42 X50. F500
C20.
X-50.
C-20.
X50.
C0
M98 P9001
G1 G40 X80.
G13.1
M30
"""
PLAIN = CALLER.replace("M98 P9001\n", "")
CALLED = "O9001\nG1 X50.\nM99\n"
BAD_CALLED = "O9001\nG0 X55.\nM99\n"
TABLE = "%\nG10 L10 P8 R{}\n%\n"
LATHE = 'inherits = "{}"\n[limits]\nc_feed = {}\n'


class Archive:
    """
    An archive in the working folder, as it was committed.

    Everything that the job of the cell `one` names lies behind as many links as were drawn.
    """

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)  # noqa: S311
        git("init", "-q", "-b", "main", "lib")
        self._write({"lib/O9001": CALLED, "lib/O9009": "O9009\nM99\n", "lib/README": "Called programs."})
        git("add", "-A", folder="lib")
        git("commit", "-q", "-m", "x", folder="lib")
        git("init", "-q", "-b", "main", "archive")
        os.chdir("archive")
        git("-c", "protocol.file.allow=always", "submodule", "--quiet", "add", "../lib", "vendor")
        git("-c", "protocol.file.allow=always", "submodule", "--quiet", "add", "../lib", "deep/vendor")
        self._fill()
        commit()

    def _write(self, texts: dict[str, str]) -> None:
        for name, text in texts.items():
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_text(text)

    def _fill(self) -> None:
        of_part = '[[part]]\ndrawing = "d.dxf"\n'
        of_jobs = 'offsets = "table"\n[run]\nsubprograms = ["subs"]\n'
        self._write(
            {
                "README.md": "An archive.",
                "pyproject.toml": "[project]\nname = 'archive'\n",
                "shared/v1/polarcheck.toml": 'units = "mm"\n[severities]\nmain-spindle-running-at-entry = "note"\n',
                "shared/v2/polarcheck.toml": 'units = "mm"\n[severities]\nmain-spindle-running-at-entry = "warning"\n',
                **{f"lathes/v{number}/m.toml": LATHE.format("base.toml", 3600 + number) for number in (1, 2)},
                **{f"lathes/v{number}/base.toml": 'inherits = "fanuc-30i"\n' for number in (1, 2)},
                "lathes/other.toml": LATHE.format("fanuc-30i", 4711) + "x_feed = 4711\n",
                "shared/polarcheck.toml": '[severities]\nmain-spindle-running-at-entry = "error"\n',
                "tables/t1": TABLE.format("4."),
                "tables/t2": TABLE.format("30."),
                "calls/v1/O9001": CALLED,
                "calls/v2/O9001": BAD_CALLED,
                "calls/v1/O9009": "O9009\nM99\n",
                "calls/v2/O9009": "O9009\nM99\n",
                "one/polarcheck.toml": f'extend = "base"\nmachine = "lathes/m.toml"\n{of_jobs}{of_part}',
                "one/calls.nc": CALLER,
                "one/plain.nc": PLAIN,
                "one/deeper/calls.nc": CALLER,
                "two/pyproject.toml": "[project]\nname = 'two'\n[tool.polarcheck]\nmachine = '../lathes/other.toml'\n"
                "[tool.polarcheck.run]\nsubprograms = ['../vendor']\n",
                "two/calls.nc": CALLER,
                "two/plain.nc": PLAIN,
                "three/calls.nc": CALLER,
                "three/polarcheck.toml": "[run]\nsubprograms = ['sub']\n",
                "four/plain.nc": PLAIN,
                "four/old/plain.nc": PLAIN,
                "four/polarcheck.toml": "exclude = ['old']\n",
                "four/old/polarcheck.toml": "strict = false\n",
            }
        )
        for number, size in ((1, 13.5), (2, 13.9)):
            dxf(Path(f"tables/d{number}.dxf"), {"0": polygon(6, size)})
        Path("one/part.nc").write_text(program(polygon(6, 13.5)))
        self.ends: dict[str, tuple[str, str]] = {}
        for name, targets in {
            "base": ("shared/v1", "shared/v2"),
            "lathes": ("lathes/v1", "lathes/v2"),
            "table": ("tables/t1", "tables/t2"),
            "d.dxf": ("tables/d1.dxf", "tables/d2.dxf"),
            "subs": ("calls/v1", "calls/v2"),
        }.items():
            self._link(f"one/{name}", targets, self.random.randint(0, 2))
        self._link("lathes/v1/base.toml", ("lathes/v2/base.toml", "lathes/other.toml"), 1)
        self._link("three/sub", ("deep/vendor", "calls/v2"), self.random.randint(0, 1))
        self._link("four/linked.nc", ("one/plain.nc", "one/calls.nc"), self.random.randint(0, 1))

    def _link(self, name: str, targets: tuple[str, str], through: int) -> None:
        """Make a link, to other links if so many are to be passed; remember the last of them, which can be moved."""
        Path(name).unlink(missing_ok=True)
        stem = name.replace("/", "_")
        for number in range(through):
            between = f"links/{stem}_{number}"
            Path("links").mkdir(exist_ok=True)
            Path(name).symlink_to(os.path.relpath(between, Path(name).parent))
            name = between
        Path(name).symlink_to(os.path.relpath(targets[0], Path(name).parent))
        self.ends[name] = targets

    def move(self, what: str) -> None:
        """Have a link lead elsewhere: the last one behind a name."""
        (end,) = [name for name in self.ends if name == what or name.startswith(f"links/{what.replace('/', '_')}_")]
        Path(end).unlink()
        Path(end).symlink_to(os.path.relpath(self.ends[end][1], Path(end).parent))

    def edit(self, path: str, before: str, after: str) -> None:
        text = Path(path).read_text()
        assert before in text, path
        Path(path).write_text(text.replace(before, after))

    def in_submodule(self, change: Callable[[], object], folder: str, *, commits: bool) -> None:
        change()
        if commits:
            git("add", "-A", folder=folder)
            git("commit", "-q", "-m", "y", folder=folder)

    def replace_by_folder(self, path: str, text: str) -> None:
        if Path(path).is_symlink():
            Path(path).unlink()
        else:
            git("rm", "-q", "-f", path)
            shutil.rmtree(path, ignore_errors=True)
        Path(path).mkdir()
        Path(path, "O9001").write_text(text)


def _submodule(folder: str, name: str, text: str, *, commits: bool) -> Callable[[Archive], None]:
    return lambda archive: archive.in_submodule(lambda: Path(folder, name).write_text(text), folder, commits=commits)


def _unlink(path: str) -> Callable[[Archive], None]:
    return lambda archive: Path(path).unlink()


def _moved(name: str) -> Callable[[Archive], None]:
    return lambda archive: archive.move(name)


def _edit(path: str, before: str, after: str) -> Callable[[Archive], None]:
    return lambda archive: archive.edit(path, before, after)


def _write(path: str, text: str) -> Callable[[Archive], None]:
    return lambda archive: archive._write({path: text})


#: A change of each kind.
CHANGES: dict[str, Callable[[Archive], object]] = {
    "pyproject deleted": _unlink("two/pyproject.toml"),
    "pyproject without its table": _write("two/pyproject.toml", "[project]\nname = 'two'\n"),
    "pyproject renamed": lambda archive: Path("two/pyproject.toml").rename("two/project.toml"),
    "pyproject with a table": _write("calls/pyproject.toml", "[tool.polarcheck]\nmachine = 'haas-lathe'\n"),
    "link of subprograms": _moved("one/subs"),
    "link of lathes": _moved("one/lathes"),
    "link of an inherited machine": _moved("lathes/v1/base.toml"),
    "link of an extended folder": _moved("one/base"),
    "link of a drawing": _moved("one/d.dxf"),
    "link of an offset table": _moved("one/table"),
    "link to a submodule": _moved("three/sub"),
    "link that is a program": _moved("four/linked.nc"),
    "submodule at another commit": _submodule("vendor", "O9001", BAD_CALLED, commits=True),
    "submodule edited in place": _submodule("vendor", "O9001", BAD_CALLED, commits=False),
    "submodule behind a link at another commit": _submodule("deep/vendor", "O9001", BAD_CALLED, commits=True),
    "submodule behind a link edited in place": _submodule("deep/vendor", "O9001", BAD_CALLED, commits=False),
    "new in a submodule": _submodule("vendor", "9001.NC", BAD_CALLED, commits=False),
    "committed anew in a submodule": _submodule("vendor", "9001.NC", BAD_CALLED, commits=True),
    "deleted in a submodule": lambda archive: Path("vendor/O9001").unlink(),
    "submodule becomes a folder": lambda archive: archive.replace_by_folder("vendor", BAD_CALLED),
    "link becomes a folder": lambda archive: archive.replace_by_folder("one/subs", BAD_CALLED),
    "extended job deleted": _unlink("shared/v1/polarcheck.toml"),
    "extended job edited": _edit("shared/v1/polarcheck.toml", '"note"', '"off"'),
    "job edited": _edit("three/polarcheck.toml", "[run]", "strict = true\n[run]"),
    "job deleted": _unlink("three/polarcheck.toml"),
    "nearer job deleted": _unlink("one/polarcheck.toml"),
    "nearer job comes": _write("one/deeper/polarcheck.toml", "units = 'inch'\n"),
    "job above comes": _write("polarcheck.toml", "strict = true\nunits = 'inch'\n"),
    "less is excluded": _edit("four/polarcheck.toml", "['old']", "[]"),
    "offset table edited": _edit("tables/t1", "R4.", "R30."),
    "drawing edited": lambda archive: shutil.copy("tables/d2.dxf", "tables/d1.dxf"),
    "machine edited": _edit("lathes/v1/m.toml", "3601", "3700"),
    "inherited machine edited": _edit("lathes/v2/base.toml", "fanuc-30i", "fanuc"),
    "subprogram edited": _edit("calls/v1/O9001", "G1 X50.", "G0 X55."),
    "subprogram deleted": _unlink("calls/v1/O9001"),
    "subprogram renamed": lambda archive: Path("calls/v1/O9001").rename("calls/v1/O9002"),
    "subprogram that shadows": _write("calls/v1/9001.NC", BAD_CALLED),
    "program edited": _edit("one/plain.nc", "C20.", "C21."),
}
#: Changes that concern no program.
UNRELATED: dict[str, Callable[[Archive], object]] = {
    "README": _edit("README.md", "archive", "folder"),
    "pyproject of somebody else": _edit("pyproject.toml", "'archive'", "'another'"),
    "machine that nobody names": _write("lathes/v3/m.toml", LATHE.format("fanuc", 1)),
    "README of a submodule": _submodule("vendor", "README", "More.", commits=True),
    "README of a submodule, edited": _submodule("deep/vendor", "README", "More.", commits=False),
    "link that nobody follows": lambda archive: Path("links.old").symlink_to("shared"),
    "job of no program": _write("tables/notes/polarcheck.toml", "strict = true\n"),
}
