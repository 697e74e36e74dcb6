"""
The page of pictures: HTML with all findings in words and tables, and with pictures if the browser runs scripts.

It loads nothing from the network. Text from a program is never markup: Python escapes what it writes, and scripts write
it as the text of an element.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from importlib import resources
from string import Template
from typing import Any

import msgspec

from polarcheck.foundation.finding import SEVERITIES, radius_origin
from polarcheck.program.reading.excerpt import visible
from polarcheck.view.packing import data_element
from polarcheck.view.picture_data import FindingPicture, Mark, Picture, SectionPicture

#: The scripts; each may use those before it.
_SCRIPTS = (
    "words",
    "data",
    "state",
    "theme",
    "colors",
    "plane",
    "face",
    "rates",
    "moves",
    "legend",
    "pins",
    "section",
    "workbench",
    "timeline",
    "metal",
    "chuck",
    "machine",
    "canvas",
    "gauges",
    "controls",
    "player",
    "findings",
    "positions",
    "shapes",
    "distances",
    "zoom",
    "source",
    "measuring",
    "nominal",
    "sides",
    "links",
    "tools",
    "keys",
    "choosing",
    "printing",
    "memory",
    "serving",
    "embedded",
    "start",
)
_STYLES = ("page", "player", "tools")
#: Only the scripts of this page run, and only a library beside it is loaded. plotly sets styles.
_POLICY = (
    "default-src 'none'; script-src {}; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
    "form-action 'none'"
)
#: What a page that is served may do beside: hear from its server of the next version.
CONNECTED = "; connect-src 'self'"
_NO_SCRIPTS = "The pictures need a browser that runs scripts; all findings are in the table."


def page(
    pictures: Sequence[Picture],
    library: str = "",
    script_path: str = "",
    notes: Iterable[str] = (),
    sources: str = "'self' file:",
    version: str = "",
) -> str:
    """
    Return the page of one program, or of several one below the other.

    library: plotly's JavaScript, to be included in the page.
    script_path: without `library`, the name of the file with it in the folder of the page.
    notes: what the page says behind the programs, in a line each.
    sources: without `library`, the sources from which the policy of the page allows to load it.
    version: of a page that is served; it is loaded anew as soon as the server has another version.
    """
    scripts = "\n".join(_part(f"{name}.js") for name in _SCRIPTS)
    script = f'\n(() => {{\n"use strict";\n{scripts}}})();\n'
    included = library.replace("</script", "<\\/script")
    allowed = [script_hash(script), script_hash(included) if included else sources]
    loaded = f"<script>{included}</script>" if included else ""
    if script_path and not included:
        loaded = f'<script src="{_text(script_path)}"></script>'
    return Template(_part("page.html")).substitute(
        policy=_POLICY.format(" ".join(allowed)) + (CONNECTED if version else ""),
        served=served(version) if version else "",
        title=_text(", ".join(picture.path for picture in pictures)),
        style=_style(),
        body="\n".join([*(_program(number, picture) for number, picture in enumerate(pictures)), *map(_note, notes)]),
        data=_data(pictures),
        library=loaded,
        script=script,
    )


def served(version: str) -> str:
    """Return the element that holds the version of a page that is served."""
    return f'<meta name="polarcheck-version" content="{_text(version)}">\n'


def script_of_served() -> str:
    """Return the script for a page that has no other one and is served."""
    return f'\n(() => {{\n"use strict";\n{_part("serving.js")}\nserved(() => null, () => {{}});\n}})();\n'


def _part(name: str) -> str:
    return resources.files("polarcheck.view").joinpath("browser", name).read_text("utf-8")


def _style() -> str:
    """Return the style; its dark colors count where the system is dark, and where the switch of the page says so."""
    dark = _part("dark.css")
    return (
        "\n".join(_part(f"{name}.css") for name in _STYLES)
        + f'\n@media screen and (prefers-color-scheme: dark) {{ :root:not([data-theme="light"]) {{ {dark} }} }}\n'
        + f'@media screen {{ :root[data-theme="dark"] {{ {dark} }} }}'
    )


def script_hash(script: str) -> str:
    """Return the hash by which the policy of a page allows one script."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"


