"""
Pairs of programs, one of a baseline and a later one, with what of the later one must be reported.

Each program is a row of polar sections, each sound or with one fault of some size. An edit is harmless, so that every
known fault stays silent, or makes a section worse, and that one must be reported. More of them than the tests take:

    python tests/drawn_baselines.py 2000
"""

from __future__ import annotations

import random
import re
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from msgspec.structs import replace

from polarcheck.checking.settings import Settings
from polarcheck.files.baselines.baseline import Baseline
from polarcheck.files.baselines.baseline_file import Contents
from polarcheck.files.batch.tasks import Task, outcome
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.foundation.finding import FileReport, Finding

RULES = ("polar-switched-in-offset-mode", "rapid-in-polar", "c-feed-above-limit", "arc-end-off-circle")
KINDS = dict(zip(("offset", "rapid", "feed", "arc"), RULES, strict=True))
#: The rule that has one finding for a program, wherever the sections with the fault stand.
ONCE = RULES[0]
FOLDER = Path("no folder of this name")


class Section(NamedTuple):
    """
    A polar section.

    name: stays the same in later programs.
    kind: of the fault that it can have.
    amount: of the fault, 0 for none.
    size: of its contour [mm].
    depth: Z [mm].
    blocks: how often the fault is repeated.
    dwell: before the contour [s], 0 for none.
    """

    name: int
    kind: str
    amount: float
    size: int
    depth: float
    blocks: int = 1
    dwell: float = 0

    @property
    def lines(self) -> list[str]:
        """The blocks of the section."""
        x, c, many = 2 * self.size, self.size - 3, range(self.blocks)
        head = [f"G0 X{x + 20}. C0", "Z5.", f"G1 Z-{self.depth} F500"]
        if self.kind == "offset":
            contour = [f"G1 G42 X{x}. F200", f"C{c}.", f"X-{x}.", f"C-{c}.", f"X{x}.", "C0"]
            inside = [*contour, *([] if self.amount else [f"G40 X{x + 20}."])]
        elif self.kind == "rapid":
            code = "G0" if self.amount else "G1"
            inside = [f"G1 X{x}. F200", *(f"{code} C{c}." for _ in many), f"G1 X-{x}.", "C0"]
        elif self.kind == "feed":
            repeats = [f"C{sign}{c}." for _ in many for sign in ("-", "")]
            inside = [f"G1 X{x}. C{c}. F{self.amount or 20:g}", "X4.", *repeats, f"X{x}.", "C0"]
        else:
            start = x + 2 * self.amount
            inside = [f"G1 X{start:g} F200", f"G3 X-{x}. C0 I-{self.size}. J0", f"G1 C{c}.", f"X{x}.", "C0"]
        inside = [re.sub(r"(X-?\d+)(?![\d.])", r"\1.", line) for line in inside]
        pause = [f"G4 U{self.dwell:g}"] if self.dwell else []
        return [*head, "G12.1", *pause, *inside, "G13.1", "G0 Z50.", f"G0 X{x + 60}."]


Program = list[Section]
Draw = random.Random


class Pair(NamedTuple):
    """
    A program of a baseline and a later one.

    edits: their names.
    old, new: the texts.
    path: of the later one; that of the first is a.nc.
    worse: rules and first lines of the sections that must be reported in the later one, and no others.
    """

    edits: list[str]
    old: str
    new: str
    path: str
    worse: set[tuple[str, int]]


#: Fault amounts: known, a little less, and worse. An amount of 1 is a fault that has no size.
_AMOUNTS = {"offset": (1, 1, None), "rapid": (1, 1, None), "feed": (400, 398, 4000), "arc": (0.5, 0.4, 14.0)}


def _section(draw: Draw, name: int, is_broken: bool) -> Section:
    kind = draw.choice([*KINDS])
    # Half of the programs repeat a contour: its blocks alone do not say which section they are of.
    size = draw.choice([20, 25, draw.randrange(18, 60)])
    return Section(name, kind, _AMOUNTS[kind][0] if is_broken else 0, size, draw.choice([2.0, name + 0.5]))


