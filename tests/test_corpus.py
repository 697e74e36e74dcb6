"""The real programs beside the checkout: what is known to be wrong is named at its block, what is good stays silent."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from polarcheck.checking import check
from polarcheck.checking.finding import FileReport
from polarcheck.checking.rule import load_all
from polarcheck.machines import profiles
from polarcheck.machines.job import Job, with_tool

CORPUS = Path(__file__).parent.parent.parent / "shared" / "corpus"
FILES = sorted(path for path in CORPUS.rglob("*") if path.is_file() and path.name != "MANIFEST.tsv")
RULES = list(load_all().values())

pytestmark = [
    pytest.mark.corpus,
    pytest.mark.skipif(not CORPUS.is_dir(), reason="the real programs are not beside this checkout"),
]


def report_of(name: str, lathe: str = "fanuc", tools: tuple[str, ...] = ()) -> FileReport:
    job = Job()
    for tool in tools:
        job = with_tool(job, tool)
    path = CORPUS / name
    return check.check_file(path.read_bytes(), profiles.load(lathe).machine, job, RULES, path.name)


#: File, machine, offsets, and the errors and warnings that a good machinist would agree with.
JUDGED: list[tuple[str, str, tuple[str, ...], list[tuple[int, str]]]] = [
    ("polar-gen-g12poly-hex-s27-r05-climb.nc", "fanuc", ("1:radius=0",), []),
    ("polar-gen-g12poly-hex-s27-r05-conv.nc", "fanuc", ("1:radius=0",), []),
    ("polar-nx-nl1500y-full.nc", "fanuc", (), [(170, "z-with-plane-axis")]),
    ("polar-nx-nl1500y-full-raw.nc", "fanuc", (), [(176, "z-with-plane-axis")]),
    ("polar-seed-gsk-o0001-single.nc", "gsk-988", ("2:radius=6",), []),
    ("polar-seed-sample-two-flats.nc", "turning-center", ("8:radius=0",), []),
    ("polar-seed-flats-method-a.nc", "turning-center", ("1:radius=0.25",), [(28, "bad-number")]),
    ("polar-seed-flats-method-b.nc", "turning-center", ("1:radius=0.25",), [(21, "bad-number")]),
]


@pytest.mark.parametrize(("name", "lathe", "tools", "expected"), JUDGED, ids=[row[0] for row in JUDGED])
def test_judged_program(name: str, lathe: str, tools: tuple[str, ...], expected: list[tuple[int, str]]) -> None:
    found = report_of(f"polar/{name}", lathe, tools).findings
    assert [(f.line, f.rule) for f in found if f.severity != "note"] == expected


#: File, machine, and an offset of a cutter that is too large for its ramps, with the blocks that say so.
TOO_LARGE = [
    ("polar-seed-sample-two-flats.nc", "turning-center", "8:radius=0.375", {13, 18}),
    ("polar-seed-flats-method-a.nc", "turning-center", "1:radius=0.5", {13, 16, 22, 25}),
    ("polar-seed-flats-method-b.nc", "turning-center", "1:radius=0.5", {13, 18}),
    ("polar-seed-gsk-o0001-single.nc", "gsk-988", "2:radius=36", {11, 31}),
]


@pytest.mark.parametrize(("name", "lathe", "tool", "lines"), TOO_LARGE, ids=[row[0] for row in TOO_LARGE])
def test_a_cutter_too_large_for_its_ramps_is_found(name: str, lathe: str, tool: str, lines: set[int]) -> None:
    found = report_of(f"polar/{name}", lathe, (tool,)).findings
    ramps = {f.line for f in found if f.rule in ("start-up-shorter-than-radius", "cancel-shorter-than-radius")}
    assert ramps == lines


#: File, machine, and the defects that are known: each must be named, at its block.
DEFECTS: list[tuple[str, str, set[tuple[int, str]]]] = [
    (
        "polar-nx-nl1500y-hex-noC-defect.nc",
        "fanuc",
        {(line, "arc-end-off-circle") for line in (22, 24, 26, 27, 29, 31, 33, 34)}
        | {(19, "path-through-center"), (23, "path-through-center"), (30, "path-through-center")}
        | {(22, "plane-selected-in-polar")},
    ),
    ("polar-nx-nl1500y-annotated-raw.nc", "fanuc", {(28, "arc-end-off-circle"), (28, "plane-selected-in-polar")}),
    (
        "polar-star-sb12rg-o6point.nc",
        "fanuc",
        {(14, "path-through-center"), (7, "x-unknown-at-entry"), (31, "program-end-missing")},
    ),
    ("polar-star-o0017-fragment.nc", "fanuc", {(7, "arc-radius-too-small"), (4, "plane-selected-in-polar")}),
    (
        "polar-web-cncarea-ex1-endash.nc",
        "fanuc",
        {(6, "arc-end-off-circle"), (8, "arc-word-of-other-plane"), (10, "arc-end-off-circle")}
        | {(line, "wrong-dash") for line in (6, 7, 8)},
    ),
    (
        "polar-web-imd-mazak-qts-cdegrees.nc",
        "fanuc",
        {(2, "polar-never-left"), (5, "degrees-in-polar"), (5, "wrong-axis-address-in-polar")},
    ),
    ("polar-web-fanuc15i-autovelocity.nc", "fanuc", {(4, "c-feed-above-limit")}),
]


@pytest.mark.parametrize(("name", "lathe", "expected"), DEFECTS, ids=[row[0] for row in DEFECTS])
def test_known_defects_are_named(name: str, lathe: str, expected: set[tuple[int, str]]) -> None:
    found = {(f.line, f.rule) for f in report_of(f"polar/{name}", lathe).findings}
    assert expected <= found


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_every_program_gives_a_report(path: Path) -> None:
    report = report_of(str(path.relative_to(CORPUS)))
    assert msgspec.json.decode(msgspec.json.encode(report))["verdict"] in ("pass", "fail", "unverified")


#: An unfinished block, `G01X`, and one whose X is missing, `G00 3.7347`.
UNFINISHED = {"O4580": [(23, "bad-number")], "O0024": [(72, "unknown-code")]}

FANUC_LATHES = sorted((CORPUS / "general" / "mikemacfarland+Doosan-Lynx-300").glob("O*")) if CORPUS.is_dir() else []


@pytest.mark.parametrize("path", FANUC_LATHES, ids=lambda path: path.name)
def test_proven_lathe_programs_have_no_error(path: Path) -> None:
    found = report_of(str(path.relative_to(CORPUS))).findings
    assert [(f.line, f.rule) for f in found if f.severity == "error"] == UNFINISHED.get(path.name, [])
