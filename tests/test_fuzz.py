"""
A short share of the fuzzing that benchmarks/fuzz.py does for as long as asked: what must hold of any input does
(fuzz_targets.py), and the loop that chooses inputs finds what is wrong, makes it small and goes on.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import fuzz_rewriting
import fuzz_targets
import msgspec
import odd_programs
import pytest
import strategies
from cases import looped
from fuzz_loop import Loop, smallest, told_of
from fuzz_mutations import mutated
from fuzz_setups import SETUPS, BrokenError
from fuzz_targets import TARGETS, drawn, fits_schema, seeds
from hypothesis import HealthCheck, given, settings
from programs import ROOT
from test_cli import IMPORTED_FROM
from test_every_machine import HANDS

from polarcheck.rewrite.writing.outcome import Decision, Figure, Outcome

pytestmark = pytest.mark.nightly


not_on_windows = pytest.mark.skipif(sys.platform == "win32", reason="no bound on the time or memory of a process")

#: About a minute in all, on two cores. Of programs that look sound each costs a second.
fewest = settings(max_examples=10, deadline=None, suppress_health_check=list(HealthCheck))
few = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
more = settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))


@given(strategies.sound_programs(), strategies.setups)
@fewest
def test_programs_that_look_sound(data: bytes, setup: int) -> None:
    fuzz_targets.whole(data, setup)
    fuzz_targets.trace(data, setup)


@given(strategies.wild_programs(), strategies.setups)
@few
def test_wild_programs(data: bytes, setup: int) -> None:
    fuzz_targets.whole(data, setup)
    fuzz_targets.trace(data, setup)


@given(strategies.worse_programs(), strategies.setups)
@few
def test_mutated_programs(data: bytes, setup: int) -> None:
    fuzz_targets.whole(data, setup)


@given(strategies.programs(), strategies.setups)
@few
def test_the_command(data: bytes, setup: int) -> None:
    fuzz_targets.command(data, setup)


@given(strategies.programs(), strategies.setups)
@settings(few, max_examples=5)
def test_reports_fit_their_schema(data: bytes, setup: int) -> None:
    fits_schema(data, setup)


@given(strategies.programs(), strategies.setups)
@more
def test_the_reader(data: bytes, setup: int) -> None:
    fuzz_targets.reader(data, setup)


@pytest.mark.nightly
@given(strategies.statements(), strategies.setups)
@more
def test_macro_statements(data: bytes, setup: int) -> None:
    fuzz_targets.statement(data, setup)


@given(strategies.statements(), strategies.setups)
@few
def test_programs_of_macro_statements(data: bytes, setup: int) -> None:
    fuzz_targets.whole(data, setup)


@given(strategies.offset_tables(), strategies.setups)
@more
def test_offset_tables(data: bytes, setup: int) -> None:
    fuzz_targets.offsets(data, setup)


@given(strategies.setting_files)
@few
def test_machine_files_and_jobs(data: bytes) -> None:
    fuzz_targets.settings(data, 0)


# ---- the commands that write programs anew ----


def endings(target: str, count: int) -> Iterator[str]:
    """What is told of programs by grammar."""
    rng = Random(3)  # noqa: S311
    for _ in range(count):
        setup = rng.randrange(len(SETUPS))
        yield from TARGETS[target](fuzz_rewriting.program(rng, setup), setup)


@pytest.mark.one_in(1)
@pytest.mark.parametrize(
    ("target", "done"),
    [("convert", "back: done"), ("unroll", "again: "), ("roll", "done"), ("compensate", "center: done")],
)
def test_programs_by_grammar_are_rewritten_not_only_refused(target: str, done: str) -> None:
    assert any(text.startswith(done) for text in endings(target, 60))


@pytest.mark.parametrize(("target", "done"), [("compare", "differs"), ("certify", "['--update'] 1")])
def test_programs_by_grammar_are_compared(target: str, done: str) -> None:
    assert done in endings(target, 6)


@looped("machine", sorted(HANDS))
def test_a_program_by_grammar_is_the_same_every_time(machine: str) -> None:
    ours, theirs = ([odd_programs.drawn(Random(seed), machine) for seed in range(8)] for _ in range(2))  # noqa: S311
    assert ours == theirs
    assert len(set(ours)) == len(ours)


@pytest.mark.parametrize(
    ("broken", "kind"),
    [
        ({"origin": [3, 2, 1]}, "lines out of order"),
        ({"origin": [1, 1, 900]}, "a line that the original does not have"),
        ({"origin": [1]}, "not of each line"),
        ({"figures": [Figure("blocks", float("inf"))]}, "infinite figure"),
        ({"decisions": [Decision(77, "M8")]}, "a decision in no line"),
        ({"notes": ["two\nlines"]}, "several lines"),
        ({"notes": ["nan mm"]}, "no number"),
    ],
)
def test_what_is_wrong_with_an_outcome_is_a_failure(
    broken: dict[str, Any], kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    sound = Outcome(b"G1\nG2\nG3", [1, 2, 3], [], [], [])
    monkeypatch.setattr(fuzz_rewriting, "converted", lambda *_: msgspec.structs.replace(sound, **broken))
    with pytest.raises(BrokenError) as error:
        list(TARGETS["convert"](b"G1 X1.\nG1 X2.\nM30", 0))
    assert error.value.kind == kind


# ---- the loop itself ----


@not_on_windows
def test_what_is_kept_runs_again_for_its_own_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program of one control means nothing on another."""
    loop = Loop(1, ["convert"], 10)
    monkeypatch.setitem(TARGETS, "convert", lambda data, setup: [f"{data!r}"])
    monkeypatch.setitem(fuzz_targets.DRAWN_SHARES, "convert", 0.0)
    loop.one("convert", b"G1 X1.", 7)
    setups = Counter(loop._next()[2] for _ in range(200))
    assert setups[7] > 100