def _text(program: Program, draw: Draw, respelled: bool, title: int) -> tuple[str, dict[int, int]]:
    """Return the text, and the line at which each section begins, by its name."""
    lines, begins = [f"O{title:04}", "T0101", "G98 G97 S1000 M3"], {}
    for section in program:
        begins[section.name] = len(lines) + 1
        lines += section.lines
    lines.append("M30")
    if not respelled:
        return "\n".join([*lines, ""]), begins
    spelled: list[str] = []
    at: dict[int, int] = {}
    for number, line in enumerate(lines, 1):
        at[number] = len(spelled) + 1
        if draw.random() < 0.1:
            spelled += draw.choice([["(CHECKED)"], [""], ["", "(REV B)"]])
        text = re.sub(r"G([0-3])(?![\d.])", r"G0\1", line) if draw.random() < 0.5 else line
        text = re.sub(r"(\d\.)(?!\d)", r"\g<1>00", text) if draw.random() < 0.3 else text
        text = text.replace(" ", "") if draw.random() < 0.2 else text
        is_numbered = number > 1 and draw.random() < 0.9
        spelled.append(f"N{10 * number} {text} (X)" if is_numbered else text)
    return "\r\n".join([*spelled, ""]), {name: at[line] for name, line in begins.items()}


# ---- edits: a later program; None where it cannot be made ----

Edit = Callable[[Program, Draw], Program | None]


def _chosen(program: Program, draw: Draw, is_broken: bool) -> int | None:
    fitting = [at for at, section in enumerate(program) if bool(section.amount) == is_broken]
    return draw.choice(fitting) if fitting else None


def nothing(program: Program, draw: Draw) -> Program:
    """Leave the blocks as they are."""
    return program


def mended(program: Program, draw: Draw) -> Program | None:
    """Take a fault away."""
    at = _chosen(program, draw, True)
    return None if at is None else _with(program, at, amount=0)


def less(program: Program, draw: Draw) -> Program | None:
    """Make a fault smaller."""
    at = _chosen(program, draw, True)
    return None if at is None else _with(program, at, amount=_AMOUNTS[program[at].kind][1])


def another_section(program: Program, draw: Draw) -> Program:
    """Put a sound section somewhere. With the blocks of another one nobody could say which of the two is new."""
    at = draw.randrange(len(program) + 1)
    section = _section(draw, 20 + len(program), False)
    return [*program[:at], section._replace(size=70 + section.name), *program[at:]]


def moved(program: Program, draw: Draw) -> Program | None:
    """Put a section before another one. Of two with the same blocks nobody could say which of them has moved."""
    at, to = draw.randrange(len(program)), draw.randrange(len(program))
    if len({section.size for section in program}) < len(program):
        return None
    others = [*program[:at], *program[at + 1 :]]
    return [*others[:to], program[at], *others[to:]]


def left_out(program: Program, draw: Draw) -> Program | None:
    """Leave a section out, if more than half of the program stays."""
    if len(program) < 3 or len({section.size for section in program}) < len(program):
        return None
    at = draw.randrange(len(program))
    return [*program[:at], *program[at + 1 :]]


def beside(program: Program, draw: Draw) -> Program:
    """Change the depth of a section, and put a block before its contour."""
    return _with(program, draw.randrange(len(program)), depth=draw.randrange(1, 9) + 0.25, dwell=0.5)


def grown(program: Program, draw: Draw) -> Program | None:
    """Make a fault larger."""
    fitting = [at for at, section in enumerate(program) if section.amount and _AMOUNTS[section.kind][2]]
    if not fitting:
        return None
    at = draw.choice(fitting)
    return _with(program, at, amount=_AMOUNTS[program[at].kind][2])


def broken(program: Program, draw: Draw) -> Program | None:
    """Give a sound section a fault."""
    at = _chosen(program, draw, False)
    return None if at is None else _with(program, at, amount=_AMOUNTS[program[at].kind][0])


def mended_and_broken(program: Program, draw: Draw) -> Program | None:
    """Mend a section, and give another one of its kind the same fault."""
    broken_ones = [at for at, section in enumerate(program) if section.amount]
    pairs = [(a, b) for a in broken_ones for b, s in enumerate(program) if not s.amount and s.kind == program[a].kind]
    if not pairs:
        return None
    first, second = draw.choice(pairs)
    return _with(_with(program, second, amount=program[first].amount), first, amount=0)


def repeated(program: Program, draw: Draw) -> Program | None:
    """Repeat the blocks of a fault."""
    fitting = [at for at, section in enumerate(program) if section.amount and section.kind in ("rapid", "feed")]
    if not fitting:
        return None
    at = draw.choice(fitting)
    return _with(program, at, blocks=4)


HARMLESS: tuple[Edit, ...] = (nothing, mended, less, another_section, moved, left_out, beside)
WORSE: tuple[Edit, ...] = (grown, broken, mended_and_broken, repeated)


def _with(program: Program, at: int, **changes: float) -> Program:
    return [*program[:at], program[at]._replace(**changes), *program[at + 1 :]]


