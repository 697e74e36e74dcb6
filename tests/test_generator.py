"""The generated benchmark program is one that a machinist would run: what its blocks say, read in the plainest way."""

from __future__ import annotations

import cmath
import itertools
import math
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

pytestmark = pytest.mark.ci

GENERATOR = Path(__file__).parent.parent / "benchmarks" / "generate.py"
CUTTER_RADIUS = 2.0
C_FEED_LIMIT = 20_000.0
CLOSING_TOLERANCE = 0.002


def generate(*arguments: str) -> bytes:
    """What the generator writes to standard output."""
    return subprocess.run([sys.executable, GENERATOR, *arguments], capture_output=True, check=True).stdout


@dataclass(frozen=True)
class Move:
    """One block with movement in the plane inside the mode; points are x + 1j*c [mm, radius]."""

    block: str
    codes: tuple[str, ...]
    start: complex
    end: complex
    radius: float
    feed: float

    def tangents(self) -> tuple[complex, complex]:
        """Unit directions at the start and at the end."""
        chord = (self.end - self.start) / abs(self.end - self.start)
        if not self.arc:
            return chord, chord
        half = math.asin(abs(self.end - self.start) / 2 / self.radius) * (1 if "G3" in self.codes else -1)
        return chord * cmath.exp(-1j * half), chord * cmath.exp(1j * half)

    @property
    def arc(self) -> bool:
        return "G2" in self.codes or "G3" in self.codes


@dataclass(frozen=True)
class Pass:
    """From the ramp on to the ramp off."""

    ramp_on: Move
    contour: list[Move]
    ramp_off: Move


def read_block(block: str) -> tuple[tuple[str, ...], dict[str, str]]:
    """The G codes and the other words of a block."""
    words = re.findall(r"([A-Z])([-+]?[0-9.]+)", re.sub(r"\(.*?\)", "", block))
    return tuple(a + v for a, v in words if a == "G"), {a: v for a, v in words if a not in "GN"}


def sections(program: str) -> list[list[str]]:
    """The blocks between each G12.1 and its G13.1, the last positioning block before it in front."""
    found = []
    blocks = program.splitlines()
    for entry in (i for i, block in enumerate(blocks) if block.endswith("G12.1")):
        leave = next(i for i in range(entry, len(blocks)) if blocks[i].endswith("G13.1"))
        found.append([blocks[entry - 1], *blocks[entry + 1 : leave]])
    return found


def moves(section: list[str]) -> list[Move]:
    """The moves of a section in the plane."""
    here, feed = complex(float(read_block(section[0])[1]["X"]) / 2, 0.0), math.nan
    found = []
    for block in section[1:]:
        codes, words = read_block(block)
        feed = float(words.get("F", feed))
        if "X" in words or "C" in words:
            end = complex(float(words.get("X", 2 * here.real)) / 2, float(words.get("C", here.imag)))
            found.append(Move(block, codes, here, end, float(words.get("R", math.nan)), feed))
            here = end
    return found


def passes(program: str) -> list[Pass]:
    """All passes of all sections; raises where ramps do not alternate."""
    found: list[Pass] = []
    for section in sections(program):
        ramp_on: Move | None = None
        contour: list[Move] = []
        for move in moves(section):
            if "G41" in move.codes or "G42" in move.codes:
                assert ramp_on is None, move.block
                ramp_on, contour = move, []
            elif "G40" in move.codes:
                assert ramp_on is not None, move.block
                found.append(Pass(ramp_on, contour, move))
                ramp_on = None
            elif ramp_on is not None:
                contour.append(move)
        assert ramp_on is None, section[-1]
    return found


@pytest.fixture(scope="module")
def program() -> str:
    return generate("--blocks", "2000").decode("ascii")


def test_same_seed_same_bytes(program: str) -> None:
    assert generate("--blocks", "2000", "--seed", "1").decode("ascii") == program
    assert generate("--blocks", "2000", "--seed", "2").decode("ascii") != program


@pytest.mark.parametrize("blocks", [1000, 1999, 24_321])
def test_block_count(blocks: int, tmp_path: Path) -> None:
    assert generate("--blocks", str(blocks), "-o", str(tmp_path / "polar.nc")) == b""
    lines = (tmp_path / "polar.nc").read_bytes().splitlines()
    assert len(lines) == blocks + 2
    assert (lines[0], lines[-1]) == (b"%", b"%")
    assert lines[1].startswith(b"O0001 (")
    assert lines[-2].endswith(b" M30")


