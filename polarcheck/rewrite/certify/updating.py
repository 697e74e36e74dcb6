"""Golden traces written anew: what changes, and what stays because its case fails."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from polarcheck.foundation.errors import CertificateError, OutputError
from polarcheck.program.reading import files
from polarcheck.rewrite.certify import expectations, golden, near_path
from polarcheck.rewrite.certify.certifying import Certified
from polarcheck.rewrite.certify.loading import Loaded


def updates(loaded: Loaded, certified: Mapping[str, Certified], names: frozenset[str]) -> Iterator[tuple[str, bool]]:
    """
    Write the golden traces of the named cases, and yield a line on each, and whether it could be written.

    A case that fails for another reason than its golden trace keeps the one that it has. Raises CertificateError for
    two cases with one file, for a file outside of the folder of the manifest, and for one that holds anything else,
    before any is written.
    """
    requested = [entry for name, entry in certified.items() if name in names and entry.case.golden is not None]
    _refuse(loaded, requested)
    for entry in requested:
        yield _updated(loaded, entry)


def _refuse(loaded: Loaded, requested: list[Certified]) -> None:
    owners: dict[str, str] = {}
    for entry in requested:
        path = loaded.beside(entry.case.golden or "")
        title = files.display_path(str(path))
        owner = owners.setdefault(str(path.resolve()), entry.case.title)
        if owner != entry.case.title:
            raise CertificateError(
                f"{title}: is the golden trace of {owner} and of {entry.case.title}: give each its own"
            )
        if not path.resolve().is_relative_to(loaded.path.resolve().parent):
            raise CertificateError(
                f"{title}: lies outside of the folder of the manifest, and is not written: {entry.case.title} names it"
            )
        if path.exists() and not golden.is_golden(path):
            raise CertificateError(
                f"{title}: is no golden trace, and stays as it is: {entry.case.title} names another file"
            )


def _updated(loaded: Loaded, entry: Certified) -> tuple[str, bool]:
    """Write the golden trace of a case; return a line on it, and whether it could be written."""
    path = loaded.beside(entry.case.golden or "")
    title = files.display_path(str(path))
    report = entry.run.report
    if report is None:
        return f"{title}: not written, {entry.case.title} was not run: {entry.run.failure}", False
    reasons = [*expectations.differences(entry.case, report)]
    if entry.result.same_path is not None and not entry.result.same_path.agrees:
        reasons.append(f"its path is not that of {entry.result.same_path.reference}")
    if reasons:
        return f"{title}: not written, {entry.case.title} fails: {reasons[0]}", False
    text = "".join(golden.lines(entry.run.moves[loaded.path_of(entry.case)], entry.run.orders))
    is_new = not path.exists()
    if not is_new and path.read_text("utf-8") == text:
        return f"{title}: unchanged", True
    change = "new" if is_new else "rewritten" if entry.run.outside else _change(loaded, entry)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{files.display_path(str(path.parent))}: {error.strerror or error}") from None
    files.write(path, text, rewrites=True)
    return f"{title}: {change}", True


def _change(loaded: Loaded, entry: Certified) -> str:
    """Return what a new golden trace changes, in one line."""
    before = golden.read(loaded.beside(entry.case.golden or ""))
    if before.is_old:
        return "rewritten: with the moves outside of polar sections"
    ours, tolerance = entry.run.golden_trace(loaded.path_of(entry.case)), loaded.tolerance(entry.case)
    compared = near_path.with_golden(ours, before, entry.run.sense, tolerance, "the golden trace before")
    deviation = compared.deviation
    if compared.reasons:
        largest = f"largest deviation {deviation:.3f} mm; " if deviation is not None else ""
        return f"rewritten: {largest}{'; '.join(compared.reasons)}"
    return f"rewritten: the same path within {deviation:.3f} mm" if deviation is not None else "rewritten"
