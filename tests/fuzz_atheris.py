"""
The same properties with inputs that libFuzzer chooses, where atheris is installed (benchmarks/fuzz.py --atheris).

It is no dependency: `pip install atheris` into an environment that has polarcheck's own.
"""

from __future__ import annotations

import argparse
import importlib
import os
import pkgutil
import sys
import time
from random import Random
from typing import Any, Protocol

import atheris  # type: ignore[import-not-found]

with atheris.instrument_imports(include=["polarcheck"], enable_loader_override=False):
    from fuzz_loop import Failure, smallest, told_of
    from fuzz_setups import SETUPS
    from fuzz_targets import TARGETS, drawn, seeds

    import polarcheck

    # All at once: what is imported later is not instrumented.
    for module in pkgutil.walk_packages(polarcheck.__path__, "polarcheck."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)

from fuzz_mutations import mutated


class Told(Protocol):
    """What benchmarks/fuzz.py wants to hear."""

    def about_to_run(self, target: str, setup: int, data: bytes) -> None: ...
    def failed(self, failure: Any, seed: int) -> None: ...
    def progress(self, inputs: int, kept: int) -> None: ...
    def final(self, inputs: int, kept: int) -> None: ...
    def stderr_grew(self) -> str: ...


def guided(asked: argparse.Namespace, told: Told) -> int:
    """Run until the time is over, and leave the process. The first two bytes of an input name its target and setup."""
    targets = asked.target or list(TARGETS)
    until = time.monotonic() + asked.minutes * 60
    found: set[str] = set()
    inputs = 0
    programs = {target: seeds(target) for target in targets}

    def one(data: bytes) -> None:
        nonlocal inputs
        if len(data) < 2:
            return
        target, setup, rest = targets[data[0] % len(targets)], data[1] % len(SETUPS), data[2:]
        inputs += 1
        told.about_to_run(target, setup, rest)
        told.progress(inputs, 0)
        result = told_of(target, rest, setup, asked.seconds)
        if isinstance(result, Failure) and result.kind not in found:
            found.add(result.kind)
            kind = result.kind

            def fails(data: bytes) -> bool:
                again = told_of(target, data, setup, asked.seconds)
                return isinstance(again, Failure) and again.kind == kind

            told.failed(result._replace(data=smallest(rest, fails)), asked.seed)
        if time.monotonic() > until:
            told.final(inputs, 0)
            os._exit(0)  # libFuzzer has no way back

    def mutate(data: bytes, most: int, seed: int) -> bytes:
        random = Random(seed)  # noqa: S311
        number = random.randrange(len(targets))
        new = drawn(targets[number], random)
        if new is not None:
            return bytes([number, new[1]]) + new[0][: most - 2]
        if len(data) < 2:
            rest = random.choice(programs[targets[number]] or [b"G1"])
            return bytes([number, random.randrange(256)]) + rest[: most - 2]
        own = programs[targets[data[0] % len(targets)]]
        if random.random() < 0.3:
            return bytes(atheris.Mutate(data, most))
        return data[:2] + mutated(data[2:], random, own)[: most - 2]

    # The bounds are those of told_of and of the process, not libFuzzer's own.
    arguments = [
        sys.argv[0],
        "-rss_limit_mb=0",
        "-timeout=3600",
        "-max_len=40000",
        "-verbosity=0",
        f"-seed={asked.seed}",
    ]
    atheris.Setup(arguments, one, custom_mutator=mutate)
    atheris.Fuzz()
    return 0
