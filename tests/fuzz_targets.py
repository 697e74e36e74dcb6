"""
What must hold of any input, by part of the program: TARGETS. Each takes bytes and the number of a Setup, and raises
where it does not.

An exception of polarcheck is raised as it is, also a warning, if warnings are errors; BrokenError says what else is
wrong.
"""

from __future__ import annotations

import functools
import itertools
import json
import re
import tempfile
import tomllib
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Any

import deep_contours
import fuzz_rewriting
import jsonschema
import msgspec
import numpy as np
from click.testing import CliRunner
from fuzz_setups import SETUPS, BrokenError, expect, job_of_setup
from polarcheck.errors import PolarcheckError
from programs import CORPUS, ROOT, machine_of

from polarcheck import reports
from polarcheck.checking import check
from polarcheck.commands import main
from polarcheck.files.batch import tasks as batch
from polarcheck.foundation.finding import Finding, Report
from polarcheck.program.execution.arithmetic import Arithmetic
from polarcheck.program.execution.custom_macro import read_statement
from polarcheck.program.execution.expression import evaluate
from polarcheck.program.execution.macro import Variables, assign
from polarcheck.program.execution.programs import read_text
from polarcheck.program.machines import offset_table, profiles
from polarcheck.program.machines.job import Job, check_work_offsets, from_table
from polarcheck.program.reading import source
from polarcheck.reports.pages import executed, json_schema
from polarcheck.rules.examples import examples
from polarcheck.rules.rule import load_all

#: Of a message, and of one finding without its fix, which has an edit for each word that it mends [characters].
_LONGEST_MESSAGE, _LONGEST_FINDING = 700, 2500
#: Of so many inputs one is checked twice, which takes as long again.
_AGAIN_EVERY = 4
_NO_NUMBER = re.compile(r"(?<![A-Za-z0-9_])[-+]?(?:inf|nan)(?![A-Za-z0-9_])")


# ---- the targets: what each found is told, so that a guide can tell a new kind of input from another ----


def reader(data: bytes, setup: int) -> Iterable[str]:
    """Bytes to words: nothing raises, all places lie in the text, every byte survives."""
    read = source.read_source(data)
    expect(read.encode(read.text) == data, "bytes lost")
    expect(len(read.code) == len(read.text), "characters lost")
    text = read_text(read, machine_of(SETUPS[setup].machine))
    for name in ("words", "comments", "strays", "foreign", "dots", "outside", "names"):
        start, end = getattr(text, name).start, getattr(text, name).end
        expect(bool(np.all((start >= 0) & (start <= end) & (end <= len(read.code)))), f"{name} outside the text")
    expect(bool(np.all(np.diff(text.blocks.start) >= 0)), "blocks out of order")
    expect(bool(np.all((text.blocks.line >= 1) & (text.blocks.line <= len(read.line_starts)))), "no such line")
    return [read.encoding]


def statement(data: bytes, setup: int) -> Iterable[str]:
    """Macro statements and expressions: read and calculated, whatever they are."""
    macro = machine_of(SETUPS[setup].machine).macro
    arithmetic = Arithmetic(macro.signed_angles, macro.largest_number)
    variables = Variables(macro, {1: 5.0, 2: -1e30, 100: 1e300})
    found = []
    for line in data[:5000].decode("utf-8", "replace").split("\n")[:200]:
        read = read_statement(
            line, calls=macro.flow_codes, loops=macro.loop_numbers, levels=macro.bracket_levels, size=5000
        )
        places = [read, *read.words, *(part for part in (read.value, read.condition, read.fault) if part is not None)]
        expect(all(0 <= part.start <= part.end <= len(line) for part in places), "statement outside its block")
        found += [read.kind.name, read.fault.kind if read.fault else ""]
        assign(read, variables, arithmetic)
        values = (word.value for word in read.words if word.address != "<")
        for expression in (read.target, read.value, read.jump, *values):
            if expression is not None:
                value, _ = evaluate(expression, variables, arithmetic)
                expect(value is None or abs(value) != float("inf"), "infinite value")
    return found


