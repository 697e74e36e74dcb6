"""How a case is checked: the values of the manifest, of its feature, its control and its own, the nearest last."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.files.settings import job_files, job_layers
from polarcheck.files.settings.job_files import JobFile
from polarcheck.files.settings.job_layers import Layer, Merged, PartLayer, Written
from polarcheck.files.settings.of_programs import Options, SettingsMaker
from polarcheck.foundation.errors import JobError
from polarcheck.foundation.record import Remembered, recorded
from polarcheck.program.machines.job import Job
from polarcheck.rewrite.certify.loading import Loaded
from polarcheck.rewrite.certify.manifest import Case

#: The keys of a manifest that are keys of a job.
_OF_JOB = frozenset(field.name for field in msgspec.structs.fields(Job)) - {
    *("extend", "exclude", "extensions", "programs", "part")
}


class _Within(Layer):
    """
    The values of a table of the manifest.

    place: the key of the table, `controls.lathe-7`; empty for the manifest itself.
    """

    def __init__(self, written: Written, table: Mapping[str, Any], path: str) -> None:
        super().__init__(written, {key: value for key, value in table.items() if key in _OF_JOB})
        self._place = path

    @property
    def title(self) -> str:
        return f"{self.written.path}: {self._place}" if self._place else str(self.written.path)

    def at(self, key: str) -> str:
        return self.written.at(f"{self._place}.{key}" if self._place else key)


class _CaseFile(JobFile, frozen=True):
    """The layers of a case in the place of those of a job file."""

    of_case: tuple[Layer, ...] = ()

    @property
    def paths(self) -> list[Path]:
        return list(dict.fromkeys(layer.written.path for layer in self.of_case))

    def merged(self, layers: object, over: Sequence[Layer] = ()) -> Merged:
        return job_layers.merged([*self.of_case, *over])


class ConditionsOfCases:
    """Returns the settings of each case of a manifest. Raises a PolarcheckError that names file, line and key."""

    def __init__(self, loaded: Loaded) -> None:
        self._loaded = loaded
        self._written = Written(loaded.path, loaded.text)
        self._maker = SettingsMaker(Options(use_config=False))
        self._configs: Remembered[Path, JobFile] = Remembered()

    def __call__(self, case: Case) -> Settings:
        with recorded() as read:
            settings = self._maker.settings(_CaseFile(self._loaded.path, (), tuple(self._layers(case))), ())
        return msgspec.structs.replace(settings, read=[*read.paths])

    def _layers(self, case: Case) -> Iterator[Layer]:
        """Yield the layers of a case, the nearest last."""
        table, number = self._loaded.table, self._loaded.numbers.get(case.title)
        yield from self._of_table(table, "", case)
        yield from self._parts(table.get("feature", {}).get(case.feature, {}), f"feature.{case.feature}")
        yield from self._of_table(table["controls"][case.control], f"controls.{case.control}", case)
        if number is not None:
            yield from self._of_table(table["case"][number - 1], f"case.{number}", case)

    def _of_table(self, table: Mapping[str, Any], key: str, case: Case) -> Iterator[Layer]:
        if "config" in table:
            yield from self._config(table["config"], f"{key}.config" if key else "config", case)
        yield _Within(self._written, table, key)
        yield from self._parts(table, key)

    def _parts(self, table: Mapping[str, Any], key: str) -> Iterator[Layer]:
        for number, part in enumerate(table.get("part", ()), 1):
            yield PartLayer(self._written, part, number, key)

    def _config(self, written: str, key: str, case: Case) -> Iterator[Layer]:
        """Yield the layers of a job file that apply to the program of a case."""
        path = self._loaded.beside(written)
        try:
            file = self._configs.get(path, lambda: job_files.load(path))
        except JobError as error:
            raise JobError(f"{self._written.at(key)}: {key}: {error}") from None
        program = self._loaded.beside(case.program)
        for layer in file.layers(os.path.realpath(program.parent), program.name):
            yield file.layer(*layer)
