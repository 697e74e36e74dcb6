"""
polarcheck beside other readers of NC programs: time and memory of whole processes, and what each of them finds.

    python benchmarks/peers.py --rs274 FILE --python FILE --nctab FILE --ncplot7py FOLDER -o docs/benchmarks.md
        [--rounds NUMBER] [--before FILE] [--note WORDS]
    python benchmarks/peers.py --only "Small files" [--before FILE]

A peer is found by its option, by RS274, PEERS_PYTHON, NCTAB or NCPLOT7PY in the environment, or on the search path; one
that is not there is left out, which the page says. All are run in turn, round by round, so that they see the same
machine. --python: one that has nc-gcode-interpreter and pygcode. --ncplot7py: the folder of its source.
--before: a Python with an older polarcheck, which is measured beside this one.
Standard error names the part of the page that is measured, and how long that took.
"""

from __future__ import annotations

import argparse
import cmath
import contextlib
import math
import os
import platform
import re
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

import editor
from contour_costs import CASES, Cost, cost, half_circles
from measuring import ROOT, SLOW, SLOW_ROUNDS, Taken, apart, exponent, measured, output, ratio, run, table
from peer_faults import FAULTS, GOOD, TOOL
from stages import stages
from xy_twin import tool_table, twin

#: How polarcheck checks files as a user would, and in one process.
_POLARCHECK = (sys.executable, "-m", "polarcheck")
CHECK_FILES = (*_POLARCHECK, "check", "--no-config", "--fail-on", "never", "-q")
CHECK = (*CHECK_FILES, "--jobs", "1")
WITHOUT, WITH = "polarcheck", "polarcheck, with compensation and overcut"
BEFORE = ", before"
CUTTERS = range(4, 13)
SIZES = (1_000, 10_000, 50_000, 200_000, 500_000, 1_000_000)
#: Sizes from here on take seconds, which do not need so many rounds.
LARGE = 1_000_000
#: Of the files that are checked by several processes.
_MANY, _BLOCKS_OF_MANY = 40, 10_000
#: Of the program that other commands than `check` are given, and letters of a line without anything else.
_BLOCKS_OF_COMMANDS, _LETTERS = 20_000, 12_000_000
#: Radius of a circle that is drawn [mm], and of how many lines it is drawn.
_CIRCLE, _LINES = 20, (60, 400)
#: Limits of a contour [s], [GB].
_LIMITS = 120, 8
_REGEX = "a bare regex"
#: Copies of a sample program, and blocks of the program that is typed.
_SAMPLES, _KEY_BLOCKS = 600, 500
_PEERS = ("LinuxCNC rs274", "nc-gcode-interpreter", "pygcode", "nctab", "ncplot7py")
#: Lets a command use the results of earlier runs, which the others do not.
_WITH_CACHE = ("env", "-u", "POLARCHECK_NO_CACHE")

