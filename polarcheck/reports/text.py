"""The report for people at a shell: the block, what is wrong with it, why, and what to do."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import msgspec
from msgspec import UNSET

from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import DESELECTED, FAIL, PASS, UNREADABLE, UNVERIFIED
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.reading.excerpt import excerpt, visible, without_commands
from polarcheck.reports import SEVERITIES, Background, Parts, of_each, painted, settings_lines
from polarcheck.reports.pages.resting import resting

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Finding, Fix, NotEvaluated, Report
    from polarcheck.rules.rule import Rule

#: Line numbers and labels end at this column; the text beside them begins three columns further.
_GUTTER = 6
_NARROWEST = 60
#: With more files than this, passing files are counted, not listed, and "not evaluated" stands once after all files.
_LISTED = 10
#: With more files than this, the report does not say what the verdicts rest on.
_RESTING = 3
#: The most unsafe fixes that are listed.
_ASSUMED = 20
#: How many places are listed for each reason for "not evaluated".
_PLACES = 3
_SENTENCE_END = lazy_pattern(r"(?<!\be\.g\.)(?<!\bi\.e\.)(?<!\bp\.)(?<=[.?!])\s+(?=[A-Z0-9(])")


class _Page(msgspec.Struct, frozen=True):
    """
    The page that lines are written for.

    columns: the width [characters].
    color: write in color.
    """

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


def text_pieces(report: Report, background: Background) -> Iterator[str]:
    """Yield findings with excerpts, then what was not evaluated, then the verdict of each file and a summary line."""
    return of_each(_parts(background, len(report.files) <= _LISTED), report, background)


def text_parts(background: Background) -> Parts:
    """Return the functions that write the report while many files are being checked."""
    return _parts(background, False)


def _parts(background: Background, are_listed: bool) -> Parts:
    """
    Return the functions that write the report of a file, and its end.

    are_listed: "not evaluated" stands after the findings of each file, not once after all files.
    """
    page = _Page(max(background.columns, _NARROWEST), background.color)
    explained: dict[str, None] = {}

    def of_file(file: FileReport, lines: Mapping[int, str]) -> str:
        output = list[str]()
        for finding in file.findings:
            rule = background.rules.get(finding.rule)
            output += _finding(finding, file, lines, rule, finding.rule not in explained, page)
            output += _following(finding, background.following, page)
            output.append("")
            explained[finding.rule] = None
        if are_listed and not background.quiet:
            output += _not_evaluated([file], page)
        output += _part(file, page)
        if background.silenced:
            output += _silenced(file, page)
        output += _views(file, page, background.dots)
        return without_commands("".join(line + "\n" for line in output))

    def end(report: Report) -> str:
        output = list[str]()
        if not background.quiet and report.files:
            output += [] if are_listed else _not_evaluated(report.files, page)
            output += _assumed(report, page)
            output += [*_verdicts(report, page), "", *settings_lines(report), summary(report, background.fixed)]
            explained_rule = next((rule for rule in explained if rule in background.rules), None)
            output += (
                [page.paint("aside", f"More about a rule: polarcheck explain {explained_rule}")]
                if explained_rule
                else []
            )
        return without_commands("".join(line + "\n" for line in output))

    return Parts(of_file, end)


def _views(file: FileReport, page: _Page, dots: bool) -> Iterator[str]:
    """Yield the drawings of the paths of each section, if they were requested."""
    for view in getattr(file, "views", ()):
        yield from view.lines(page.columns, dots=dots, paint=page.paint, path=file.path)


def _silenced(file: FileReport, page: _Page) -> Iterator[str]:
    """Yield a paragraph on the silenced findings of a file."""
    if not file.silenced:
        return
    from polarcheck.reports.concise import why_silenced

    yield from page.heading("silenced", counted(len(file.silenced), "finding"))
    for finding in file.silenced:
        yield from page.labelled("at", f"{file.path}:{finding.line}:{finding.column}: {why_silenced(finding)}")
    yield ""


def _part(file: FileReport, page: _Page) -> Iterator[str]:
    """Yield a paragraph on the part that a file makes, if it was requested."""
    if not file.part:
        return
    from polarcheck.reports.pages.part_lines import part_lines

    yield from page.heading("part", file.path)
    for label, line in part_lines(file):
        yield from page.labelled(label, line)
    yield ""


def _following(finding: Finding, is_shown: bool, page: _Page) -> Iterator[str]:
    """Yield the findings that follow from a finding, or their number."""
    if not finding.follows:
        return
    if not is_shown:
        count = len(finding.follows)
        follow = "follows" if count == 1 else "follow"
        yield from page.labelled("also", f"{counted(count, 'finding')} {follow} from this one (--show-following)")
    for effect in finding.follows if is_shown else ():
        yield from page.labelled("so", f"line {effect.line}: {effect.severity}: {effect.message} [{effect.rule}]")


def _finding(
    finding: Finding, file: FileReport, lines: Mapping[int, str], rule: Rule | None, is_first: bool, page: _Page
) -> Iterator[str]:
    yield from page.heading(finding.severity, finding.message)
    location = f"{file.path}:{finding.line}:{finding.column}"
    if finding.channel:
        location += f", channel {finding.channel}"
    if finding.program and len(file.programs) > 1:
        location += f", program {finding.program}"
    if finding.count > 1 and not (rule and rule.once):
        location += f", in {finding.count} runs of the block"
    yield from page.labelled("at", location)
    yield from _excerpt(finding, lines, page)
    yield from page.labelled("rule", f"{finding.rule}, alarm {finding.alarm}" if finding.alarm else finding.rule)
    why = first_sentence(rule.page) if rule and is_first else ""
    if why:
        yield from page.labelled("why", why)
    if finding.fix is not None:
        yield from page.labelled("fix", _fix(finding.fix))


def _excerpt(finding: Finding, lines: Mapping[int, str], page: _Page) -> Iterator[str]:
    """Yield the G12.1 that the block belongs to, the block, and a mark under the words at fault."""
    room = page.columns - _GUTTER - 3
    related = finding.section_line
    if related is not None and related != finding.line and related in lines:
        yield _numbered(related, excerpt(lines[related], 0, 0, room).text, page)
    if finding.line not in lines:
        return
    line = lines[finding.line]
    end = finding.end_column - 1 if finding.end_line == finding.line else len(line)
    marked_line = excerpt(line, finding.column - 1, end, room)
    yield _numbered(finding.line, marked_line.text, page)
    mark = page.paint(finding.severity, "^" * marked_line.marked)
    yield f"{page.paint('aside', ' ' * _GUTTER + ' |')} {' ' * marked_line.first}{mark}"


def _numbered(line: int, text: str, page: _Page) -> str:
    return f"{page.paint('aside', f'{line:{_GUTTER}} |')} {text}".rstrip()


def first_sentence(page: str) -> str:
    """Return the first sentence below the title of a manual page; it says why."""
    body = page.partition("\n")[2].strip().partition("\n\n")[0]
    return _SENTENCE_END.split(" ".join(body.split()), maxsplit=1)[0]


def _fix(fix: Fix) -> str:
    return f"{fix.title} ({'--fix writes it' if fix.safe else 'look at it first: --diff --unsafe-fixes'})"


class _Reason:
    """
    What was not evaluated for one reason.

    rules: the names of the rules, in order.
    places: for each of the first places (path and channel) its number of blocks.
    more: the number of further places.
    """

    def __init__(self) -> None:
        self.rules: dict[str, None] = {}
        self.places: dict[str, int] = {}
        self.more = 0

    def add(self, file: FileReport, group: Sequence[NotEvaluated]) -> None:
        """Add the entries of a file, without a reference to them: there may be very many files."""
        self.rules |= dict.fromkeys(missing.rule for missing in group)
        blocks: dict[str, int] = {}
        for missing in group:
            title = f"{file.path}, channel {missing.channel}" if missing.channel else file.path
            blocks[title] = max(missing.blocks, blocks.get(title, 0))
        for title, count in blocks.items():
            if len(self.places) < _PLACES:
                self.places[title] = count
            else:
                self.more += 1


def _not_evaluated(files: Iterable[FileReport], page: _Page) -> Iterator[str]:
    """Yield one paragraph for each reason, with all rules that were not evaluated for it."""
    reasons: dict[str, _Reason] = {}
    for file in files:
        groups: dict[str, list[NotEvaluated]] = {}
        for missing in (each for each in file.not_evaluated if each.matters):
            groups.setdefault(missing.reason, []).append(missing)
        for reason, group in groups.items():
            reasons.setdefault(reason, _Reason()).add(file, group)
    for reason, entry in reasons.items():
        yield from page.heading("not evaluated", reason)
        for location, blocks in entry.places.items():
            yield from page.labelled("at", f"{location}, {counted(blocks, 'block')}")
        if entry.more:
            yield from page.labelled("", f"and in {counted(entry.more, 'more file')}")
        if not entry.rules.keys() - {DESELECTED}:
            yield ""
            continue
        yield from page.labelled("rule" if len(entry.rules) == 1 else "rules", ", ".join(entry.rules))
        yield ""


def _is_listed(file: FileReport, report: Report) -> bool:
    return file.verdict != PASS or len(report.files) <= _LISTED


def _assumed(report: Report, page: _Page) -> Iterator[str]:
    """Yield a paragraph on what unsafe fixes have written, so that nobody takes it for what the program says."""
    if report.assumed is UNSET:
        return
    yield "assumed by --unsafe-fixes:"
    for one in report.assumed[:_ASSUMED]:
        yield from page.indented(f"{one.path}:{one.line}: {one.block} ({one.rule}: {one.title})")
    if len(report.assumed) > _ASSUMED:
        yield from page.indented(f"{len(report.assumed) - _ASSUMED} more")
    yield ""


def _verdicts(report: Report, page: _Page) -> Iterator[str]:
    # Iterates over the files twice, so that not all reports are in memory at once.
    widths = [len(verdict(file)) for file in report.files if _is_listed(file, report)]
    width = max(widths, default=0)
    for file in report.files:
        if not _is_listed(file, report):
            continue
        word = verdict(file)
        if file.verdict == UNREADABLE:
            space = " " * (width - len(word))
            yield f"{page.paint(word, word)}{space}  {visible(f'{file.path}: {file.reason}')}"
            continue
        facts = [severities(Counter(finding.severity for finding in file.findings))]
        if file.sections or file.verdict != PASS:
            facts.append(counted(file.sections, "polar section") if file.sections else "no polar section")
        facts.append(counted(file.blocks, "block"))
        machine = f", for {visible(file.machine)}" if report.machine is None else ""
        space = " " * (width - len(word))
        yield f"{page.paint(file.verdict, word)}{space}  {visible(file.path)}: {', '.join(facts)}{machine}"
        if file.makes and file.part is UNSET and len(widths) <= _RESTING:
            yield from page.indented(f"makes: {file.makes}")
        if file.verdict != FAIL and len(widths) <= _RESTING:
            for line in resting(file):
                yield from page.indented(line)


def verdict(file: FileReport) -> str:
    """Return the verdict in words, with remarks: no polar section, silenced findings."""
    remarks = ["no polar section"] if file.verdict == PASS and not file.sections else []
    remarks += [f"{len(file.silenced)} silenced"] if file.silenced else []
    return f"{file.verdict} ({', '.join(remarks)})" if remarks else file.verdict


def summary(report: Report, fixed: int = 0) -> str:
    """Return one line on all files. fixed: the number of fixes written into them before."""
    total, verdicts = report.summary, ""
    if len(report.files) > 1 or total.unreadable:
        empty = sum(file.verdict == PASS and not file.sections for file in report.files)
        silent = sum(file.verdict == PASS and bool(file.silenced) for file in report.files)
        remarks = [
            f"{count} with {what}" if count < total.passed else what
            for count, what in ((empty, "no polar section"), (silent, "findings silenced"))
            if count
        ]
        of_pass = f"{total.passed} pass" + (f" ({', '.join(remarks)})" if remarks else "")
        counts = {FAIL: total.fail, UNREADABLE: total.unreadable, UNVERIFIED: total.unverified}
        texts = [f"{count} {word}" for word, count in counts.items() if count] + [of_pass] * bool(total.passed)
        verdicts = f": {', '.join(texts)}"
    machines = len({file.machine for file in report.files if file.verdict != UNREADABLE})
    machine = f"{machines} machines" if report.machine is None else visible(report.machine)
    facts = [severities({"error": total.errors, "warning": total.warnings, "note": total.notes})]
    facts += [f"{total.silenced} silenced"] if total.silenced else []
    unsafe = "" if report.assumed is UNSET else f", {len(report.assumed)} by --unsafe-fixes"
    facts += [f"{fixed} fixed{unsafe}"] if fixed else []
    planned = len(report.files) if report.interrupted is UNSET else report.interrupted.planned
    checked = len(report.files) - total.unreadable
    files = f"{checked} of {planned} files" if checked < planned else counted(planned, "file")
    parts = [f"{files} checked for {machine}{verdicts}", ", ".join(facts)]
    if total.not_read or total.excluded:
        from polarcheck.reports.pages.unread import unread

        parts += unread(total)
    return "; ".join(parts)


def severities(number: Mapping[str, int]) -> str:
    """Return numbers in words: `2 errors, 1 note`."""
    return (
        ", ".join(counted(number[severity], severity) for severity in SEVERITIES if number[severity]) or "no findings"
    )


def _wrapped(text: str, columns: int) -> list[str]:
    return textwrap.wrap(text, columns, break_long_words=False, break_on_hyphens=False) or [""]
