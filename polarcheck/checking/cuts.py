"""How deep and how fast the blocks of a finding cut: with that a fault grows whose rule is `gouges`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.checking.called_files import in_the_file
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats
from polarcheck.foundation.finding import FASTEST, FASTEST_PER_REVOLUTION, LOWEST_Z, Outline
from polarcheck.foundation.states import Motion
from polarcheck.rules import places
from polarcheck.rules.rule import load_all

if TYPE_CHECKING:
    from polarcheck.checking.engine import Listed
    from polarcheck.rules.tables import Tables


def _depth(trace: Trace) -> Floats:
    """Z behind each row, with its sign turned [mm]; NaN on the sub spindle, whose part may lie on either side."""
    return np.where(trace.modal.on_sub_spindle, np.nan, -trace.path.z)


def _feed(trace: Trace) -> Floats:
    """F in force in each row [mm/min]; NaN in rapid traverse."""
    return np.where(trace.axes.motion == Motion.RAPID, np.nan, trace.feedrate.feed)


def _feed_per_revolution(trace: Trace) -> Floats:
    """F in force in each row [mm/rev]; NaN in rapid traverse."""
    is_other = trace.feedrate.per_minute | (trace.axes.motion == Motion.RAPID)
    return np.where(is_other, np.nan, trace.feedrate.feed_number)


#: The column of each number, which is the worse the higher it is, and the sign that the number has.
_NUMBERS: Mapping[str, tuple[Callable[[Trace], Floats], int]] = {
    LOWEST_Z: (_depth, -1),
    FASTEST: (_feed, 1),
    FASTEST_PER_REVOLUTION: (_feed_per_revolution, 1),
}


def cuts(runs: Iterable[tuple[str, Tables]]) -> dict[str, dict[str, float]]:
    """
    Return the numbers of all findings of rules that are `gouges`, those that follow from others too, by Outline.key.

    A finding stands for several blocks, and a block runs several times: the worst of them counts.
    """
    rules = load_all()
    worst: dict[str, dict[str, float]] = {}
    for _, tables in runs:
        listed: dict[str, Listed] = tables.get("listed", {})
        for name in [name for name in listed if rules[name].gouges]:
            for key, numbers in _of_rule(listed[name], rules[name].over, tables):
                known = worst.setdefault(key, {})
                known.update({number: max(value, known.get(number, value)) for number, value in numbers.items()})
    return {key: {name: _NUMBERS[name][1] * value for name, value in numbers.items()} for key, numbers in worst.items()}


def _of_rule(listed: Listed, over: str, tables: Tables) -> Iterable[tuple[str, dict[str, float]]]:
    """Yield the keys of the findings of a rule in one run, and their highest numbers."""
    trace: Trace = tables["trace"]
    rows = places.rows(over, tables)[listed.index]
    numbers = {}
    for name, (column, _) in _NUMBERS.items():
        numbers[name] = np.full(len(listed.findings), np.nan)
        np.fmax.at(numbers[name], listed.finding, column(trace)[rows])
    for number, finding in enumerate(listed.findings):
        values = {name: float(column[number]) for name, column in numbers.items() if not np.isnan(column[number])}
        for shown in in_the_file([finding], trace, lambda answered, _: answered, tables.get("rows_in_calls")):
            yield Outline.key(shown), values
