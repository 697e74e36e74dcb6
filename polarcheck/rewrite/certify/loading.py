"""Reads a manifest: every name in it is known, and every feature of a control has its cases or is missing."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.foundation.errors import CertificateError, enumerated, suggestion
from polarcheck.program.machines import toml_lines, toml_text
from polarcheck.program.machines.value_types import MisfitError, display, fitted
from polarcheck.program.reading import files
from polarcheck.rewrite.certify import quoting
from polarcheck.rewrite.certify.manifest import PLACE, Case, Conditions, Manifest
from polarcheck.rules.rule import load_all

#: Keys whose values are files; a machine may be the name of a built-in one.
_FILES = ("config", "drawing", "machine", "offsets")
#: How far a path may be from another one unless the manifest says so [mm]: ten least increments.
_TOLERANCE = 0.01


class Loaded(msgspec.Struct, frozen=True):
    """
    A manifest as it was read.

    path: the file.
    text: its text, to find the lines of keys.
    table: its values as written.
    manifest: its values.
    cases: the cases by name: first those of [[case]], then those of `programs`.
    numbers: the number of the [[case]] of a case, from 1, by name.
    remarks: what is not compared although the manifest asks for it, by name of the case.
    """

    path: Path
    text: str
    table: Mapping[str, Any]
    manifest: Manifest
    cases: Mapping[str, Case]
    numbers: Mapping[str, int]
    remarks: Mapping[str, str]

    def beside(self, written: str) -> Path:
        """Return the path of a file that the manifest names; backslashes count as slashes, too."""
        return _path_from(self.path, written)

    def outside(self, paths: Iterable[str | os.PathLike[str]]) -> list[str]:
        """Return the files among the paths that lie neither below its folder nor below the working folder."""
        return quoting.outside((self.path.parent, Path()), paths)

    def named_files(self) -> Iterator[str]:
        """Yield the drawings, tables and settings that the manifest names, of each case and of none."""
        remaining: list[Any] = [self.table]
        while remaining:
            value = remaining.pop()
            if isinstance(value, Mapping):
                yield from (value[key] for key in _FILES if isinstance(value.get(key), str))
                remaining += value.values()
            elif isinstance(value, list):
                remaining += value

    def without_programs(self) -> Iterator[str]:
        """Yield a line for each control whose `programs` finds no file at all, as one with a slip in it."""
        for name, control in self.manifest.controls.items():
            of_control = [case for title, case in self.cases.items() if title not in self.numbers]
            if control.programs is not None and not any(case.control == name for case in of_control):
                key = f"controls.{name}.programs"
                yield f"{_location(self.path, self.text, key)}: {key}: there is no file {control.programs}"

    def has_golden(self, case: Case) -> bool:
        """Return True if the golden trace of a case is there."""
        return case.golden is not None and self.beside(case.golden).exists()

    def tolerance(self, case: Case) -> float:
        """Return the tolerance of paths of a case [mm]."""
        tolerances = (of.tolerance for of in self._nearest(case))
        return next((tolerance for tolerance in tolerances if tolerance is not None), _TOLERANCE)

    def path_of(self, case: Case) -> str:
        """Return which path of a case is compared: tool or programmed."""
        return next((of.path for of in self._nearest(case) if of.path is not None), "tool")

    def _nearest(self, case: Case) -> tuple[Conditions, ...]:
        return case, self.manifest.controls[case.control], self.manifest


def load(path: Path) -> Loaded:
    """Read a manifest. Raises CertificateError, which names file, line and key."""
    try:
        text = toml_text.text_of(path, "manifest", pipes=True)
        table = toml_text.parsed(text)
    except ValueError as error:
        raise CertificateError(toml_lines.placed(files.display_path(str(path)), str(error))) from None
    try:
        manifest = fitted(table, Manifest)
        cases, numbers = _written(manifest)
        _check(manifest)
        for control in manifest.controls:
            for case in _by_pattern(path, manifest, control, cases.values()):
                cases.setdefault(case.title, case)
        cases, remarks = _with_references(manifest, cases, numbers)
    except MisfitError as misfit:
        raise CertificateError(f"{_location(path, text, misfit.key)}: {misfit}") from None
    return Loaded(path, text, table, manifest, cases, numbers, remarks)


def _location(path: Path, text: str, key: str) -> str:
    """Return the file and the line of a key: post.toml:12."""
    line = toml_lines.line_of(key, toml_lines.of_keys(text))
    return f"{files.display_path(str(path))}:{line}" if line else files.display_path(str(path))


def _path_from(path: Path, written: str) -> Path:
    path_as_written = path.parent / written
    return (
        path.parent / written.replace("\\", "/")
        if "\\" in written and not path_as_written.exists()
        else path_as_written
    )


def _written(manifest: Manifest) -> tuple[dict[str, Case], dict[str, int]]:
    """Return the [[case]] entries and their numbers by name."""
    cases: dict[str, Case] = {}
    for number, case in enumerate(manifest.case, 1):
        if case.title in cases:
            raise MisfitError(
                f"case.{number}",
                f"case.{number}: a case {display(case.title)} is there already; give name = a name of its own",
            )
        cases[case.title] = case
    return cases, {title: number for number, title in enumerate(cases, 1)}


def _require_name(key: str, name: str, names: Collection[str], what: str) -> None:
    """Raise MisfitError for a name that is not among those of a kind."""
    if name not in names:
        near = suggestion(name, names) or (f"; there are {enumerated(names, 'or')}" if names else "; there is none")
        raise MisfitError(key, f"{key}: no {what} {display(name)}{near}")


def _check(manifest: Manifest) -> None:
    """Raise MisfitError for a name that nothing has, and for values that contradict each other."""
    features, controls, rules = manifest.features, manifest.controls, load_all()
    twice = next((name for number, name in enumerate(features) if name in features[:number]), None)
    if twice is not None:
        raise MisfitError("features", f"features: {display(twice)} is there twice")
    if not controls:
        raise MisfitError("controls", "controls: expected at least one, as in [controls.lathe-7]")
    for name in manifest.feature:
        _require_name(f"feature.{name}", name, features, "feature")
    for name, control in controls.items():
        key = f"controls.{name}"
        for pattern in ("programs", "golden"):
            written = getattr(control, pattern)
            if written is not None and PLACE not in written:
                raise MisfitError(
                    f"{key}.{pattern}", f"{key}.{pattern}: expected {PLACE} in the name, found {display(written)}"
                )
        if control.golden is not None and control.programs is None:
            raise MisfitError(f"{key}.golden", f"{key}.golden: is for the programs of {key}.programs, which is missing")
        if control.same_path_as is not None:
            rivals = [second for second in controls if second != name]
            _require_name(f"{key}.same_path_as", control.same_path_as, rivals, "other control")
        for feature in control.not_offered:
            _require_name(f"{key}.not_offered.{feature}", feature, features, "feature")
    for number, case in enumerate(manifest.case, 1):
        key = f"case.{number}"
        _require_name(f"{key}.feature", case.feature, features, "feature")
        _require_name(f"{key}.control", case.control, controls, "control")
        if case.feature in controls[case.control].not_offered:
            raise MisfitError(f"{key}.feature", f"{key}.feature: {case.control} does not offer {case.feature}")
        for index, finding in enumerate(case.findings, 1):
            _require_name(f"{key}.findings.{index}.rule", finding.rule, rules, "rule")


def _by_pattern(path: Path, manifest: Manifest, name: str, cases: Collection[Case]) -> Iterator[Case]:
    """
    Yield the cases of `programs` of a control: for each feature that has no case to pass, if there is a file.

    A golden trace without its program is a case, too: the program is lost.
    """
    control = manifest.controls[name]
    if control.programs is None:
        return
    written = {case.feature for case in cases if case.control == name and case.expected == "pass"}
    for feature in manifest.features:
        if feature in written or feature in control.not_offered:
            continue
        program = control.programs.replace(PLACE, feature)
        golden = control.golden.replace(PLACE, feature) if control.golden is not None else None
        if any(_path_from(path, file).exists() for file in (program, golden) if file is not None):
            yield Case(feature=feature, control=name, program=program, golden=golden)


def _with_references(
    manifest: Manifest, cases: Mapping[str, Case], numbers: Mapping[str, int]
) -> tuple[dict[str, Case], dict[str, str]]:
    """
    Return the cases with the case whose path they share, and a remark for each that lacks it.

    Raises MisfitError for a case that is not there, and for cases that refer to each other in a circle.
    """
    referring: dict[str, Case] = {}
    remarks: dict[str, str] = {}
    for title, case in cases.items():
        reference_control = manifest.controls[case.control].same_path_as
        if case.same_path_as is None and reference_control is not None and case.expected == "pass":
            reference = f"{case.feature}/{reference_control}"
            if reference in cases:
                case = msgspec.structs.replace(case, same_path_as=reference)
            else:
                remarks[title] = f"the path is not compared: {reference_control} has no case {reference}"
        elif case.same_path_as is not None:
            _require_name(f"case.{numbers[title]}.same_path_as", case.same_path_as, [*cases], "case")
        referring[title] = case
    for title, case in referring.items():
        passed = {title}
        while case.same_path_as is not None:
            if case.same_path_as in passed:
                key = (
                    f"case.{numbers[title]}.same_path_as"
                    if title in numbers
                    else f"controls.{case.control}.same_path_as"
                )
                raise MisfitError(key, f"{key}: {title} is compared with itself by {enumerated(sorted(passed), 'or')}")
            passed.add(case.same_path_as)
            case = referring[case.same_path_as]
    return referring, remarks
