"""The report for people at a shell: the block, what is wrong with it, why, and what to do."""

from __future__ import annotations

import re
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.reading.excerpt import excerpt, visible, without_commands
from polarcheck.reports import SEVERITIES, Background, Parts, counted, of_each, painted
from polarcheck.reports.pages.resting import resting

if TYPE_CHECKING:
    from polarcheck.checking.rule import Rule
    from polarcheck.finding import FileReport, Finding, Fix, NotEvaluated, Report

#: Line numbers and labels end at this column; the text beside them begins three further.
_GUTTER = 6
_NARROWEST = 60
#: Of more files than this, those that pass are counted, not listed, and what was not evaluated is told for all at once.
_LISTED = 10
#: Of more files than this it is not told what their verdicts rest on.
_RESTING = 3
#: Places that are listed where many files lack the same.
_PLACES = 3
_SENTENCE_END = re.compile(r"(?<!\be\.g\.)(?<!\bi\.e\.)(?<!\bp\.)(?<=[.?!])\s+(?=[A-Z0-9(])")


class _Page(NamedTuple):
    """How to write: the width in columns, and whether in color."""

    columns: int
    color: bool

    def paint(self, style: str, text: str) -> str:
        return painted(style, text) if self.color else text

    def heading(self, word: str, text: str) -> Iterator[str]:
        indent = len(word) + 2
        first, *more = _wrapped(visible(text), self.columns - indent)
        yield f"{self.paint(word, word)}: {self.paint('message', first)}"
        yield from (" " * indent + self.paint("message", line) for line in more)

    def labelled(self, label: str, text: str) -> Iterator[str]:
        indent = _GUTTER + 3
        first, *more = _wrapped(visible(text), self.columns - indent)
        yield f"{self.paint('aside', label.rjust(_GUTTER))}   {first}"
        yield from (" " * indent + line for line in more)

    def indented(self, text: str) -> Iterator[str]:
        for index, line in enumerate(_wrapped(visible(text), self.columns - _GUTTER - 2)):
            yield self.paint("aside", " " * (_GUTTER + 2 * (index > 0)) + line)


def text(report: Report, background: Background) -> str:
    """Findings with excerpts, then what was not evaluated, then the verdict of each file and one line over all."""
    return "".join(text_pieces(report, background))


def text_pieces(report: Report, background: Background) -> Iterator[str]:
    """The same, file by file."""
    return of_each(_parts(background, len(report.files) <= _LISTED), report, background)


def text_parts(background: Background) -> Parts:
    """The same, of files as they are finished, of which there are many."""
    return _parts(background, False)


def _parts(background: Background, are_listed: bool) -> Parts:
    """are_listed: whether of each file it is said with its findings what was not evaluated, not behind all of them."""
    page = _Page(max(background.columns, _NARROWEST), background.color)
    explained: dict[str, None] = {}

    def of_file(file: FileReport, lines: Mapping[int, str]) -> str:
        shown = list[str]()
        for found in file.findings:
            rule = background.rules.get(found.rule)
            shown += _finding(found, file, lines, rule, found.rule not in explained, page)
            shown += _following(found, background.following, page)
            shown.append("")
            explained[found.rule] = None
        if are_listed and not background.quiet:
            shown += _not_evaluated([file], page)
        shown += _made(file, page)
        if background.silenced:
            shown += _silenced(file, page)
        shown += _views(file, page, background.dots)
        return without_commands("".join(line + "\n" for line in shown))

    def end(report: Report) -> str:
        shown = list[str]()
        if not background.quiet and report.files:
            shown += [] if are_listed else _not_evaluated(report.files, page)
            shown += [*_verdicts(report, page), "", summary(report, background.fixed)]
            known = next((rule for rule in explained if rule in background.rules), None)
            shown += [page.paint("aside", f"More about a rule: polarcheck explain {known}")] if known else []
        return without_commands("".join(line + "\n" for line in shown))

    return Parts(of_file, end)


def _views(file: FileReport, page: _Page, dots: bool) -> Iterator[str]:
    """The paths of each section, where they were asked for."""
    views = getattr(file, "views", ())
    if not views:
        return
    from polarcheck.reports.pages.path_view import path_view

    for view in views:
        yield from path_view(view, page.columns, dots=dots, paint=page.paint, path=file.path)