def fails_at(wanted: bytes) -> Callable[[bytes, int], Iterable[str]]:
    def target(data: bytes, setup: int) -> Iterable[str]:
        if wanted in data:
            raise BrokenError("planted")
        return []

    return target


def found_by(loop: Loop, seconds: float = 60) -> dict[str, bytes]:
    """The first failure, within a time that nobody needs."""
    return {failure.kind: failure.data for failure in [next(loop.run(time.monotonic() + seconds))]}


@not_on_windows
def test_what_fails_is_found_and_made_small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(TARGETS, "reader", fails_at(b"G13.1"))
    assert found_by(Loop(1, ["reader"], 10)) == {"planted": b"G13.1"}


@not_on_windows
def test_a_warning_and_a_hang_are_failures(monkeypatch: pytest.MonkeyPatch) -> None:
    def warns(data: bytes, setup: int) -> Iterable[str]:
        warnings.warn("planted", RuntimeWarning, stacklevel=1)
        return []

    def hangs(data: bytes, setup: int) -> Iterable[str]:
        while True:
            pass

    monkeypatch.setitem(TARGETS, "reader", warns)
    assert list(found_by(Loop(1, ["reader"], 10))) == ["RuntimeWarning in test_fuzz.warns"]
    monkeypatch.setitem(TARGETS, "reader", hangs)
    assert "HangError" in getattr(told_of("reader", b"G1", 0, 0.2), "kind", "")


@not_on_windows
def test_what_is_written_on_standard_error_is_a_failure() -> None:
    written = iter(["", "", "a library warns"])
    loop = Loop(1, ["reader"], 10, lambda: next(written, ""))
    found = [loop.one("reader", b"G1 X1.", 0) for _ in range(4)]
    assert [failure.reason if failure else "" for failure in found] == ["", "", "a library warns", ""]


@not_on_windows
def test_an_input_that_reaches_new_lines_is_kept() -> None:
    loop = Loop(1, ["reader"], 10)
    kept = []
    for data in (b"G1 X1.", b"G1 X1.", b"G1 X(A)1.--\n%<>", b"G1 X2."):
        loop.one("reader", data, 0)
        kept.append(loop.kept)
    assert kept[0] == kept[1] < kept[2] == kept[3]


def test_the_smallest_input_has_only_what_it_takes() -> None:
    data = b"".join(b"N%d X%d.\n" % (n, n) for n in range(60))
    assert smallest(data, lambda found: b"17" in found and b"\n" in found) == b"17\n"
    assert smallest(b"", lambda found: True) == b""


def test_mutation_of_a_seed_is_the_same_every_time() -> None:
    programs = seeds("whole")
    ours, theirs = (
        [mutated(programs[3], rng, programs) for _ in range(50)]
        for rng in (Random(5), Random(5))  # noqa: S311
    )
    assert ours == theirs
    assert len(set(ours)) > 40


@looped("target", TARGETS, one_in=14)
def test_seeds_hold(target: str) -> None:
    """A few of the inputs that the loop begins with, so that a failure later is one of a mutation."""
    rng = Random(2)  # noqa: S311
    begun = seeds(target)
    inputs = [(data, number) for number, data in enumerate(rng.sample(begun, 2))] if begun else []
    while len(inputs) < 2:
        inputs += filter(None, [drawn(target, rng)])
    for data, setup in inputs:
        TARGETS[target](data, setup)


# ---- the script ----


def script(*arguments: str) -> tuple[int, str]:
    import os
    import subprocess

    command = [sys.executable, str(ROOT / "benchmarks" / "fuzz.py"), *arguments]
    environment = {**os.environ, "PYTHONPATH": IMPORTED_FROM}
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    return run.returncode, run.stdout + run.stderr


@not_on_windows
def test_the_script_fuzzes_for_as_long_as_it_is_told() -> None:
    status, told = script("--minutes", "0.05", "--jobs", "1", "--target", "reader", "--target", "statement")
    assert (status, "0 distinct failures" in told) == (0, True), told
    assert " inputs in " in told


@not_on_windows
def test_the_script_bears_the_death_of_its_process(tmp_path: Path) -> None:
    """So little memory is not enough to begin with."""
    status, told = script("--minutes", "1", "--memory", "0.03", "--keep", str(tmp_path))
    assert status == 1, told
    assert "before any input" in told
    (about,) = tmp_path.glob("*.txt")
    assert "before any input" in json.loads(about.read_text())["kind"]
