"""Runs the cases of a manifest, and makes the certificate of them."""

from __future__ import annotations

from collections.abc import Collection, Generator, Iterable, Mapping, Sequence

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.files.batch.tasks import forget
from polarcheck.foundation import record
from polarcheck.foundation.errors import CertificateError, PolarcheckError, UsageError, suggestion
from polarcheck.foundation.finding import Producer
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.foundation.version import __version__
from polarcheck.program.reading import files
from polarcheck.rewrite.certify import expectations, golden, near_path, quoting, results
from polarcheck.rewrite.certify.case_runs import CaseRun, run
from polarcheck.rewrite.certify.conditions import ConditionsOfCases
from polarcheck.rewrite.certify.loading import Loaded
from polarcheck.rewrite.certify.manifest import Case
from polarcheck.rewrite.certify.results import (
    FAIL,
    MISSING,
    NO_GOLDEN,
    NOT_OFFERED,
    NOT_RUN,
    PASS,
    CaseResult,
    Cell,
    Certificate,
)
from polarcheck.rewrite.certify.tool_path import ToolPath, tool_path


class Certified(msgspec.Struct, frozen=True):
    """
    A case that was run.

    case: the case. result: what came of it. run: its program.
    """

    case: Case
    result: CaseResult
    run: CaseRun


def chosen(loaded: Loaded, names: Iterable[str], option: str = "--case") -> list[str]:
    """
    Return the names of the cases to run, all of them without any name.

    option: what names them. Raises UsageError for an unknown one.
    """
    requested = list(dict.fromkeys(names))
    for name in requested:
        if name not in loaded.cases:
            raise UsageError(f"{option} {name}: the manifest has no case of this name{suggestion(name, loaded.cases)}")
    if not loaded.cases:
        title = files.display_path(str(loaded.path))
        raise CertificateError(
            f"{title}: no cases: give a [[case]], or a file for a feature in `programs` of a control"
        )
    return requested or [*loaded.cases]


def conditions(loaded: Loaded, names: Collection[str]) -> dict[str, Settings]:
    """
    Return the settings of the named cases.

    Raises a PolarcheckError for those that cannot be used, before anything is run.
    """
    of_case = ConditionsOfCases(loaded)
    settings: dict[str, Settings] = {}
    with record.recorded() as read:
        for name in names:
            try:
                settings[name] = of_case(loaded.cases[name])
                continue
            except PolarcheckError:
                outside = loaded.outside(read.paths)
                if not outside:
                    raise
            # Behind the clause: an error raised in it would hold the one that quotes.
            title = files.display_path(str(loaded.path))
            raise CertificateError(f"{title}: {name}: cannot be checked; {quoting.remark(outside)}")
    return settings


def needed(loaded: Loaded, names: Iterable[str]) -> list[str]:
    """Return the names of cases and of those that their paths are compared with, in the order of the manifest."""
    required: set[str] = set()
    for name in names:
        reference: str | None = name
        while reference is not None and reference not in required:
            required.add(reference)
            reference = loaded.cases[reference].same_path_as
    return [name for name in loaded.cases if name in required]


def runs(loaded: Loaded, settings: Mapping[str, Settings], most: int) -> Generator[tuple[str, CaseRun], None, None]:
    """Yield the name and the run of each case that has settings. most: the largest size of a program [bytes]."""
    paths_of: dict[str, set[str]] = {name: set() for name in settings}
    for name in settings:
        case = loaded.cases[name]
        if case.golden is not None:
            paths_of[name].add(loaded.path_of(case))
        if case.same_path_as is not None:
            for title in (name, case.same_path_as):
                paths_of[title] |= {"programmed", loaded.path_of(case)}
    for name, of_case in settings.items():
        yield name, run(str(loaded.beside(loaded.cases[name].program)), of_case, most, sorted(paths_of[name]), loaded)
        forget()


class _Alone(msgspec.Struct, frozen=True):
    """
    What came of a case without other cases.

    reasons: why its findings and its verdict are not the expected ones, or why it was not run.
    golden: its path beside its golden trace. path: the same in detail.
    """

    reasons: list[str]
    golden: results.PathComparison | None
    path: near_path.Comparison

    def fails(self, is_golden_there: bool) -> bool:
        """Return True if its program is wrong; a golden trace that is not there yet proves nothing."""
        return bool(self.reasons or (is_golden_there and self.path.reasons))