REGEX = "import re, sys; re.findall(rb'([A-Z])([-+]?[0-9.]+)', open(sys.argv[1], 'rb').read())"
INTERPRETER = "import sys, nc_gcode_interpreter as n; n.nc_to_dataframe(open(sys.argv[1]).read())"
PYGCODE = "import sys, pygcode; [pygcode.Line(line) for line in open(sys.argv[1])]"
NCPLOT7PY = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from ncplot7py.application.nc_execution import NCExecutionEngine
from ncplot7py.infrastructure.machines.base_stateful_control import UniversalConfigDrivenControl
from ncplot7py.shared import configure_i18n, configure_logging, get_message_stack
from ncplot7py.shared.file_adapter import get_program
configure_logging(console=False, web_buffer=True)
configure_i18n()
programs = get_program(Path(sys.argv[2]), split_on_blank_line=False)
NCExecutionEngine(UniversalConfigDrivenControl(count_of_canals=1)).get_Syncro_plot(programs, synch=False)
print(*get_message_stack(), sep="\\n")
"""


class Peer(NamedTuple):
    """
    A reader of NC programs.

    kind: of the input that it reads (inputs). command: without the file. rs274: what of LinuxCNC it is put beside.
    """

    kind: str
    command: Sequence[str]
    rs274: str = "LinuxCNC rs274"


def by_older(python: str, command: Sequence[str]) -> list[str]:
    """A command of polarcheck with the package that this Python has, not with that of the working folder (-P)."""
    return [python, "-P", *command[1:]]


def cutters(radius: float) -> list[str]:
    """The tools of the benchmark program as options."""
    return [f"--tool={number}:radius={radius},nose=0" for number in CUTTERS]


def peers(asked: argparse.Namespace, folder: Path) -> dict[str, Peer]:
    """Those that are installed, polarcheck among them; folder: where the tables of tools for rs274 lie."""
    found = {
        WITHOUT: Peer("lathe", CHECK),
        WITH: Peer("lathe", [*CHECK, *cutters(2)], "LinuxCNC rs274, G41/G42"),
        _REGEX: Peer("lathe", [sys.executable, "-c", REGEX]),
    }
    if asked.before:
        older = by_older(asked.before, CHECK)
        found[WITHOUT + BEFORE] = Peer("lathe", older)
        found[WITH + BEFORE] = Peer("lathe", [*older, *cutters(2)], "LinuxCNC rs274, G41/G42")
    if rs274 := _place(asked.rs274, "RS274", "rs274"):
        for kind, name in (("mill", "LinuxCNC rs274"), ("compensated", "LinuxCNC rs274, G41/G42")):
            found[name] = Peer(kind, [rs274, "-t", str(folder / f"{kind}.tbl"), "-g"], name)
    python = _place(asked.python, "PEERS_PYTHON", "") or sys.executable
    if not run([python, "-c", "import nc_gcode_interpreter"]).status:
        found["nc-gcode-interpreter"] = Peer("sinumerik", [python, "-c", INTERPRETER])
    if not run([python, "-c", "import pygcode"]).status:
        found["pygcode (reads only)"] = Peer("lathe", [python, "-c", PYGCODE])
    if nctab := _place(asked.nctab, "NCTAB", "nctab"):
        found["nctab"] = Peer("lathe", [nctab, "check", "-p", "fanuc-turn"])
    if ncplot7py := _place(asked.ncplot7py, "NCPLOT7PY", ""):
        found["ncplot7py"] = Peer("G112", [python, "-c", NCPLOT7PY, ncplot7py])
    return found


def _place(given: str | None, variable: str, program: str) -> str | None:
    return given or os.environ.get(variable) or (shutil.which(program) if program else None)


def inputs(folder: Path, name: str, program: str) -> dict[str, Path]:
    """A program and its twins, by kind, in files."""
    texts = {
        "lathe": program,
        "G112": re.sub(r"\bG1([23])\.1", r"G11\1", program),
        "mill": twin(program),
        "compensated": twin(program, compensated=True),
        "sinumerik": twin(program, sinumerik=True),
    }
    paths = {kind: folder / f"{name}_{kind}.nc" for kind in texts}
    for kind, text in texts.items():
        paths[kind].write_text(text, "ascii")
    return paths


def generated(folder: Path, blocks: int) -> Path:
    """The benchmark program; made by a process of its own, since memory counts what this one holds."""
    path = folder / f"{blocks}.nc"
    if not path.exists():
        command = [sys.executable, str(ROOT / "benchmarks" / "generate.py"), "--blocks", str(blocks), "-o", str(path)]
        status, said = output(command)
        if status:
            raise SystemExit(said)
    return path


def large_inputs(folder: Path, blocks: int) -> dict[str, Path]:
    """The benchmark program and its twins."""
    return inputs(folder, "large", generated(folder, blocks).read_text("ascii"))


def speed(asked: argparse.Namespace, folder: Path) -> str:
    """Whole processes on one large program."""
    for kind, radius in (("mill", 0.0), ("compensated", 2.0)):
        (folder / f"{kind}.tbl").write_text(tool_table(radius))
    paths = apart(large_inputs, folder, asked.blocks)
    readers = peers(asked, folder)
    taken = measured({name: [*peer.command, str(paths[peer.kind])] for name, peer in readers.items()}, asked.rounds)
    size = paths["lathe"].stat().st_size
    return table(
        ["reader", "input", "runs", "CPU s", "clock s", "to rs274", "to a regex", "peak MB", "peak per byte", "exit"],
        [_row(name, readers[name], taken, size) for name in taken],
    )


def _row(name: str, peer: Peer, taken: dict[str, Taken], size: int) -> list[str]:
    one = taken[name]
    beside = [f"{ratio(one.cpus, taken[base].cpus):.2f}" if base in taken else "-" for base in (peer.rs274, _REGEX)]
    figures = f"{one.cpu:.2f}", f"{one.clock:.2f}", *beside, f"{one.peak / 1e6:.0f}", f"{one.peak / size:.0f}"
    return [name, peer.kind, str(one.runs), *figures, str(one.status)]


def small(asked: argparse.Namespace, folder: Path) -> str:
    """Small files, the same file again from the cache, what a commit hook checks, and an editor, on the clock."""
    program = str(ROOT / "sample_programs" / "hexagon.nc")
    changed = []
    for number in range(20):
        changed.append(folder / f"changed_{number}.nc")
        lines = generated(folder, 1_000).read_text("ascii").splitlines(keepends=True)
        changed[-1].write_text("".join([*lines[:2], *lines[-501:]]), "ascii")
    inputs_of = {
        "polarcheck, a sample program": [program],
        "polarcheck, a program of 500 blocks": [str(changed[0])],
        "polarcheck, 20 programs of 500 blocks": [*map(str, changed)],
        f"polarcheck, {_SAMPLES} sample programs in one process": ["--jobs", "1", *samples(folder, program)],
    }
    again = [*_WITH_CACHE, *CHECK_FILES[:-1], "--cache-dir", str(folder / "cache"), program]
    commands = {"`import click, numpy`": [sys.executable, "-c", "import click, numpy"]}
    commands |= {name: [*CHECK_FILES, *files] for name, files in inputs_of.items()}
    commands["polarcheck, a sample program again, with its report"] = again
    run(again)
    if asked.before:
        older = by_older(asked.before, CHECK_FILES)
        commands |= {name + BEFORE: [*older, *files] for name, files in inputs_of.items()}
    taken = measured(commands, 2 * asked.rounds)
    base, one = taken["`import click, numpy`"], taken["polarcheck, a program of 500 blocks"]
    rows = []
    for name, found in taken.items():
        ratios = [ratio(found.clocks, other.clocks) for other in (base, one)]
        ratios += [ratio(found.cpus, taken[name + BEFORE].cpus)] if name + BEFORE in taken else []
        rows.append([name, f"{found.clock * 1000:.0f}", *(f"{number:.2f}" for number in ratios)])
        rows[-1] += ["-"] * (len(ratios) < 3)
    # The server looks for programs in its folder, where those of all other rows would lie.
    with tempfile.TemporaryDirectory() as alone:
        key = editor.measured(_KEY_BLOCKS, 4 * asked.rounds, Path(alone).resolve())[editor.AFTER_A_KEY]
    clock = statistics.median(key)
    to_both = (f"{clock / 1000 / other.clock:.2f}" for other in (base, one))
    rows.append(
        [f"{editor.AFTER_A_KEY}, a program of {_KEY_BLOCKS} blocks in an editor", f"{clock:.0f}", *to_both, "-"]
    )
    return table(["command", "clock ms", "to the import", "to one program", "CPU to before"], rows)


def samples(folder: Path, program: str) -> list[str]:
    """Copies of a sample program."""
    paths = [folder / f"sample_{number}.nc" for number in range(_SAMPLES)]
    for path in paths:
        shutil.copyfile(program, path)
    return [*map(str, paths)]


def many(asked: argparse.Namespace, folder: Path) -> str:
    """Many files in one process and in two."""
    text = generated(folder, _BLOCKS_OF_MANY).read_text("ascii")
    paths = [folder / f"many_{number}.nc" for number in range(_MANY)]
    for path in paths:
        path.write_text(text, "ascii")
    taken = measured({jobs: [*CHECK_FILES, "--jobs", jobs, *map(str, paths)] for jobs in ("1", "2")}, asked.rounds)
    rows = [
        [jobs, f"{one.clock:.2f}", f"{ratio(one.clocks, taken['1'].clocks):.2f}", f"{one.cpu:.2f}"]
        for jobs, one in taken.items()
    ]
    return table(["processes", "clock s", "to one process", "CPU s"], rows)


def commands(asked: argparse.Namespace, folder: Path) -> str:
    """Other commands beside the check of the same program, and what its page takes."""
    program = str(generated(folder, min(_BLOCKS_OF_COMMANDS, asked.blocks)))
    page_of_program, page_of_sample = folder / "page.html", folder / "sample.html"
    options = ["--no-config", *cutters(2)]
    taken = measured(
        {
            "check": [*CHECK, *cutters(2), program],
            "part": [*_POLARCHECK, "part", *options, program],
            "convert --to haas-lathe": [*_POLARCHECK, "convert", *options, "--to", "haas-lathe", program],
            "plot": [*_POLARCHECK, "plot", *options, program, "-o", str(page_of_program)],
        },
        asked.rounds,
    )
    rows = [
        [name, f"{one.cpu:.2f}", f"{ratio(one.cpus, taken['check'].cpus):.2f}", f"{one.peak / 1e6:.0f}"]
        for name, one in taken.items()
    ]
    sample = str(ROOT / "sample_programs" / "hexagon.nc")
    run([*_POLARCHECK, "plot", "--no-config", sample, "-o", str(page_of_sample)])
    if not (page_of_program.exists() and page_of_sample.exists()):
        return table(["command", "CPU s", "to the check", "peak MB"], rows)
    above = page_of_program.stat().st_size - page_of_sample.stat().st_size
    told = table(["command", "CPU s", "to the check", "peak MB"], rows)
    return f"{told}\nThe page of `plot` has {above / 1e6:.2f} MB more than that of a sample program.\n"


def long_line(asked: argparse.Namespace, folder: Path) -> str:
    """A file that is one line of one letter."""
    letters = min(_LETTERS, 60 * asked.blocks)
    rows = []
    for letter in "AX":
        path = folder / f"{letter}.nc"
        path.write_text(letter * letters, "ascii")
        one = measured({"check": [*CHECK, "--max-size", "512MB", str(path)]}, min(asked.rounds, SLOW_ROUNDS))["check"]
        rows.append([f"{letters:,} times {letter}", f"{one.cpu:.2f}", f"{one.peak / 1e6:.0f}"])
    return table(["line", "CPU s", "peak MB"], rows)


def contours(asked: argparse.Namespace, folder: Path) -> str:
    """Contours that are hard to judge, with the R of a cutter beside without."""
    rows = []
    for name, case in CASES.items():
        path = folder / f"contour_{name}.nc"
        path.write_bytes(case.make())
        runs = [
            [cost(path, radius, *_LIMITS) for radius in (0.0, case.radius)]
            for _ in range(1 if asked.quick else min(asked.rounds, SLOW_ROUNDS))
        ]
        bare, using = ([one for one in column if isinstance(one, Cost)] for column in zip(*runs, strict=True))
        if len(bare) < len(runs) or len(using) < len(runs):
            rows.append([name, "above a limit", "-", "-", "-"])
            continue
        times = [[one.time for one in column] for column in (bare, using)]
        peak = statistics.median(one.peak for one in using)
        rows.append([name, *(f"{statistics.median(one):.2f}" for one in times)])
        rows[-1] += [f"{ratio(times[1], times[0]):.2f}", f"{peak / 1e6:.0f}"]
    return table(["contour", "CPU s", "with R", "ratio", "peak MB"], rows)


def drawings(asked: argparse.Namespace, folder: Path) -> str:
    """A circle that is milled, and drawn as a circle or as lines with gaps between them."""
    program = folder / "circle.nc"
    program.write_bytes(half_circles(2, _CIRCLE))
    commands = {}
    for count in (0, *_LINES):
        path = folder / f"circle_{count}.dxf"
        path.write_text(drawn_circle(count), "ascii")
        name = f"{count} LINEs with gaps" if count else "a CIRCLE"
        options = ["--no-config", "--tool=1:radius=5,nose=0", "--drawing", str(path)]
        commands[name] = [*_POLARCHECK, "part", *options, str(program)]
    taken = measured(commands, asked.rounds)
    return table(
        ["drawing", "CPU s", "to the CIRCLE", "exit"],
        [
            [name, f"{one.cpu:.2f}", f"{ratio(one.cpus, taken['a CIRCLE'].cpus):.2f}", str(one.status)]
            for name, one in taken.items()
        ],
    )


def drawn_circle(lines: int) -> str:
    """A drawing of a circle as so many lines, each with a gap of a fifth of it at its ends; 0 for a CIRCLE."""
    corners = [cmath.rect(_CIRCLE, math.tau * number / lines) for number in range(lines)]
    groups = [(0, "CIRCLE"), (8, 0), (10, 0), (20, 0), (40, _CIRCLE)] if not lines else []
    for start, end in zip(corners, [*corners[1:], *corners[:1]], strict=True):
        first, last = start + (end - start) / 10, end - (end - start) / 10
        groups += [(0, "LINE"), (8, 0), (10, first.real), (20, first.imag), (11, last.real), (21, last.imag)]
    head = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC")]
    groups = [*head, (0, "SECTION"), (2, "ENTITIES"), *groups, (0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in groups)


def growth(asked: argparse.Namespace, folder: Path) -> str:
    """Programs of more and more blocks, and the exponents of time and memory."""
    sizes = [size for size in SIZES if size <= asked.blocks or not asked.quick]
    taken = []
    for size in sizes:
        command = [*CHECK, "--max-size", "512MB", str(generated(folder, size))]
        taken.append(measured({"check": command}, asked.rounds if size < LARGE else 1)["check"])
    rows = [
        [f"{size:,}", f"{one.cpu:.2f}", f"{one.cpu / size * 1e6:.1f}", f"{one.peak / 1e6:.0f}"]
        for size, one in zip(sizes, taken, strict=True)
    ]
    told = table(["blocks", "CPU s", "µs per block", "peak MB"], rows)
    if len(sizes) < 4:
        return told
    last = len(sizes) // 2
    time_of = exponent(sizes[last:], [one.cpu for one in taken[last:]])
    peak_of = exponent(sizes[last:], [one.peak for one in taken[last:]])
    grows = f"CPU grows with the power {time_of:.2f} of the blocks, the peak with {peak_of:.2f}"
    if {LARGE, *sizes[:4]} <= {*sizes}:
        a_block = {size: one.cpu / size for size, one in zip(sizes, taken, strict=True)}
        grows += f"; a block of {LARGE:,} takes {a_block[LARGE] / a_block[sizes[3]]:.2f} of one of {sizes[3]:,}"
    return f"{told}\nFrom {sizes[last]:,} blocks on {grows}.\n"


def findings(asked: argparse.Namespace, folder: Path) -> str:
    """On how many programs with one fault each reader says what it does not say of the sound one, and names it."""
    (folder / "compensated.tbl").write_text(tool_table(4.0))
    readers = peers(asked, folder)
    for name in (WITH, WITHOUT + BEFORE, WITH + BEFORE, _REGEX, "LinuxCNC rs274"):
        readers.pop(name, None)
    readers["polarcheck"] = Peer("lathe", [*CHECK[:4], "--no-config", "--tool", TOOL])
    rows = []
    for name, peer in readers.items():
        status, sound = output([*peer.command, str(inputs(folder, "one", GOOD)[peer.kind])])
        told = right = 0
        for fault in FAULTS.values():
            path = inputs(folder, "one", GOOD.replace(fault.meant, fault.written, 1))[peer.kind]
            code, said = output([*peer.command, str(path)])
            new = _messages(said, path) - _messages(sound, path)
            told += code != status or bool(new)
            right += any(re.search(fault.says, line, re.IGNORECASE) for line in new)
        rows.append([name, str(status), str(told), str(right)])
    return table(["reader", "exit without a fault", f"says something of {len(FAULTS)}", "names the fault of"], rows)


def _messages(said: str, path: Path) -> set[str]:
    """What a reader says of a program, but moves, blocks of the program, counts, and numbers of lines and blocks."""
    blocks = {line.strip() for line in path.read_text("ascii").splitlines()}
    lines = [re.sub(r"^\s*\d+:?\s+|\bline \d+", "", line).strip() for line in said.splitlines()]
    return {line for line in lines if line and line not in blocks and not re.match(r"N\.\.|errors?, |error: \d", line)}


def both_stages(asked: argparse.Namespace, folder: Path) -> str:
    """Where the time goes, without and with a cutter."""
    path = generated(folder, asked.blocks)
    kinds = {"without a cutter": [], "with one": cutters(2)}
    told = [f"{what}:\n\n{stages(path, *CHECK[4:], *tools)}" for what, tools in kinds.items()]
    sample = ROOT / "sample_programs" / "hexagon.nc"
    return "\n".join([*told, f"a sample program:\n\n{stages(sample, *CHECK[4:])}"])


def versions(asked: argparse.Namespace) -> str:
    """The version of each peer, as its package or its checkout tells it."""
    python = _place(asked.python, "PEERS_PYTHON", "") or sys.executable
    of_package = "import sys, importlib.metadata as m; print(m.version(sys.argv[1]))"
    questions = {
        "LinuxCNC rs274": ["dpkg-query", "-W", "-f", "${Version}", "linuxcnc-uspace"],
        "nc-gcode-interpreter": [python, "-c", of_package, "nc-gcode-interpreter"],
        "pygcode": [python, "-c", of_package, "pygcode"],
        "nctab": [_place(asked.nctab, "NCTAB", "nctab") or "nctab", "--version"],
        "ncplot7py": ["git", "-C", asked.ncplot7py or "no folder", "log", "-1", "--format=%h of %cs"],
    }
    told = {}
    for name, command in questions.items():
        with contextlib.suppress(OSError):
            status, said = output(command)
            told[name] = said.strip().splitlines()[-1] if not status and said.strip() else ""
    return ", ".join(f"{name} {version}" for name, version in told.items() if version)


ONE_SLIP = """\
## One slip in a sound program

    python benchmarks/slips.py --count 3000 --kinds
    python benchmarks/slips.py --sound 1500
    python benchmarks/slips.py --pairs 400

