"""
polarcheck beside other readers of NC programs: time and memory of whole processes, and what each of them finds.

    python benchmarks/peers.py --rs274 FILE --python FILE --nctab FILE -o docs/benchmarks.md

A peer is found by its option, by RS274, PEERS_PYTHON or NCTAB in the environment, or on the search path; one that is not
there is left out. All are run in turn, round by round, so that they see the same machine.
"""  # noqa: E501

from __future__ import annotations

import argparse
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import generate
import numpy as np
from one_fault import FAULTS, GOOD, TOOL
from xy_twin import tool_table, twin

ROOT = Path(__file__).parent.parent
CHECK = (sys.executable, "-m", "polarcheck", "check", "--no-config", "--fail-on", "never", "--jobs", "1", "-q")
TOOLS = tuple(f"--tool={number}:radius=2" for number in range(4, 13))
REGEX = "import re, sys; re.findall(rb'([A-Z])([-+]?[0-9.]+)', open(sys.argv[1], 'rb').read())"
INTERPRETER = "import sys, nc_gcode_interpreter as n; n.nc_to_dataframe(open(sys.argv[1]).read())"
PYGCODE = "import sys, pygcode; [pygcode.Line(line) for line in open(sys.argv[1])]"
SIZES = (1_000, 10_000, 50_000, 200_000, 1_000_000, 5_000_000)


class Taken(NamedTuple):
    """What a process has taken: time of the processor and on the clock [s], peak memory [bytes], and its exit code."""

    cpu: float
    clock: float
    peak: int
    status: int


def run(command: Sequence[str]) -> Taken:
    """Run a process to its end."""
    began = time.perf_counter()
    running = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=ROOT, env={**os.environ, "COLUMNS": "200"}
    )
    _, status, used = os.wait4(running.pid, 0)
    running.returncode = os.waitstatus_to_exitcode(status)
    return Taken(used.ru_utime + used.ru_stime, time.perf_counter() - began, used.ru_maxrss * 1024, running.returncode)


def measured(commands: Mapping[str, Sequence[str]], rounds: int) -> dict[str, Taken]:
    """The median of each figure over the rounds; in a round each command runs once."""
    taken: dict[str, list[Taken]] = {name: [] for name in commands}
    for _ in range(rounds):
        for name, command in commands.items():
            taken[name].append(run(command))
    return {
        name: Taken(*(statistics.median(column) for column in zip(*runs, strict=True))) for name, runs in taken.items()
    }


def table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table of Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def exponent(blocks: Sequence[int], values: Sequence[float]) -> float:
    """The slope of the upper half in logarithms: 1 where twice the blocks take twice as much."""
    half = len(blocks) // 2
    return float(np.polyfit(np.log(blocks[half:]), np.log(values[half:]), 1)[0])


def found(asked: argparse.Namespace, name: str, variable: str, default: str) -> str | None:
    """Where a peer is."""
    return getattr(asked, name) or os.environ.get(variable) or shutil.which(default)


def peers(asked: argparse.Namespace, table_of_tools: Path) -> dict[str, tuple[str, list[str]]]:
    """The peers that are installed: the kind of input that each reads, and its command without the file."""
    made = {"a bare regex": ("lathe", [sys.executable, "-c", REGEX])}
    if rs274 := found(asked, "rs274", "RS274", "rs274"):
        made["LinuxCNC rs274"] = ("mill", [rs274, "-t", str(table_of_tools), "-g"])
    if nctab := found(asked, "nctab", "NCTAB", "nctab"):
        made["nctab"] = ("lathe", [nctab, "check", "-p", "fanuc-turn"])
    python = asked.python or os.environ.get("PEERS_PYTHON") or sys.executable
    for name, module, kind, code in (
        ("nc-gcode-interpreter", "nc_gcode_interpreter", "sinumerik", INTERPRETER),
        ("pygcode", "pygcode", "lathe", PYGCODE),
    ):
        if not run([python, "-c", f"import {module}"]).status:
            made[name] = (kind, [python, "-c", code])
    return made


def inputs(folder: Path, name: str, program: str) -> dict[str, Path]:
    """A program and its twins, by kind, in files."""
    texts = {
        "lathe": program,
        "mill": twin(program),
        "compensated": twin(program, compensated=True),
        "sinumerik": twin(program, sinumerik=True),
    }
    paths = {kind: folder / f"{name}_{kind}.nc" for kind in texts}
    for kind, text in texts.items():
        paths[kind].write_text(text, "ascii")
    return paths


