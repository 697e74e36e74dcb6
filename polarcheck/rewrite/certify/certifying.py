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
from polarcheck.rewrite.certify import expectations, near_path, quoting, results
from polarcheck.rewrite.certify.case_paths import NOTHING, UPDATE, with_golden, with_reference
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
        return _Alone([of_case.failure], None, NOTHING)
    return _Alone([*expectations.differences(case, of_case.report)], *with_golden(loaded, case, of_case))


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
    same_path, compared = (None, NOTHING) if report is None else with_reference(loaded, case, case_runs)
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


def _state(is_run: bool, reasons: Sequence[str]) -> str:
    if not is_run:
        return NOT_RUN
    is_golden_alone = len(reasons) == 1 and reasons[0].endswith(UPDATE)
    return PASS if not reasons else NO_GOLDEN if is_golden_alone else FAIL


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
