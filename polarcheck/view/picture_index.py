"""The index page of the pages of many programs, and the names of those pages."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import UNREADABLE
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports.text import severities, verdict
from polarcheck.view.plotly_script import FILE_NAME

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport

#: The name of the index page.
INDEX = "index.html"
#: The longest part of a program's name in the name of its page [characters].
_LENGTH = 100
#: Names of devices on Windows, with any extension.
_DEVICE = re.compile(r"(?i)(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)")
_HEADS = ("Program", "Verdict", "Findings", "Polar sections")
_STYLE = (
    "body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em}"
    "table{border-collapse:collapse;width:100%}th,td{border-bottom:1px solid #bbb;padding:.3em .6em;text-align:left}"
    "tr{break-inside:avoid}.fail,.unreadable{font-weight:bold}.unverified{font-style:italic}"
)


class Entry(NamedTuple):
    """
    A program in the table.

    page: the name of its page; empty if it has none.
    path: the path of the program.
    kind: the verdict: pass, fail, unverified, unreadable.
    verdict: the verdict in words.
    findings: the numbers of findings, in words; of an unreadable file the reason.
    sections: the number of polar sections.
    """

    page: str
    path: str
    kind: str
    verdict: str
    findings: str
    sections: int


def entry(file: FileReport, page: str) -> Entry:
    """Return the entry of a file."""
    if file.verdict == UNREADABLE:
        return Entry(page, file.path, file.verdict, verdict(file), visible(file.reason or ""), 0)
    findings = severities(Counter(finding.severity for finding in file.findings)) if file.findings else "none"
    return Entry(page, file.path, file.verdict, verdict(file), findings, file.sections)


def page_names(paths: Iterable[str]) -> list[str]:
    """
    Return a name for the page of each path: valid on any file system, and unique even where case is ignored.

    The page of a.nc is a.nc.html, that of a second program of this name a.nc-2.html.
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


def index(entries: Sequence[Entry], notes: Iterable[str] = (), version: str = "") -> str:
    """
    Return the page, in the order of the programs.

    notes: lines behind the table.
    version: of a page that is served, as in `page`; else it has no scripts.
    """
    from polarcheck.view.page import CONNECTED, script_hash, script_of_served, served

    script = script_of_served() if version else ""
    policy = f"; script-src {script_hash(script)}{CONNECTED}" if version else ""
    heads = "".join(f'<th scope="col">{head}</th>' for head in _HEADS)
    rows = "\n".join(map(_row, entries))
    below = "".join(f"<p>{escape(visible(note))}</p>\n" for note in notes)
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'"
        f'{policy}">\n{served(version) if version else ""}'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>polarcheck: {counted(len(entries), 'program')}</title>\n<style>{_STYLE}</style>\n</head>\n"
        f"<body>\n<h1>{counted(len(entries), 'program')}</h1>\n<table>\n<thead><tr>{heads}</tr></thead>\n"
        f"<tbody>\n{rows}\n</tbody>\n</table>\n{below}"
        + (f"<script>{script}</script>\n" if script else "")
        + "</body>\n</html>\n"
    )


def _row(entry: Entry) -> str:
    name = escape(visible(entry.path))
    name = f'<a href="{entry.page}">{name}</a>' if entry.page else name
    return (
        f"<tr><td>{name}</td>"
        f'<td class="{escape(entry.kind)}">{escape(entry.verdict)}</td>'
        f"<td>{escape(entry.findings)}</td><td>{entry.sections}</td></tr>"
    )
