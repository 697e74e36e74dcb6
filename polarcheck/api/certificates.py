"""`polarcheck.certify`: the programs of a post beside a manifest."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from polarcheck.api.keywords import path_of
from polarcheck.api.values import names, whole
from polarcheck.program.reading import files
from polarcheck.rewrite.certify import certifying
from polarcheck.rewrite.certify.loading import load
from polarcheck.rewrite.certify.results import Certificate


def certify(path: str | Path, *, cases: Iterable[str] = (), max_size: int = files.LARGEST) -> Certificate:
    """
    Return the certificate of a post: its programs beside what a manifest says of them. Golden traces are read only.

    path: of the manifest. cases: names of the cases to run; all without any. max_size: of a program [bytes].

    Raises CertificateError, JobError or MachineError for a manifest that cannot be used, UsageError for a case that
    it does not have.
    """
    function = "polarcheck.certify()"
    manifest = path_of(function, path, "the path of a manifest")
    most = whole(f"{function}: max_size", max_size, 0, files.LARGEST)
    chosen_cases = names(f"{function}: cases", cases)
    loaded = load(Path(manifest))
    chosen = certifying.chosen(loaded, chosen_cases, f"{function}: cases")
    settings = certifying.conditions(loaded, certifying.needed(loaded, chosen))
    case_runs = dict(certifying.runs(loaded, settings, most))
    bug = next((run.bug for run in case_runs.values() if run.bug is not None), None)
    if bug is not None:
        raise bug
    certified = certifying.certified_cases(loaded, settings, case_runs)
    return certifying.certificate(loaded, {name: certified[name] for name in chosen})
