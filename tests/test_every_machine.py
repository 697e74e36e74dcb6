"""What a machinist would nod at, on every lathe: the same part written otherwise is the same part."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import example, given, settings
from hypothesis import strategies as st
from programs import job_of, machine_of, tables_of

from polarcheck.checking import check
from polarcheck.columns.path.moves import Moves, programmed_moves
from polarcheck.program.machines import profiles
from polarcheck.rules.rule import load_all

EXAMPLES = 2
#: Half the width of the part [mm].
HALF = 30.0


@dataclass(frozen=True)
class Hand:
    """
    How a program for a lathe is written, from its manual and posts, not from our profile.

    head: before the approach. on, off: of the mode, with what belongs there. axis: of the virtual axis. factor,
    outside: of X in the mode and outside of it, 2 for diameters. steps: addresses of incremental words; empty: by G91.
    arc: address of the radius. codes: line, G2, G3. turns: whether C at the switch turns the plane. sense: else -1
    where the tool stands at its angle the other way round.
    """

    head: str
    on: str = "G12.1"
    off: str = "G13.1"
    axis: str = "C"
    factor: int = 2
    outside: int = 2
    steps: str = "UH"
    arc: str = "R"
    codes: tuple[str, str, str] = ("G1", "G2", "G3")
    comment: str = "(COMMENT G0 X1.)"
    turns: bool = True
    sense: int = 1


FANUC = Hand("O1\nG40 G97 G98\nT0101")
HANDS = {
    "fanuc": FANUC,
    "fanuc-16i": FANUC,
    "fanuc-30i": replace(FANUC, on="G112", off="G113"),
    "turning-center": Hand("O1\nG18 G40 G97 G98\nT0101\nM5\nM35\nG28 H0\nM33 S1000"),
    "gsk-988": replace(FANUC, on="G12.1 P1 Q3"),
    "mitsubishi-m700": Hand("O1\nG17 G90 G94 G40 G97\nT0101", factor=1, outside=1, steps=""),
    "haas-lathe": Hand("O1\nG17 G40 G97 G98\nT0101\nM154\nM133 P1000", "G112", "G113", "Y", 1, steps="UV"),
    "okuma-osp": Hand(
        "O1\nG97 G40 G94\nM110\nT0101\nSB=1000 M13",
        "G137 C0",
        "G136",
        "Y",
        1,
        steps="",
        arc="L",
        codes=("G101", "G102", "G103"),
    ),
    "mazak-eia": Hand("O1\nG90 G94 G40 G97\nT0101\nM200\nG10.9 X1\nG17 XC", steps=""),
    "mazak-quick-turn": Hand("O1\nG40 G97 G98\nT0101\nM5\nM200\nM203 S3000\nG17 XC"),
    "mazak-integrex": Hand(
        "O1\nG90 G94 G40 G97\nT0101\nM205\nM200\nM3 S3000\nG10.9 X0\nG17 XC", factor=1, outside=1, steps=""
    ),
    "citizen": Hand("O1\nG40 G97 G98\nT0101", "G12.1 D0 E=C", axis="Y", factor=1, steps="UV"),
    "siemens-iso": Hand("O1\nG17 G90 G94 G40 G97\nT0101", steps=""),
    "siemens-transmit": Hand(
        "G90 G94 G40 G97\nT1 D1",
        "DIAMOF\nTRANSMIT",
        "TRAFOOF\nDIAMON",
        "Y",
        1,
        steps="",
        arc="CR=",
        comment="; COMMENT G0 X1.",
        sense=-1,
        turns=False,
    ),
    "doosan": Hand("O1\nG40 G97 G98\nM35\nG28 H0\nT0101"),
    "takisawa": Hand("O1\nG40 G97 G98\nM5\nM76\nG28 H0\nT0101\nM70 S3000"),
    "colchester": Hand("O1\nG40 G97 G98\nM109\nG28 H0\nT0101"),
    "hurco": Hand("O1\nG90 G94 G40 G97\nT0101\nM5\nM33 S3000\nG7", "G101", "G109", "Y", 1, 1, "", turns=False),
    "fagor-8055t": Hand(
        "G90 G94 G40 G97 G18\nT1 D1 M6\nM51\nG15",
        "G16 XC",
        "G18",
        factor=1,
        steps="",
        comment=";(COMMENT G0 X1.)",
        turns=False,
    ),
    "lsis": Hand("O1\nG40 G97 G98\nT0101", "G112", "G113", factor=1, outside=1),
}
#: Where the program itself says whether X is a diameter, not the lathe alone: how it says the other.
OTHERWISE: dict[str, dict[str, Any]] = {
    "siemens-transmit": {"on": "DIAMON\nTRANSMIT"},
    "hurco": {"head": HANDS["hurco"].head.replace("G7", "G8"), "outside": 2},
    "mazak-integrex": {"head": HANDS["mazak-integrex"].head.replace("G10.9 X0", "G10.9 X1"), "outside": 2},
    "mazak-eia": {"head": HANDS["mazak-eia"].head.replace("G10.9 X1", "G10.9 X0"), "outside": 1},
}
every_machine = pytest.mark.parametrize("name", sorted(HANDS))


@dataclass(frozen=True)
class Part:
    """A square with round corners about the center, and the feed on it."""

    corner: float
    feed: float

    def blocks(self) -> list[tuple[int, complex]]:
        """Kind (1, 2, 3) and end of each move, the way round counterclockwise, from the middle of a side to it."""
        inner, half, found = HALF - self.corner, HALF, []
        for turn in (1, 1j, -1, -1j):
            found += [(1, turn * complex(half, inner)), (3, turn * complex(inner, half))]
        return [*found, (1, complex(half, 0))]


parts = st.builds(Part, st.integers(9, 25).map(float), st.sampled_from([50.0, 300.0, 2000.0]))


def number(value: float) -> str:
    return f"{value:.9f}".rstrip("0")


def written(
    part: Part,
    hand: Hand,
    *,
    side: str = "G42",
    unit: float = 1.0,
    incremental: bool = False,
    mirrored: bool = False,
    split: bool = False,
    entry: float = 0.0,
) -> str:
    """The program of a part; unit: 25.4 for inch."""
    line, clockwise, counter = hand.codes
    mirror = -1 if mirrored else 1
    sense = {1: line, 3: clockwise if mirrored else counter}
    by_g91 = incremental and not hand.steps

    def block(kind: int, here: complex, end: complex, more: str = "") -> str:
        to = end - here if incremental else end
        x, c = hand.steps if incremental and hand.steps else ("X", hand.axis)
        arc = f" {hand.arc}{number(part.corner / unit)}" if kind == 3 else ""
        return (
            f"{more}{sense[kind]} {x}{number(to.real * hand.factor / unit)} {c}{number(mirror * to.imag / unit)}{arc}"
        )

    start, here = complex(HALF + 30, 0), complex(HALF, 0)
    lines = [hand.head, f"G0 X{number(hand.outside * start.real / unit)} C{number(entry)} Z{number(5 / unit)}"]
    # Where the block that begins the mode says in which direction of C its X axis points, it says the same.
    lines.append(hand.on.replace("C0", f"C{number(entry)}"))
    lines += ["G91"] if by_g91 else []
    lines.append(f"{block(1, start, here, f'{side} ')} F{number(part.feed / unit)}")
    for kind, end in part.blocks():
        if split and kind == 1:
            lines.append(block(1, here, (here + end) / 2))
            here = (here + end) / 2
        lines.append(block(kind, here, end))
        here = end
    lines.append(block(1, here, start, "G40 "))
    lines += ["G90"] if by_g91 else []
    return "\n".join([*lines, hand.off, f"G0 X{number(hand.outside * (HALF + 40) / unit)}", "M30", ""])


def read(name: str, program: str, radius: float, **given: Any) -> tuple[Moves, set[tuple[str, str]], str]:
    """The path of the tool, what is found, also as following from another finding, and the verdict."""
    unit = 25.4 if given.pop("inch", False) else 1.0
    stock = {"stock": {"diameter": given.pop("bar", 90) / unit}}
    job = {"program_units": "mm" if unit == 1.0 else "inch", **stock}
    tool, changes = f"1:radius={radius / unit},nose=0", given.pop("changes", {})
    machine = machine_of(name, {"limits": {"c_feed": 7200.0}, **changes})
    work = job_of(tool, job=job)
    found = check.read(program.encode(), machine, work)
    report = check.check_runs(found, list(load_all().values()))
    findings = {(each.rule, each.severity) for told in report.findings for each in (told, *told.follows)}
    return found[0][1]["moves"], findings, report.verdict


def assert_same_path(ours: Moves, theirs: Moves) -> None:
    assert len(ours) == len(theirs) > 0
    for column in ("start", "end", "center", "feed", "nearest", "c_feed"):
        np.testing.assert_allclose(getattr(ours, column), getattr(theirs, column), 1e-6, 1e-6, err_msg=column)
    for angle, other in zip(ours.c_angles, theirs.c_angles, strict=True):
        np.testing.assert_allclose(angle, other, atol=1e-5)


def test_every_machine_has_a_hand() -> None:
    assert sorted(HANDS) == profiles.names()


@pytest.mark.one_in(12)
@every_machine
def test_its_program_is_read_whole(name: str) -> None:
    """Else the twins would agree on nothing."""
    path, findings, verdict = read(name, written(Part(10.0, 300.0), HANDS[name]), 8.0)
    assert len(path) == 11
    assert path.known.all()
    np.testing.assert_allclose(np.max(np.abs(path.end.real[1:-1])), HALF + 8, atol=1e-9)
    assert {severity for _, severity in findings} <= {"note"}
    assert verdict == "pass"


def respelled(program: str, hand: Hand) -> str:
    """Other blanks, comments, N words and leading zeros, which mean nothing."""
    lines = []
    for at, line in enumerate(program.split("\n")):
        found = re.sub(r"\b([GM])(\d)\b", r"\g<1>0\2", line)
        found = found.replace(" ", "  ") if hand.arc == "CR=" else found.replace(" ", "")
        if found and not found.startswith("O"):
            found = f"N{10 * at} {found} {hand.comment}" if at % 2 else f"{found}\t"
        lines.append(found)
    return "\r\n".join(lines)


@pytest.mark.nightly
@pytest.mark.one_in(20)
@every_machine
@given(part=parts, radius=st.integers(1, 9))
@settings(max_examples=EXAMPLES, deadline=None)
def test_spelling_changes_nothing(name: str, part: Part, radius: int) -> None:
    program = written(part, HANDS[name])
    ours, findings, verdict = read(name, program, radius)
    theirs, same, other = read(name, respelled(program, HANDS[name]), radius)
    assert_same_path(ours, theirs)
    assert (findings, verdict) == (same, other)


@pytest.mark.nightly
@pytest.mark.one_in(20)
@every_machine
@given(part=parts, radius=st.integers(1, 9))
@settings(max_examples=EXAMPLES, deadline=None)
def test_twins_have_the_same_path(name: str, part: Part, radius: int) -> None:
    """Incremental, in inch, and on a lathe on which X in the mode is the other of diameter and radius."""
    hand = HANDS[name]
    ours, findings, verdict = read(name, written(part, hand), radius)
    other = 3 - hand.factor
    otherwise = replace(hand, factor=other, **OTHERWISE.get(name, {}))
    x = {"polar": {"x": "diameter" if other == 2 else "radius"}}
    for program, options in (
        (written(part, hand, incremental=True), {}),
        (written(part, hand, unit=25.4), {"inch": True}),
        (written(part, otherwise), {"changes": x}),
    ):
        theirs, same, result = read(name, program, radius, **options)
        assert_same_path(ours, theirs)
        assert (findings, verdict) == (same, result), options


@pytest.mark.nightly
@pytest.mark.one_in(5)
@pytest.mark.parametrize("name", sorted(name for name, hand in HANDS.items() if hand.turns))
@given(part=parts, radius=st.integers(1, 9), angle=st.integers(-179, 180))
@settings(max_examples=EXAMPLES, deadline=None)
def test_turning_shifts_only_c(name: str, part: Part, radius: int, angle: int) -> None:
    """The C angle at G12.1 turns the whole plane."""
    hand = HANDS[name]
    ours, findings, verdict = read(name, written(part, hand), radius)
    theirs, same, other = read(name, written(part, hand, entry=angle), radius)
    np.testing.assert_array_equal(ours.end, theirs.end)
    for before, after in zip(ours.c_angles, theirs.c_angles, strict=True):
        np.testing.assert_allclose(after - before, angle, atol=1e-9)
    assert (findings, verdict) == (same, other)


@pytest.mark.ci
@pytest.mark.one_in(5)
@pytest.mark.parametrize("name", sorted(name for name, hand in HANDS.items() if not hand.turns))
@given(part=parts, radius=st.integers(1, 9), angle=st.integers(-179, 180))
@settings(max_examples=EXAMPLES, deadline=None)
def test_where_the_plane_stays_with_the_part_only_the_way_to_it_changes(
    name: str, part: Part, radius: int, angle: int
) -> None:
    hand = HANDS[name]
    ours, *_ = read(name, written(part, hand), radius)
    theirs, *_ = read(name, written(part, hand, entry=angle), radius)
    np.testing.assert_allclose(theirs.start[0], (HALF + 30) * np.exp(1j * np.radians(hand.sense * angle)), atol=1e-9)
    np.testing.assert_allclose(theirs.end[1:], ours.end[1:], atol=1e-9)
    np.testing.assert_allclose(theirs.c_angles[0][0], angle, atol=1e-9)
    if hand.sense < 0:
        return  # the sense of C is machine data that no profile has
    turns = (theirs.c_angles[1][1:] - ours.c_angles[1][1:]) / 360
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)


@pytest.mark.ci
@pytest.mark.one_in(10)
@every_machine
@given(part=parts, radius=st.integers(1, 9))
@settings(max_examples=EXAMPLES, deadline=None)
def test_mirroring_swaps_the_sides(name: str, part: Part, radius: int) -> None:
    hand = HANDS[name]
    ours, findings, verdict = read(name, written(part, hand), radius)
    theirs, same, other = read(name, written(part, hand, side="G41", mirrored=True), radius)
    np.testing.assert_allclose(theirs.end, np.conj(ours.end), atol=1e-9)
    np.testing.assert_allclose(theirs.c_feed, ours.c_feed, rtol=1e-9)
    assert (findings, verdict) == (same, other)


@pytest.mark.one_in(5)
@every_machine
@given(part=parts)
@settings(max_examples=EXAMPLES, deadline=None)
def test_radius_zero_gives_the_programmed_path(name: str, part: Part) -> None:
    tables = tables_of(written(part, HANDS[name]), name, "1:radius=0,nose=0", job={"program_units": "mm"})
    programmed = programmed_moves(tables["trace"])
    np.testing.assert_allclose(tables["moves"].end, programmed.end[programmed.length > 1e-9], atol=1e-9)


@pytest.mark.nightly
@pytest.mark.one_in(20)
@every_machine
@given(part=parts, radius=st.integers(1, 9), limit=st.floats(100, 5000), more=st.floats(1, 9))
@example(part=Part(9.0, 300.0), radius=1, limit=100.0, more=6.0)
@settings(max_examples=EXAMPLES, deadline=None)
def test_raising_a_limit_adds_no_finding(name: str, part: Part, radius: int, limit: float, more: float) -> None:
    program = written(part, HANDS[name])
    keys = ("c_feed", "c_acceleration", "polar_feed")
    (_, low, _), (_, high, _) = (
        read(name, program, radius, changes={"limits": dict.fromkeys(keys, value)}) for value in (limit, limit * more)
    )
    assert high <= low


@pytest.mark.ci
@pytest.mark.one_in(10)
@every_machine
@given(part=parts, radius=st.integers(1, 9))
@settings(max_examples=EXAMPLES, deadline=None)
def test_splitting_a_move_changes_no_finding(name: str, part: Part, radius: int) -> None:
    hand = HANDS[name]
    ours, findings, verdict = read(name, written(part, hand), radius)
    theirs, same, other = read(name, written(part, hand, split=True), radius)
    assert (findings, verdict) == (same, other)
    assert len(theirs) == len(ours) + 5
    np.testing.assert_allclose(np.nansum(theirs.time), np.nansum(ours.time), rtol=1e-9)


@pytest.mark.nightly
@every_machine
@looped("radius", [9.5, 12.0, 20.0], one_in=20)
def test_a_cutter_too_large_for_a_pocket_is_found(name: str, radius: float) -> None:
    """Inside the square, where its corners are smaller than R."""
    hand = HANDS[name]
    _, findings, verdict = read(name, written(Part(9.0, 300.0), hand, side="G41"), radius)
    assert verdict == "fail"
    assert {rule for rule, severity in findings if severity == "error"}


@pytest.mark.ci
@every_machine
@looped("radius", [30.5, 45.0], one_in=14)
def test_a_ramp_shorter_than_r_is_found(name: str, radius: float) -> None:
    """The start-up is 30 mm long."""
    _, findings, verdict = read(name, written(Part(9.0, 300.0), HANDS[name]), radius, bar=1)
    assert verdict == "fail"
    assert "start-up-shorter-than-radius" in {rule for rule, _ in findings}
