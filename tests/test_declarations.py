"""A setting is declared once: option, keyword, key of polarcheck.toml and the pages have it from there."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest
from programs import ROOT

from polarcheck.api.keywords import CheckKeywords
from polarcheck.commands.check import check
from polarcheck.files.settings.declarations import SETTINGS, Setting
from polarcheck.files.settings.of_programs import Options
from polarcheck.program.machines.job import Job

#: What no program has by itself: they choose programs. `--units` is `program_units` in Python, as in polarcheck.toml.
_OF_WALKS, _OTHER_KEYWORD = {"exclude", "extensions"}, {"units": "program_units"}


@pytest.mark.parametrize("setting", SETTINGS.values(), ids=SETTINGS)
def test_a_declaration_is_an_option_a_keyword_a_key_and_a_row(setting: Setting) -> None:
    (option,) = (parameter for parameter in check.params if parameter.name == setting.name)
    flags = [*option.opts, *option.secondary_opts]
    assert setting.flag in flags
    assert option.envvar == "POLARCHECK_" + option.opts[0][2:].upper().replace("-", "_")
    if setting.name not in _OF_WALKS:
        assert _OTHER_KEYWORD.get(setting.name, setting.name) in CheckKeywords.__annotations__
        assert setting.name in Options.__struct_fields__
    if setting.key:
        kind: Any = Job
        for part in setting.key.split("."):
            kind = next(field.type for field in msgspec.structs.fields(kind) if field.name == part)
        assert f"| `{setting.key}` |" in (ROOT / "docs" / "configuration.md").read_text("utf-8")


def test_each_option_of_programs_is_declared() -> None:
    apart = {"extras", "gives_verdicts", "named", "keywords", "use_config", "baseline", "use_baseline"}
    assert set(Options.__struct_fields__) - apart == SETTINGS.keys() - {"extensions"}
