"""
What must hold of any program in the commands that write it anew, and in compare and certify: the targets of
fuzz_targets.py for these.

A program is rewritten, or refused by a PolarcheckError; what is written is read again and rewritten further.
"""

from __future__ import annotations

import functools
import json
import re
import tempfile
import zlib
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from random import Random
from typing import TypeVar

import msgspec
from click.testing import CliRunner
from fuzz_mutations import mutated
from fuzz_setups import SETUPS, BrokenError, expect, job_of_setup
from odd_programs import drawn
from polarcheck.errors import PolarcheckError
from setter_dialects import DIALECTS
from setter_programs import FAMILIES
from setter_programs import drawn as drawn_by_setter

from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.commands import main
from polarcheck.files.settings.of_programs import OfPrograms, Options, on_machine
from polarcheck.foundation.time_limit import time_limit
from polarcheck.program.machines import profiles
from polarcheck.program.machines.feed_keys import WITH_ROTARY
from polarcheck.program.reading.source import read_source
from polarcheck.reports.pages.painting import plain
from polarcheck.rewrite.compare import comparison_page as comparison
from polarcheck.rewrite.compare.comparison_report import DIFFERS, SAME_METAL
from polarcheck.rewrite.compare.revision_comparison import Revision, compared, default_tolerance
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rewrite.compensate.centering import centered
from polarcheck.rewrite.compensate.compensating import Compensating, compensated
from polarcheck.rewrite.convert.converting import converted
from polarcheck.rewrite.convert.doubtful_values import KEYS
from polarcheck.rewrite.roll.rolling import Rolling, rolled
from polarcheck.rewrite.unroll.unrolled_feeds import FEEDS
from polarcheck.rewrite.unroll.unrolling import Unrolling, unrolled
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Outcome, RefusedError
from polarcheck.rewrite.writing.rewritten_program import Work, rewritten

#: As long as a check in SETUPS may take [s].
_SECONDS = 5.0
_RUN = "[controls.A.run]\nmax_blocks = 3000\nmax_statements = 2000\nmax_seconds = 5\n"
_NO_NUMBER = re.compile(r"(?<![A-Za-z0-9_])[-+]?(?:inf|nan)(?![A-Za-z0-9_])")
Choice = TypeVar("Choice")
_SIDES = ("", "left", "right", "part-inside", "part-outside")


def program(random: Random, setup: int) -> bytes:
    """A program by grammar for the machine of a setup: one with odd moves, or a sound one with something changed."""
    machine = SETUPS[setup].machine
    if random.random() < 0.7 or machine not in DIALECTS:
        return drawn(random, machine)
    data = drawn_by_setter(random.randrange(10_000), machine, random.choice(FAMILIES)).text().encode()
    return data if random.random() < 0.4 else mutated(data, random, (drawn(random, machine),))


# ---- the targets: what each is told tells a new kind of input from another ----


def convert(data: bytes, setup: int) -> Iterable[str]:
    """To another control, for which it is a program of its own, whose words stay; and back."""
    settings = _settings(setup)
    name = _chosen(data, profiles.names())
    outcome = _rewritten(data, settings, lambda original: converted(original, on_machine(settings, name), KEYS))
    if not isinstance(outcome, Outcome):
        return outcome
    there = on_machine(settings, name)
    again = _rewritten(outcome.data, there, lambda original: converted(original, on_machine(there, name), KEYS))
    expect(
        not isinstance(again, Outcome) or bool(again.decisions) or _words(again.data) == _words(outcome.data),
        "converted for its own control: it changes",
    )
    back = _rewritten(outcome.data, there, lambda original: converted(original, on_machine(there, settings.name), KEYS))
    return [f"to {name}", f"{len(outcome.decisions) > 0}", *_endings("back", back)]


def unroll(data: bytes, setup: int) -> Iterable[str]:
    """To plain moves of X and C, which have no section, and to sections again."""
    settings, feed = _settings(setup), _chosen(data, ("", "", *FEEDS))
    chord_error = _chosen(data, (0.005, 0.005, 0.0005, 0.1), 1)
    outcome = _rewritten(data, settings, lambda original: unrolled(original, Unrolling(chord_error, feed)))
    if not isinstance(outcome, Outcome):
        return outcome
    trace = check.read(outcome.data, settings.machine, settings.job)[0][1]["trace"]
    expect(not len(trace.mode.sections), "unrolled: it has sections")
    rule = feed if feed in WITH_ROTARY else ""
    return [f"by {feed}", *_endings("again", roll_with(outcome.data, settings, Rolling(feed=rule)))]


def roll(data: bytes, setup: int) -> Iterable[str]:
    """To polar sections, and once more."""
    options = Rolling(
        _chosen(data, (0.01, 0.01, 0.0001, 0.5)), _chosen(data, ("", *WITH_ROTARY), 1), _chosen(data, (False, True), 2)
    )
    outcome = roll_with(data, _settings(setup), options)
    if not isinstance(outcome, Outcome):
        return outcome
    return ["done", *_endings("again", roll_with(outcome.data, _settings(setup), options))]


def roll_with(data: bytes, settings: Settings, options: Rolling) -> Outcome | list[str]:
    """What comes of rolling a program."""
    return _rewritten(data, settings, lambda original: rolled(original, options))


def compensate(data: bytes, setup: int) -> Iterable[str]:
    """To contours with G41 or G42, to paths of the tool center, and back from there."""
    settings, options = _settings(setup), Compensating(_chosen(data, _SIDES))

    def compensates(original: Original) -> Outcome:
        return compensated(original, options)

    contour = _rewritten(data, settings, compensates)
    center = _rewritten(data, settings, centered)
    endings = [*_endings("contour", contour), *_endings("center", center)]
    if isinstance(contour, Outcome):
        endings += _endings("center of contour", _rewritten(contour.data, settings, centered))
    if isinstance(center, Outcome):
        endings += _endings("contour of center", _rewritten(center.data, settings, compensates))
    return endings


