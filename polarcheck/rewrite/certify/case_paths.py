"""The path of a case beside its golden trace, and beside that of the case whose path it should be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from polarcheck.foundation.errors import CertificateError
from polarcheck.program.reading import files
from polarcheck.rewrite.certify import golden, near_path, quoting, results
from polarcheck.rewrite.certify.case_runs import CaseRun
from polarcheck.rewrite.certify.loading import Loaded
from polarcheck.rewrite.certify.manifest import Case
from polarcheck.rewrite.certify.tool_path import ToolPath, tool_path

#: The end of a reason that a new golden trace answers.
UPDATE = ": certify --update"
_NO_GOLDEN = f"no golden trace yet{UPDATE}"
#: Of a case whose path is compared with none.
NOTHING = near_path.Comparison(None, [], [])
_Compared = tuple[results.PathComparison | None, near_path.Comparison]


def with_golden(loaded: Loaded, case: Case, of_case: CaseRun) -> _Compared:
    """Compare the path of a case with its golden trace."""
    if case.golden is None:
        return None, NOTHING
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


def with_reference(loaded: Loaded, case: Case, case_runs: Mapping[str, CaseRun]) -> _Compared:
    """Compare the path of a case with that of another one."""
    if case.same_path_as is None:
        return None, NOTHING
    title, which, tolerance = case.same_path_as, loaded.path_of(case), loaded.tolerance(case)
    of_case, reference = case_runs[case.title], case_runs[title]
    if reference.report is None:
        compared = _not_compared(f"{title} was not run")
    elif not of_case.moves[which] and not reference.moves[which]:
        compared = _not_compared(f"neither this program nor {title} has any")
    else:
        ours, theirs = _path_of_run(of_case, which), _path_of_run(reference, which)
        compared = near_path.with_other(ours, theirs, tolerance, title)
        if which == "tool" and compared.deviation is not None and compared.reasons:
            programmed = _path_of_run(of_case, "programmed"), _path_of_run(reference, "programmed")
            if not near_path.with_other(*programmed, tolerance, title).reasons:
                compared.reasons.append(
                    f"the programmed path is that of {title}: controls lead the tool round corners in different ways; "
                    'path = "programmed" compares what is programmed'
                )
        if compared.reasons and (of_case.outside or reference.outside):
            compared = _without_text(compared, title)
    return _comparison(title, compared, tolerance), compared


def _path_of_run(of_case: CaseRun, name: str) -> ToolPath:
    """Return the path of a program by its name, tool or programmed; controls lift Z in the mode or behind it."""
    path = tool_path(of_case.moves[name], of_case.sense)
    return path[~path.is_still]


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
