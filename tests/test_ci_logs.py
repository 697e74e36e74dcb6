"""No command begins a line with a command to the log of a CI job, whatever files, folders and cases are called."""

from __future__ import annotations

import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from test_cli import GOOD, RAPID, call

from polarcheck.commands import main

pytestmark = [
    pytest.mark.usefixtures("own_folder"),
    pytest.mark.skipif(sys.platform == "win32", reason="no file of Windows has : in its name"),
]

#: What GitHub, its older runners and Azure take for a command at the head of a line, behind blanks as well.
COMMAND = re.compile(r"^\s*(?:::|##[A-Za-z]*\[)", re.MULTILINE)
NAMES = ("::error::x", "  ::add-mask::x", "::", "##[error]x", "##vso[task.setvariable variable=a]x", "a\n::error::x")

UNCOMPENSATED = "T0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX-40.\nC-10.\nX40.\nC0\nX60.\nG13.1\nM30\n"
PLAIN = "G98 G0 X60. C0\nG1 X40. F200\n" + "".join(f"X{40 - n / 10:.3f} C{n}.\n" for n in range(30)) + "M30\n"

#: The calls of each command, with `;` between: `@` is a planted name, and files have that name with an ending.
CALLS = {
    name: [" ".join(call.split()) for call in calls.split(";")]
    for name, calls in {
        "baseline create": "@.nc -o @.json; @d -o ./@.json; @.gone; @.nc -o @d; @.nc --config @.broken",
        "baseline prune": "@.nc -o @.base; @.nc -o @.gone; @.nc -o @.broken",
        "baseline update": "@.nc -o @.base --reason @; @.nc -o @.gone; @.nc -o @.broken",
        "certify": """
            @.toml; @.toml --format json; @.toml --case @; @.toml --case @x; @.gone; @.broken; init @suite; init
            @suite/.. --machine @.lathe; @.toml -o text:@.out; @.toml --update; @.toml @d; @.toml -o
            json:@.toml; @.toml -o html:@d
        """,
        "check": """
            @.nc; @d; @.gone; @.nc --format concise; @.nc --format short; @.nc --show path; @.long --diff
            --unsafe-fixes; @.nc --format json; @.nc --format sarif; @.nc --format junit; @.nc --show-files; @d
            --show-files; @.nc --machine @.lathe; @.nc --machine @; @.nc --offsets @.gone; @.nc --config
            @.broken; @d/@.nc @.nc; @.nc --drawing @.broken; @.nc -o json:@.json; @.nc -o json:@d; @.nc -o @;
            @.nc --baseline @.broken; @.nc --baseline @.base; @.nc --select @; @.nc --tool @; @.nc --set @; @.nc
            --diff --unsafe-fixes; @d --diff-base @; @.nc --with-callers; @.nc --stdin-filename @.nc; @.nc
            --subprograms @d; @.nc --fix; @.nc --color always; @.long; @.nc --exclude @.nc; @.nc --severity @;
            @.nc --encoding @
        """,
        "compare": """
            @.nc @.new; @d @e; @.nc @.gone; @.nc @d; @.nc; /dev/null @.nc; @.nc @.new --format json; @.nc @.nc
        """,
        "compensate": """
            @.uncompensated --tool 1:radius=4; @.uncompensated --tool 1:radius=4 --diff; @.nc -o @.out; @.gone;
            @.nc --diff; @.nc -o @.base; @d -o @.out
        """,
        "completion": "@; bash @; bash",
        "config show": "@.nc; @.gone; @.nc --config @.broken; @.nc --config @.job; @.nc --machine @.lathe; @d",
        "convert": """
            @.new --to fanuc-30i;
            @.nc --to haas-lathe; @.nc --to @.lathe -o @.out; @.nc --to @; @.gone --to haas-lathe; @d --to fanuc
        """,
        "explain": "@; overcut @.nc; PS0146 @.gone; overcut --machine @.lathe; overcut --machine @.broken",
        "feeds": "@.nc; @.nc --format csv; @.nc --diff; @.gone; @.nc --format json; @.nc --machine @.lathe",
        "init": "@d; @e --no-schema --machine @.lathe; @.gone; --part @.nc; @d --machine @; --part @.gone",
        "machines": """
            @; @.lathe; check @.lathe; check @.broken; check @.gone; new @made --from @.lathe; new @; new @ @;
            new @made --from @.broken; @.broken; new @short --short; check @.nc
        """,
        "part": "@.nc; @d; @.gone; @.nc --format json; @.nc --drawing @.broken; @.nc --machine @.lathe",
        "plot": "@.nc -o @.html; @.nc; @.gone; @d -o @pages; @.nc -o @.nc; @.nc --png @.base; @.nc --serve -o @",
        "roll": "@.plain; @.plain --diff; @.nc; @.nc -o @.out; @.gone; @.nc --diff; @d",
        "rules": "; @; --format @",
        "schema": "@; report @; ",
        "server": "@; --config @",
        "trace": "@.nc; @.nc --format table; @.nc --format json; @.nc --show path; @.gone; @.nc --machine @.lathe",
        "unroll": "@.nc; @.nc -o @.out; @.gone; @.long --diff; @d",
    }.items()
}