def compare(data: bytes, setup: int) -> Iterable[str]:
    """With itself and with a changed one, both ways round: neither is worse."""
    settings = _settings(setup)
    random = Random(zlib.crc32(data))  # noqa: S311
    changed = mutated(data, random, (drawn(random, settings.name),))
    try:
        old, new = (
            Revision(name, settings.name, check.read(text, settings.machine, settings.job))
            for name, text in (("a.nc", data), ("b.nc", changed))
        )
    except PolarcheckError as error:
        return [_said(error)]
    found = []
    for pair in ((old, old), (old, new), (new, old)):
        try:
            with time_limit(4 * _SECONDS):
                result = compared(*pair, Terms(default_tolerance(*pair)))
        except PolarcheckError as error:
            found.append(_said(error))
            continue
        found.append(result.verdict)
        json.loads(msgspec.json.encode(result), parse_constant=functools.partial(BrokenError, "no JSON"))
        text = comparison.text(result, inch=False, paint=plain)
        expect(not _NO_NUMBER.search(text), "no number", text)
        expect(all(letter.isprintable() or letter == "\n" for letter in text), "unprintable", repr(text))
        if pair[0] is pair[1]:
            expect(result.verdict not in (DIFFERS, SAME_METAL), "a program differs from itself", text)
            expect(not result.deviation, "a program is away from itself", result.deviation)
    return found


def certify(data: bytes, setup: int) -> Iterable[str]:
    """The command, with a golden trace that is written first: the program is on it, or cannot be compared."""
    chosen = SETUPS[setup]
    manifest = f'features = ["fa", "fb"]\n[controls.A]\nmachine = "{chosen.machine}"\n{_RUN}' + "".join(
        f'[[case]]\nname = "{name}"\nfeature = "f{name}"\ncontrol = "A"\nprogram = "{name}.nc"\n{more}\n'
        for name, more in (("a", 'golden = "a.jsonl"'), ("b", 'same_path_as = "a"'))
    )
    random = Random(zlib.crc32(data))  # noqa: S311
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "post.toml").write_text(manifest)
        Path(folder, "a.nc").write_bytes(data)
        Path(folder, "b.nc").write_bytes(random.choice((data, mutated(data, random, (data,)))))
        endings = []
        for words in (["--update"], ["--format", "json"]):
            result = CliRunner().invoke(main, ["certify", str(Path(folder, "post.toml")), *words])
            if result.exception is not None and not isinstance(result.exception, SystemExit):
                raise result.exception
            expect(result.exit_code in (0, 1, 2), f"certify: exit {result.exit_code}", result.stderr)
            expect("internal error" not in result.stderr, "certify: internal error", result.stderr)
            endings.append(f"{words} {result.exit_code}")
        if result.stdout:
            json.loads(result.stdout, parse_constant=functools.partial(BrokenError, "no JSON"))
    return endings


Target = Callable[[bytes, int], Iterable[str]]
TARGETS: dict[str, Target] = {
    "convert": convert,
    "unroll": unroll,
    "roll": roll,
    "compensate": compensate,
    "compare": compare,
    "certify": certify,
}


# ---- what they share ----


@functools.cache
def _settings(setup: int) -> Settings:
    settings = OfPrograms(Options(machine=SETUPS[setup].machine, use_config=False))("")
    return msgspec.structs.replace(settings, job=job_of_setup(setup))


def _chosen(data: bytes, choices: Sequence[Choice], number: int = 0) -> Choice:
    """One of the choices, the same for the same bytes. number: of what is chosen."""
    return choices[zlib.crc32(data, number) % len(choices)]


def _rewritten(data: bytes, settings: Settings, work: Work) -> Outcome | list[str]:
    """The outcome, of which what every one promises holds; or how it is refused."""
    try:
        outcome = rewritten("a.nc", data, settings, work)
    except RefusedError as error:
        for refusal in error.refusals:
            _readable(refusal.text)
            expect(refusal.line >= 0, "refused in no line", refusal)
        expect(bool(error.refusals), "refused without a reason")
        return [_said(error)]
    except PolarcheckError as error:
        _readable(str(error))
        return [_said(error)]
    lines, new_lines = (len(read_source(text, "", settings.encoding).line_starts) for text in (data, outcome.data))
    expect(outcome.origin == sorted(outcome.origin), "lines out of order")
    expect(all(1 <= line <= lines for line in outcome.origin), "a line that the original does not have")
    expect(len(outcome.origin) in (new_lines, new_lines - 1), "not of each line", (len(outcome.origin), new_lines))
    expect(all(0 <= decision.line <= lines for decision in outcome.decisions), "a decision in no line")
    expect(all(abs(figure.value) != float("inf") for figure in outcome.figures), "infinite figure", outcome.figures)
    for text in (*outcome.notes, *(decision.text for decision in outcome.decisions)):
        _readable(text)
    return outcome


def _words(data: bytes) -> bytes:
    """A program without blanks."""
    return data.replace(b" ", b"")


def _endings(name: str, outcome: Outcome | list[str]) -> list[str]:
    return [f"{name}: done"] if isinstance(outcome, Outcome) else [f"{name}: {text}" for text in outcome]


def _said(error: PolarcheckError) -> str:
    return re.sub(r"[^a-z ]+", "", str(error))[:60]


def _readable(text: str) -> None:
    """Of what quotes a program: commands write control characters as something else."""
    expect(not _NO_NUMBER.search(text), "no number", text)
    expect("\n" not in text, "several lines", text)
