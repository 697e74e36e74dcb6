"""
Slips in sound programs: what is said of them, in how many findings, and whether the remedy makes the sound part.

    python benchmarks/slips.py --count 3000 [--seed 1] [--kind "R: "] [--kinds] [--misses FILE]
    python benchmarks/slips.py --sound 1500         sound programs that are told something
    python benchmarks/slips.py --pairs 200          two slips in one contour, and in different ones

Programs come from tests/setter_programs.py, slips from tests/single_slips.py. tests/metal_simulation.py and
tests/slip_witnesses.py, which share no code with polarcheck, say before any check whether a slip does something to
metal or lathe and whether anything tells of it without a drawing; other slips are not counted.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
import time
from collections import Counter, defaultdict
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from setter_dialects import DIALECTS
from setter_programs import FAMILIES, Program, drawn
from single_slips import LEADS, SLIPS, Planted, Slip, drawn_slip, planted
from slip_answers import Answer, answered, changed_lines, lines_named, report_on, said_of

from polarcheck.foundation.finding import Finding

COLUMNS = ("slips", "spoken", "open", "several", "there", "named", "right", "repairs", "fixed", "fix right")
#: A miss, in the order of their weight.
MISSES = ("silent", "several", "wrong value", "wrong fix", "elsewhere")


class Judged(NamedTuple):
    """A slip and what is said of it."""

    slip: Planted
    answer: Answer

    @property
    def miss(self) -> str:
        """What is wrong with the answer: one of MISSES, or "open", or ""."""
        answer = self.answer
        if not answer.findings:
            return "open" if answer.is_open else "silent"
        is_bad = {
            "several": len(answer.findings) > 1,
            "wrong value": answer.remedy == "wrong",
            "wrong fix": answer.fix == "wrong",
            "elsewhere": not answer.is_there,
        }
        return next((name for name, bad in is_bad.items() if bad), "")

    @property
    def row(self) -> Counter[str]:
        answer = self.answer
        cells = {
            "slips": True,
            "spoken": bool(answer.findings),
            "open": answer.is_open,
            "several": len(answer.findings) > 1,
            "there": answer.is_there,
            "named": bool(answer.remedy),
            "right": answer.names == "right",
            "repairs": answer.remedy == "right",
            "fixed": bool(answer.fix),
            "fix right": answer.fix == "right",
        }
        return Counter({name: int(cell) for name, cell in cells.items()})


def judged(count: int, seed: int, kinds: tuple[Slip, ...] = SLIPS, machine: str = "") -> list[Judged]:
    """Slips of all kinds in turn, each checked."""
    drawn_ones = (drawn_slip(number, kinds, machine) for number in range(seed, seed + count))
    return [Judged(slip, answered(slip)) for slip in drawn_ones if slip is not None]


def told_sound(count: int, seed: int, machine: str = "") -> list[tuple[Program, list[Finding]]]:
    """The sound programs that are told something."""
    found = []
    for number in range(seed, seed + count):
        program = drawn(number, machine, FAMILIES[number % len(FAMILIES)], LEADS[number % len(LEADS)])
        said = said_of(report_on(program))
        if said:
            found.append((program, said))
    return found


class Pair(NamedTuple):
    """Two slips in a program: whether in one contour, the program with both, how many of them are told."""

    kinds: tuple[str, str]
    is_one: bool
    program: Program
    lines: tuple[int, int]
    told: int


def pairs(count: int, seed: int) -> list[Pair]:
    """
    Pairs of slips, half of them in one contour; each of them alone is told in one finding.

    Both are told where two findings name their lines or are those of each alone, or where one names both lines.
    """
    found: list[Pair] = []
    kinds = [slip for slip in SLIPS if not re.search("block|swapped|missing|forgotten", slip.name)]
    for number in range(seed, seed + 60 * count):
        draw = random.Random(f"pair {number}")  # noqa: S311 - programs that can be written again
        program = drawn(draw.randrange(10**6), "", draw.choice(FAMILIES), draw.choice(LEADS))
        counts = Counter(pair.is_one for pair in found)
        missing = [is_one for is_one in (True, False) if counts[is_one] < (count + 1 - is_one) // 2]
        pair = _pair(program, draw.sample(kinds, 2), draw, missing)
        found += [pair] if pair else []
        if len(found) == count:
            break
    return found


def _pair(program: Program, kinds: list[Slip], draw: random.Random, missing: list[bool]) -> Pair | None:
    one, two = (planted(kind, program, draw) for kind in kinds)
    if one is None or two is None or len(one.program.lines) != len(two.program.lines):
        return None
    lines = [changed_lines(program, slip.program)[0] for slip in (one, two)]
    if len(lines[0]) != 1 or len(lines[1]) != 1 or lines[0] == lines[1]:
        return None
    is_one = _is_one(program, lines[0][0], lines[1][0])
    if is_one not in missing:
        return None
    alone = [said_of(report_on(slip.program)) for slip in (one, two)]
    if any(len(findings) != 1 for findings in alone):
        return None
    index = lines[1][0] - 1
    both = one.program.changed(index, two.program.lines[index].text)
    findings = said_of(report_on(both))
    meant = [
        {i for i, said in enumerate(findings) if set(of) & lines_named(said) or said.rule == single[0].rule}
        for of, single in zip(lines, alone, strict=True)
    ]
    told = 2 if any(i != j for i in meant[0] for j in meant[1]) else min(1, len(meant[0] | meant[1]))
    if any({*lines[0], *lines[1]} <= lines_named(said) for said in findings):
        told = 2
    return Pair((kinds[0].name, kinds[1].name), is_one, both, (lines[0][0], lines[1][0]), told)


def _is_one(program: Program, first: int, second: int) -> bool:
    """Whether no contour ends between two lines (from 1)."""
    low, high = sorted((first, second))
    return not any(line.role == "cancel" for line in program.lines[low - 1 : high - 1])


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1, help="the first of them")
    parser.add_argument("--kind", default="", help="only the kinds whose name matches this regular expression")
    parser.add_argument("--machine", default="", choices=["", *DIALECTS])
    parser.add_argument("--kinds", action="store_true", help="a line for each kind, those with most misses first")
    parser.add_argument("--misses", type=Path, metavar="FILE", help="write each miss as a program with a comment")
    parser.add_argument("--sound", type=int, default=0, metavar="N", help="check N sound programs instead")
    parser.add_argument("--pairs", type=int, default=0, metavar="N", help="check N pairs of slips instead")
    options = parser.parse_args()
    began = time.perf_counter()
    blocks: list[str] = []
    if options.sound:
        told = told_sound(options.sound, options.seed, options.machine)
        for program, said in told:
            blocks.append(marked(program, said, 0, "SOUND"))
            print(f"seed {program.seed} {program.machine} {program.family}, {program.style.lead}: {_text(said[0])}")
        print(f"{len(told)} of {options.sound} sound programs are told something")
    elif options.pairs:
        found = pairs(options.pairs, options.seed)
        for is_one, where in ((True, "one contour"), (False, "different contours")):
            counts = Counter(pair.told for pair in found if pair.is_one == is_one)
            print(f"in {where}: both told {counts[2]} of {counts.total()}, one {counts[1]}, none {counts[0]}")
        missed = [pair for pair in found if pair.told < 2]
        blocks = [marked(p.program, said_of(report_on(p.program)), p.lines[0], " AND ".join(p.kinds)) for p in missed]
    else:
        kinds = tuple(slip for slip in SLIPS if re.search(options.kind, slip.name))
        results = judged(options.count, options.seed, kinds, options.machine)
        print_table(results, options.kinds)
        for result in sorted(results, key=lambda one: (one.slip.slip.name, one.miss)):
            if result.miss in MISSES:
                name = f"{result.miss.upper()}: {result.slip.slip.name}, known by {result.slip.witness}"
                blocks.append(marked(result.slip.program, result.answer.findings, result.slip.line, name))
    if options.misses:
        options.misses.write_text("\n".join(blocks))
    print(f"{time.perf_counter() - began:.0f} s")
    return 0


def print_table(results: list[Judged], by_kind: bool) -> None:
    """Shares of all, and a line for each kind."""
    rows: dict[str, Counter[str]] = defaultdict(Counter)
    misses: dict[str, Counter[str]] = defaultdict(Counter)
    for result in results:
        rows[result.slip.slip.name] += result.row
        misses[result.slip.slip.name][result.miss] += 1
    total = sum(rows.values(), Counter[str]())
    weight = {name: sum(misses[name][miss] for miss in MISSES) for name in rows}
    if by_kind:
        print("kind".ljust(46) + "".join(name.rjust(10) for name in COLUMNS))
        for name in sorted(rows, key=lambda name: (-weight[name], name)):
            print(name.ljust(46) + "".join(str(rows[name][column]).rjust(10) for column in COLUMNS))
    spoken = max(total["spoken"], 1)
    shares = {
        f"spoken about (of {total['slips']} slips of {len(rows)} kinds)": (total["spoken"], total["slips"]),
        "named as not evaluated instead": (total["open"], total["slips"]),
        "in more than one finding": (total["several"], spoken),
        "at a line of the slip, or naming it": (total["there"], spoken),
        "a value named": (total["named"], spoken),
        "that of the sound program": (total["right"], total["named"]),
        "it makes the sound part": (total["repairs"], total["named"]),
        "--unsafe-fixes makes it": (total["fix right"], total["fixed"]),
    }
    for name, (part, whole) in shares.items():
        print(f"{name:48} {part:6} {part / max(whole, 1):7.1%}")
    together = Counter(
        " + ".join(sorted(finding.rule for finding in result.answer.findings))
        for result in results
        if len(result.answer.findings) > 1
    )
    for names, number in together.most_common(12):
        print(f"{number:6} {names}")


def _text(finding: Finding) -> str:
    return f"{finding.line}: {finding.severity}: {finding.message} [{finding.rule}]"


def marked(program: Program, findings: tuple[Finding, ...] | list[Finding], line: int, what: str) -> str:
    """A program; comments say what is wrong with it, how it is checked and what is said of it."""
    first, last = program.dialect.remark
    tools = " ".join(f"--tool {tool}" for tool in program.tools())
    stock = f" job.stock.diameter={program.stock / program.scale:g}" if program.stock else ""
    lines = program.text().splitlines()
    if line:
        lines[line - 1] += f" {first}SLIP{last}"
    head = [
        what,
        f"SEED {program.seed} {program.family} --machine {program.machine} {tools}{stock}",
        *map(_text, findings),
    ]
    return (
        "\n".join(f"{first}{text.replace('(', '[').replace(')', ']')}{last}" for text in head)
        + "\n"
        + "\n".join(lines)
        + "\n"
    )


if __name__ == "__main__":
    sys.exit(main())
