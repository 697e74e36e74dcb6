"""
Archives of many files: processor use, time and memory of several processes and of a cluster, beside one process.

    python benchmarks/archives.py [--files 10000] [--sizes tiny,small,large] [--jobs 1,2] [--cluster]

The programs are made in a temporary folder, and checked by real processes.

wall, CPU   seconds on the clock, and of processor time of all processes together
busy        how many processes had something to do, on average: those that ran or waited for a processor (schedstat of
            Linux). It says whether anybody is idle, whatever else the machine does meanwhile.
ratio       to one process, on the clock: of use on a machine with nothing else to do
free        the same as a machine with nothing else to do would show it: busy, times the CPU time of one process, by
            the CPU time of all
MB          peak of the largest process

Of a cluster only the process that asks is looked at.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from generate import program

ROOT = Path(__file__).parent.parent
SAMPLES = [path.read_bytes() for path in sorted((ROOT / "sample_programs").glob("*.nc"))]
#: Blocks of the programs of each size: those of the samples, and such as CAM posts write.
BLOCKS = {"tiny": 0, "small": 1000, "large": 10_000}
CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=int(sys.argv[1]), threads_per_worker=1, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


def make(folder: Path, files: int, size: str) -> None:
    """So many programs, each with another number and another depth, so that no two are the same."""
    random.seed(1)
    bases = [program(BLOCKS[size], seed=seed).replace(b"\r", b"") for seed in range(4)] if BLOCKS[size] else SAMPLES
    for number in range(files):
        base = bases[number % len(bases)]
        text = re.sub(rb"(?m)^O\d+", b"O%04d" % (number % 9999 + 1), base, count=1)
        (folder / f"O{number:05}.nc").write_bytes(text + b"(%d)\n" % random.randrange(10**9))  # noqa: S311


class Taken(NamedTuple):
    """Wall time [s]; processor time [s]; how many processes had something to do, on average; peak memory [MB]."""

    wall: float
    used: float
    busy: float
    peak: float


def run(folder: Path, *options: str) -> Taken:
    """Check a folder by processes of their own, and look at them meanwhile."""
    words = [sys.executable, "-m", "polarcheck", "check", str(folder), "--no-config", "--fail-on", "never", *options]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "POLARCHECK_NO_CACHE": "1"}
    wanted: dict[int, float] = {}
    peaks = [0.0]
    began = time.perf_counter()
    with subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
        while running.poll() is None:
            for process in (running.pid, *children(running.pid)):
                with contextlib.suppress(OSError, StopIteration, ValueError):
                    on, waiting, _ = map(int, Path(f"/proc/{process}/schedstat").read_text().split())
                    wanted[process] = (on + waiting) / 1e9
                    status = Path(f"/proc/{process}/status").read_text().splitlines()
                    peaks.append(next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024)
            time.sleep(0.02)
    wall = time.perf_counter() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - sum(_BEFORE)
    _BEFORE.append(used)
    if running.returncode:
        raise SystemExit(f"{' '.join(words)} ended with {running.returncode}")
    return Taken(wall, used, sum(wanted.values()) / wall, max(peaks))


#: Processor time of the runs before [s].
_BEFORE: list[float] = []


def children(process: int) -> list[int]:
    """The processes that a process has started."""
    with contextlib.suppress(OSError):
        return [int(one) for one in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    return []


@contextlib.contextmanager
def cluster(workers: int) -> Iterator[str]:
    """The address of a cluster of processes on this machine."""
    words = [sys.executable, "-c", CLUSTER, str(workers)]
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "cluster.py"
        script.write_text(CLUSTER)
        words = [sys.executable, str(script), str(workers)]
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "POLARCHECK_NO_CACHE": "1"}
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        with subprocess.Popen(words, env=environment, text=True, cwd=folder, **pipes) as running:  # type: ignore[call-overload]
            yield running.stdout.readline().strip()
            running.stdin.close()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", default="10,30,100,1000", help="numbers of files, with commas between")
    parser.add_argument("--sizes", default="tiny,small", help=f"of {', '.join(BLOCKS)}")
    parser.add_argument("--jobs", default="1,2", help="as --jobs takes them, the first for comparison")
    parser.add_argument("--format", default="concise")
    parser.add_argument("--select", help="rules, instead of all: for memory few are enough")
    parser.add_argument("--cluster", type=int, default=0, help="workers of a cluster that is tried, too")
    asked = parser.parse_args()
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; kB: of an average file")
    print("size       kB  files           by     wall      CPU   busy  ratio   free    MB")
    for size in asked.sizes.split(","):
        for files in map(int, asked.files.split(",")):
            with tempfile.TemporaryDirectory() as made, contextlib.ExitStack() as stack:
                folder = Path(made)
                make(folder, files, size)
                mean = sum(path.stat().st_size for path in folder.iterdir()) / files / 1000
                ways = [(f"--jobs {jobs}", ["--jobs", jobs]) for jobs in asked.jobs.split(",")]
                if asked.cluster:
                    ways.append(
                        (f"cluster of {asked.cluster}", ["--cluster", stack.enter_context(cluster(asked.cluster))])
                    )
                first: Taken | None = None
                for name, options in ways:
                    rules = ["--select", asked.select] if asked.select else []
                    taken = run(folder, "--format", asked.format, *rules, *options)
                    first = first or taken
                    free = "" if "cluster" in name else f"{taken.busy * first.used / taken.used:6.2f}"
                    print(
                        f"{size:6} {mean:6.1f} {files:6} {name:>12} {taken.wall:8.2f} {taken.used:8.2f} "
                        f"{taken.busy:6.2f} {first.wall / taken.wall:6.2f} {free:>6} {taken.peak:5.0f}",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