The first draws sound programs as setters and CAM posts write them (`tests/setter_programs.py`), makes one slip in each
(`tests/single_slips.py`), and prints how many are spoken about, how many in more than one finding, how many at their
line, and how many of the values that are named, and of `--unsafe-fixes`, make the part of the sound program. A
simulation that shares no code with polarcheck (`tests/metal_simulation.py`) runs both programs: a slip counts where the
part comes out otherwise, the control stops or metal is met by rapid, and where a check without a drawing could know:
by an alarm, or since the sound contour is more regular, tangent or closed, or another pass or a comment says it
(`tests/slip_witnesses.py`). `--misses FILE` writes those that are silent, in several findings or given another value.
The second checks programs without a slip, the third those with two.
"""


def _processor() -> str:
    """The name of the processor, as Linux has it."""
    with contextlib.suppress(OSError):
        if match := re.search(r"model name\s*:\s*(.+)", Path("/proc/cpuinfo").read_text()):
            return match[1]
    return platform.processor() or platform.machine()


def page(asked: argparse.Namespace, parts: dict[str, str]) -> str:
    """The page of Markdown."""
    machine = f"{os.cpu_count()} cores of {_processor()}, CPython {platform.python_version()}, NumPy {version('numpy')}"
    missing = [name for name in _PEERS if name not in parts["Whole processes"]]
    left_out = f" Not installed there, and left out: {', '.join(missing)}." if missing else ""
    about = {
        "Whole processes": f"""\