def certified_cases(
    loaded: Loaded, settings: Mapping[str, Settings], case_runs: Mapping[str, CaseRun]
) -> dict[str, Certified]:
    """Return the cases that were run, each with its result, by name."""
    limits = {
        name: seconds_for(of_case.size, settings[name].job.run.max_seconds) for name, of_case in case_runs.items()
    }
    alone: dict[str, _Alone] = {}
    for name, of_case in case_runs.items():
        with time_limit(limits[name]):
            alone[name] = _alone(loaded, loaded.cases[name], of_case)
    certified: dict[str, Certified] = {}
    for name, of_case in case_runs.items():
        # Paths that are too hard to compare in this time are not compared, which fails the case.
        with time_limit(limits[name]):
            result = _result(loaded, loaded.cases[name], settings[name], case_runs, alone)
        certified[name] = Certified(loaded.cases[name], result, of_case)
    return certified


def _alone(loaded: Loaded, case: Case, of_case: CaseRun) -> _Alone:
    if of_case.report is None:
        return _Alone([of_case.failure], None, _NOTHING)
    return _Alone([*expectations.differences(case, of_case.report)], *_golden(loaded, case, of_case))


def _result(
    loaded: Loaded,
    case: Case,
    settings: Settings,
    case_runs: Mapping[str, CaseRun],
    alone: Mapping[str, _Alone],
) -> CaseResult:
    """Return what came of a case."""
    report, itself = case_runs[case.title].report, alone[case.title]
    reasons = list(itself.reasons)
    remarks = [loaded.remarks[case.title]] if case.title in loaded.remarks else []
    same_path, compared = (None, _NOTHING) if report is None else _compared_with_reference(loaded, case, case_runs)
    outside = [] if report is None else case_runs[case.title].outside
    not_quoted = [quoting.remark(outside)] if outside else []
    is_golden_there = loaded.has_golden(case)
    # A golden trace that is not there yet is no news of a case that fails anyway.
    if is_golden_there or not (reasons or compared.reasons):
        reasons += itself.path.reasons
    if compared.reasons and case.same_path_as is not None:
        reference = loaded.cases[case.same_path_as]
        if is_golden_there and not itself.fails(True) and alone[reference.title].fails(loaded.has_golden(reference)):
            remarks.append(f"the path is not that of {reference.title}, which fails itself")
        else:
            reasons += compared.reasons
    return CaseResult(
        name=case.title,
        feature=case.feature,
        control=case.control,
        program=files.display_path(str(loaded.beside(case.program))),
        machine=settings.machine_id,
        state=_state(report is not None, reasons),
        expected=case.expected,
        verdict=None if report is None else report.verdict,
        reasons=reasons,
        remarks=[*remarks, *itself.path.remarks, *compared.remarks, *not_quoted],
        golden=itself.golden,
        same_path=same_path,
    )


_UPDATE = ": certify --update"
_NO_GOLDEN = f"no golden trace yet{_UPDATE}"
_NOTHING = near_path.Comparison(None, [], [])
_Compared = tuple[results.PathComparison | None, near_path.Comparison]


def _state(is_run: bool, reasons: Sequence[str]) -> str:
    if not is_run:
        return NOT_RUN
    is_golden_alone = len(reasons) == 1 and reasons[0].endswith(_UPDATE)
    return PASS if not reasons else NO_GOLDEN if is_golden_alone else FAIL


def _golden(loaded: Loaded, case: Case, of_case: CaseRun) -> _Compared:
    """Compare the path of a case with its golden trace."""
    if case.golden is None:
        return None, _NOTHING
    file, tolerance = loaded.beside(case.golden), loaded.tolerance(case)
    title = files.display_path(case.golden)
    if not file.exists():
        compared = near_path.Comparison(None, [_NO_GOLDEN], [])
    else:
        try:
            before = golden.read(file)
        except CertificateError as error:
            compared = near_path.Comparison(None, [str(error)], [])
        else:
            ours = of_case.golden_trace(loaded.path_of(case))
            compared = near_path.with_golden(ours, before, of_case.sense, tolerance, title)
        outside = loaded.outside([file])
        if compared.reasons and (of_case.outside or outside):
            compared = _without_text(compared, title, outside)
    return _comparison(title, compared, tolerance), compared