def speed(asked: argparse.Namespace, folder: Path) -> str:
    """The table of whole processes on one large program."""
    (folder / "none.tbl").write_text(tool_table(0.0))
    (folder / "cutter.tbl").write_text(tool_table(2.0))
    paths = inputs(folder, "large", generate.program(asked.blocks).decode())
    commands = {
        "polarcheck": [*CHECK, str(paths["lathe"])],
        "polarcheck, with compensation and overcut": [*CHECK, *TOOLS, str(paths["lathe"])],
    }
    others = peers(asked, folder / "none.tbl")
    commands |= {name: [*command, str(paths[kind])] for name, (kind, command) in others.items()}
    if "LinuxCNC rs274" in others:
        command = [others["LinuxCNC rs274"][1][0], "-t", str(folder / "cutter.tbl"), "-g"]
        commands["LinuxCNC rs274, with compensation"] = [*command, str(paths["compensated"])]
    taken = measured(commands, asked.rounds)
    beside = {name: taken.get("LinuxCNC rs274" + (", with compensation" if "with" in name else "")) for name in taken}
    size = paths["lathe"].stat().st_size
    rows = [
        [
            *(name, f"{one.cpu:.2f}", f"{one.clock:.2f}", f"{one.peak / 1e6:.0f}", f"{one.peak / size:.0f}"),
            f"{one.cpu / other.cpu:.2f}" if (other := beside[name]) else "-",
            f"{one.status:.0f}",
        ]
        for name, one in taken.items()
    ]
    return table(["reader", "CPU s", "clock s", "peak MB", "per byte", "CPU to rs274", "exit"], rows)


def growth(asked: argparse.Namespace, folder: Path) -> str:
    """The table of sizes, and the exponents."""
    sizes = [size for size in SIZES if size <= (asked.blocks if asked.quick else SIZES[-1])]
    taken = []
    for size in sizes:
        path = folder / "growth.nc"
        path.write_bytes(generate.program(size))
        taken.append(measured({"check": [*CHECK, str(path)]}, asked.rounds if size <= asked.blocks else 1)["check"])
    rows = [
        [f"{size:,}", f"{one.cpu:.2f}", f"{one.peak / 1e6:.0f}", f"{one.cpu / size * 1e6:.2f}"]
        for size, one in zip(sizes, taken, strict=True)
    ]
    told = table(["blocks", "CPU s", "peak MB", "µs per block"], rows)
    if len(sizes) < 3:
        return told
    time_of, peak_of = (exponent(sizes, values) for values in zip(*((one.cpu, one.peak) for one in taken), strict=True))
    return f"{told}\nExponent over the larger half: CPU {time_of:.2f}, peak {peak_of:.2f}.\n"


def said(command: Sequence[str]) -> tuple[int, str]:
    """The exit code and all output of a process."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    return done.returncode, done.stdout + done.stderr


def findings(asked: argparse.Namespace, folder: Path) -> str:
    """On how many programs with one fault each reader says anything else, and names it for the right reason."""
    others = peers(asked, folder / "cutter.tbl")
    others.pop("a bare regex")
    check = [*(word for word in CHECK if word not in ("--fail-on", "never")), "--tool", TOOL]
    readers = {"polarcheck": ("lathe", check), **others}
    rows = []
    for name, (kind, command) in readers.items():
        kind = "compensated" if kind == "mill" else kind
        status, good = said([*command, str(inputs(folder, "one", GOOD)[kind])])
        told = right = 0
        for fault in FAULTS.values():
            path = inputs(folder, "one", GOOD.replace(fault.meant, fault.written, 1))[kind]
            code, output = said([*command, str(path)])
            new = set(output.splitlines()) - set(good.splitlines())
            spoke = code != status or (bool(new) and "rs274" not in name)
            told += spoke
            right += spoke and any(re.search(fault.says, line, re.IGNORECASE) for line in new)
        rows.append([name, "no" if status == 0 else "yes", str(told), str(right)])
    heads = ["reader", "objects to the program without a fault", f"says otherwise of {len(FAULTS)}", "right reason"]
    return table(heads, rows)


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("rs274", "python", "nctab"):
        parser.add_argument(f"--{name}")
    parser.add_argument("--blocks", type=int, default=200_000)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="nothing larger than --blocks")
    parser.add_argument("-o", "--output", type=Path, required=True)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        parts = speed(asked, folder), growth(asked, folder), findings(asked, folder)
        path = folder / "large_lathe.nc"
        stages = subprocess.run([*CHECK, "--timings", str(path)], capture_output=True, text=True, check=True, cwd=ROOT)
    machine = f"{os.cpu_count()} cores, CPython {platform.python_version()}, NumPy {np.__version__}"
    titles = ("Whole processes", "Growth", "What is found")
    text = "".join(f"## {title}\n\n{part}\n" for title, part in zip(titles, parts, strict=True))
    asked.output.write_text(
        f"# Benchmarks\n\nMade by `benchmarks/peers.py` on {machine}: {asked.blocks:,} blocks, median of {asked.rounds} "  # noqa: E501
        "rounds in turn. Readers of mill\nprograms have the same path in X and Y. Ratios carry over to another machine, "  # noqa: E501
        f"seconds do not.\n\n{text}## Where the time goes\n\n`polarcheck check --timings`, without a cutter:\n\n"
        + "".join(f"    {line}\n" for line in stages.stderr.splitlines()),
        "utf-8",
    )


if __name__ == "__main__":
    main()