def _silenced(file: FileReport, page: _Page) -> Iterator[str]:
    """What is silenced in a file, a paragraph for all of it."""
    if not file.silenced:
        return
    from polarcheck.reports.concise import why_silenced

    yield from page.heading("silenced", counted(len(file.silenced), "finding"))
    for found in file.silenced:
        yield from page.labelled("at", f"{file.path}:{found.line}:{found.column}: {why_silenced(found)}")
    yield ""


def _made(file: FileReport, page: _Page) -> Iterator[str]:
    """What a file makes, where that was asked for."""
    if not file.part:
        return
    from polarcheck.reports.pages.made import made

    yield from page.heading("part", file.path)
    for label, said in made(file):
        yield from page.labelled(label, said)
    yield ""


def _following(found: Finding, is_shown: bool, page: _Page) -> Iterator[str]:
    """What follows from a finding, or how much that is."""
    if not found.follows:
        return
    if not is_shown:
        count = len(found.follows)
        follow = "follows" if count == 1 else "follow"
        yield from page.labelled("also", f"{counted(count, 'finding')} {follow} from this one (--show-following)")
    for one in found.follows if is_shown else ():
        yield from page.labelled("so", f"line {one.line}: {one.severity}: {one.message} [{one.rule}]")


def _finding(
    found: Finding, file: FileReport, lines: Mapping[int, str], rule: Rule | None, is_first: bool, page: _Page
) -> Iterator[str]:
    yield from page.heading(found.severity, found.message)
    place = f"{file.path}:{found.line}:{found.column}"
    if found.channel:
        place += f", channel {found.channel}"
    if found.program and len(file.programs) > 1:
        place += f", program {found.program}"
    if found.count > 1 and not (rule and rule.once):
        place += f", in {found.count} runs of the block"
    yield from page.labelled("at", place)
    yield from _excerpt(found, lines, page)
    yield from page.labelled("rule", f"{found.rule}, alarm {found.alarm}" if found.alarm else found.rule)
    why = first_sentence(rule.page) if rule and is_first else ""
    if why:
        yield from page.labelled("why", why)
    if found.fix is not None:
        yield from page.labelled("fix", _fix(found.fix))


def _excerpt(found: Finding, lines: Mapping[int, str], page: _Page) -> Iterator[str]:
    """The G12.1 that the block belongs to, the block, and a mark under the words at fault."""
    room = page.columns - _GUTTER - 3
    related = found.section_line
    if related is not None and related != found.line and related in lines:
        yield _numbered(related, excerpt(lines[related], 0, 0, room).text, page)
    if found.line not in lines:
        return
    line = lines[found.line]
    end = found.end_column - 1 if found.end_line == found.line else len(line)
    shown = excerpt(line, found.column - 1, end, room)
    yield _numbered(found.line, shown.text, page)
    mark = page.paint(found.severity, "^" * shown.marked)
    yield f"{page.paint('aside', ' ' * _GUTTER + ' |')} {' ' * shown.first}{mark}"


def _numbered(line: int, text: str, page: _Page) -> str:
    return f"{page.paint('aside', f'{line:{_GUTTER}} |')} {text}".rstrip()


def first_sentence(page: str) -> str:
    """The first sentence below the title of a manual page; it says why."""
    body = page.partition("\n")[2].strip().partition("\n\n")[0]
    return _SENTENCE_END.split(" ".join(body.split()), maxsplit=1)[0]


def _fix(fix: Fix) -> str:
    return f"{fix.title} ({'--fix writes it' if fix.safe else 'look at it first: --diff --unsafe-fixes'})"


class _Reason:
    """What was not evaluated for one reason: the rules, the first places with their blocks, and how many more."""

    def __init__(self) -> None:
        self.rules: dict[str, None] = {}
        self.places: dict[str, int] = {}
        self.more = 0

    def add(self, file: FileReport, group: Sequence[NotEvaluated]) -> None:
        """What a file has of it; none of that is held on to, however many files there are."""
        self.rules |= dict.fromkeys(missing.rule for missing in group)
        blocks: dict[str, int] = {}
        for missing in group:
            place = f"{file.path}, channel {missing.channel}" if missing.channel else file.path
            blocks[place] = max(missing.blocks, blocks.get(place, 0))
        for place, count in blocks.items():
            if len(self.places) < _PLACES:
                self.places[place] = count
            else:
                self.more += 1


