"""
Fuzzing that goes on, for as long as asked: mutated programs, machine files, jobs and offset tables; and programs drawn
by grammar for the commands that write programs anew.

    python benchmarks/fuzz.py --minutes 60 --jobs 2 [--seed 1] [--keep FOLDER] [--target whole] [--atheris]

Inputs begin with the sample programs, the examples of the rules and the real programs beside the checkout; those that
reach new lines of polarcheck are mutated further (tests/fuzz_loop.py; what must hold: tests/fuzz_targets.py). Those of
convert, unroll, roll, compensate, compare and certify are drawn by tests/odd_programs.py and tests/setter_programs.py
for each machine (what must hold: tests/fuzz_rewriting.py). With --atheris, where that is installed, libFuzzer chooses
the inputs instead.

Each job is a process with a bound on its memory, and each input has one on its time: a process that dies or hangs is
ended, its input kept, and another one begun. --keep writes the smallest input of each distinct failure to a folder,
with a line that says what is wrong. Ends with 1 where anything failed. Not for Windows, which has no such bounds.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from pathlib import Path
from typing import IO, Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

#: Commands that write programs anew, and those that compare.
REWRITING = ("convert", "unroll", "roll", "compensate", "compare", "certify")
TARGETS = ("whole", "reader", "statement", "trace", "command", "commands", "settings", "offsets", *REWRITING)
#: The whole check is what people run.
WEIGHTED = ("whole", "whole", "whole", "trace", "command", "commands", "convert", *TARGETS)
#: A process that says nothing for so many times the seconds of an input, or for so long [s], hangs.
PATIENCE, MINIMISING = 4, 90


def main() -> int:
    """Fuzz, tell, and say at the end what failed; 1 where anything did."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1, help="the same seed begins with the same inputs")
    parser.add_argument("--keep", type=Path, help="folder for inputs that fail")
    parser.add_argument("--target", action="append", choices=TARGETS, help="only this part; may be repeated")
    parser.add_argument("--seconds", type=float, default=20.0, help="of the processor for one input")
    parser.add_argument("--memory", type=float, default=4.0, help="of one process [GB]")
    parser.add_argument("--atheris", action="store_true", help="inputs by libFuzzer, where atheris is installed")
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.worker:
        return work(asked)
    began = time.monotonic()
    watches = [Watch(asked, number, began + asked.minutes * 60) for number in range(asked.jobs)]
    threads = [threading.Thread(target=watch.run) for watch in watches]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return summary(watches, time.monotonic() - began)


class Watch:
    """One job: a process that fuzzes, and another one where that ends or hangs. failures: by kind, with a count."""

    def __init__(self, asked: argparse.Namespace, number: int, until: float) -> None:
        self.asked, self.number, self.until = asked, number, until
        self.inputs = self.kept = 0
        self.failures: dict[str, tuple[int, str]] = {}
        self._heard = time.monotonic()

    def run(self) -> None:
        """Until the time is over."""
        process_number = 0
        while self.until - time.monotonic() > 1:
            seed = self.asked.seed + 1000 * self.number + 100_000 * process_number
            process_number += 1
            with tempfile.TemporaryDirectory() as folder:
                self._run_process(seed, Path(folder))

    def _run_process(self, seed: int, folder: Path) -> None:
        minutes = max(self.until - time.monotonic(), 1) / 60
        command = [
            sys.executable,
            __file__,
            "--worker",
            str(folder),
            "--seed",
            str(seed),
            "--minutes",
            f"{minutes:.3f}",
        ]
        command += ["--seconds", str(self.asked.seconds), "--memory", str(self.asked.memory)]
        command += [word for target in self.asked.target or () for word in ("--target", target)]
        command += ["--atheris"] * self.asked.atheris
        with (folder / "stderr").open("wb") as errors:
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True)
        self._heard = time.monotonic()
        reader = threading.Thread(target=self._listen, args=(process.stdout,))
        reader.start()
        patience = max(PATIENCE * self.asked.seconds, MINIMISING)
        while process.poll() is None and time.monotonic() - self._heard < patience:
            time.sleep(0.5)
        hangs = process.poll() is None
        if hangs:
            process.kill()
        status = process.wait()
        reader.join()
        if status or hangs:
            self._lost(folder, "does not end" if hangs else f"process ended with {status}")

    def _listen(self, stream: IO[str]) -> None:
        before = self.inputs, self.kept
        for line in stream:
            self._heard = time.monotonic()
            said = json.loads(line)
            if "kind" in said:
                self._failed(said)
            else:
                self.inputs, self.kept = before[0] + said["inputs"], before[1] + said["kept"]

    def _failed(self, said: dict[str, Any]) -> None:
        count, reason = self.failures.get(said["kind"], (0, said["reason"]))
        self.failures[said["kind"]] = count + 1, reason
        if not count:
            print(f"{said['kind']}: {said['reason']}", flush=True)
            if self.asked.keep:
                keep(self.asked.keep, said)

    def _lost(self, folder: Path, kind: str) -> None:
        """A process is gone: what it was at is told by the file that it wrote before."""
        errors = (folder / "stderr").read_text("utf-8", "replace").strip().splitlines()[-1:]
        current = folder / "input"
        if not current.exists():
            self._failed({"kind": f"{kind} before any input", "reason": " ".join(errors), "data": ""})
            self.until = 0.0  # another one would end likewise
            return
        said = json.loads((folder / "about").read_text())
        reason = " ".join([kind, *errors])
        self._failed({**said, "kind": f"{said['target']} {kind}", "reason": reason, "data": current.read_bytes().hex()})


