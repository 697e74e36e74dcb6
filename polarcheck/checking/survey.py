"""The job that the programs of a folder need: the machines that read them, and the offsets called."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.checking import check
from polarcheck.checking.written_for import written_for
from polarcheck.columns.trace import Trace
from polarcheck.foundation.errors import PolarcheckError
from polarcheck.foundation.states import Side, Units
from polarcheck.foundation.time_limit import time_limit
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.profiles import Profile
from polarcheck.program.reading import files
from polarcheck.rules.other_machine import reads_well
from polarcheck.rules.tables import Tables

#: A program that takes longer tells nothing [s].
_SECONDS = 5.0
#: With more programs than this no other machines would be found.
_TRIED = 12
_NUMBERED = re.compile(r"([GM])(\d+)(?:\.(\d))?")


class StatedOffset(msgspec.Struct, frozen=True):
    """An offset that a program needs: its R [mm] and the comment that gives it; None where none does."""

    path: str
    radius: float | None = None
    comment: str = ""


class Survey(msgspec.Struct, frozen=True):
    """
    The needs of some programs.

    programs: how many there are. polar: those that begin the polar mode. machine: the name of that which read them.
    fitting: the built-in machines that read all that were tried. offsets: by key, one entry per program that calls it.
    units: mm, inch, both or, where none says it, none.
    """

    programs: int
    polar: list[str]
    machine: str
    fitting: list[str]
    offsets: dict[str, list[StatedOffset]]
    units: list[str]


def survey(paths: Sequence[str], requested: Profile | None, awaited: Iterable[str] | None = None) -> Survey:
    """
    Read the programs of some paths; those that cannot be read are skipped.

    requested: the machine, if somebody knows it; else those that fit are looked for. awaited: the same paths, as they
    are gone through.
    """
    begins = _begins(requested)
    candidates = [requested] if requested else list(profiles.built_in())
    contents: list[tuple[str, bytes]] = []
    for path in paths if awaited is None else awaited:
        data = _data(path)
        if data is not None and begins.search(data.replace(b"\0", b"")):  # UTF-16, too
            contents.append((path, data))
    sample = [data for _, data in _sample(contents)]
    fitting = _fitting(sample, candidates) or ([] if requested else _recognized(sample))
    names = [profile.name for profile in fitting]
    chosen = _chosen(requested, fitting)
    offsets: dict[str, list[StatedOffset]] = {}
    units: set[str] = set()
    polar = []
    for path, data in contents:
        tables = _tables(data, chosen.machine)
        if tables is None or not len(tables["trace"].mode.sections):
            continue
        polar.append(path)
        trace: Trace = tables["trace"]
        for key, offset in _of_program(path, trace):
            offsets.setdefault(key, []).append(offset)
        units |= set(_units(trace))
    return Survey(len(paths), polar, chosen.name, names, offsets, sorted(units))


def _chosen(requested: Profile | None, fitting: Sequence[Profile]) -> Profile:
    if requested is not None:
        return requested
    default = profiles.load(profiles.DEFAULT)
    return default if not fitting or default.name in [profile.name for profile in fitting] else fitting[0]


def _data(path: str) -> bytes | None:
    try:
        return files.read_program(path)
    except PolarcheckError:
        return None


def _begins(requested: Profile | None) -> re.Pattern[bytes]:
    """A pattern of the codes that begin the polar mode, as they may be written: it skips most programs of a folder."""
    choices = [requested] if requested else profiles.built_in()
    codes = {word for profile in choices for word in (*profile.machine.polar.on, *profile.machine.control.native_words)}
    return re.compile(rb"(?i)" + b"|".join(sorted(_written(code) for code in codes)))


def _written(code: str) -> bytes:
    match = _NUMBERED.fullmatch(code)
    if match is None:
        return r"\s*".join(map(re.escape, code.split())).encode()  # G16XC is G16 XC
    point = rf"\s*\.\s*{match[3]}" if match[3] else r"(?:\.0*)?"
    return rf"{match[1]}\s*0*{match[2]}{point}(?!\d)".encode()


def _sample(contents: Sequence[tuple[str, bytes]]) -> Sequence[tuple[str, bytes]]:
    return contents[:: max(1, -(-len(contents) // _TRIED))]


def _tables(data: bytes, machine: Machine) -> Tables | None:
    try:
        with time_limit(_SECONDS):
            return check.read(data, machine, Job())[0][1]
    except (PolarcheckError, MemoryError):
        return None


def _fitting(programs: Sequence[bytes], candidates: Sequence[Profile]) -> list[Profile]:
    """The machines that read all of the programs well which any machine reads."""
    reading: list[set[str]] = []
    for data in programs:
        well = set()
        for profile in candidates:
            tables = _tables(data, profile.machine)
            if tables is not None and _reads(tables):
                well.add(profile.name)
        if well:
            reading.append(well)
    names = set.intersection(*reading) if reading else set()
    return [profile for profile in candidates if profile.name in names]


def _recognized(programs: Sequence[bytes]) -> list[Profile]:
    """The machines for which all programs are written whose control is recognized."""
    default = profiles.load(profiles.DEFAULT).machine
    read = [tables for data in programs if (tables := _tables(data, default)) is not None]
    recognized = [machines for tables in read if (machines := written_for(tables))]
    return [profile for profile in recognized[0] if all(profile in more for more in recognized)] if recognized else []


def _reads(tables: Tables) -> bool:
    try:
        with time_limit(_SECONDS):
            return bool(len(tables["trace"].mode.sections)) and reads_well(tables)
    except PolarcheckError:
        return False


def _of_program(path: str, trace: Trace) -> Iterator[tuple[str, StatedOffset]]:
    """The offsets that the program calls in the polar mode or with cutter compensation there."""
    needed = trace.mode.in_polar & (trace.compensation.side != Side.OFF)
    needed = needed if needed.any() else trace.mode.in_polar
    given = np.unique(trace.tools.offset_number[needed & (trace.offsets.radius_set_in < 0)])
    for number in given[given > 0].tolist():
        key, comment = trace.tools.offset_key(number), trace.offsets.radii_in_comments.get(number)
        if key:
            yield key, StatedOffset(path, comment.radius, comment.comment) if comment else StatedOffset(path)


def _units(trace: Trace) -> Iterator[str]:
    """The units that the program itself says."""
    state = trace.modal.state("units")
    yield from (
        name for name, unit in (("inch", Units.INCH), ("mm", Units.MM)) if np.any(state[trace.mode.in_polar] == unit)
    )
