"""
Converts programs of each machine for each other one, and says how many read back equal and why others are refused.

    python benchmarks/conversions.py --count 40 [--from fanuc-30i] [--to okuma-osp] [--write docs/convert.md]

Programs are those of setters as the tests draw them (contour families, several depths, pockets, subprograms, inch),
random sections with helices, and the sample programs of the machine. For a machine that the tests write no programs
for, those of fanuc-30i are converted first. --write puts the matrix into a page, between its two marks.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

import msgspec  # noqa: E402
from setter_dialects import DIALECTS  # noqa: E402
from setter_programs import FAMILIES, drawn  # noqa: E402
from twin_sections import CONTROLS, written  # noqa: E402
from twin_sections import drawn as drawn_sections  # noqa: E402

from polarcheck.checking.settings import Settings  # noqa: E402
from polarcheck.files.settings.of_programs import OfPrograms, Options, on_machine  # noqa: E402
from polarcheck.foundation.errors import PolarcheckError, RefusedError  # noqa: E402
from polarcheck.program.machines import profiles  # noqa: E402
from polarcheck.rewrite.convert.converting import converted  # noqa: E402
from polarcheck.rewrite.convert.doubtful_values import KEYS  # noqa: E402
from polarcheck.rewrite.writing.rewritten_program import rewritten  # noqa: E402

BASE = "fanuc-30i"
#: Of the programs of a machine so many are random sections.
SECTIONS = 8
BEGIN, END = "<!-- matrix: begin -->", "<!-- matrix: end -->"
EQUAL, DECIDED, REFUSED, WRONG = "equal", "to decide", "refused", "wrong"


class Case(NamedTuple):
    """
    A program.

    name: what draws it again, or the path of a sample program, with the job file beside it.
    inch: lengths of its tools are in inch.
    """

    machine: str
    name: str
    data: bytes
    tools: tuple[str, ...] = ()
    inch: bool = False
    is_sample: bool = False


def cases(machine: str, count: int) -> list[Case]:
    """Return programs for a machine."""
    result = [
        Case(machine, f"section {seed}", written(drawn_sections(seed), machine).encode(), ("1:radius=3,nose=0",), False)
        for seed in range(1, SECTIONS + 1)
        if machine in CONTROLS
    ]
    result += _samples(machine)
    seed = 0
    while len(result) < count and seed < 3 * count:
        seed += 1
        program = drawn(seed, machine if machine in DIALECTS else BASE, FAMILIES[seed * 7 % len(FAMILIES)])
        case = Case(
            program.machine, f"{program.family} {seed}", program.text().encode(), tuple(program.tools()), program.inch
        )
        if machine not in DIALECTS:
            case = _for_machine(case, machine)
        if case is not None:
            result.append(case)
    return result


def _samples(machine: str) -> list[Case]:
    """The sample programs of a machine."""
    folder = ROOT / "sample_programs"
    paths = sorted((folder if machine == BASE else folder / machine).glob("*.[nm][cp]*"))
    return [Case(machine, str(path), path.read_bytes(), is_sample=True) for path in paths]


def _settings(case: Case) -> Settings:
    if case.is_sample:
        return OfPrograms(Options())(case.name)
    settings = OfPrograms(Options(machine=case.machine, tools=case.tools, use_config=False))("")
    # Programs that were converted may be in other units than their tools.
    return msgspec.structs.replace(
        settings, job=msgspec.structs.replace(settings.job, units="inch" if case.inch else "mm")
    )


def _for_machine(case: Case, machine: str) -> Case | None:
    settings = _settings(case)
    target = on_machine(settings, machine)
    try:
        outcome = rewritten(case.name, case.data, settings, lambda original: converted(original, target, KEYS))
    except RefusedError:
        return None
    return Case(machine, case.name, outcome.data, case.tools, case.inch)


def outcomes(case: Case, machines: list[str]) -> list[tuple[str, str, str]]:
    """Return for each machine what comes of converting a program, and why it is refused."""
    settings = _settings(case)
    result = []
    for machine in machines:
        target = on_machine(settings, machine)
        try:
            outcome = rewritten(
                case.name, case.data, settings, lambda original, target=target: converted(original, target)
            )
        except RefusedError as error:
            result.append((machine, REFUSED, error.refusals[0].text))
        except PolarcheckError as error:
            result.append((machine, REFUSED, str(error)))
        except Exception as error:
            result.append((machine, WRONG, repr(error)))
        else:
            result.append((machine, DECIDED if outcome.decisions else EQUAL, ""))
    return result


def _task(arguments: tuple[str, int, list[str]]) -> list[tuple[str, str, str, str]]:
    machine, count, machines = arguments
    others = [other for other in machines if other != machine]
    return [(case.name, *outcome) for case in cases(machine, count) for outcome in outcomes(case, others)]


def matrix(results: dict[str, list[tuple[str, str, str, str]]], machines: list[str]) -> list[str]:
    """Return a table in Markdown: of each pair how many read back equal, how many of them leave something to decide."""
    lines = ["| from \\ to | " + " | ".join(machines) + " |", "|---" * (len(machines) + 1) + "|"]
    for source, rows in results.items():
        counts = Counter((target, what) for _, target, what, _ in rows)
        cells = []
        for target in machines:
            equal, decided, refused, wrong = (counts[target, what] for what in (EQUAL, DECIDED, REFUSED, WRONG))
            total = equal + decided + refused + wrong
            cells.append("" if target == source else f"{equal}+{decided} of {total}" + f", {wrong} wrong" * bool(wrong))
        lines.append(f"| **{source}** | " + " | ".join(cells) + " |")
    return lines


def reasons(results: dict[str, list[tuple[str, str, str, str]]]) -> list[str]:
    """Return a table in Markdown of why programs are refused, the most frequent first."""
    kinds: Counter[str] = Counter()
    for rows in results.values():
        kinds.update(_kind(why) for _, _, what, why in rows if what in (REFUSED, WRONG))
    return ["| programs | why |", "|---:|---|", *(f"| {count} | {kind} |" for kind, count in kinds.most_common())]


def _kind(why: str) -> str:
    """A reason without its numbers and words."""
    for pattern, kind in _KINDS:
        if re.search(pattern, why):
            return kind
    return why.replace("|", "/")


_KINDS = (
    ("path differs", "the path of the tool center would differ: outer corners in cutter compensation"),
    ("is a statement of a language", "a macro statement for a control with another language"),
    ("computed", "a computed word that counts otherwise there"),
    ("runs several times", "a block that would be another one each time that it runs, since the plane lies otherwise"),
    ("Z cannot move in an arc", "a helix for a control whose arcs have no Z"),
    ("how .* writes that is not known", "a subprogram for a control whose calls are not known"),
)


def main() -> None:
    """Convert, and print or write the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--from", dest="sources", action="append")
    parser.add_argument("--to", dest="targets", action="append")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--write", type=Path)
    chosen = parser.parse_args()
    machines = [name for name in profiles.names() if name != "fanuc"]
    sources, targets = chosen.sources or machines, chosen.targets or machines
    with ProcessPoolExecutor(chosen.jobs) as executor:
        rows = executor.map(_task, [(source, chosen.count, targets) for source in sources])
        results = dict(zip(sources, rows, strict=True))
    lines = [*matrix(results, targets), "", *reasons(results)]
    if chosen.write is None:
        print("\n".join(lines))
    else:
        page = chosen.write.read_text(encoding="utf-8")
        before, _, rest = page.partition(BEGIN)
        behind = rest.partition(END)[2]
        chosen.write.write_text("\n".join([before + BEGIN, "", *lines, "", END + behind]), encoding="utf-8")
    for source, outcome in results.items():
        for name, target, what, why in outcome:
            if what == WRONG:
                print(f"{source} -> {target}: {name}: {why}", file=sys.stderr)


if __name__ == "__main__":
    main()
