"""
The tool data of a Siemens control as it archives them: `$TC_DP6[8,1]=4.0` is R of tool 8, edge 1.

Parameters of edges (Siemens, programming manual, job planning, 6FC5398-2BP40-0BA0 p. 391; 6FC5398-2BP10-1BA0 p. 8-2):
1 is the type, 2 the direction of the edge of a turning tool, 6 the radius, 15 its wear; a slotting saw has its diameter
there. `$TC_TP2[8]="MILL_8"` names a tool (writers of such files: public sources 60938428940, 59709065520).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from polarcheck.program.machines.offset_keys import key_of
from polarcheck.program.machines.offset_page import Entry, NotUnderstoodError

IS_TOOL_DATA = re.compile(r"\$TC_DP\d{1,2}\s*+\[")
#: A value that is set: its name, the tool, the edge, and what stands for it.
_SETTING = re.compile(
    r"\$TC_(?:DP(?P<edge_value>1|2|6|15)|(?P<name>TP2))\s*+\[\s*+(?P<tool>[^],;]{0,99}+)(?:,(?P<edge>[^];]{0,99}+))?\]\s*+=\s*+"
    r'(?P<value>"[^"\n]*+"|[^\s;]++)'
)
_REMARK = re.compile(r';[^\n\r]*+|"[^"\n\r]*+"')
_COUNT = re.compile(r"\d{1,8}")
_NUMBER = re.compile(r"[-+]?(?:\d{1,15}\.?\d{0,15}|\.\d{1,15})")
#: Types by their hundreds: mills, and tools for turning; and the slotting saw.
_MILL, _TURNING, _SAW = 1, 5, 700


def entries(text: str) -> Iterator[Entry]:
    """
    R and nose of the edges in capitals; a mill has the nose 0. Raises NotUnderstoodError for a value that is no number.
    """
    names: dict[str, str] = {}
    edges: dict[tuple[str, int], dict[int, tuple[int, float]]] = {}
    for line, match in _settings(text):
        tool = _count(line, match, "tool")
        if match["name"]:
            names[tool] = match["value"].strip('"')
            continue
        if _NUMBER.fullmatch(match["value"]) is None:
            raise _not_understood(line, match, "a number")
        edge = int(_count(line, match, "edge"))
        edges.setdefault((tool, edge), {})[int(match["edge_value"])] = line, float(match["value"])
    for (tool, edge), values in edges.items():
        offset = key_of(names.get(tool) or tool, edge)
        kind = int(values.get(1, (0, 0.0))[1])
        for parameter, (line, value) in values.items():
            if parameter in (6, 15) and kind != _SAW:
                yield Entry(line, offset, parameter == 6, "radius", value)
            elif parameter == 1 and kind // 100 == _MILL:
                yield Entry(line, offset, True, "nose", 0.0)
            elif parameter == 2 and kind // 100 == _TURNING:
                yield Entry(line, offset, True, "nose", value)


def _settings(text: str) -> Iterator[tuple[int, re.Match[str]]]:
    """The settings with the numbers of their lines; those in remarks left out."""
    ends = "\n" if "\n" in text else "\r"
    for line, written in enumerate(text.split(ends), 1):
        block = _REMARK.sub(lambda match: match[0] if match[0].startswith('"') else "", written)
        for match in _SETTING.finditer(block):
            yield line, match


def _count(line: int, match: re.Match[str], what: str) -> str:
    written = (match[what] or "").strip()
    if _COUNT.fullmatch(written) is None or not int(written):
        raise _not_understood(line, match, f"the number of the {what}")
    return str(int(written))


def _not_understood(line: int, match: re.Match[str], expected: str) -> NotUnderstoodError:
    return NotUnderstoodError(line, f"expected {expected}, such as $TC_DP6[8,1]=4.0, found {match[0][:40]}", True)