def drawn(seed: int) -> Pair:
    """Draw a pair of programs."""
    draw = random.Random(seed)  # noqa: S311
    old = [_section(draw, name, draw.random() < 0.5) for name in range(draw.randrange(2, 7))]
    old_text, _ = _text(old, draw, False, 1000 + seed % 8000)
    if draw.random() < 0.1:
        # Another program under a new name, or in place of the old one.
        new = [_section(draw, name + 40, True)._replace(depth=9.0 + name) for name in range(len(old))]
        kind = draw.choice([*KINDS])
        new = [
            section._replace(kind=kind, amount=_AMOUNTS[kind][0], size=61 + 7 * section.name % 30) for section in new
        ]
        text, begins = _text(new, draw, False, 9000)
        return Pair(["another program"], old_text, text, draw.choice(["a.nc", "b.nc"]), _expected(old, new, begins))
    edits: list[Edit] = [draw.choice(HARMLESS) for _ in range(draw.randrange(1, 3))]
    if draw.random() < 0.6:
        edits.append(draw.choice(WORSE))
    new, names = old, []
    for edit in edits:
        later = edit(new, draw)
        if later is not None:
            new = later
            names.append(edit.__name__)
    text, begins = _text(new, draw, draw.random() < 0.6, 1000 + seed % 8000)
    path = "a.nc" if draw.random() < 0.7 or {"another_section", "left_out"} & {*names} or len(old) < 4 else "sub/b.nc"
    return Pair(names, old_text, text, path, _expected(old, new, begins))


def _expected(old: Program, new: Program, begins: dict[int, int]) -> set[tuple[str, int]]:
    before = {section.name: (section.amount, section.blocks) for section in old}
    return {
        (KINDS[section.kind], begins[section.name])
        for section in new
        if section.amount and not _is_known(section, *before.get(section.name, (0, 0)))
    }


def _is_known(section: Section, amount: float, blocks: int) -> bool:
    return section.amount <= amount and section.blocks <= blocks


# ---- what is reported ----


def settings() -> Settings:
    """The settings of all pairs."""
    options = Options(select=RULES, changes=("limits.c_feed=3600",), tools=("1:radius=3",), use_config=False)
    return replace(OfPrograms(options)("a.nc"), baseline=FOLDER / "known.json")


def report_of(text: str, path: str, its_settings: Settings) -> FileReport:
    """Check a text under a path in the folder."""
    report = outcome(Task(str(FOLDER / path), its_settings), data=text.encode()).report
    assert report is not None
    return report


def known(pair: Pair, its_settings: Settings) -> Contents:
    """Return the baseline of the first program."""
    report = report_of(pair.old, "a.nc", its_settings)
    return Baseline(Contents(), FOLDER, [str(FOLDER / "a.nc")]).updated([(report, RULES)], "").contents


def reported(pair: Pair, its_settings: Settings) -> list[Finding]:
    """Return what is reported of the later program."""
    report = report_of(pair.new, pair.path, its_settings)
    baseline = Baseline(known(pair, its_settings), FOLDER, [str(FOLDER / pair.path)])
    return baseline.without_known(report, RULES).findings


def disagreement(pair: Pair, its_settings: Settings) -> str:
    """Return in words what is reported and must not be, or must be reported and is not; empty if all is right."""
    findings = reported(pair, its_settings)
    begins = [number for number, line in enumerate(pair.new.split("\n"), 1) if re.search(r"Z0*5\.0*(?!\d)", line)]
    found = set()
    for finding in findings:
        begin = max(line for line in begins if line <= finding.line)
        found.add((finding.rule, 0 if finding.rule == ONCE else begin))
    # A section begins one block before its Z5.
    wanted = {(rule, 0 if rule == ONCE else min(at for at in begins if at >= line)) for rule, line in pair.worse}
    if found == wanted:
        return ""
    return f"{pair.edits} {pair.path}: silent and worse {wanted - found}, told and known {found - wanted}"


def faults(first: int, count: int) -> Iterator[tuple[int, str]]:
    """Yield the seeds of pairs on which the check and the draw disagree."""
    its_settings = settings()
    for seed in range(first, first + count):
        if wrong := disagreement(drawn(seed), its_settings):
            yield seed, wrong


if __name__ == "__main__":
    begun = time.monotonic()
    amount = int(sys.argv[1])
    wrong = 0
    for seed, said in faults(int(sys.argv[2]) if len(sys.argv) > 2 else 0, amount):
        wrong += 1
        print(seed, said)
    print(f"{amount} pairs, {wrong} wrong, {time.monotonic() - begun:.0f} s")
