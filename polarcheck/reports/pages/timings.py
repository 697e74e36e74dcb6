"""Where the time of a check has gone, as a table: a row for each stage, and their sum."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from polarcheck.checking.timing import Spent

_HEADS = ("stage", "CPU s", "share", "blocks/s", "touched MB", "peak MB")
_GAP = "  "


def timings_table(spent: Mapping[str, Spent], files: int, blocks: int) -> str:
    """
    The table in lines: of each stage the time, how many blocks it does in a second, and the memory in MB.

    spent: by stage; their sum stands below them. files, blocks: of the whole check. A stage that has taken no time has
    no rate; memory is `-` where the system does not count it.
    """
    first, *others = spent.values()
    total = sum(others, first)
    rows = [_HEADS, *(_row(name, one, total, blocks) for name, one in (*spent.items(), ("total", total)))]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        _GAP.join(
            (row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)))
        )
        for row in rows
    ]
    return "\n".join((*lines, f"{files:,} file{'' if files == 1 else 's'}, {blocks:,} blocks, in one process", ""))


def _row(name: str, spent: Spent, total: Spent, blocks: int) -> tuple[str, ...]:
    share = spent.seconds / total.seconds if total.seconds else 0.0
    rate = f"{blocks / spent.seconds:,.0f}" if spent.seconds and blocks else "-"
    memory = (f"{size / 1e6:.1f}" if total.touched else "-" for size in (spent.touched, spent.peak))
    return name, f"{spent.seconds:.3f}", f"{share:.0%}", rate, *memory