def path_of_run(of_case: CaseRun, name: str) -> ToolPath:
    """Return the path of a program by its name, tool or programmed; controls lift Z in the mode or behind it."""
    path = tool_path(of_case.moves[name], of_case.sense)
    return path[~path.is_z_alone]


def _compared_with_reference(loaded: Loaded, case: Case, case_runs: Mapping[str, CaseRun]) -> _Compared:
    """Compare the path of a case with that of another one."""
    if case.same_path_as is None:
        return None, _NOTHING
    title, which, tolerance = case.same_path_as, loaded.path_of(case), loaded.tolerance(case)
    of_case, reference = case_runs[case.title], case_runs[title]
    if reference.report is None:
        compared = _not_compared(f"{title} was not run")
    elif not of_case.moves[which] and not reference.moves[which]:
        compared = _not_compared(f"neither this program nor {title} has any")
    else:
        ours, theirs = path_of_run(of_case, which), path_of_run(reference, which)
        compared = near_path.with_other(ours, theirs, tolerance, title)
        if which == "tool" and compared.deviation is not None and compared.reasons:
            programmed = path_of_run(of_case, "programmed"), path_of_run(reference, "programmed")
            if not near_path.with_other(*programmed, tolerance, title).reasons:
                compared.reasons.append(
                    f"the programmed path is that of {title}: controls lead the tool round corners in different ways; "
                    'path = "programmed" compares what is programmed'
                )
        if compared.reasons and (of_case.outside or reference.outside):
            compared = _without_text(compared, title)
    return _comparison(title, compared, tolerance), compared


def _not_compared(why: str) -> near_path.Comparison:
    return near_path.Comparison(None, [f"the path is not compared: {why}"], [])


def _without_text(compared: near_path.Comparison, title: str, outside: Sequence[str] = ()) -> near_path.Comparison:
    """Return the same comparison without lines, points and feeds, since they come from files that are not quoted."""
    remarks = [quoting.remark(outside)] if outside else []
    return near_path.Comparison(compared.deviation, [f"the path is not that of {title}"], remarks)


def _comparison(reference: str, compared: near_path.Comparison, tolerance: float) -> results.PathComparison:
    deviation = compared.deviation
    is_number = deviation is not None and deviation < float("inf")
    return results.PathComparison(
        reference=reference,
        agrees=not compared.reasons,
        deviation=round(deviation, 6) if deviation is not None and is_number else None,
        tolerance=tolerance,
    )


def certificate(loaded: Loaded, certified: Mapping[str, Certified]) -> Certificate:
    """Return the certificate of the cases that were run; where only some were, that of their features and controls."""
    manifest = loaded.manifest
    is_whole = len(certified) == len(loaded.cases)
    of_cases = [entry.case for entry in certified.values()]
    features = [name for name in manifest.features if is_whole or any(case.feature == name for case in of_cases)]
    controls = [name for name in manifest.controls if is_whole or any(case.control == name for case in of_cases)]
    cells = [_cell(loaded, feature, control, certified) for feature in features for control in controls]
    cases = [certified[name].result for name in loaded.cases if name in certified]
    return Certificate(
        schema=results.SCHEMA,
        tool=Producer("polarcheck", __version__),
        title=manifest.title,
        manifest=files.display_path(str(loaded.path)),
        features=features,
        controls=controls,
        cells=cells,
        cases=cases,
        summary=results.summary(cases, cells),
    )


def _cell(loaded: Loaded, feature: str, control: str, certified: Mapping[str, Certified]) -> Cell:
    not_offered = loaded.manifest.controls[control].not_offered
    if feature in not_offered:
        return Cell(feature=feature, control=control, state=NOT_OFFERED, reason=not_offered[feature])
    names = [name for name, case in loaded.cases.items() if (case.feature, case.control) == (feature, control)]
    states = [certified[name].result.state for name in names if name in certified]
    state = results.worst(states) if states else NOT_RUN if names else MISSING
    return Cell(feature=feature, control=control, state=state, cases=[name for name in names if name in certified])
