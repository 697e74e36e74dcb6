"""
Where the time of a check goes, by stage, as cProfile measures it in a process of its own.

    python benchmarks/stages.py FILE [--tool 1:radius=2]...

A function counts for the stage of its module. What belongs to no stage, such as NumPy and polarcheck/geometry, counts
for the stages that call it, in proportion to the time of the calls.
"""

from __future__ import annotations

import argparse
import pstats
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from measuring import ROOT, output, table

#: In the order of the data.
STAGES = ("start", "reading", "execution", "columns", "tool path", "faces", "rules", "report")
#: By room of polarcheck; a room within a room comes first.
OF_ROOM = {
    "__main__": "start",
    "commands": "start",
    "program/machines": "start",
    "program/reading": "reading",
    "program/execution": "execution",
    "columns": "columns",
    "parts": "faces",
    "rules": "rules",
    "checking": "rules",
    "files": "start",
    "reports": "report",
}
#: Modules whose tables are more than columns.
OF_TABLE = {
    **dict.fromkeys(("tool_center", "moves", "ramps", "trial", "travel"), "tool path"),
    **dict.fromkeys(("dynamics", "feed_curve", "highest_feeds", "feed_ranges"), "tool path"),
    **dict.fromkeys(("overcuts", "slots", "uncompensated_cuts", "fitting_radius", "finished"), "faces"),
    **dict.fromkeys(("coverage", "mirrored"), "faces"),
}
#: Calls lead through fewer functions of libraries, one in the other, than this.
DEEPEST = 200

#: Time of the processor, since that of the clock counts other processes, too.
PROFILE = """
import cProfile, runpy, sys, time
path, *sys.argv[1:] = sys.argv[1:]
profile = cProfile.Profile(time.process_time, builtins=False)
try:
    profile.runcall(runpy.run_module, "polarcheck", run_name="__main__", alter_sys=True)
finally:
    profile.dump_stats(path)
"""

#: File, line and name of a function, as pstats has them.
Function = tuple[str, int, str]


def profiled(arguments: Sequence[str]) -> dict[Function, Any]:
    """The statistics of `polarcheck check` with these arguments, by function."""
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "check.prof")
        command = [sys.executable, "-c", PROFILE, path, "check", *arguments]
        status, said = output(command)
        if status:
            raise SystemExit(said)
        return pstats.Stats(path).stats  # type: ignore[attr-defined]


def stage_of(function: Function) -> str | None:
    """The stage of a function; None for one of a library, which counts for its callers."""
    file, _, name = function
    if name == "<module>" or file.startswith("<frozen importlib"):
        return "start"
    if not Path(file).is_relative_to(ROOT / "polarcheck"):
        return None
    path = Path(file).relative_to(ROOT / "polarcheck").with_suffix("")
    stage = next((stage for room, stage in OF_ROOM.items() if path.is_relative_to(room)), None)
    return OF_TABLE.get(path.name, stage) if stage == "columns" else stage


def seconds_by_stage(stats: dict[Function, Any]) -> dict[str, float]:
    """The time of each stage [s]; together they are the whole."""
    seconds = dict.fromkeys(STAGES, 0.0)
    left = {function: own for function, (_, _, own, _, _) in stats.items()}
    for _ in range(DEEPEST):
        above: dict[Function, float] = {}
        for function, own in left.items():
            stage = stage_of(function)
            callers = {caller: calls[3] for caller, calls in stats[function][4].items() if caller != function}
            whole = sum(callers.values())
            if stage or not whole:
                seconds[stage or "start"] += own
                continue
            for caller, share in callers.items():
                above[caller] = above.get(caller, 0.0) + own * share / whole
        left = above
    return seconds


def stages(path: Path, *options: str) -> str:
    """The table of a check of a file."""
    seconds = seconds_by_stage(profiled([*options, str(path)]))
    blocks = path.read_bytes().count(b"\n")
    whole = sum(seconds.values())
    rows = [
        [name, f"{one:.3f}", f"{one / whole:.0%}", f"{blocks / one:,.0f}" if one >= 0.001 else "-"]
        for name, one in (*seconds.items(), ("total", whole))
    ]
    return table(["stage", "CPU s", "share", "blocks/s"], rows)


def main() -> None:
    """Profile, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--tool", action="append", default=[])
    asked = parser.parse_args()
    options = ["--no-config", "--fail-on", "never", "--jobs", "1", "-q", *(f"--tool={tool}" for tool in asked.tool)]
    print(stages(asked.file, *options), end="")


if __name__ == "__main__":
    main()