# ---- data for the scripts ----


def _data(pictures: Sequence[Picture]) -> str:
    """Return the element with the data of the pictures, without what the page says in words already."""
    names = ("findings", "sections", "source", "source_line", "source_lines")
    drawn = [
        {
            **{name: _without_markup(getattr(picture, name)) for name in names},
            "order": (order := _order(picture.findings)),
            "numbers": _numbers(order),
        }
        for picture in pictures
    ]
    return data_element(drawn)


def _without_markup(value: Any) -> Any:
    """Make all texts in a value printable; columns of numbers stay as they are."""
    if isinstance(value, str):
        return visible(value)
    if isinstance(value, msgspec.Struct):
        return {name: _without_markup(getattr(value, name)) for name in value.__struct_fields__}
    if isinstance(value, list) and value and isinstance(value[0], str | msgspec.Struct):
        return [_without_markup(element) for element in value]
    return value


# ---- the page without scripts ----


def _text(text: str) -> str:
    """Escape text from any source for HTML."""
    return escape(visible(text.replace("\t", " ")))


def _note(text: str) -> str:
    return f'<p class="none">{_text(text)}</p>'


def _program(number: int, picture: Picture) -> str:
    sections = "\n".join(_section(number, index, section) for index, section in enumerate(picture.sections))
    lacking = "".join(f"<li>{_text(reason)}</li>" for reason in picture.not_evaluated)
    return Template(_part("program.html")).substitute(
        picture=number,
        path=_text(picture.path),
        state=_text(picture.verdict.split()[0] if picture.verdict else ""),
        verdict=_text(picture.verdict),
        summary=_text(picture.summary),
        no_scripts=_NO_SCRIPTS,
        shape="" if picture.sections else " is-plain",
        sections=sections,
        absent="".join(f'<p class="missing">{_text(text)}</p>' for label, text in picture.head if label == "not drawn"),
        findings=_findings(number, picture.findings),
        lacking=f'<h2>Not evaluated</h2>\n<ul class="lacking">{lacking}</ul>' if lacking else "",
        head=_pairs(picture.head),
    )


def _order(findings: Sequence[FindingPicture]) -> list[int]:
    """Return the places of the findings as they are listed: the worst first, silenced ones last."""
    return sorted(
        range(len(findings)),
        key=lambda index: (bool(findings[index].silenced), -SEVERITIES.get(findings[index].severity, -1), index),
    )


def _numbers(order: Sequence[int]) -> list[int]:
    """Return the number of each finding in the list, from 1."""
    return [index + 1 for index in sorted(range(len(order)), key=order.__getitem__)]


def _pairs(pairs: Iterable[tuple[str, str]]) -> str:
    return "".join(f"<dt>{_text(label)}</dt><dd>{_text(text)}</dd>" for label, text in pairs)


def _findings(number: int, findings: Sequence[FindingPicture]) -> str:
    if not findings:
        return '<p class="none">No findings.</p>\n'
    order = _order(findings)
    rows = "\n".join(_finding(number, index, count, findings[index]) for count, index in enumerate(order, 1))
    heads = "".join(f'<th scope="col">{head}</th>' for head in ("No.", "Line", "Severity", "What is wrong", "Rule"))
    return (
        f'<h2>All findings</h2>\n<table class="findings">\n<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n'
        "</table>\n"
    )


