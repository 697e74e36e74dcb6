"""The real programs beside the checkout: what is known to be wrong is named at its block, what is good stays silent."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import pytest
from cases import looped
from programs import CORPUS, report_of

from polarcheck.foundation.finding import FileReport

FILES = sorted(path for path in CORPUS.rglob("*") if path.is_file() and path.name != "MANIFEST.tsv")
POLAR = CORPUS / "polar"

pytestmark = [
    pytest.mark.ci,
    pytest.mark.corpus,
    pytest.mark.skipif(not CORPUS.is_dir(), reason="the real programs are not beside this checkout"),
]


def report_of_file(path: Path, *machine_and_tools: str, **given: Any) -> FileReport:
    """The report of a real program, which can be written whatever the program is."""
    report = report_of(path.read_bytes(), *machine_and_tools, **given, path=path.name)
    assert msgspec.json.decode(msgspec.json.encode(report))["verdict"] in ("pass", "fail", "unverified")
    return report


class Judged(NamedTuple):
    """The errors and warnings that a good machinist would agree with, of a file on a machine with these offsets."""

    name: str
    machine: str
    tools: tuple[str, ...]
    expected: list[tuple[int, str, str]]
    changes: dict[str, Any] | None = None


R10 = ("2:radius=10", "2:nose=0")
SYSTEM_B = {"control": {"g_code_system": "B"}}
JUDGED = [
    Judged("polar-gen-g12poly-hex-s27-r05-climb.nc", "fanuc", ("1:radius=0",), []),
    Judged("polar-gen-g12poly-hex-s27-r05-conv.nc", "fanuc", ("1:radius=0",), []),
    Judged("polar-nx-nl1500y-full.nc", "fanuc", (), []),
    Judged("polar-nx-nl1500y-full-raw.nc", "fanuc", (), []),
    Judged("polar-seed-gsk-o0001-single.nc", "gsk-988", ("2:radius=6",), []),
    Judged("polar-seed-gsk-o0001-single.nc", "gsk-988", R10, []),
    Judged("polar-seed-gsk-o0002-cycle-e8.nc", "gsk-988", R10, []),
    Judged("polar-seed-sample-two-flats.nc", "turning-center", ("8:radius=0",), []),
    Judged("polar-seed-flats-method-a.nc", "turning-center", ("1:radius=0.25",), [(28, "error", "bad-number")]),
    Judged("polar-seed-flats-method-b.nc", "turning-center", ("1:radius=0.25",), [(21, "error", "bad-number")]),
    Judged("polar-web-lsis-xgt-g112.nc", "lsis", R10, []),
    Judged("polar-web-imd-lynx220-fix-g01.nc", "doosan", R10, []),
    Judged(
        "polar-web-imd-mazak-qts-cdegrees.nc",
        "mazak-eia",
        R10,
        [
            (2, "error", "polar-never-left"),
            (5, "error", "wrong-axis-address-in-polar"),
            (5, "warning", "degrees-in-polar"),
        ],
    ),
    Judged(
        "polar-web-fanuc15i-autovelocity.nc",
        "fanuc",
        R10,
        [(4, "error", "c-feed-above-limit")],
        {**SYSTEM_B, "parameters": {"1422": 3600}},
    ),
    Judged(
        "polar-web-fanuc15i-autovelocity.nc",
        "fanuc",
        R10,
        [(4, "warning", "c-feed-above-limit")],
        {**SYSTEM_B, "parameters": {"1422": 3600, "5450#1": 1}},
    ),
]


@looped("row", JUDGED, ids=lambda row: " ".join([row.name, row.machine, *row.tools]), one_in=4)
def test_judged_program(row: Judged) -> None:
    report = report_of_file(POLAR / row.name, row.machine, *row.tools, changes=row.changes)
    found = [(f.line, f.severity, f.rule) for f in report.findings if f.severity != "note"]
    assert sorted(found) == sorted(row.expected)


#: File, machine, and an offset of a cutter that is too large for its ramps, with the blocks that say so.
TOO_LARGE = [
    ("polar-seed-sample-two-flats.nc", "turning-center", "8:radius=0.375", {13, 18}),
    ("polar-seed-flats-method-a.nc", "turning-center", "1:radius=0.5", {13, 16, 22, 25}),
    ("polar-seed-flats-method-b.nc", "turning-center", "1:radius=0.5", {13, 18}),
    ("polar-seed-gsk-o0001-single.nc", "gsk-988", "2:radius=36", {11, 31}),
]


@looped(("name", "lathe", "tool", "lines"), TOO_LARGE, ids=[row[0] for row in TOO_LARGE], one_in=2)
def test_a_cutter_too_large_for_its_ramps_is_found(name: str, lathe: str, tool: str, lines: set[int]) -> None:
    shown = report_of_file(POLAR / name, lathe, tool).findings
    found = [one for root in shown for one in (root, *root.follows)]
    ramps = {f.line for f in found if f.rule in ("start-up-shorter-than-radius", "cancel-shorter-than-radius")}
    assert ramps == lines


#: The defects that are known, on the default machine without offsets: each must be named, at its block.
DEFECTS: dict[str, set[tuple[int, str]]] = {
    "polar-nx-nl1500y-hex-noC-defect.nc": (
        # One finding for all arcs of the contour.
        {(22, "arc-end-off-circle")}
        | {(19, "path-through-center"), (23, "path-through-center"), (30, "path-through-center")}
        | {(22, "plane-selected-in-polar")}
    ),
    "polar-nx-nl1500y-annotated-raw.nc": {(28, "arc-end-off-circle"), (28, "plane-selected-in-polar")},
    "polar-star-sb12rg-o6point.nc": {
        (14, "path-through-center"),
        (7, "x-unknown-at-entry"),
        (31, "program-end-missing"),
    },
    "polar-star-o0017-fragment.nc": {(7, "arc-radius-too-small"), (4, "plane-selected-in-polar")},
    "polar-web-cncarea-ex1-endash.nc": (
        {(6, "arc-end-off-circle"), (8, "arc-word-of-other-plane")} | {(line, "wrong-dash") for line in (6, 7, 8)}
    ),
    "polar-web-imd-mazak-qts-cdegrees.nc": {
        (2, "polar-never-left"),
        (5, "degrees-in-polar"),
        (5, "wrong-axis-address-in-polar"),
    },
    "polar-web-fanuc15i-autovelocity.nc": {(4, "c-feed-above-limit")},
}


@pytest.mark.nightly
@looped("name", DEFECTS, one_in=4)
def test_known_defects_are_named(name: str) -> None:
    shown = report_of_file(POLAR / name).findings
    assert DEFECTS[name] <= {(one.line, one.rule) for found in shown for one in (found, *found.follows)}


#: An unfinished block, `G01X`, and one whose X is missing, `G00 3.7347`.
UNFINISHED = {"O4580": [(23, "bad-number")], "O0024": [(72, "unknown-code")]}

FANUC_LATHES = sorted((CORPUS / "general" / "mikemacfarland+Doosan-Lynx-300").glob("O*"))


@pytest.mark.parametrize("path", FANUC_LATHES, ids=lambda path: path.name)
def test_proven_lathe_programs_have_no_error(path: Path) -> None:
    found = report_of_file(path).findings
    assert [(f.line, f.rule) for f in found if f.severity == "error"] == UNFINISHED.get(path.name, [])


#: On the default machine without offsets, the ones above are checked there.
JUDGED_SO = {row.name for row in JUDGED if (row.machine, row.tools, row.changes) == ("fanuc", (), None)}
OTHERS = [path for path in FILES if path.name not in {*JUDGED_SO, *DEFECTS} and path not in FANUC_LATHES]


@looped("path", OTHERS, ids=lambda path: f"{path.parent.name}/{path.name}", one_in=18)
def test_every_other_program_gives_a_report(path: Path) -> None:
    report_of_file(path)


def test_every_program_is_checked_once() -> None:
    named = [POLAR / name for name in (*JUDGED_SO, *DEFECTS)]
    assert sorted([*OTHERS, *FANUC_LATHES, *named]) == FILES
