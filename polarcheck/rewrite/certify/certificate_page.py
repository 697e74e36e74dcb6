"""The certificate as one page of HTML that loads nothing and runs no script."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

from polarcheck.program.reading.excerpt import visible
from polarcheck.rewrite.certify.certificate_text import summary, words
from polarcheck.rewrite.certify.results import CaseResult, Cell, Certificate, PathComparison

_POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
_STYLE = (
    "body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:80em;padding:0 1em;color:#1a1a1a}"
    "table{border-collapse:collapse;margin:1em 0}th,td{border:1px solid #bbb;padding:.3em .7em;text-align:left;"
    "vertical-align:top}tr{break-inside:avoid}.pass{background:#e4f3e8}.fail{background:#f8e0db;font-weight:bold}"
    ".no-golden-trace,.missing{background:#fdf3d7}.not-run{background:#f8e0db;font-style:italic}.not-offered{color:#555}"
    "ul{margin:0;padding-left:1.2em;font-weight:normal}"
)
_HEADS = ("Case", "Program", "Machine", "Expected", "Verdict", "State", "Paths", "Reasons")


def html(certificate: Certificate) -> str:
    """Return the page."""
    title = _text(certificate.title or certificate.manifest)
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n<link rel="icon" href="data:,">\n'
        f"<title>{title}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
        f"<p>{_text(summary(certificate))}; {_text(certificate.manifest)}, "
        f"{_text(certificate.tool.name)} {_text(certificate.tool.version)}</p>\n"
        f"{_matrix(certificate)}\n<h2>Cases</h2>\n{_cases(certificate)}\n</body>\n</html>\n"
    )


def _text(text: str) -> str:
    """Escape text from any source for HTML."""
    return escape(visible(text))


def _matrix(certificate: Certificate) -> str:
    heads = "".join(f'<th scope="col">{_text(control)}</th>' for control in certificate.controls)
    rows = "".join(
        f'<tr><th scope="row">{_text(feature)}</th>'
        + "".join(_cell(cell, certificate) for cell in certificate.cells if cell.feature == feature)
        + "</tr>\n"
        for feature in certificate.features
    )
    return f"<table>\n<thead><tr><td></td>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>"


def _cell(cell: Cell, certificate: Certificate) -> str:
    reason = f": {_text(cell.reason)}" if cell.reason else ""
    return f'<td class="{_class(cell.state)}">{_text(words(cell, certificate))}{reason}</td>'


def _class(state: str) -> str:
    return state.replace(" ", "-")


def _cases(certificate: Certificate) -> str:
    heads = "".join(f'<th scope="col">{head}</th>' for head in _HEADS)
    rows = "\n".join(_case(case) for case in certificate.cases)
    return f"<table>\n<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n</table>"


def _case(case: CaseResult) -> str:
    expected = [case.name, case.program, case.machine, case.expected, case.verdict or ""]
    columns = "".join(f"<td>{_text(column)}</td>" for column in expected)
    return (
        f'<tr>{columns}<td class="{_class(case.state)}">{_text(case.state)}</td>'
        f"<td>{_list(_compared(case))}</td><td>{_list(iter([*case.reasons, *case.remarks]))}</td></tr>"
    )


def _compared(case: CaseResult) -> Iterator[str]:
    for comparison in (case.golden, case.same_path):
        if comparison is not None:
            yield f"{comparison.reference}: {_deviation(comparison)}"


def _deviation(comparison: PathComparison) -> str:
    if comparison.deviation is None:
        return "not compared"
    return f"{comparison.deviation:.3f} mm (tolerance {comparison.tolerance:g})"


def _list(lines: Iterator[str]) -> str:
    entries = "".join(f"<li>{_text(line)}</li>" for line in lines)
    return f"<ul>{entries}</ul>" if entries else ""
