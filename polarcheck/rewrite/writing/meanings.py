"""What a program orders beside its moves, by what its codes mean in the lists of its machine and not by their names."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence
from difflib import SequenceMatcher

import msgspec
import numpy as np

from polarcheck.columns.feed.dwells import time_of_dwells
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.states import Units
from polarcheck.program.machines.m_codes import SWITCHED
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at

#: Lists of G codes; what the others do is compared as paths, feeds and states.
_G_LISTS = (
    *("dwell", "work_offset", "work_offset_extended", "drilling_cycle", "drilling_cycle_off", "scaling", "scaling_off"),
    *("rotation", "rotation_off", "mirror_image", "mirror_image_off", "tool_length_offset", "tool_length_offset_off"),
    *("data_input", "reference_check", "reference_return", "machine_coordinates", "cylindrical_interpolation"),
    *("thread_cutting", "turning_cycle", "threading_cycle", "facing_cycle", "repetitive_cycle", "local_shift"),
    *("coordinate_setting", "coordinate_preset", "constant_surface_speed", "constant_surface_speed_off"),
)
#: Lists of M codes.
_M_LISTS = (*(name for pair in SWITCHED for name in pair), "spindle_orientation", "optional_stop", "program_end")
#: M5 stops whichever spindle runs, and M3 starts a live tool without codes of its own: which one turns where a section
#: begins is compared there.
_ANY_SPINDLE = {"live_tool_on": "spindle_on", "live_tool_off": "spindle_off"}
#: Dwells that differ by no more are the same [s]: a control counts thousandths.
_SAME_TIME = 1e-3
#: Speeds are whole numbers: those by G96 are rounded where the units are others.
_SAME_SPEED = 1.0
#: More differences than this are not listed.
_LISTED = 20
#: More orders than this, between those that are equal at both ends, are not paired.
_PAIRED = 2000


class Order(msgspec.Struct, frozen=True):
    """
    An order.

    row: of the trace. name: the list of the machine that its code stands in. code: as `M8`.
    """

    row: int
    name: str
    code: str


def lost_orders(old: Trace, new: Trace, decided: Collection[int]) -> Iterator[Refusal]:
    """
    Yield the orders of the old program that the new one does not have at their place in the order.

    decided: lines of the old file that are comments in the new one, for somebody to decide.
    """
    lines = old.blocks.line_in_file
    ordered = [order for order in orders(old) if int(lines[order.row]) not in decided]
    pairs, missing = _paired(ordered, list(orders(new)))
    for order in missing[:_LISTED]:
        yield Refusal(int(lines[order.row]), f"{order.code} ({order.name.replace('_', ' ')}) would be missing")
    if len(missing) > _LISTED:
        yield Refusal(0, f"and {len(missing) - _LISTED} other codes would be missing")
    yield from _dwells(old, new, pairs)


def other_speeds(old: Trace, new: Trace, left_out: Collection[int], origin: Sequence[int]) -> Iterator[Refusal]:
    """
    Yield the first spindle speed that differs, whichever words name it: S, SB=, or P beside M133.

    left_out: lines of the old file whose speeds do not count. origin: of each new line the line in the old file.
    """
    for machine in (old.machine, new.machine):
        if machine.writing.live_tool_speed.rstrip("=") not in ("S", "P", *machine.control.spindle_words):
            return  # S3= is not read there
    of_left_out = {number for number, line in enumerate(origin, 1) if line in left_out}
    speeds = _speeds(old, left_out), _speeds(new, of_left_out)
    for (line, speed), (new_line, new_speed) in itertools.zip_longest(*speeds, fillvalue=(0, 0.0)):
        is_same = abs(speed - new_speed) <= _SAME_SPEED
        if not is_same and not (np.isnan(speed) and np.isnan(new_speed)):
            where = f" (line {new_line} of the result)" if new_line else ""
            yield Refusal(line, f"the spindle speed {speed:g} would be {new_speed:g}{where}")
            return


def _speeds(trace: Trace, left_out: Collection[int]) -> list[tuple[int, float]]:
    """The speeds of a program in order, with their lines."""
    machine, words = trace.machine, trace.run.words
    addresses = [machine.address_number(word) for word in ("S", *machine.control.spindle_words)]
    is_speed = np.isin(words.address, addresses)
    if machine.writing.live_tool_speed == "P":
        starts = trace.blocks.codes(*machine.m_codes.live_tool_on)
        is_speed |= (words.address == ord("P")) & starts[trace.run.row]
    lines = trace.blocks.line_in_file[trace.run.row[is_speed]].tolist()
    row = trace.run.row[is_speed]
    in_ft = (trace.modal.state("speed")[row] != 0) & ~trace.blocks.listed("coordinate_setting")[row]
    in_ft &= trace.lengths.units[row] == Units.INCH
    pairs = zip(lines, (words.value[is_speed] * np.where(in_ft, 0.3048, 1.0)).tolist(), strict=True)
    return [(line, speed) for line, speed in pairs if line not in left_out]


def orders(trace: Trace) -> Iterator[Order]:
    """Yield the orders of a program in the order in which they run."""
    listed_words: set[tuple[int, str]] = set()
    machine = trace.machine
    listed = {name: machine.codes(name) for name in _G_LISTS}
    listed |= {name: list(getattr(machine.m_codes, name)) for name in _M_LISTS}
    for name, codes in listed.items():
        listed_words |= {(index, name) for index in trace.blocks.code_indices(*codes).tolist()} if codes else set()
    words = trace.run.words
    for index, name in _of_one_meaning(trace, listed_words):
        yield Order(int(trace.run.row[index]), name, f"{chr(int(words.address[index]))}{float(words.value[index]):g}")


def _of_one_meaning(trace: Trace, listed_words: Collection[tuple[int, str]]) -> list[tuple[int, str]]:
    """
    Words with their lists in order. A code that stops the live tool and does something else stops it if it runs.

    On the lathe of the builder's guide M35 engages the C axis and stops the live tool.
    """
    names: dict[int, list[str]] = {}
    for index, name in sorted(listed_words):
        names.setdefault(index, []).append(name)
    result = set()
    for index, listed in names.items():
        row = int(trace.run.row[index])
        runs = row > 0 and bool(trace.modal.live_tool[row - 1])
        if "scaling_off" in listed and "coordinate_setting" in listed:
            # G50 S2500 limits the speed, G50 alone ends scaling.
            has_words = _has_other_words(trace, row)
            listed = [name for name in listed if name != ("scaling_off" if has_words else "coordinate_setting")]
        if len(listed) > 1 and "live_tool_off" in listed:
            listed = ["live_tool_off"] if runs else [name for name in listed if name != "live_tool_off"]
        result |= {(index, _ANY_SPINDLE.get(name, name)) for name in listed}
    return sorted(result)


def _has_other_words(trace: Trace, row: int) -> bool:
    address = trace.run.words.address[slice(*stretch(trace.run.row, row, row + 1))]
    return bool((~np.isin(address, np.frombuffer(b"GMTNO/", np.uint8))).any())


def _paired(old: list[Order], new: list[Order]) -> tuple[list[tuple[Order, Order]], list[Order]]:
    """Orders that both have in the same order, and those of the old program that are left over."""
    names = [[order.name for order in orders] for orders in (old, new)]
    # Equal ends are cut off: what is left is short.
    head = next(
        (index for index, (old_name, new_name) in enumerate(zip(*names, strict=False)) if old_name != new_name),
        min(map(len, names)),
    )
    most = min(map(len, names)) - head
    backwards = zip(reversed(names[0]), reversed(names[1]), strict=False)
    tail = min(
        next((index for index, (old_name, new_name) in enumerate(backwards) if old_name != new_name), most), most
    )
    pairs = [*zip(old[:head], new[:head], strict=True)]
    removed, added = old[head : len(old) - tail], new[head : len(new) - tail]
    missing: list[Order] = []
    if max(len(removed), len(added)) > _PAIRED:
        missing = removed
    else:
        matcher = SequenceMatcher(None, names[0][head : len(old) - tail], names[1][head : len(new) - tail], False)
        for kind, low, high, new_low, new_high in matcher.get_opcodes():
            if kind == "equal":
                pairs += zip(removed[low:high], added[new_low:new_high], strict=True)
            else:
                missing += removed[low:high]
    pairs += zip(old[len(old) - tail :], new[len(new) - tail :], strict=True)
    return pairs, missing


def _dwells(old: Trace, new: Trace, pairs: list[tuple[Order, Order]]) -> Iterator[Refusal]:
    rows = [(first.row, second.row) for first, second in pairs if first.name == "dwell"]
    if not rows:
        return
    times = time_of_dwells(old), time_of_dwells(new)
    for first, second in rows:
        was, is_now = float(times[0][first]), float(times[1][second])
        if not (abs(was - is_now) <= _SAME_TIME or (np.isnan(was) and np.isnan(is_now))):
            yield refusal_at(old, first, f"the dwell of {was:g} s would be one of {is_now:g} s")