def whole(data: bytes, setup: int) -> Iterable[str]:
    """The whole check, with machine, cutter and job."""
    report, lines = _report(data, setup)
    (file,) = report.files
    text = source.read_source(data).text
    every = list(_every(file.findings))
    for found in every:
        _place_is_in_file(found, lines)
        _told_well(found, text)
    expect(all(len(name) < 100 for name in file.programs), "long name of a program")
    for missing in file.not_evaluated:
        expect(not _NO_NUMBER.search(missing.reason) or bool(_NO_NUMBER.search(text)), "no number", missing.reason)
        expect(len(missing.reason) < _LONGEST_MESSAGE, "long reason", missing.rule)
    twice = Counter((found.rule, found.line, found.column) for found in every)
    for place, count in twice.items():
        expect(count == 1, f"twice in one place: {place[0]}", place)
    shown = reports.render("json", report, reports.Background())
    json.loads(shown, parse_constant=functools.partial(BrokenError, "no JSON"))
    if zlib.crc32(data) % _AGAIN_EVERY == 0:
        again = reports.render("json", _report(data, setup)[0], reports.Background())
        expect(shown == again, "another result the second time")
    _rendered(report, {file.path: dict(enumerate(lines, 1))})
    kinds = (f"{found.rule} {found.severity}" for found in every)
    return [*kinds, *(f"not {missing.rule}" for missing in file.not_evaluated), file.verdict]


def trace(data: bytes, setup: int) -> Iterable[str]:
    """The trace of both paths and of the rows, as CSV and JSON lines."""
    machine = machine_of(SETUPS[setup].machine)
    tables = check.read(data, machine, job_of_setup(setup))[0][1]
    of_path = tables["trace"], tables["tool_center"]
    for which in ("tool", "programmed", ""):
        items = list(itertools.islice(executed.moves(*of_path, which) if which else executed.rows(*of_path), 3000))
        for line in executed.as_jsonl(items):
            for part in line.splitlines():
                json.loads(part, parse_constant=functools.partial(BrokenError, "no JSON"))
        expect("inf" not in "".join(executed.as_csv(items)).replace("infeed", ""), "infinite value in CSV")
    executed.without_radius(*of_path)
    return []


def settings(data: bytes, setup: int) -> Iterable[str]:
    """Machine files and jobs: taken or refused by a PolarcheckError of one line."""
    text = data.decode("utf-8", "replace")
    try:
        table = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return []
    told = []
    for use in (_as_job, _as_machine):
        try:
            use(table)
            told.append(use.__name__)
        except PolarcheckError as error:
            expect("\n" not in str(error), "error of several lines", error)
            told.append(re.sub(r"[^a-z ]+", "", str(error))[:60])
    return told


def _as_job(table: dict[str, Any]) -> None:
    job = from_table(table, "a.toml")
    check_work_offsets(job, machine_of(), str)
    check.check_file(_SMALL, machine_of(), job, list(load_all().values()))


def _as_machine(table: dict[str, Any]) -> None:
    changes = {key: value for key, value in table.items() if key != "inherits"}
    found = profiles.load(profiles.DEFAULT, changes).machine
    check.check_file(_SMALL, found, Job(), list(load_all().values()))


