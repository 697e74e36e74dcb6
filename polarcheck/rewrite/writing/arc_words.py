"""The words of arcs for a machine: I and J or a radius, and into how many parts it takes an arc."""

from __future__ import annotations

import math

from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.style import Style
from polarcheck.rewrite.writing.written_arcs import Arc, nearest_center, nearest_radius
from polarcheck.rewrite.writing.written_numbers import Numbers


class ArcWords:
    """Writes the words of arcs beside their end points. numbers: writes numbers for the machine."""

    def __init__(self, machine: Machine, style: Style, numbers: Numbers) -> None:
        self.machine, self.style, self.numbers = machine, style, numbers

    def parts(self, arc: Arc) -> int:
        """Into how many parts an arc is written."""
        arcs, writing = self.machine.arcs, self.machine.writing
        limit = math.radians(min(writing.arc_split, arcs.sweep_limit))
        if "center" not in writing.arcs_by:
            limit = min(limit, math.pi)
        count = math.ceil(abs(arc.sweep) / limit - 1e-9)
        is_at_limit = abs(arc.sweep) / count > math.radians(arcs.sweep_limit) - 0.01
        return count + (is_at_limit and not arcs.takes_sweep_limit)

    def written(self, arc: Arc, start: complex, end: complex) -> list[str] | None:
        """
        I and J, or the radius; None where the arc that they make is off by more than the least increment.

        start, end: the points of the words before and beside them [mm].
        """
        numbers, step = self.numbers, self.numbers.step
        for form in self._forms(arc):
            if form == "radius":
                radius, deviation = nearest_radius(arc, start, end, step)
                if deviation <= step:
                    return [numbers.word(self.machine.writing.arc_radius, radius)]
            else:
                i, j, deviation = nearest_center(arc, start, end, step)
                if deviation <= step:
                    addresses = self.machine.polar.center_words[self.machine.polar.linear_address]
                    return [a + numbers.of_increments(n) for a, n in zip(addresses, (i, j), strict=True)]
        return None

    def _forms(self, arc: Arc) -> list[str]:
        """What may be written, the first choice first; a radius only for arcs of which it is certain."""
        forms: list[str] = list(self.machine.writing.arcs_by)
        preferred = {True: "center", False: "radius", None: ""}[self.style.by_center]
        forms.sort(key=lambda form: form != preferred)
        limit = math.pi if self.machine.arcs.takes_sweep_limit else math.pi - 0.01
        return [form for form in forms if form == "center" or abs(arc.sweep) <= limit + 1e-9]
