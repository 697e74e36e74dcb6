"""What compare calls the same is the same to check and to part; a slip that either of them sees is a difference."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
from cases import looped
from click.testing import CliRunner
from programs import report_of, tables_of
from setter_programs import Program, drawn
from single_slips import SLIPS, planted

from polarcheck.commands import main
from polarcheck.reports.made_parts.part_report import made_by

#: compare leaves comments out, and says so.
_OF_PROGRAMS = tuple(slip for slip in SLIPS if "comment" not in slip.name)
_LINES = re.compile(r"lines? \d+(?:, \d+| and \d+)*")


def said_of(program: Program) -> tuple[list[tuple[str, str]], list[str]]:
    """What check and part say of a program, without lines."""
    text, machine, tools = program.text(), program.machine, program.tools()
    findings = report_of(text, machine, *tools).findings
    shapes = made_by(tables_of(text, machine, *tools))
    return [(finding.rule, _LINES.sub("line", finding.message)) for finding in findings], [
        shape.text for shape in shapes
    ]


@pytest.mark.ci
@looped("seed", range(400), one_in=130)
def test_what_is_the_same_is_so_to_check_and_part(seed: int, tmp_path: Path) -> None:
    draw = random.Random(f"slip {seed}")  # noqa: S311 - programs that can be written again
    sound = drawn(draw.randrange(10**6))
    slip = planted(_OF_PROGRAMS[seed % len(_OF_PROGRAMS)], sound, draw)
    if slip is None:
        return
    programs = sound, slip.program
    options = ["--machine", sound.machine, "--no-config"]
    options += [option for tool in sound.tools() for option in ("--tool", tool)]
    files = [tmp_path / name for name in ("old.nc", "new.nc")]
    for file, program in zip(files, programs, strict=True):
        file.write_text(program.text(), "utf-8")
    result = CliRunner().invoke(main, ["compare", *options, *map(str, files)])
    assert result.exit_code in (0, 1, 2)
    if result.exit_code == 0:
        assert said_of(sound) == said_of(slip.program), result.stdout
