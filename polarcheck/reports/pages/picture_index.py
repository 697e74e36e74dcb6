"""The page that leads to those of many programs: a name for each, and a table of all."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.pictures.library import FILE_NAME
from polarcheck.reading.excerpt import visible
from polarcheck.reports import SEVERITIES, counted
from polarcheck.reports.text import verdict

if TYPE_CHECKING:
    from polarcheck.finding import FileReport

#: The page itself.
INDEX = "index.html"
#: Of the name of a program [characters].
_LENGTH = 100
#: Names of devices on Windows, whatever their ending.
_DEVICE = re.compile(r"(?i)(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)")
_HEADS = ("Program", "Verdict", "Findings", "Polar sections")
_STYLE = (
    "body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em}"
    "table{border-collapse:collapse;width:100%}th,td{border-bottom:1px solid #bbb;padding:.3em .6em;text-align:left}"
    "tr{break-inside:avoid}.fail{font-weight:bold}.unverified{font-style:italic}"
)


class Entry(NamedTuple):
    """A program in the table: its page, its path, the kind of its verdict and the verdict as it is told, and counts."""

    page: str
    path: str
    kind: str
    verdict: str
    findings: str
    sections: int


def entry(file: FileReport, page: str) -> Entry:
    """What the table says of a file."""
    severities = [found.severity for found in file.findings]
    told = [counted(severities.count(one), one) for one in SEVERITIES if one in severities]
    return Entry(page, file.path, file.verdict, verdict(file), ", ".join(told) or "none", file.sections)


def page_names(paths: Iterable[str]) -> list[str]:
    """
    A name for the page of each path: safe on any file system, and no two the same in any case.

    The page of a.nc is a.nc.html; of a second program of this name a.nc-2.html.
    """
    names: list[str] = []
    taken = {INDEX, FILE_NAME}
    for path in paths:
        plain = re.sub(r"[^A-Za-z0-9._-]", "_", path.replace("\\", "/").rpartition("/")[2])[:_LENGTH]
        if not plain or plain[0] in ".-" or _DEVICE.match(plain):
            plain = f"_{plain}"
        number, name = 1, f"{plain}.html"
        while name.lower() in taken:
            number += 1
            name = f"{plain}-{number}.html"
        taken.add(name.lower())
        names.append(name)
    return names


def index(entries: Sequence[Entry]) -> str:
    """The page, in the order of the programs; readable without scripts, which it has none of."""
    heads = "".join(f'<th scope="col">{head}</th>' for head in _HEADS)
    rows = "\n".join(map(_row, entries))
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>polarcheck: {counted(len(entries), 'program')}</title>\n<style>{_STYLE}</style>\n</head>\n"
        f"<body>\n<h1>{counted(len(entries), 'program')}</h1>\n<table>\n<thead><tr>{heads}</tr></thead>\n"
        f"<tbody>\n{rows}\n</tbody>\n</table>\n</body>\n</html>\n"
    )


def _row(one: Entry) -> str:
    return (
        f'<tr><td><a href="{one.page}">{escape(visible(one.path))}</a></td>'
        f'<td class="{escape(one.kind)}">{escape(one.verdict)}</td><td>{one.findings}</td><td>{one.sections}</td></tr>'
    )
