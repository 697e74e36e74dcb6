"""What a program orders beside its moves, by what its codes mean in the lists of its machine and not by their names."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from polarcheck.columns.feed.dwells import time_of_dwells
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, stretch
from polarcheck.foundation.states import Units
from polarcheck.program.machines.m_codes import SWITCHED
from polarcheck.rewrite.compare.orders import Step
from polarcheck.rules.wording.written import executed_word

#: Lists of G codes; what the others do is compared as paths, feeds and states.
_G_LISTS = (
    *("dwell", "work_offset", "work_offset_extended", "drilling_cycle", "drilling_cycle_off", "scaling", "scaling_off"),
    *("rotation", "rotation_off", "mirror_image", "mirror_image_off", "tool_length_offset", "tool_length_offset_off"),
    *("data_input", "reference_check", "reference_return", "machine_coordinates", "cylindrical_interpolation"),
    *("thread_cutting", "turning_cycle", "threading_cycle", "facing_cycle", "repetitive_cycle", "local_shift"),
    *("coordinate_setting", "coordinate_preset", "constant_surface_speed", "constant_surface_speed_off"),
)
#: Lists of codes that put the coordinates elsewhere; the no word of a block goes with those without words.
_SHIFTS = (
    *("work_offset", "work_offset_extended", "scaling", "scaling_off", "rotation", "rotation_off", "mirror_image"),
    *("mirror_image_off", "data_input", "local_shift", "coordinate_setting"),
)
_WITHOUT_WORDS = ("work_offset", "scaling_off", "rotation_off", "mirror_image_off")
#: Lists of M codes.
_M_LISTS = (*(name for pair in SWITCHED for name in pair), "spindle_orientation", "optional_stop", "program_end")
#: M5 stops whichever spindle runs, and M3 starts a live tool without codes of its own: which one turns where a section
#: begins is compared there.
_ANY_SPINDLE = {"live_tool_on": "spindle_on", "live_tool_off": "spindle_off"}


def shift_steps(trace: Trace) -> list[Step]:
    """Return the orders that put the coordinates elsewhere, each with its code and the words that go with it."""
    words, row = trace.run.words, trace.run.row
    result = []
    for step in meaning_steps(trace):
        (name,), text = step.tokens, step.text.partition(" ")[0]
        if name not in _SHIFTS:
            continue
        low, high = stretch(row, step.row, step.row + 1)
        beside = low + np.flatnonzero(~np.isin(words.address[low:high], np.frombuffer(b"GMNOSTF/", np.uint8)))
        if name not in _WITHOUT_WORDS:
            text += "".join(f" {executed_word(trace.run, index)}" for index in beside.tolist())
        if len(beside) or name != "coordinate_setting":
            result.append(Step(step.row, step.line, (text,), (), text))
    return result


def meaning_steps(trace: Trace) -> list[Step]:
    """Return the orders of a program by their lists, in the order in which they run; of a dwell its time [s]."""
    listed_words: set[tuple[int, str]] = set()
    machine = trace.machine
    listed = {name: machine.codes(name) for name in _G_LISTS}
    listed |= {name: list(getattr(machine.m_codes, name)) for name in _M_LISTS}
    for name, codes in listed.items():
        listed_words |= {(index, name) for index in trace.blocks.code_indices(*codes).tolist()} if codes else set()
    words, lines, times = trace.run.words, trace.blocks.line_in_file, time_of_dwells(trace)
    result = []
    for index, name in _of_one_meaning(trace, listed_words):
        row = int(trace.run.row[index])
        text = f"{chr(int(words.address[index]))}{float(words.value[index]):g} ({name.replace('_', ' ')})"
        values: tuple[float, ...] = ()
        if name == "dwell":
            values = (float(times[row]),)
            text = f"{text} of {times[row]:g} s"
        result.append(Step(row, int(lines[row]), (name,), values, text))
    return result


def is_speed(trace: Trace) -> Mask:
    """Return a mask of the executed words that name a spindle speed, whichever they are: S, SB=, or P beside M133."""
    machine, words = trace.machine, trace.run.words
    addresses = [machine.address_number(word) for word in ("S", *machine.control.spindle_words)]
    starts = trace.blocks.codes(*machine.m_codes.live_tool_on) & (machine.writing.live_tool_speed == "P")
    return np.asarray(np.isin(words.address, addresses) | ((words.address == ord("P")) & starts[trace.run.row]))


def speed_steps(trace: Trace) -> list[Step]:
    """Return the spindle speeds of a program in order."""
    words, names = trace.run.words, is_speed(trace)
    row = trace.run.row[names]
    in_ft = (trace.modal.state("speed")[row] != 0) & ~trace.blocks.listed("coordinate_setting")[row]
    in_ft &= trace.lengths.units[row] == Units.INCH
    speeds = (words.value[names] * np.where(in_ft, 0.3048, 1.0)).tolist()
    lines = trace.blocks.line_in_file[row].tolist()
    return [
        Step(index, line, ("speed",), (speed,), f"the spindle speed {speed:g}")
        for index, line, speed in zip(row.tolist(), lines, speeds, strict=True)
    ]


def names_speeds(trace: Trace) -> bool:
    """Return True if the words that name speeds on the machine of a program are read; S3= is not."""
    words = ("S", "P", *trace.machine.control.spindle_words)
    return trace.machine.writing.live_tool_speed.rstrip("=") in words


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
