"""
The table in docs/convert.md: what `convert` writes of a polar section for each control, by its profile.

The rest of that page is written by hand.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from generators.tables import row, rule_under
from polarcheck.program.machines import profiles
from polarcheck.rewrite.writing.pen import Pen

BEGIN, END = "<!-- sections: begin -->", "<!-- sections: end -->"
PAGE = Path(__file__).parent.parent / "convert.md"


def page() -> str:
    """Return the page with the table as the profiles have it."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    return "\n".join([before + BEGIN, "", *_table(), "", END + rest.partition(END)[2]])


def _table() -> Iterator[str]:
    yield from rule_under("control", "on", "off", "words", "arcs", "at most", "rapid traverse", "Z in arcs")
    for name in profiles.names():
        machine = profiles.load(name).machine
        writing, arcs, polar = machine.writing, machine.arcs, machine.polar
        radius = writing.arc_radius if "radius" in writing.arcs_by else ""
        centers = " ".join(polar.center_words["X"]) if "center" in writing.arcs_by else ""
        x = "diameter" if Pen(machine).factors[0] == 2 else "radius"
        split = min(writing.arc_split, arcs.sweep_limit)
        yield row(
            name,
            _blocks((*writing.before, writing.switch, *writing.behind)),
            _blocks((writing.end, *writing.behind_end)),
            f"X ({x}), {polar.virtual_axis}",
            ", ".join(filter(None, (centers, radius))),
            f"{'' if arcs.takes_sweep_limit else 'below '}{split:g} deg",
            "G0" if writing.rapid_in_mode else f"F{writing.rapid_feed:g}",
            "yes" if writing.helices else "no",
        )


def _blocks(blocks: Sequence[str]) -> str:
    return ", ".join(f"`{block}`" for block in blocks)
