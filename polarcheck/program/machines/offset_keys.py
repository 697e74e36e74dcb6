"""
The keys of tool offsets in a job: `8` for offset 8 or edge 1 of tool 8, `8/2` for its edge 2, `MILL_8`, `MILL_8/2`.

One offset has one key, however it is written: capitals, no leading zeros, and edge 1 left out.
"""

from __future__ import annotations

import re
from typing import Annotated, Final, TypeAlias

import msgspec

from polarcheck.program.machines.value_types import EXPECTED

_NUMBER: Final = r"0*[1-9][0-9]{0,7}(?:/0*[1-9][0-9]{0,4})?"
# What looks like a number, or like T8, is a slip, and no name.
_NAME: Final = r"(?![-+.0-9]+(?:/[0-9]*)?$)(?![Tt][0-9]+$)[^\x00-\x1f\x7f\"]+"

#: As a job file has it.
OffsetKey: TypeAlias = Annotated[
    str,
    msgspec.Meta(
        pattern=f"^(?:{_NUMBER}|{_NAME})$(?!\\n)",
        description="offset number (T0808: 8), or tool and edge: 8/1, MILL_8/1; edge 1 may be left out",
        extra={EXPECTED: "the number of a tool offset, 8 for T0808"},
    ),
]

_EDGE: Final = re.compile(r"/0*([1-9][0-9]{0,4})\Z")


def canonical(written: str) -> str:
    """The key of an offset as it is written in a job: `mill_8/1` is MILL_8."""
    edge = _EDGE.search(written)
    tool = written[: edge.start()] if edge else written
    return key_of(tool.lstrip("0") if tool.isdecimal() else tool.upper(), int(edge[1]) if edge else 1)


def key_of(tool: str, edge: int) -> str:
    """The key of an edge of a tool, which is told by number or name."""
    return tool if edge == 1 and not _EDGE.search(tool) else f"{tool}/{edge}"


def is_plain_number(key: str) -> bool:
    """Return True for a plain offset number, which names no tool and no edge."""
    return key.isdecimal()