def keep(folder: Path, said: dict[str, Any]) -> None:
    """The input of a failure, and beside it how it came about."""
    folder.mkdir(parents=True, exist_ok=True)
    name = "".join(letter if letter.isalnum() else "-" for letter in said["kind"])[:80]
    (folder / f"{name}.nc").write_bytes(bytes.fromhex(said["data"]))
    (folder / f"{name}.txt").write_text(json.dumps({key: said[key] for key in said if key != "data"}) + "\n")


def summary(watches: list[Watch], seconds: float) -> int:
    """What was run, and the distinct failures; 1 where there are any."""
    inputs, kept = sum(watch.inputs for watch in watches), sum(watch.kept for watch in watches)
    print(f"{inputs} inputs in {seconds / 60:.1f} minutes, {len(watches)} jobs; {kept} reached something new")
    failures = {kind: reason for watch in watches for kind, (_, reason) in watch.failures.items()}
    print(f"{len(failures)} distinct failures")
    for kind, reason in sorted(failures.items()):
        print(f"  {kind}: {reason}")
    return int(bool(failures))


# ---- the process that fuzzes ----


def work(asked: argparse.Namespace) -> int:
    """Fuzz in this process; says on standard output, a line of JSON each, how far it is and what failed."""
    warnings.simplefilter("error")
    resource.setrlimit(resource.RLIMIT_AS, (int(asked.memory * 1e9),) * 2)
    if asked.atheris:
        from fuzz_atheris import guided
    else:
        guided = by_own_loop
    return guided(asked, Teller(Path(asked.worker)))


class Teller:
    """Says how far a process is; keeps what it is at in files, for the case that it dies."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._last = 0.0
        self._size = 0
        # What anybody prints shows among what is written on standard error.
        self._out = os.fdopen(os.dup(1), "w")
        os.dup2(2, 1)

    def about_to_run(self, target: str, setup: int, data: bytes) -> None:
        """Before each input."""
        (self.folder / "about").write_text(json.dumps({"target": target, "setup": setup}))
        (self.folder / "input").write_bytes(data)

    def failed(self, failure: Any, seed: int) -> None:
        """A failure, made small."""
        self._say({**failure._asdict(), "data": failure.data.hex(), "seed": seed})

    def progress(self, inputs: int, kept: int) -> None:
        """Every second."""
        if time.monotonic() - self._last > 1:
            self._last = time.monotonic()
            self.final(inputs, kept)

    def final(self, inputs: int, kept: int) -> None:
        """At the end."""
        self._say({"inputs": inputs, "kept": kept})

    def stderr_grew(self) -> str:
        """What was written on standard error since the last time, by whomever."""
        size = os.fstat(2).st_size
        if size == self._size:
            return ""
        with (self.folder / "stderr").open("rb") as file:
            file.seek(self._size)
            self._size = size
            return file.read().decode("utf-8", "replace").strip()

    def _say(self, said: dict[str, Any]) -> None:
        print(json.dumps(said), file=self._out, flush=True)


def by_own_loop(asked: argparse.Namespace, teller: Teller) -> int:
    """Inputs by the loop of tests/fuzz_loop.py."""
    from fuzz_loop import Loop

    loop = Loop(asked.seed, asked.target or WEIGHTED, asked.seconds, teller.stderr_grew)

    def tell(target: str, setup: int, data: bytes) -> None:
        teller.about_to_run(target, setup, data)
        teller.progress(loop.inputs, loop.kept)

    for failure in loop.run(time.monotonic() + asked.minutes * 60, tell):
        teller.failed(failure, asked.seed)
    teller.final(loop.inputs, loop.kept)
    return 0


if __name__ == "__main__":
    sys.exit(main())