The program is that of `benchmarks/generate.py`: turning, then polar sections with G41/G42, {asked.blocks:,} blocks.
Readers of mill programs have the same path in X and Y (`benchmarks/xy_twin.py`), block for block; rs274 with G41/G42 is
what polarcheck with a cutter is put beside. A reader that takes longer than {SLOW} s runs {SLOW_ROUNDS} times at most.
Of one that needs less memory than what starts it, the peak is that of what starts it.{left_out}""",
        "Small files": "On the clock, since that is what somebody waits for at a commit. The sample has 23 blocks.",
        "Many files": f"{_MANY} programs of {_BLOCKS_OF_MANY:,} blocks, in one process and in two (`--jobs`).",
        "Other commands": f"""\
The program of `benchmarks/generate.py` with {min(_BLOCKS_OF_COMMANDS, asked.blocks):,} blocks and a cutter of R 2.""",
        "Long lines": "A file that is one line of one letter.",
        "Contours": """\
Those of `benchmarks/contour_costs.py`, which says what is hard about each; without the start of the process.""",
        "Drawings": f"`part --drawing` of a circle of {2 * _CIRCLE} mm that is milled in two arcs.",
        "Growth": f"Without a cutter; from {LARGE:,} blocks on one run each.",
        "What is found": f"""\
{len(FAULTS)} programs with one fault each (`benchmarks/peer_faults.py`), and the sound one. A reader names a fault
where what it says, and does not say of the sound program, holds the words that belong to the fault: a generous
measure, and the faults were chosen here. Readers of mill programs get the twin: a fault of the mode itself cannot stand
in it.""",
        "Where the time goes": """\