def offsets(data: bytes, setup: int) -> Iterable[str]:
    """Offset tables as controls punch them out."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "a.txt")
        path.write_bytes(data)
        try:
            return [str(len(offset_table.read_offset_table(path, "a.txt")))]
        except PolarcheckError as error:
            expect("\n" not in str(error), "error of several lines", error)
            return [re.sub(r"[^a-z ]+", "", str(error))[:60]]


def command(data: bytes, setup: int) -> Iterable[str]:
    """The command line in process, the program on standard input: it ends with 0, 1 or 2, and says something."""
    chosen = SETUPS[setup]
    form = ("text", "json", "short", "concise")[setup % 4]
    tools = [word for tool in chosen.tools for word in ("--tool", tool)]
    arguments = ["check", "-", "--no-config", "--machine", chosen.machine, "--format", form, *tools, *_BOUNDS]
    result = CliRunner().invoke(main, arguments, input=data)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    expect(result.exit_code in (0, 1, 2), f"exit {result.exit_code}", result.stderr)
    expect(form == "concise" or bool(result.stdout), "nothing said", result.stderr)
    expect("internal error" not in result.stderr, "internal error", result.stderr)
    return [str(result.exit_code)]


def commands(data: bytes, setup: int) -> Iterable[str]:
    """Every command that follows the tool, in process: it ends with 0, 1 or 2, and says something."""
    chosen = SETUPS[setup]
    tools = [word for tool in chosen.tools for word in ("--tool", tool)]
    endings = []
    with tempfile.TemporaryDirectory() as folder:
        page = str(Path(folder, "a.html"))
        for words in (["check", "--part"], ["part"], ["feeds"], ["trace"], ["plot", "-o", page]):
            arguments = [*words, "-", "--no-config", "--machine", chosen.machine, *tools, *_BOUNDS]
            result = CliRunner().invoke(main, arguments, input=data)
            if result.exception is not None and not isinstance(result.exception, SystemExit):
                raise result.exception
            name = words[0]
            expect(result.exit_code in (0, 1, 2), f"{name}: exit {result.exit_code}", result.stderr)
            expect("internal error" not in result.stderr, f"{name}: internal error", result.stderr)
            endings.append(f"{name} {result.exit_code}")
    return endings


_BOUNDS = ("--max-blocks", "3000", "--max-statements", "2000", "--max-seconds", "5")


_SMALL = b"O1\nG21 G98\nT0101\nG0 X80. C0 Z2.\nG12.1\nG1 G42 X60. C0 F100\nC20.\nX-60.\nC0\nG40 X80.\nG13.1\nM30\n"

Target = Callable[[bytes, int], Iterable[str]]
TARGETS: dict[str, Target] = {
    "whole": whole,
    "reader": reader,
    "statement": statement,
    "trace": trace,
    "command": command,
    "commands": commands,
    "settings": settings,
    "offsets": offsets,
    **fuzz_rewriting.TARGETS,
}
#: Of the inputs of a target that many are programs drawn by grammar, for the machine of their setup.
DRAWN_SHARES = dict.fromkeys(("whole", "trace", "commands"), 0.1) | dict.fromkeys(fuzz_rewriting.TARGETS, 0.6)


# ---- properties of a report ----


def _report(data: bytes, setup: int) -> tuple[Report, list[str]]:
    chosen = SETUPS[setup]
    machine = machine_of(chosen.machine)
    found = check.read(data, machine, job_of_setup(setup), "a.nc")
    file = check.check_runs(found, list(load_all().values()))
    text = found[0][1]["trace"].text.source
    count = int(np.searchsorted(text.line_starts, len(source.read_source(data).code), side="left")) or 1
    lines = [text.line_text(line) for line in range(1, count + 1)]
    return batch.report([msgspec.structs.replace(file, machine=chosen.machine)], chosen.machine), lines


def _every(findings: Iterable[Finding]) -> Iterator[Finding]:
    for found in findings:
        yield found
        yield from _every(found.follows)


def _place_is_in_file(found: Finding, lines: Sequence[str]) -> None:
    place = f"{found.rule} {found.line}:{found.column} to {found.end_line}:{found.end_column}"
    expect(1 <= found.line <= found.end_line <= len(lines), f"no such line: {found.rule}", place)
    expect((found.line, found.column) < (found.end_line, found.end_column), f"empty range: {found.rule}", place)
    # A block that is only blank has no character to point at, and a line end may be what is wrong.
    expect(1 <= found.column <= len(lines[found.line - 1]) + 2, f"no such column: {found.rule}", place)
    expect(found.end_column <= len(lines[found.end_line - 1]) + 3, f"no such end column: {found.rule}", place)


def _told_well(found: Finding, text: str) -> None:
    expect(not _NO_NUMBER.search(found.message) or bool(_NO_NUMBER.search(text)), f"no number: {found.rule}", found)
    expect(len(found.message) < _LONGEST_MESSAGE, f"long message: {found.rule}", len(found.message))
    alone = msgspec.structs.replace(found, follows=[], fix=None)
    expect(len(str(alone)) < _LONGEST_FINDING, f"long finding: {found.rule}", len(str(alone)))
    expect(bool(found.message.strip()), f"no message: {found.rule}")


def _rendered(report: Report, lines: dict[str, dict[int, str]]) -> None:
    for form, color in (("text", False), ("text", True), ("short", False), ("concise", False)):
        background = reports.Background(lines, load_all(), color=color, following=color)
        shown = reports.render(form, report, background)
        bare = re.sub(r"\x1b\[[0-9;]*m", "", shown) if color else shown
        hidden = next((one for one in bare if not one.isprintable() and one != "\n"), None)
        expect(hidden is None, f"unprintable in {form}", repr(hidden))


@functools.cache
def _validator() -> Any:
    return jsonschema.Draft202012Validator(json_schema.schema("report"))


def fits_schema(data: bytes, setup: int) -> None:
    """The report is what `polarcheck schema report` says; slow, and so not for every input."""
    shown = json.loads(reports.render("json", _report(data, setup)[0], reports.Background()))
    for error in _validator().iter_errors(shown):
        raise BrokenError("report does not fit the schema", f"{error.json_path}: {error.message[:200]}")


# ---- what to begin with ----


def drawn(target: str, random: Random) -> tuple[bytes, int] | None:
    """An input by grammar with its setup, for as many inputs of a target as DRAWN_SHARES has; None for the rest."""
    if random.random() >= DRAWN_SHARES.get(target, 0.0):
        return None
    setup = random.randrange(len(SETUPS))
    return fuzz_rewriting.program(random, setup), setup


def seeds(target: str) -> list[bytes]:
    """Inputs that make sense to a target: sample programs, examples of rules, real programs where they are present."""
    if target == "settings":
        files = sorted((ROOT / "polarcheck" / "program" / "machines").glob("*.toml"))
        return [*(_JOBS), *(path.read_bytes()[:6000] for path in files)]
    if target == "offsets":
        return [b"%\nG10 P1 X0. Z0. R5. Q0\nG10 P10001 X1.5 Z-2. R.4 Q3\n%\n", b"G10 L2 P1 X1.\nG10 P8 R9.525\n"]
    if target in fuzz_rewriting.TARGETS:
        return []
    if target == "commands":
        return [deep_contours.program(Random(seed)) for seed in range(300)]  # noqa: S311
    pages = (one.program for rule in load_all().values() for one in examples(rule.page))
    samples = (path.read_bytes() for path in sorted((ROOT / "sample_programs").glob("*.nc")))
    real = sorted(path for path in CORPUS.rglob("*") if path.is_file() and path.suffix != ".tsv")
    rng = Random(1)  # noqa: S311
    return [*samples, *(page.encode() for page in pages), *(_piece(path.read_bytes(), rng) for path in real)]


_JOBS = (
    b'machine = "fanuc-30i"\nunits = "mm"\nradius_from_comments = true\nselect = ["polar"]\nignore = ["PS0146"]\n'
    b'[tools.1]\nradius = 5.0\nnose = 0\n[stock]\ndiameter = 60.0\n[run]\nblock_skip = "both"\nmax_blocks = 1000\n'
    b'[run.variables]\n500 = 1.5\n[work_offsets.G54]\nx = 1.0\n[severities]\nrapid-in-polar = "note"\n',
    b"[limits]\nc_feed = 3600\nc_acceleration = 100.0\n[control]\nleast_increment = 0.0001\noffset_digits = 3\n",
    b'[polar]\nx = "radius"\non = ["G112"]\noff = ["G113"]\n[macro]\nloop_numbers = 9\nsubprogram_levels = 2\n',
)


def _piece(data: bytes, random: Random, most: int = 120) -> bytes:
    """Of a long program some blocks."""
    blocks = data.split(b"\n")
    start = random.randrange(max(len(blocks) - most, 0) + 1)
    return b"\n".join(blocks[start : start + most])