def test_too_few_blocks() -> None:
    run = subprocess.run([sys.executable, GENERATOR, "--blocks", "10"], capture_output=True, check=False)
    assert run.returncode == 2
    assert b"at least 1000" in run.stderr


def test_every_length_and_feed_has_a_point(program: str) -> None:
    words = re.sub(r"\(.*?\)", "", program)
    assert set(re.findall(r"[XZCRF][-+]?\d+(?![\d.])", words)) == {"C0"}


def test_no_block_twice_in_a_row(program: str) -> None:
    blocks = [block.split(" ", 1)[1] for block in program.splitlines()[2:-1]]
    assert [block for block, following in itertools.pairwise(blocks) if block == following] == []


def test_only_permitted_codes_in_polar(program: str) -> None:
    for section in sections(program):
        for block in section[1:]:
            codes, words = read_block(block)
            assert {"G1", "G2", "G3"} & set(codes), block
            assert set(codes) <= {"G1", "G2", "G3", "G40", "G41", "G42"}, block
            assert set(words) <= {"X", "C", "R", "F"} or set(words) <= {"Z", "F"}, block


def test_approach_outside_part_with_c_at_zero(program: str) -> None:
    bar = max(float(x) for x in re.findall(r"G1 X(\S+)", program.partition("G12.1")[0]))
    for section in sections(program):
        _, words = read_block(section[0])
        assert words["C"] == "0"
        assert float(words["X"]) > bar


def test_ramps(program: str) -> None:
    found = passes(program)
    assert {code for run in found for code in run.ramp_on.codes} == {"G1", "G41", "G42"}
    for run in found:
        assert set(run.ramp_off.codes) == {"G1", "G40"}
        for ramp in (run.ramp_on, run.ramp_off):
            assert ramp.start.imag == ramp.end.imag
            assert 2 * abs(ramp.end - ramp.start) > 2 * CUTTER_RADIUS
        # The tool comes on from outside and leaves to where it came from.
        assert abs(run.ramp_on.start) > abs(run.ramp_on.end)
        assert run.ramp_off.end == run.ramp_on.start


def test_contours_close_smoothly_on_the_right_side(program: str) -> None:
    for run in passes(program):
        contour = run.contour
        assert abs(contour[-1].end - run.ramp_on.end) <= CLOSING_TOLERANCE
        for move, following in zip(contour, [*contour[1:], contour[0]], strict=True):
            assert abs(cmath.phase(following.tangents()[0] / move.tangents()[1])) < math.radians(3), following.block
        turns = sum(cmath.phase(move.end / move.start) for move in contour) / math.tau
        assert turns == pytest.approx(-1 if "G41" in run.ramp_on.codes else 1, abs=1e-3)


def test_arcs_close(program: str) -> None:
    arcs = 0
    for run in passes(program):
        for before, move, after in zip(run.contour, run.contour[1:], run.contour[2:], strict=False):
            if not move.arc:
                continue
            arcs += 1
            chord = abs(move.end - move.start)
            assert chord < 2 * move.radius, move.block
            # The cutter would find room even if the arc bent towards it.
            assert move.radius > CUTTER_RADIUS, move.block
            # R and the sense of the arc fit the lines on both sides: these turn by what the arc and half of each turn.
            # An arc that sweeps too far by d stands chord * d / 8 off the contour at its middle.
            turned = cmath.phase((after.end - after.start) / (before.end - before.start))
            sense = 1 if "G3" in move.codes else -1
            sweep = sense * (chord + (abs(before.end - before.start) + abs(after.end - after.start)) / 2) / move.radius
            assert chord * abs(turned - sweep) / 8 < CLOSING_TOLERANCE, move.block
    assert arcs > 50


def test_c_axis_keeps_below_its_limit(program: str) -> None:
    for run in passes(program):
        nearest = min(abs(move.end) for move in run.contour)
        assert 15.0 <= nearest <= max(abs(move.end) for move in run.contour) <= 40.0
        feed = max(move.feed for move in [run.ramp_on, *run.contour, run.ramp_off])
        # F < L * R * pi / 180 (FANUC B-62764EN/01, p. 52), with L of the programmed path, nearer than the tool center.
        assert math.degrees(feed / nearest) < C_FEED_LIMIT