def registered() -> Iterator[str]:
    """The words that call each command, those of groups, too."""
    for name, command in main.commands.items():
        inner = command.commands if isinstance(command, click.Group) else {}
        yield from (f"{name} {verb}" for verb in inner) if inner else (name,)


def plant(name: str) -> None:
    """Files and folders of this name, with an ending of each kind."""
    lathe = 'inherits = "fanuc-30i"\n'
    toml = name.replace("\n", "\\n")
    cases = (("", "nc", ""), ("1", "gone", ""), ("2", "nc", "golden"), ("3", "new", "new.jsonl"))
    manifest = f'title = "{toml}"\n[controls.c]\nmachine = "{toml}.lathe"\n' + "".join(
        f'[[case]]\nname = "{toml}{number}"\nfeature = "contour"\ncontrol = "c"\nprogram = "{toml}.{program}"\n'
        + (f'golden = "{toml}.{golden}"\n' if golden else "")
        for number, program, golden in cases
    )
    texts = {
        "nc": f"({name})\n{RAPID}",
        "new": GOOD,
        "long": f"{RAPID * 3}::error::x\n  ::error::x\n",
        "lathe": lathe,
        "toml": manifest,
        "job": f'machine = "{toml}.lathe"\n',
        "uncompensated": UNCOMPENSATED,
        "plain": PLAIN,
        "broken": f'"{toml}" = [1, "{toml}"]\n',
        "golden": "no golden trace\n",
        "d/O1.nc": RAPID,
        f"d/{name}.nc": f"G0 X1.\n{RAPID}",
        f"d/{name}2.nc": RAPID,
        f"e/{name}.nc": GOOD,
        f"e/{name}3.nc": GOOD,
    }
    for ending, text in texts.items():
        path = Path(f"{name}{ending}" if "/" in ending else f"{name}.{ending}")
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)


def test_each_command_has_its_calls() -> None:
    assert set(registered()) == set(CALLS)


@pytest.mark.ci
@pytest.mark.one_in(44)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("command", CALLS)
def test_no_line_of_a_command_begins_as_one_of_a_ci_log(command: str, name: str) -> None:
    plant(name)
    call("baseline", "create", f"./{name}.nc", "-o", f"{name}.base")
    codes = set()
    for arguments in CALLS[command]:
        words = [word.replace("@", name) for word in shlex.split(arguments)]
        result = call(*command.split(), *words, given="M30\n")
        codes.add(result.exit_code)
        assert not COMMAND.search(result.stdout), (arguments, result.stdout)
        assert not COMMAND.search(result.stderr), (arguments, result.stderr)
    # Of each command there are calls that do what they are asked for, and calls that fail.
    assert codes <= {0, 1, 2}
    assert codes & {0, 1} or command == "server"
    assert 2 in codes