By cProfile, which adds time to each call (`benchmarks/stages.py FILE` does so for any file). A function counts for the
stage of its module, one of a library or of polarcheck/geometry for the stages that call it.""",
    }
    text = "\n".join(f"## {title}\n\n{about[title]}\n\n{part}" for title, part in parts.items())
    peers_there = versions(asked)
    beside = f"Peers: {peers_there}." if peers_there else ""
    older = f"`{BEFORE[2:]}` is polarcheck at {asked.before_is}, in the same rounds.\n" if asked.before else ""
    return f"""\
# Benchmarks

Made by one command:

    python benchmarks/peers.py --rs274 FILE --python FILE --nctab FILE --ncplot7py FOLDER -o docs/benchmarks.md

on {machine}; medians of {asked.rounds} rounds, in each of which every command runs once;
ratios are medians of those of each round.
What they write goes to /dev/null, and polarcheck keeps no results of earlier runs.
`--only "Small files" --before FILE` prints one part, beside the polarcheck of another Python, instead of the page.
{older}{beside}
{asked.note}

{text}
{ONE_SLIP}"""


#: What the page shows, in its order.
PARTS = {
    "Whole processes": speed,
    "Small files": small,
    "Many files": many,
    "Other commands": commands,
    "Long lines": long_line,
    "Contours": contours,
    "Drawings": drawings,
    "Growth": growth,
    "What is found": findings,
    "Where the time goes": both_stages,
}


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("rs274", "python", "nctab", "ncplot7py"):
        parser.add_argument(f"--{name}")
    parser.add_argument("--before", metavar="FILE", help="a Python that has an older polarcheck")
    parser.add_argument("--before-is", default="an earlier commit", metavar="WORDS", help="which one that is")
    parser.add_argument(
        "--note",
        default="Ratios differ between machines, too.",
        metavar="WORDS",
        help="what else the page says of its figures",
    )
    parser.add_argument("--blocks", type=int, default=200_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--quick", action="store_true", help="nothing larger than --blocks")
    parser.add_argument("--only", choices=PARTS, metavar="TITLE", help="one part of the page, on standard output")
    parser.add_argument("-o", "--output", type=Path)
    asked = parser.parse_args()
    if not (asked.output or asked.only):
        parser.error("either --output or --only is needed")
    for command in (CHECK, *([by_older(asked.before, CHECK)] if asked.before else [])):
        run([*command, str(ROOT / "sample_programs" / "hexagon.nc")])  # compiles what is not yet
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        parts = {}
        for title, measure in PARTS.items():
            if asked.only not in (None, title):
                continue
            print(f"{title} ...", end=" ", file=sys.stderr, flush=True)
            began = time.perf_counter()
            parts[title] = measure(asked, folder)
            print(f"{time.perf_counter() - began:.0f} s", file=sys.stderr)
    if asked.only:
        print(parts[asked.only], end="")
    else:
        asked.output.write_text(page(asked, parts), "utf-8")


if __name__ == "__main__":
    main()
