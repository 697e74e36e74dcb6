"""
The one word or block that explains the findings of a contour: it is searched, and a program without the slip is tried.

A contour with a finding is a symptom. Each edit of its words and blocks that is one slip of the pen away is compared by
what it leaves to chance (columns/contour/likely_edits.py). The best are tried: the program with the edit is read and
checked. An edit explains the findings that are gone then, if no other finding has come; they are listed under it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, islice
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.checking.code_edits import (
    CodeEdit,
    as_in_passes,
    before_arcs,
    exchanged,
    missing_steps,
    ramp_edits,
    unneeded_sides,
    unneeded_steps,
    unskipped,
)
from polarcheck.checking.edits import origins
from polarcheck.checking.engine import Engine, with_following
from polarcheck.checking.hidden_findings import REPORTS, TrialCount, edited, is_told, with_hidden
from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.likely_edits import (
    AS_LIKELY,
    LEAST_GAIN,
    LEAST_IF_WHOLE,
    Compared,
    Likely,
    all_compared,
    correction_by,
    likely_edits,
    likely_pairs,
)
from polarcheck.columns.contour.loop_edits import Edit
from polarcheck.columns.contour.written_loop import WrittenLoop, written_loops
from polarcheck.columns.words.slips import WORD
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import SEVERITIES, WARNING, Finding
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.editing import Replace, in_place_of, is_plain, with_word, without, words_of
from polarcheck.rules.places import PLACES
from polarcheck.rules.rule import Hits, Rule

#: The rule that compares paths: either of them may be wrong.
_COMPARES = "passes-differ"
#: Paths of a file that are searched, edits and pairs of edits of each that are tried.
_MOST_LOOPS, _TRIALS, _PAIRS = 8, 5, 4
#: As many edits that are as likely are named.
_NAMED = 2
#: By how much less one may explain that removes all findings of a path, where likelier ones leave some [coordinates].
_LESS_LIKELY = 1.5

#: Blocks from the last one of a contour on in which a finding is a reason to tell nothing else of the contour.
_AROUND = 4
#: So many rules must find something that a code in another block explains, in a path of so many blocks: the geometry
#: does not speak for it.
_RULES_OF_CODE, _BLOCKS_OF_CODE = 2, 4
#: Rules that a smaller cutter satisfies: only what is clear beside them explains them by another word.
_OF_CUTTER = {"overcut", "slot-narrower-than-cutter", "inside-arc-smaller-than-radius", "interference"}
#: The rule of the ramps of a contour that is too narrow.
_OF_RAMPS = "start-up-sweeps-contour"
#: Rules of rates: no code that stands elsewhere explains them.
_OF_RATES = "c-feed-above-limit", "c-acceleration-above-limit", "x-acceleration-above-limit"
#: The rule that speaks of a word or a code that is missing, and of no number.
_NO_CENTER = "arc-without-center"
#: Rules of arcs that are none: behind them nothing of the contour is judged.
_NO_ARC = "arc-end-off-circle", "arc-radius-too-small"

#: A rule and a line at which it fires.
_Symptom = tuple[str, int]


class _Explained(NamedTuple):
    """
    An edit that explains findings.

    row: of its block. edits: of the text. gone: the symptoms that it removes. left: those that are there with it.
    other: a second one that is as likely. is_named: False where several values of the block do so, and none is named.
    is_whole: nothing is left of the findings of the path. is_of_two: it is one of two mistakes, and may remove nothing
    by itself.
    """

    likely: Likely
    row: int
    edits: list[Replace]
    gone: frozenset[_Symptom]
    left: frozenset[_Symptom]
    other: _Explained | None = None
    is_named: bool = True
    is_whole: bool = False
    is_of_two: bool = False


#: The rows of contours of a run that an edit makes more regular.
LessRegular = Callable[[Engine], Sequence[tuple[Rows, Correction]]]


def explained(engine: Engine, findings: list[Finding], number: int, less_regular: LessRegular) -> list[Finding]:
    """
    Return the findings, with those that one edit explains listed under it, and those that are hidden by others.

    number: of the run, in the order of program/execution/runs.py. less_regular: where an edit makes a contour more
    regular to which no rule objects; that is a finding, too.
    """
    source = engine.trace.text.source
    if REPORTS not in engine.rules or source.parts or source.channel:
        return findings
    count = TrialCount(engine.trace)
    findings, partly, whole = _explained(engine, findings, number, less_regular, count)
    clear = {source.line_of(start) for start, _, _ in whole}
    hiding = [finding for finding in findings if finding.line not in clear]
    try:
        return with_hidden(
            engine,
            findings,
            hiding,
            number,
            partly,
            lambda trial, found: _explained(trial, found, number, less_regular, count)[0],
            count,
        )
    except TooHardError:
        return findings
    finally:
        engine.unlisted += count.not_searched()


def _explained(
    engine: Engine, findings: list[Finding], number: int, less_regular: LessRegular, count: TrialCount
) -> tuple[list[Finding], list[Replace], list[Replace]]:
    """The findings, with those that one edit explains under it; the edits that leave others, and those that do not."""
    trace = engine.trace
    symptoms = [finding for finding in findings if _is_symptom(engine, finding)]
    partly: list[Replace] = []
    whole: list[Replace] = []
    if symptoms:
        search = _Search(engine, number, findings, count)
        try:
            for explanation in search.explanations(symptoms):
                findings = _under(engine, findings, explanation)
                edits = whole if explanation.is_whole else partly
                edits += explanation.edits
        except TooHardError:
            pass  # what was found before stands
    lines = {part.line for finding in findings if is_told(finding) for part in (finding, *finding.follows)}
    unexplained = []
    for rows, correction in less_regular(engine):
        if lines.isdisjoint(trace.blocks.line[rows[0] : rows[-1] + _AROUND].tolist()):
            unexplained.append(_new(engine, correction))
            lines.add(unexplained[-1].line)
    return [*findings, *unexplained], partly, whole


def _is_symptom(engine: Engine, finding: Finding) -> bool:
    return is_told(finding) and engine.rules[finding.rule].is_symptom


def _lines(finding: Finding) -> set[int]:
    """The lines of a finding: both where it compares two."""
    return {finding.line, int(finding.values["other_line"])} if finding.rule == _COMPARES else {finding.line}


class _Search:
    def __init__(self, engine: Engine, number: int, findings: list[Finding], count: TrialCount) -> None:
        self.engine, self.trace, self.number, self.count = engine, engine.trace, number, count
        told = {finding.rule for finding in findings if is_told(finding)}
        self.roots = {(finding.rule, finding.line) for finding in findings}
        rules = (rule for rule in engine.rules.values() if not rule.of_text and rule.over == "rows")
        # What a rule only notes is a warning or an error where others follow from it.
        self.rules = [rule for rule in rules if rule.name in told or _warns(engine, rule)]
        self.section_line = 0
        # What is explained is mended when the next path is tried, which may be compared with it.
        self.mended: list[Replace] = []
        self.symptoms = _symptoms(engine, self.rules)
        # By line of a block that differs from that of another pass, the line of the other one.
        self.compared: dict[int, int] = {}

    def explanations(self, findings: Sequence[Finding]) -> Iterator[_Explained]:
        """One explanation at most for each path with a symptom, or two of two mistakes."""
        trace = self.trace
        lines = set[int]().union(*map(_lines, findings))
        for pair in (_lines(finding) for finding in findings if finding.rule == _COMPARES):
            self.compared |= {line: other for line in pair for other in pair - {line}}
        rows = np.flatnonzero(np.isin(trace.blocks.line, [*lines]) & (trace.mode.section >= 0))
        sections = np.flatnonzero(np.bincount(trace.mode.section[rows], minlength=1)).tolist()
        loops = list(islice(written_loops(trace, sections), _MOST_LOOPS + 1))
        if len(loops) > _MOST_LOOPS:
            self.count.stopped.add(self._line_of_section(loops.pop()))
        begins = [max(int(loop.row[0]) - 1, 0) for loop in loops]
        ends = [*(int(loop.row[1]) for loop in loops[1:]), len(trace)]
        reach = [set(trace.blocks.line[slice(*rows)].tolist()) for rows in zip(begins, ends, strict=False)]
        known: set[_Symptom] = set()
        for loop, own_lines in zip(loops, reach, strict=True):
            own = {(finding.rule, finding.line) for finding in findings if _lines(finding) & own_lines}
            if not own <= known:
                self.section_line = self._line_of_section(loop)
                others = (other for other in reach if other is not own_lines and other & lines)
                for found in self._explained(loop, own_lines, set[int]().union(*others) - own_lines):
                    known |= found.gone
                    self.mended += found.edits
                    self.symptoms = found.left
                    yield found

    def _line_of_section(self, loop: WrittenLoop) -> int:
        mode = self.trace.mode
        return int(self.trace.blocks.line[mode.sections.enter[mode.section[loop.row[1]]]])

    def _lines_of_section(self, loop: WrittenLoop) -> set[int]:
        section = self.trace.mode.section
        return set(self.trace.blocks.line[section == section[loop.row[1]]].tolist())

    def _explained(self, loop: WrittenLoop, own: set[int], others: set[int]) -> list[_Explained]:
        """
        The likeliest edit that removes symptoms and brings none, or two that do so together; none for too many alike.

        One that removes all symptoms of the path comes before one that leaves some. own: the lines of the path. others:
        those of other paths with a symptom, where another one may come, as by a comparison of passes.
        """
        of_code = chain.from_iterable(
            search(self.trace, loop.row[1:]) for search in (unskipped, unneeded_sides, missing_steps, before_arcs)
        )
        whole = self._by_codes(of_code, own, others, 1)
        partly: list[_Explained] = []
        shows_more: list[_Explained] = []
        rules = {rule for rule, line in self.symptoms if line in own}
        # What makes the path symmetric is named already: only what is clear is likelier.
        least = LEAST_GAIN if rules == {REPORTS} else LEAST_IF_WHOLE
        compared = None if whole else all_compared(self.trace, loop)
        if compared is not None and not compared.edits:
            self.count.stopped.add(self.section_line)
        for likely in () if compared is None else likely_edits(compared, _TRIALS, least):
            best, reach = (whole, AS_LIKELY) if whole else (partly, _LESS_LIKELY)
            if best and best[0].likely.gain - likely.gain > reach:
                break
            row = loop.row_of(self.trace.run, likely.edit.corner, likely.edit.words)
            edits = [] if self._contradicts(row, likely, own) else self._edits(loop, likely)
            found = self._tried(likely, row, edits, others) if edits else None
            if found is not None and not likely.is_clear and _is_of_cutter({rule for rule, _ in found.gone}):
                continue
            if found is not None and own.isdisjoint(line for _, line in found.left):
                whole.append(found)
            elif found is not None and likely.is_clear:
                (shows_more if found.left - self.symptoms else partly).append(found)
        # Increments that are read as positions make a path of which little can be told.
        whole = whole or self._by_codes(unneeded_steps(self.trace, loop.row[1:]), own, others, 1)
        whole = whole or self._by_codes(as_in_passes(self.engine, loop.row[1:]), own, others, _RULES_OF_CODE)
        # A path that two numbers make regular has no code at the wrong place.
        is_of_two = sum(rule == REPORTS and line in own for rule, line in self.symptoms) > 1
        is_of_code = not is_of_two and len(rules) >= _RULES_OF_CODE and len(loop.turns) >= _BLOCKS_OF_CODE
        if not whole and is_of_code:
            lines = {line for rule, line in self.symptoms if line in own and rule not in _OF_RATES}
            rows = np.flatnonzero(np.isin(self.trace.blocks.line, [*lines]))
            whole = self._by_codes(ramp_edits(self.trace, loop.row[1:], rows), own, others, _RULES_OF_CODE)
        # An arc that has no center has none with two other numbers either.
        is_of_numbers = not any(rule == _NO_CENTER and line in own for rule, line in self.symptoms)
        if not whole and is_of_numbers and compared is not None and (pair := self._pair(compared, own, others)):
            return pair
        best = whole or partly
        if shows_more and not whole and (not partly or _exceeds(shows_more[0], partly[0])):
            best = shows_more[:1]
        best = [found for found in best if best[0].likely.gain - found.likely.gain <= AS_LIKELY]
        if not best:
            return []
        # What is left in the section and stands under another finding is searched without the mistake.
        hidden = {line for rule, line in best[0].left if (rule, line) not in self.roots}
        is_whole = bool(whole) and hidden.isdisjoint(self._lines_of_section(loop))
        best[0] = best[0]._replace(is_whole=is_whole)
        if len(best) > _NAMED:
            is_one = bool(whole) and all(found.row == best[0].row for found in best)
            return [best[0]._replace(is_named=False, edits=[], left=self.symptoms)] if is_one else []
        return [best[0]._replace(other=best[1]) if best[1:] else best[0]]

    def _contradicts(self, row: int, likely: Likely, own: set[int]) -> bool:
        """
        The block of an edit differs from that of another pass, and with the edit it would have another number.

        What is not clear edits no block either that the other pass has, too, but for the number of that. own: the lines
        of the path.
        """
        blocks, edit, numbers = self.trace.blocks, likely.edit, _numbers(likely.edit.text)
        line, differing = int(blocks.line[row]), own & self.compared.keys()
        other = self.compared.get(line)
        is_as_there = other is None and not likely.is_clear and bool(differing)
        if is_as_there:
            near = min(differing, key=lambda one: abs(one - line))
            other = self.compared[near] + line - near
        if edit.kind != "word" or other is None or len(numbers) != 1:
            return is_as_there
        ((letter, number),) = numbers
        value = blocks.word(letter.strip("="))[np.argmax(blocks.line == other)]
        return bool(abs(value - number) > ROUNDING or (is_as_there and np.isnan(value)))

    def _pair(self, compared: Compared, own: set[int], others: set[int]) -> list[_Explained]:
        """
        Two edits that remove all symptoms of a path together, or the one of them that is clear and in all likely pairs.

        What is found with the first of them stands there because of the second. Of a few blocks a pair makes anything.
        """
        loop = compared.loop
        if len(loop.turns) < _BLOCKS_OF_CODE:
            return []
        whole: list[tuple[float, dict[Edit, tuple[Likely, list[Replace]]]]] = []
        for pair in likely_pairs(self.trace, compared, _PAIRS):
            gain = sum(likely.gain for likely in pair)
            if whole and whole[0][0] - gain > AS_LIKELY:
                break
            edits = [self._edits(loop, likely) for likely in pair]
            found = self._tried(pair[0], 0, [*chain(*edits)], others) if all(edits) else None
            if found is not None and own.isdisjoint(line for _, line in found.left):
                whole.append((gain, {one.edit: (one, edit) for one, edit in zip(pair, edits, strict=True)}))
        pairs = [pair for _, pair in whole]
        sure = [
            edit
            for edit in (pairs[0] if pairs else ())
            if all(edit in pair and pair[edit][0].is_clear for pair in pairs)
        ]
        explained: list[_Explained] = []
        before = self.symptoms
        for edit in sure:
            likely, replaced = pairs[0][edit]
            left = self._left_by([*chain(*(other.edits for other in explained)), *replaced])
            left = before if left is None else left
            row = loop.row_of(self.trace.run, edit.corner, edit.words)
            is_whole = len(sure) == len(pairs[0])
            explained.append(_Explained(likely, row, replaced, before - left, left, is_whole=is_whole, is_of_two=True))
            before = left
        return explained

    def _by_codes(
        self, edits: Iterable[list[CodeEdit]], own: set[int], others: set[int], least: int
    ) -> list[_Explained]:
        """
        Edits that change no number and remove all symptoms of a path; of those that say the same the first one.

        least: rules whose findings are to be gone.
        """
        whole = []
        for alike in edits:
            for row, edit, replaced in alike:
                found = self._tried(Likely(edit, 0.0, "it would fit", False, False, True), row, replaced, others)
                if found is None or not own.isdisjoint(line for _, line in found.left):
                    continue
                if len({rule for rule, _ in found.gone}) >= least:
                    whole.append(found)
                    break
        return whole

    def _tried(self, likely: Likely, row: int, edits: list[Replace], others: set[int]) -> _Explained | None:
        """
        The program with an edit: None where no symptom is gone, or another one has come but in `others`.

        Behind an arc that was none others may come, which nothing could show before.
        """
        trial = self._trial(edits)
        if trial is None:
            return None
        # The search of nearly regular contours takes longest, and most edits are refused without it.
        fired = {rule for rule, _ in self.symptoms}
        left = trial(rule for rule in self.rules if rule.name in fired and rule.name != REPORTS)
        for rule in sorted(self.rules, key=lambda rule: rule.name == REPORTS):
            if self.symptoms <= left:
                return None
            left |= trial([rule]) if rule.name not in fired or rule.name == REPORTS else frozenset()
            gone = self.symptoms - left
            more = {rule for rule, line in left - self.symptoms if line not in others}
            rules = {rule for rule, _ in gone}
            if more and (not likely.is_clear or rules.isdisjoint(_NO_ARC) or not rules.isdisjoint(more)):
                return None
        # A number that leaves nothing to move gives an arc no center.
        if not gone or (likely.edit.kind == "word" and any(rule == _NO_CENTER for rule, _ in gone)):
            return None
        return _Explained(likely, row, edits, gone, left)

    def _edits(self, loop: WrittenLoop, likely: Likely) -> list[Replace]:
        """The edits of the text; none where its words stand there in another form."""
        run, edit = self.trace.run, likely.edit
        row = loop.row_of(run, edit.corner, edit.words)
        if run.text.blocks.is_macro[run.block[row]] or (edit.kind == "twice" and not is_plain(run, row)):
            return []
        if edit.kind == "twice":
            return without(run, row, words_of(run, row))
        if edit.kind == "order":
            following = int(loop.row[edit.corner + 1])
            return exchanged(self.trace, row, following)
        if not edit.words:
            return [with_word(run, row, edit.text)]
        if len(edit.words) == 1:
            return [in_place_of(run, edit.words[0], edit.text)]
        return [in_place_of(run, word, text) for word, text in zip(edit.words, edit.text.split(), strict=True)]

    def _left_by(self, edits: list[Replace]) -> frozenset[_Symptom] | None:
        """The symptoms of the program with these edits; None where it cannot be read as before."""
        trial = self._trial(edits)
        return None if trial is None else trial(self.rules)

    def _trial(self, edits: list[Replace]) -> Callable[[Iterable[Rule]], frozenset[_Symptom]] | None:
        """What rules find in the program with these edits; None where it cannot be read as before."""
        source, engine = self.trace.text.source, self.engine
        if not self.count.counted(self.section_line):
            return None
        edits = [*self.mended, *edits]
        trial = edited(engine, self.number, edits, self.rules)
        if trial is None:
            return None
        origin = origins(source, trial.trace.text.source, edits)
        return lambda rules: frozenset((rule, int(origin[number - 1])) for rule, number in _symptoms(trial, rules))


def _warns(engine: Engine, rule: Rule) -> bool:
    """The findings of a rule are warnings or errors by themselves."""
    return bool(SEVERITIES[rule.level(engine.severities)] >= WARNING)


def _symptoms(engine: Engine, rules: Iterable[Rule]) -> frozenset[_Symptom]:
    """Where these rules fire as warnings or errors."""
    line = engine.trace.blocks.line
    found: set[_Symptom] = set()
    for rule in rules:
        hits = engine.hits(rule)
        if hits.mask.any():
            severity = rule.severity if hits.severity is None else hits.severity
            fires = hits.mask & (np.asarray(severity) >= WARNING)
            found.update((rule.name, number) for number in set(line[fires].tolist()))
    return frozenset(found)


def _exceeds(one: _Explained, other: _Explained) -> bool:
    return one.likely.gain - other.likely.gain > _LESS_LIKELY


def _under(engine: Engine, findings: Sequence[Finding], explanation: _Explained) -> list[Finding]:
    """The findings with those that are explained under the edit: under the one at its line, else under a new one."""
    gone = [finding for finding in findings if (finding.rule, finding.line) in explanation.gone]
    if not gone and not explanation.is_of_two:
        return list(findings)
    line = int(engine.trace.blocks.line[explanation.row])
    # What compares two passes may be listed under what is found in one of them.
    may_lead = [*gone, *(one for finding in gone for one in finding.follows if one.rule == _COMPARES)]
    there = [finding for finding in may_lead if finding.line == line and _may_lead(engine, finding, explanation)]
    if not explanation.is_named and not there:
        return list(findings)
    there = [*(finding for finding in findings if _is_of_word(engine, finding, explanation)), *there]
    others = [finding for finding in findings if finding not in (*gone, *there[:1])]
    head = _with_remedy(engine, there[0], explanation) if there else _new(engine, _correction(engine, explanation))
    symptoms = [
        symptom
        for finding in gone
        if finding not in there[:1]
        for symptom in (msgspec.structs.replace(finding, follows=[]), *finding.follows)
        if symptom.rule != REPORTS and symptom not in there[:1]
    ]
    return [*others, with_following(head, [*head.follows, *symptoms])]


def _is_of_word(engine: Engine, finding: Finding, explanation: _Explained) -> bool:
    """A finding about the writing of the one word that the edit replaces: it is the mistake, and no symptom."""
    rule = engine.rules.get(finding.rule)
    words = explanation.likely.edit.words
    if rule is None or rule.over != "words" or len(words) != 1 or not explanation.is_named:
        return False
    start = int(engine.trace.run.words.start[words[0]])
    column = start - int(engine.trace.text.source.line_starts[finding.line - 1]) + 1
    return finding.line == finding.end_line and finding.column <= column < finding.end_column


def _may_lead(engine: Engine, finding: Finding, explanation: _Explained) -> bool:
    """A finding in the block of the edit may lead: a symptom, or one that names the words of the edit; no mere note."""
    if explanation.likely.edit.kind == "other pass":
        return finding.rule == _COMPARES
    if not _warns(engine, engine.rules[finding.rule]):
        return False
    needed = str(finding.values.get("word_needed", ""))
    names_none = not needed and finding.rule != REPORTS
    return names_none or _numbers(needed) == _numbers(explanation.likely.edit.text)


def _is_of_cutter(rules: set[str]) -> bool:
    return not rules.isdisjoint(_OF_CUTTER) and rules <= _OF_CUTTER | {_OF_RAMPS}


def _numbers(words: str) -> list[tuple[str, float]]:
    return [(letter, float(number)) for letter, number in WORD.findall(words)]


def _with_remedy(engine: Engine, finding: Finding, explanation: _Explained) -> Finding:
    """The finding, which also says what the edit is."""
    edit = explanation.likely.edit
    stated = edit.how or edit.text
    is_said = finding.rule == REPORTS or edit.kind == "other pass" or (stated and stated in finding.message)
    if is_said or not explanation.is_named:
        return finding
    message = f"{finding.message}; {_remedies(engine, explanation)} {explanation.likely.becomes}"
    return msgspec.structs.replace(finding, message=message)


def _correction(engine: Engine, explanation: _Explained) -> Correction:
    correction = correction_by(explanation.likely, explanation.row)
    return correction._replace(remedy=_remedies(engine, explanation))


def _new(engine: Engine, correction: Correction) -> Finding:
    trace, tables, row, word = engine.trace, engine.tables, correction.row, correction.word
    tables["regularity"].explained[row] = correction
    at = trace.blocks.words_at(np.array([word][: word >= 0], np.int64))
    hits = Hits(trace.blocks.mask_of([row]), at=at)
    place = PLACES["rows"](tables, row)
    return engine.answered(engine.finding(engine.rules[REPORTS], place, hits, 1), place.block)


def _remedies(engine: Engine, explanation: _Explained) -> str:
    remedy = explanation.likely.edit.remedy
    if (other := explanation.other) is None:
        return remedy
    edit, line = other.likely.edit, int(engine.trace.blocks.line[other.row])
    return f"{remedy}, or {edit.remedy}{'' if edit.how else f' in line {line}'},"
