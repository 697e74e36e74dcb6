"""What a baseline knows may not grow: depth and feed of rules by which the tool cuts where it must not, by program."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from programs import job_of, machine_of, settings_of
from test_known_places import FILE, call, write

from polarcheck.checking import check
from polarcheck.checking.block_outline import with_outline
from polarcheck.files.baselines.baseline import Baseline
from polarcheck.files.baselines.baseline_file import Contents, read
from polarcheck.foundation.finding import FileReport
from polarcheck.rules.examples import Example, examples
from polarcheck.rules.rule import Rule, load_all

pytestmark = pytest.mark.usefixtures("own_folder")

RULES = load_all()
GOUGING = [rule for rule in RULES.values() if rule.gouges]
OPTIONS = ("--tool", "1:radius=4", "--ignore", "setup,silence")


def narrow(z: str, feed: str) -> str:
    """A groove narrower than the cutter."""
    return (
        f"O1\nT0101\nG98 G0 X100. C0 Z2.\nG1 Z{z} F150\nG12.1\nG1 C20. F{feed}\nG41 X60.\nC3.\nX40.\nC-3.\nX60.\n"
        "C-20.\nG40 X100.\nG13.1\nG0 Z50.\nM30\n"
    )


def through(z: str, feed: str) -> str:
    """A path through the center of C."""
    return f"O2\nT0101\nG98 G0 X60. C0 Z2.\nG1 Z{z} F{feed}\nG12.1\nG1 X-40.\nC10.\nX60.\nG13.1\nG0 Z50.\nM30\n"


def through_inch(z: str, feed: str) -> str:
    """The same in inch."""
    return f"O3\nG20\nT0101\nG98 G0 X2.5 C0 Z.1\nG1 Z{z} F{feed}\nG12.1\nG1 X-1.6\nC.4\nX2.5\nG13.1\nG0 Z2.\nM30\n"


def in_steps(z: str, feed: str) -> str:
    """The same in increments of Z."""
    return (
        f"O4\nT0101\nG98 G0 X60. C0 Z2.\nG1 W{float(z) - 2:.1f} F{feed}\nG12.1\nG1 X-40.\nC10.\nX60.\nG13.1\n"
        "G0 Z50.\nM30\n"
    )


def by_variable(z: str, feed: str) -> str:
    """The same in a loop, whose last pass is the deepest."""
    return (
        f"O5\nT0101\n#1=-.1\nWHILE[#1GT{z}]DO1\n#1=#1-.4\nG98 G0 X60. C0 Z2.\nG1 Z#1 F{feed}\nG12.1\nG1 X-40.\n"
        "C10.\nX60.\nG13.1\nEND1\nG0 Z50.\nM30\n"
    )


def by_call(z: str, feed: str) -> str:
    """The same in a subprogram of the file, which is called at two depths."""
    return (
        f"O6\nT0101\nG98 G0 X60. C0 Z2.\nF{feed}\nG1 Z-.2\nM98 P7\nG1 Z{z}\nM98 P7\nG0 Z50.\nM30\n"
        "O7\nG12.1\nG1 X-40.\nC10.\nX60.\nC0\nG13.1\nM99\n"
    )


def by_called_file(z: str, feed: str) -> str:
    """The same in a subprogram that is a file of its own."""
    Path("subs").mkdir(exist_ok=True)
    Path("subs/O0007.nc").write_text("O7\nG12.1\nG1 X-40.\nC10.\nX60.\nC0\nG13.1\nM99\n")
    return f"O6\nT0101\nG98 G0 X60. C0 Z2.\nF{feed}\nG1 Z-.2\nM98 P7\nG1 Z{z}\nM98 P7\nG0 Z50.\nM30\n"


def per_revolution(z: str, feed: str) -> str:
    """The same with F for each turn."""
    return through(z, feed).replace("G98", "G99")


def on_siemens(z: str, feed: str) -> str:
    """The same on another control."""
    return (
        f"T1 D1\nG94 G90 DIAMON\nG0 X60 Z2\nSPOS=0\nG1 Z={z} F{feed}\nTRANSMIT\nG1 X-40\nY10\nX60\nTRAFOOF\n"
        "G0 Z50\nM30\n"
    )


def create(program: str, *options: str) -> None:
    write(a=program)
    assert call("baseline create", "a.nc", "-q", "-o", FILE, options=(*OPTIONS, *options)).output == ""


def told(*options: str) -> list[str]:
    """What of each finding is worse, by its rule; "new" for one that is not known."""
    result = call("check", "a.nc", "--baseline", FILE, "--format", "concise", options=(*OPTIONS, *options))
    said = re.findall(r"(?m)(?:; worse than in the baseline: (.*))? \[([a-z-]+)\]$", result.stdout)
    return [f"{rule}: {growth or 'new'}" for growth, rule in said]


SUBS = ("--subprograms", "subs")
SIEMENS = ("--machine", "siemens-transmit")
Program = Callable[[str, str], str]
Numbers = tuple[str, str]
CENTER, NARROW = "path-through-center", "interference"


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("program", "old", "new", "expected", "options"),
    [
        (narrow, ("-.5", "150"), ("-9.", "900"), f"{NARROW}: known with Z -0.5, now -9, known with F 150, now 900", ()),
        (narrow, ("-.5", "150"), ("-.52", "150"), f"{NARROW}: known with Z -0.5, now -0.52", ()),
        (narrow, ("-.5", "150"), ("-.5", "170"), f"{NARROW}: known with F 150, now 170", ()),
        (narrow, ("-.5", "150"), ("-.5", "152"), "", ()),
        (narrow, ("-.5", "150"), ("-.501", "150."), "", ()),
        (narrow, ("-.5", "150"), ("-.3", "20"), "", ()),
        (narrow, ("48.", "150"), ("47.9", "150"), f"{NARROW}: known with Z 48, now 47.9", ()),
        (through, ("-.5", "200"), ("-20.", "200"), f"{CENTER}: known with Z -0.5, now -20", ()),
        (through, ("-20.", "200"), ("-.5", "100"), "", ()),
        (through_inch, ("-.02", "8."), ("-.0201", "8.1"), "", ()),
        (through_inch, ("-.02", "8."), ("-.8", "8."), f"{CENTER}: known with Z -0.508, now -20.32", ()),
        (through_inch, ("-.02", "8."), ("-.02", "80."), f"{CENTER}: known with F 203.2, now 2032", ()),
        (in_steps, ("-.5", "200"), ("-5.", "200"), f"{CENTER}: known with Z -0.5, now -5", ()),
        (by_variable, ("-.5", "200"), ("-4.1", "200"), f"{CENTER}: known with Z -0.5, now -4.1", ()),
        (by_call, ("-.5", "200"), ("-5.", "200"), f"{CENTER}: known with Z -0.5, now -5", ()),
        (by_call, ("-.5", "200"), ("-.3", "900"), f"{CENTER}: known with F 200, now 900", ()),
        (by_called_file, ("-.5", "200"), ("-5.", "200"), f"{CENTER}: known with Z -0.5, now -5", SUBS),
        (by_called_file, ("-.5", "200"), ("-.5", "900"), f"{CENTER}: known with F 200, now 900", SUBS),
        (per_revolution, ("-.5", ".1"), ("-.5", ".6"), f"{CENTER}: known with F per revolution 0.1, now 0.6", ()),
        (on_siemens, ("-.5", "200"), ("-20.", "200"), f"{CENTER}: known with Z -0.5, now -20", SIEMENS),
    ],
)  # fmt: skip
def test_deeper_or_faster_is_worse(
    program: Program, old: Numbers, new: Numbers, expected: str, options: tuple[str, ...]
) -> None:
    create(program(*old), *options)
    assert told(*options) == []
    write(a=program(*new))
    assert [line for line in told(*options) if not line.startswith("feed-")] == ([expected] if expected else [])


@pytest.mark.nightly
def test_lines_that_shift_and_an_update_keep_what_is_known() -> None:
    create(narrow("-.5", "150"))
    write(a=narrow("-.5", "150").replace("G12.1", "(NEW)\nG4 U1.\n\nG12.1"))
    assert told() == []
    write(a=narrow("-3.", "150"))
    assert len(told()) == 1
    assert call("baseline update", "a.nc", "-q", "-o", FILE, options=OPTIONS).output == ""
    assert told() == []


@pytest.mark.nightly
def test_a_baseline_without_these_numbers_compares_the_others() -> None:
    create(narrow("-.5", "150"))
    text = Path(FILE).read_text()
    Path(FILE).write_text(re.sub(r', "lowest_z": -0\.5, "fastest_f": 150\.0', "", text))
    assert Path(FILE).read_text() != text
    write(a=narrow("-20.", "5000"))
    assert told() == []
    assert told("--tool", "1:radius=5") == [f"{NARROW}: known with radius 4, now 5"]
    assert call("baseline update", "a.nc", "-q", "-o", FILE, options=OPTIONS).output == ""
    (entry,) = read(Path(FILE)).entries
    assert entry.places[0].values == {"radius": 4.0, "lowest_z": -20.0, "fastest_f": 5000.0}


def test_what_follows_may_not_go_deeper_under_its_cause() -> None:
    text = by_call("-.5", "200").replace("C0\nG13.1", "G13.1")
    create(text)
    write(a=text.replace("-.5", "-5."))
    assert f"c-elsewhere-at-entry: known with {CENTER}.Z -0.5, now -5" in told()


PLUNGE = (
    "(BAR DIA 40)\nT0101\nG98 G0 X24. C0 Z2.\n{down}G12.1\nG1 X20. F200\nC3.\nX24.\nZ2. F1000\nG13.1\nG0 Z5.\nM30\n"
)


def test_a_number_that_two_names_have_is_said_once() -> None:
    create(PLUNGE.format(down="#1=-1.\nZ#1\n"))
    write(a=PLUNGE.format(down="#1=-9.\nZ#1\n"))
    (line,) = (line for line in told() if line.startswith("rapid-plunge-into-stock"))
    assert line == "rapid-plunge-into-stock: known with Z -1, now -9"


@pytest.mark.ci
def test_where_a_number_is_not_known_any_more_it_is_worse() -> None:
    create(through("-.5", "200"))
    write(a=through("#500", "200"))
    assert told() == [f"{CENTER}: known with Z -0.5, now unknown"]


# ---- all rules ----

#: Rules of metal and motion whose finding has no size: a state, a word, or an alarm with which the control stops. What
#: is written otherwise in the block is another finding.
WITHOUT_SIZE = {
    *("cancel-on-arc", "d-word-on-lathe", "offset-changed-in-polar", "start-up-on-arc", "tool-length-offset-in-polar"),
    *("feed-lost-from-per-revolution", "feed-missing-in-polar", "turning-feed-not-restored"),
    *("cut-in-air", "nearly-regular-contour", "pass-ends-inside-bar", "tool-contradicts-comment"),
    *("arc-center-on-path", "arc-off-polar-plane", "arc-without-center", "arc-word-of-other-plane"),
    *("corner-word-in-polar", "full-circle-by-radius", "helical-arc-in-polar"),
    *("code-not-allowed-in-polar", "direction-word-missing", "incremental-word-of-other-code-system"),
    *("infeed-out-of-range", "linear-axis-never-programmed", "modal-state-wrong-at-entry", "origin-shifted-in-polar"),
    *("plane-selected-in-polar", "plane-wrong-at-entry", "polar-axis-number-wrong", "polar-code-of-another-control"),
    *("polar-entered-twice", "polar-never-entered", "polar-never-left", "polar-shift-incremental"),
    *("polar-switch-not-alone", "polar-switch-unknown", "polar-switched-in-offset-mode", "rapid-in-polar"),
    *("second-axis-never-programmed", "wrong-axis-address-in-polar"),
    *(
        "c-angle-unknown-at-entry",
        "offset-of-another-tool",
        "c-axis-clamped-in-polar",
        "c-axis-not-engaged",
        "c-axis-not-referenced",
    ),
    *("flat-end-mill-at-od", "live-tool-never-stopped", "live-tool-without-speed", "main-spindle-running-at-entry"),
    *("no-tool-offset-at-entry", "spindle-code-in-polar", "variable-never-set", "x-unknown-at-entry"),
    "units-contradict-sizes",
}


def test_a_rule_of_metal_or_motion_has_numbers_that_may_not_grow() -> None:
    groups = ("compensation", "feed", "metal", "motion", "polar", "setup")
    without = {
        rule.name
        for rule in RULES.values()
        if rule.group in groups and rule.severity.name != "NOTE" and not rule.worse and not rule.gouges
    }
    assert without == WITHOUT_SIZE


def with_z(program: str, z: float) -> str:
    """A program that begins at a Z, and all of whose other Z are that much higher or lower."""
    moved = re.sub(r"(?<![A-Z(#])Z(-?[\d.]+)", lambda word: f"Z{float(word[1]) + z:.3f}", program)
    head, switch, rest = (
        re.split(r"(?m)^((?:G98|G94|T\d).*\n)", moved, maxsplit=1) if "T0" in moved else ("", "", moved)
    )
    return f"{head}{switch}G0 Z{z:g}.\n{rest}"


def report_of(example: Example, program: str, rule: Rule) -> FileReport:
    machine, values = settings_of(example)
    job = job_of(*example.tools, job=values["job"])
    runs = check.read(program.encode(), machine_of(machine, values["machine"]), job, "a.nc")
    return with_outline(check.check_runs(runs, [rule]), runs)


def told_again(rule: Rule, change: Callable[[str], str]) -> list[bool]:
    """For each finding of a rule in its Bad examples, if it is told again behind a change."""
    told = []
    for example in examples(rule.page):
        first = with_z(example.program, -1)
        contents = Baseline(Contents(), Path(), ["a.nc"]).updated([(report_of(example, first, rule), [*RULES])], "")
        changed = report_of(example, change(first), rule)
        again = Baseline(contents.contents, Path(), ["a.nc"]).without_known(changed, [*RULES]).findings
        told += [finding.line in {finding.line for finding in again} for finding in changed.findings]
    return told


@pytest.mark.ci
@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    "rule",
    [
        # The examples with a drawing take a minute.
        pytest.param(rule, marks=pytest.mark.ci if "drawing" in rule.name else ())
        for rule in GOUGING
    ],
    ids=lambda rule: str(rule.name),
)
def test_what_each_rule_that_gouges_finds_is_told_again_deeper_or_faster(rule: Rule) -> None:
    assert not any(told_again(rule, lambda program: program))
    deeper = told_again(rule, lambda program: with_z(program, -7))
    assert deeper
    assert all(deeper)
    if "rapid" not in rule.name:
        faster = told_again(rule, lambda program: re.sub(r"(?<![A-Z(#])F(\d)", r"F9\1", program))
        assert any(faster)  # some examples move in rapid traverse