def _not_evaluated(files: Iterable[FileReport], page: _Page) -> Iterator[str]:
    """One paragraph for each reason, whatever the number of rules that it silences."""
    reasons: dict[str, _Reason] = {}
    for file in files:
        groups: dict[str, list[NotEvaluated]] = {}
        for missing in (one for one in file.not_evaluated if one.matters):
            groups.setdefault(missing.reason, []).append(missing)
        for reason, group in groups.items():
            reasons.setdefault(reason, _Reason()).add(file, group)
    for reason, found in reasons.items():
        yield from page.heading("not evaluated", reason)
        for place, blocks in found.places.items():
            yield from page.labelled("at", f"{place}, {counted(blocks, 'block')}")
        if found.more:
            yield from page.labelled("", f"and in {counted(found.more, 'more file')}")
        yield from page.labelled("rule" if len(found.rules) == 1 else "rules", ", ".join(found.rules))
        yield ""


def _is_listed(file: FileReport, report: Report) -> bool:
    return file.verdict != "pass" or len(report.files) <= _LISTED


def _verdicts(report: Report, page: _Page) -> Iterator[str]:
    # Of many files no report is held on to.
    widths = [len(verdict(file)) for file in report.files if _is_listed(file, report)]
    width = max(widths, default=0)
    for file in report.files:
        if not _is_listed(file, report):
            continue
        word = verdict(file)
        facts = [severities(Counter(found.severity for found in file.findings))]
        if file.sections or file.verdict != "pass":
            facts.append(counted(file.sections, "polar section") if file.sections else "no polar section")
        facts.append(counted(file.blocks, "block"))
        machine = f", for {visible(file.machine)}" if report.machine is None else ""
        space = " " * (width - len(word))
        yield f"{page.paint(file.verdict, word)}{space}  {visible(file.path)}: {', '.join(facts)}{machine}"
        if file.verdict != "fail" and len(widths) <= _RESTING:
            for line in resting(file):
                yield from page.indented(line)


def verdict(file: FileReport) -> str:
    """The verdict in words, with what it does not rest on: nothing to look at, or findings that are silenced."""
    remarks = ["no polar section"] if file.verdict == "pass" and not file.sections else []
    remarks += [f"{len(file.silenced)} silenced"] if file.silenced else []
    return f"{file.verdict} ({', '.join(remarks)})" if remarks else file.verdict


def summary(report: Report, fixed: int = 0) -> str:
    """One line over all files. fixed: how many fixes were written into them before."""
    total, verdicts = report.summary, ""
    if len(report.files) > 1:
        empty = sum(file.verdict == "pass" and not file.sections for file in report.files)
        silent = sum(file.verdict == "pass" and bool(file.silenced) for file in report.files)
        remarks = [
            f"{count} with {what}" if count < total.passed else what
            for count, what in ((empty, "no polar section"), (silent, "findings silenced"))
            if count
        ]
        of_pass = f"{total.passed} pass" + (f" ({', '.join(remarks)})" if remarks else "")
        counts = {f"{total.fail} fail": total.fail, f"{total.unverified} unverified": total.unverified}
        verdicts = ": " + ", ".join([text for text, count in counts.items() if count] + [of_pass] * bool(total.passed))
    machines = len({file.machine for file in report.files})
    machine = f"{machines} machines" if report.machine is None else visible(report.machine)
    found = [severities({"error": total.errors, "warning": total.warnings, "note": total.notes})]
    found += [f"{total.silenced} silenced"] if total.silenced else []
    found += [f"{fixed} fixed"] if fixed else []
    return f"{counted(len(report.files), 'file')} checked for {machine}{verdicts}; {', '.join(found)}"


def severities(number: Mapping[str, int]) -> str:
    """`2 errors, 1 note`."""
    return ", ".join(counted(number[one], one) for one in SEVERITIES if number[one]) or "no findings"


def _wrapped(text: str, columns: int) -> list[str]:
    return textwrap.wrap(text, columns, break_long_words=False, break_on_hyphens=False) or [""]