def _finding(number: int, index: int, count: int, finding: FindingPicture) -> str:
    severity = f"{finding.severity}, silenced ({finding.silenced})" if finding.silenced else finding.severity
    more = [("Why", finding.why), ("Fix", finding.fix)]
    notes = "".join(f'<p class="more"><span>{label}</span> {_text(text)}</p>' for label, text in more if text)
    alarm = f'<p class="more">alarm {_text(finding.alarm)}</p>' if finding.alarm else ""
    state = " silenced" if finding.silenced else ""
    return (
        f'<tr class="{_text(finding.severity)}{state}" data-picture="{number}" data-finding="{index}">'
        f'<td class="line">{count}</td><td class="line">{finding.line}</td><td class="severity">{_text(severity)}</td>'
        f"<td><p>{_text(finding.message)}</p><code>{_text(finding.block)}</code>{notes}</td>"
        f"<td>{_text(finding.rule)}{alarm}</td></tr>"
    )


def _section(number: int, index: int, section: SectionPicture) -> str:
    return Template(_part("section.html")).substitute(
        picture=number,
        section=index,
        title=_text(section.title),
        missing=f'<p class="missing">{_text(section.needs_radius)}</p>' if section.needs_radius else "",
        facts=_pairs(_facts(section)),
        notes=_notes(number, section),
    )


def _facts(section: SectionPicture) -> Iterator[tuple[str, str]]:
    """Yield label and text of each value that the pictures of a section depend on."""
    if section.channel:
        yield "channel", section.channel
    yield "units", f"{section.units}, X as a {'diameter' if section.diameter else 'radius'}"
    if section.radius is not None:
        yield "cutter", f"R {_length(section.radius, section)} ({radius_origin(section.radius_source)})"
    if section.stock is not None:
        yield "stock", f"{_length(section.stock, section)} across"
    if section.keep_out is not None:
        yield "keep-out", f"{_length(section.keep_out, section)} round the center"
    limits = [
        f"{axis} {value / scale:.0f} {unit}/min"
        for axis, value, scale, unit in (
            ("C", section.c_limit, 1.0, "deg"),
            ("X", section.x_limit, section.scale, section.units),
            ("F", section.feed_limit, section.scale, section.units),
        )
        if value is not None
    ]
    yield "limits", ", ".join(limits) or "none given"
    if section.time is not None:
        yield "time", f"{section.time:.1f} s"
    if section.thinned > 0:
        yield "drawn", f"within {_length(section.thinned, section)} of the path"
    if section.played > section.thinned:
        yield "played", f"within {_length(section.played, section)} of the path"


def _length(value: float, section: SectionPicture) -> str:
    """Return a length [mm] in the units of the program."""
    return f"{value / section.scale:.{4 if section.units == 'inch' else 3}f} {section.units}"


def _notes(number: int, section: SectionPicture) -> str:
    """Return HTML: what the section makes, and what it overcuts or leaves standing."""
    notes = ""
    shapes = section.makes or [part.text for part in section.parts]
    if shapes:
        notes += f'<ul class="parts">{"".join(f"<li>{_text(text)}</li>" for text in shapes)}</ul>\n'
    notes += "".join(f'<p class="remark">{_text(remark)}</p>\n' for remark in section.remarks)
    if section.marks:
        rows = "".join(_mark(number, index, mark, section) for index, mark in enumerate(section.marks))
        heads = "".join(f'<th scope="col">{head}</th>' for head in ("Mark", "Lines", "Where", "By how much"))
        notes += f'<div class="marks"><table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table></div>\n'
    return notes


def _letter(index: int) -> str:
    """Return the letter of a mark, as on the drawing: A to Z, then A1."""
    return chr(ord("A") + index % 26) + (str(index // 26) if index >= 26 else "")


def _mark(number: int, index: int, mark: Mark, section: SectionPicture) -> str:
    x, c = mark.place[0] * (2 if section.diameter else 1) / section.scale, mark.place[1] / section.scale
    digits = 4 if section.units == "inch" else 3
    return (
        f'<tr data-picture="{number}" data-mark="{index}"><td>{_letter(index)}</td>'
        f'<td class="line">{", ".join(map(str, mark.lines))}</td><td>X{x:.{digits}f} C{c:.{digits}f}</td>'
        f"<td>{_text(mark.text)}</td></tr>"
    )
