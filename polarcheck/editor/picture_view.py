"""What an extension of an editor shows beside the text: the page with the picture of a program, and its verdict."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import msgspec
from pygls.exceptions import JsonRpcException, JsonRpcInvalidParams

from polarcheck.editor.analysis import Analysis
from polarcheck.foundation.errors import PolarcheckError, StoppedError
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.reading import files
from polarcheck.program.reading.excerpt import visible

#: The verdict of a program that could not be checked.
_NOT_CHECKED = "not checked"
#: The most characters of an address or of sources of scripts.
_LONGEST = 4096
#: Sources of scripts, as a policy lists them: no sign that ends the list or the attribute.
_SOURCES = re.compile(r"[\w:/.*'+%@\[\] -]*+")


class RequestFailed(JsonRpcException):
    """A valid request that cannot be answered, with the reason for the user."""

    CODE = -32803
    MESSAGE = "Request failed"


class Changed(JsonRpcException):
    """The text has changed while the answer was computed: the editor asks again after the next verdict."""

    CODE = -32801
    MESSAGE = "Content modified"


def member(value: Any, name: str) -> Any:
    """Return a member of what an editor has sent, as a dictionary or as an object; None if there is none."""
    return value.get(name) if isinstance(value, dict) else getattr(value, name, None)


def text_of(params: Any, name: str, default: str | None = None) -> str:
    """
    Return a text among the parameters of a request.

    Raises JsonRpcInvalidParams if it is missing (without a default), too long, or no text.
    """
    value = member(params, name)
    value = default if value is None else value
    if not isinstance(value, str) or len(value) > _LONGEST:
        raise JsonRpcInvalidParams(f"{name} must be a text of at most {_LONGEST} characters")
    return value


def library() -> str:
    """Return the path of plotly's JavaScript, which pages load. Raises RequestFailed if it is not installed."""
    import importlib.util

    spec = importlib.util.find_spec("plotly")
    path = Path(spec.origin).parent / "package_data" / "plotly.min.js" if spec and spec.origin else None
    if path is None or not path.is_file():
        raise RequestFailed("pictures need plotly, of the extra [plot]: pip install plotly")
    return str(path)


def picture(
    analysis: Analysis, folders: Sequence[Path], is_stopped: Callable[[], bool], address: str = "", sources: str = ""
) -> str:
    """
    Return the page of a checked program.

    folders: those that are open in the editor; the page names the program from there.
    is_stopped: returns True once the text has changed; then Changed is raised.
    address: from where the page loads plotly; if empty, the page holds it.
    sources: the source of scripts that the policy of the page allows with an address.

    Raises RequestFailed if there is no page, with the reason; JsonRpcInvalidParams for sources that are none.
    """
    if not _SOURCES.fullmatch(sources):
        raise JsonRpcInvalidParams("sources must be sources of a content security policy")
    if analysis.report is None or analysis.settings is None:
        raise RequestFailed(visible(f"This program is not checked. {analysis.error}"))
    from polarcheck.reports import Background
    from polarcheck.view.program_page import program_page

    try:
        with time_limit(seconds_for(len(analysis.text.data), analysis.settings.job.run.max_seconds), is_stopped):
            named = msgspec.structs.replace(
                analysis.report, path=_title(analysis.path, folders), machine=visible(analysis.settings.machine_id)
            )
            background = Background(rules=_rules(), settings={named.path: analysis.settings})
            return program_page(named, analysis.runs, background, address, sources)
    except StoppedError:
        raise Changed("the text has changed") from None
    except PolarcheckError as error:
        raise RequestFailed(visible(str(error))) from None
    except MemoryError:
        raise RequestFailed("there is not enough memory to draw this program") from None


def _title(path: Path, folders: Sequence[Path]) -> str:
    """Return the path of a program as the editor shows it: from the folder that is open."""
    inside = [folder for folder in folders if path.is_relative_to(folder) and folder != path.parent]
    return files.display_path(str(path.relative_to(inside[0])) if inside else path.name)


@functools.cache
def _rules() -> Any:
    from polarcheck.rules.rule import load_all

    return load_all()


def verdict(analysis: Analysis, uri: str, version: int | None) -> dict[str, Any]:
    """
    Return the verdict of a document, for a status bar.

    uri, version: of the document.
    verdict: pass, fail, unverified or not checked.
    errors, warnings, notes: the numbers of findings.
    sections: the number of polar sections.
    machine: the title of the machine, and its name in parentheses.
    reasons: why it is not verified or not checked, in a line each.
    """
    if analysis.report is None:
        counts, state, machine, sections = {}, _NOT_CHECKED, "", 0
        reasons = [analysis.error]
    else:
        report = analysis.report
        severities = [finding.severity for finding in report.findings]
        counts = {severity: severities.count(severity) for severity in ("error", "warning", "note")}
        state, sections = report.verdict, report.sections
        settings = analysis.settings
        machine = f"{settings.machine.title} ({settings.machine_id})" if settings is not None else ""
        reasons = list(dict.fromkeys(gap.reason for gap in report.not_evaluated if gap.matters))
    return {
        "uri": uri,
        "version": version,
        "verdict": state,
        **{f"{severity}s": counts.get(severity, 0) for severity in ("error", "warning", "note")},
        "sections": sections,
        "machine": visible(machine),
        "reasons": [visible(reason) for reason in reasons],
    }
