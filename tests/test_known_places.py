"""A baseline does not forgive worse: what grows, what another section or program has, and what stays silent."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import drawn_baselines
import pytest
from cases import looped
from click.testing import CliRunner, Result

from polarcheck.checking.block_outline import outline
from polarcheck.checking.settings import Settings
from polarcheck.commands import main
from polarcheck.editor.analysis import judge
from polarcheck.editor.open_text import OpenText
from polarcheck.files.baselines.baseline_file import read
from polarcheck.files.baselines.block_alignment import aligned
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.rules.rule import load_all
from polarcheck.rules.vocabulary import Kind, kinds

pytestmark = pytest.mark.usefixtures("own_folder")

FILE = "known.json"
OPTIONS = ("--set", "limits.c_feed=3600", "--tool", "1:radius=3", "--ignore", "setup,silence")


def call(command: str, *arguments: Any, options: tuple[str, ...] = OPTIONS) -> Result:
    return CliRunner().invoke(main, [*command.split(), *map(str, arguments), *options])


def create(**texts: str) -> None:
    write(**texts)
    assert call("baseline create", ".", "-q", "-o", FILE).output == ""


def write(**texts: str) -> None:
    for name, text in texts.items():
        Path(name.replace("_of_", "/")).parent.mkdir(exist_ok=True)
        Path(f"{name.replace('_of_', '/')}.nc").write_text(text)


def told(*arguments: str) -> list[str]:
    """What is told of all programs, without their paths: `line: message [rule]`."""
    result = call("check", ".", "--baseline", FILE, "--format", "concise", *arguments)
    assert result.exit_code == (1 if result.stdout else 0)
    return [line.split(" error: ")[-1].split(" warning: ")[-1] for line in result.stdout.splitlines()]


def near_center(feed: str, z: str = "") -> str:
    return f"O1\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. C5. F{feed}\nX4.\nC-5.\n{z}X40.\nC0\nG13.1\nM30\n"


def arc(start: str) -> str:
    return f"O1\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X{start} F200\nG3 X-40. C0 I-20. J0\nG1 C15.\nX60.\nG13.1\nM30\n"


def open_ended(size: int, end: str = "", depth: str = "Z-2.") -> str:
    """A section with G42 that lacks G40, but for what `end` writes."""
    return (
        f"G98 G0 X{size + 20}. C0\nG1 {depth} F300\nG12.1\nG1 G42 X{size}. F200\nC{size // 3}.\nX-{size}.\n"
        f"C-{size // 3}.\nX{size}.\nC0\n{end}G13.1\nG0 Z50.\n"
    )


def program(*sections: str) -> str:
    return "".join(["O1\nT0101\n", *sections, "M30\n"])


SOUND = "G40 X110.\n"


# ---- what grows ----


@pytest.mark.nightly
def test_a_feed_that_grows_is_told_again_with_what_is_known_of_it() -> None:
    create(a=near_center("400."))
    assert told() == []
    write(a=near_center("40000."))
    (line,) = told()
    assert (
        "; worse than in the baseline: known in 3 blocks, now in 5, known with c feed 11459.156, now 1145915.59" in line
    )
    assert line.endswith("[c-feed-above-limit]")


@pytest.mark.nightly
@pytest.mark.one_in(3)
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (arc("40.26"), arc("96."), "known with difference 0.13, now 28"),
        (arc("40.26"), arc("40.63"), "known with difference 0.13, now 0.315"),
        (arc("40.26"), arc("40.262"), ""),
        (arc("40.63"), arc("40.26"), ""),
        (near_center("400."), near_center("404."), ""),
        (near_center("400."), near_center("380."), ""),
        (near_center("400."), near_center("420."), "known with c feed 11459.156, now 12032.114"),
    ],
    ids=["arc", "three times", "rounding", "less", "a percent", "less feed", "five percent"],
)
def test_a_rounding_difference_is_no_growth(old: str, new: str, said: str) -> None:
    create(a=old)
    write(a=new)
    lines = told()
    assert len(lines) == bool(said)
    assert all(f"worse than in the baseline: {said} [" in line for line in lines)


@pytest.mark.nightly
def test_more_blocks_of_a_fault_are_told() -> None:
    create(a=near_center("400."))
    write(a=near_center("400.", "C5.\nC-5.\n"))
    (line,) = told()
    assert "worse than in the baseline: known in 3 blocks, now in 5 [" in line
    write(a=near_center("400.").replace("C-5.", "G4 U1.\nC-5."))
    assert told() == []


def test_one_fault_that_a_file_has_once_and_then_four_times_is_told() -> None:
    text = program(open_ended(60, SOUND), open_ended(66, SOUND))
    create(a=text.replace("C20.", "C20. ?"))
    write(a=text.replace("C20.", "C20. ?").replace("C22.", "C22. ?").replace("X66.", "X66. ?"))
    (line,) = told()
    assert "; worse than in the baseline: known with count 1, now " in line
    assert line.endswith("[stray-character]")


@pytest.mark.nightly
def test_what_is_worse_is_neither_new_nor_gone_and_an_update_takes_it() -> None:
    create(a=arc("40.26"))
    write(a=arc("96."))
    result = call("check", "a.nc", "--baseline", FILE, "--fail-on-stale", "--format", "json")
    (finding,) = json.loads(result.stdout)["files"][0]["findings"]
    assert finding["values"]["difference"] == 28.0
    assert result.stderr.count("no longer") == 0
    result = call("baseline update", "a.nc", "-o", FILE)
    assert result.stdout == f"{FILE}: 1 finding of 1 file known; 0 new, 0 gone\n"
    assert told() == []


@pytest.mark.nightly
def test_a_finding_that_follows_may_not_grow_under_its_cause() -> None:
    """The numbers of findings that follow are known under their rule."""
    create(a=near_center("400."))
    (entry,) = read(Path(FILE)).entries[:1]
    text = Path(FILE).read_text()
    assert entry.places[0].values.keys() == {"c_feed"}
    Path(FILE).write_text(text.replace('"c_feed": 11459.155903', '"c_feed": 11459.155903, "no-rule.depth": 1.5'))
    assert told() == []


@pytest.mark.parametrize("rule", [rule for rule in load_all().values() if rule.worse], ids=lambda rule: str(rule.name))
def test_what_grows_is_a_number_of_the_rule(rule: Any) -> None:
    """test_values.py proves that the Bad examples of the rule give each of its values."""
    declared = kinds(rule.values, rule.name)
    for name in rule.worse:
        for part in name.removeprefix("-").split(":"):
            assert declared[part] not in (Kind.TEXT, Kind.OFFSET, Kind.LINE, Kind.NUMBER), name


# ---- another section, another program ----


@pytest.mark.ci
@pytest.mark.parametrize("other", [60, 66], ids=["same contour", "other contour"])
@pytest.mark.parametrize("more", ["", open_ended(90, SOUND)], ids=["two", "a new one too"])
def test_a_section_that_is_mended_says_nothing_of_another_one_that_breaks(other: int, more: str) -> None:
    create(a=program(open_ended(60), open_ended(other, SOUND)))
    write(a=program(open_ended(60, SOUND), more, open_ended(other)))
    result = call("check", "a.nc", "--baseline", FILE, "--format", "concise")
    assert result.stdout.count("\n") == 1
    assert "[polar-switched-in-offset-mode]" in result.stdout
    assert "1 known finding no longer occurs: polar-switched-in-offset-mode in a.nc" in result.stderr


def test_of_several_sections_one_that_breaks_is_told_though_another_one_is_mended() -> None:
    create(a=program(open_ended(60), open_ended(66, SOUND), open_ended(72)))
    write(a=program(open_ended(60), open_ended(66), open_ended(72, SOUND)))
    (message,) = told()
    assert "worse than in the baseline: now in line 23, too" in message
    write(a=program(open_ended(60, SOUND), open_ended(66, SOUND), open_ended(72)))
    assert told() == []


@pytest.mark.parametrize("name", ["O7777", "O1005"], ids=["new name", "same name"])
def test_a_program_does_not_inherit_the_silence_of_another(name: str) -> None:
    create(O1005=program(open_ended(60)))
    Path("O1005.nc").unlink()
    other = "O7777\nT0303\nG97 S3000 M13\nG0 X90. C0\nG98\nG12.1\nG1 G42 X50. F100\nC8.\nX-50.\nC-8.\nX50.\nC2.\n"
    write(**{name: f"{other}G13.1\nM30\n"})
    assert [line[-31:] for line in told("--tool", "3:radius=3")] == ["[polar-switched-in-offset-mode]"]


@pytest.mark.ci
@pytest.mark.one_in(12)
@pytest.mark.parametrize("name", ["O1005", "new_of_O1005", "O9999"], ids=["here", "other folder", "renamed"])
@pytest.mark.parametrize(
    "edit",
    [
        lambda text: text,
        lambda text: "%\n" + text.replace("O1\n", "O0222 (REV B)\n"),
        lambda text: "".join(f"N{number} {line}\n" for number, line in enumerate(text.splitlines())),
        lambda text: text.replace("X-60.", "X-060.00 (CHECKED)").replace("\n", "\n\n"),
        lambda text: text.replace("C-20.\n", "C-20.\nG4 U.5\n").replace("F300", "F350"),
        lambda text: text.replace("G0 Z50.\n", "G0 Z50.\nG0 X200.\n", 1).replace("M30", "M5\nM30"),
        lambda text: text.replace(open_ended(60), "").replace("M30", open_ended(60) + "M30"),
    ],
    ids=["as it is", "title", "numbered", "respelled", "beside", "elsewhere", "section moved"],
)
def test_what_is_edited_elsewhere_keeps_what_is_known(edit: Any, name: str) -> None:
    text = program(open_ended(60), open_ended(66, SOUND), open_ended(72, depth="Z-4."))
    create(O1005=text)
    Path("O1005.nc").unlink()
    write(**{name: edit(text)})
    assert told() == []


@pytest.mark.nightly
def test_where_the_first_block_of_a_section_is_mended_the_others_stay_known() -> None:
    blocks = "G0 C5.\n"
    create(a=f"O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\n{blocks}G1 X30.\n{blocks}G1 X20.\n{blocks}G13.1\nM30\n")
    text = Path("a.nc").read_text()
    write(a=text.replace(blocks, "G1 C5.\n", 1))
    assert told() == []


@pytest.mark.nightly
def test_a_long_program_is_known_by_a_part_of_its_blocks() -> None:
    passes = [open_ended(60 + number % 7, SOUND, f"Z-{number / 8:g}") for number in range(260)]
    create(a=program(*passes[:100], open_ended(50), *passes[100:]))
    (listed,) = read(Path(FILE)).programs
    assert listed.of == 2
    assert len(listed.hashes) <= 2000
    write(a=program(*passes[:30], *passes[40:100], open_ended(50), *passes[100:]))
    assert told() == []
    write(a=program(*passes[:100], open_ended(50, SOUND), *passes[100:180], open_ended(50), *passes[180:]))
    assert len(told()) == 1


@pytest.mark.nightly
def test_pairs_that_are_drawn() -> None:
    """`python tests/drawn_baselines.py 5000` takes more of them."""
    assert list(drawn_baselines.faults(0, 25)) == []


# ---- the parts ----


@looped(
    ("old", "new", "pairs"),
    [
        ([1, 2, 3], [1, 2, 3], {0: 0, 1: 1, 2: 2}),
        ([], [1], {}),
        ([1, 2, 3, 4], [1, 5, 3, 6, 4], {0: 0, 2: 2, 3: 4}),
        ([1, 1, 2, 1, 1], [1, 1, 1, 1], {0: 0, 1: 1, 3: 2, 4: 3}),
        # More edits than are tried: only what occurs once in both is a hold.
        ([*range(1000, 1400), 7, *range(2000, 2400)], [*range(3000, 3400), 7, *range(4000, 4400)], {400: 400}),
    ],
)
def test_blocks_are_aligned(old: list[int], new: list[int], pairs: dict[int, int]) -> None:
    assert aligned(old, new) == pairs


def test_an_outline_leaves_out_what_says_nothing() -> None:
    text = "%\nO0001\n\nN10 G01 X+05.0\n  \ng1x5.\nM30\n%\n"
    short = outline(text, [2, 4, 5, 7])
    assert short.hashes[0] == short.hashes[1] != short.hashes[2]
    assert short.place_of_line == {4: 0, 7: 2}
    assert outline(text.replace("\n", "\r"), [4]).hashes == short.hashes
    long = outline("".join(f"X{number}.\n" for number in range(100)), [1, 99], most=20)
    assert (len(long.hashes) <= 20, long.of >= 4, long.place_of_line[99] <= len(long.hashes)) == (True, True, True)


# ---- the command ----


@pytest.mark.nightly
def test_a_job_file_names_the_baseline() -> None:
    write(sub_of_a=arc("40.26"))
    Path("sub/polarcheck.toml").write_text('baseline = "known.json"\n')
    check = ("check", "sub", "--format", "concise")
    result = call(*check)
    assert result.exit_code == 2
    assert result.stderr.startswith(
        f"polarcheck: {Path('sub/polarcheck.toml')}:1: baseline: sub/known.json: No such file"
    )
    assert call("baseline create", "sub").stdout == "sub/known.json: 1 finding of 1 file known\n"
    result = call(*check)
    assert (result.exit_code, result.stdout) == (0, "")
    assert call(*check, "--no-baseline").exit_code == 1
    assert call("baseline create", "sub", "-o", "other.json", "-q").exit_code == 0
    write(sub_of_a=arc("40.47"))
    assert call(*check).exit_code == 1
    assert call("baseline update", "sub", "-q").output == ""
    assert call(*check).exit_code == 0
    assert call(*check, "--baseline", "other.json").exit_code == 1
    result = call("check", "sub", "-o", "json:sub/known.json")
    assert result.exit_code == 2
    write(more_of_a=arc("40.26"))
    Path("more/polarcheck.toml").write_text('baseline = "../other.json"\n')
    result = call("baseline update", ".")
    assert result.exit_code == 2
    assert "these programs have several baselines, more/../other.json, sub/known.json" in result.stderr


@pytest.mark.nightly
def test_what_is_gone_fails_only_on_demand() -> None:
    create(a=arc("40.26"))
    options = ("check", ".", "--baseline", FILE)
    assert call(*options, "--fail-on-stale").exit_code == 0
    write(a=arc("40."))
    assert call(*options).exit_code == 0
    assert call(*options, "--fail-on-stale").exit_code == 1
    assert call("baseline prune", ".", "-o", FILE, "-q").output == ""
    assert call(*options, "--fail-on-stale").exit_code == 0


@pytest.mark.nightly
def test_an_entry_of_an_unknown_rule_is_told_with_its_line() -> None:
    create(a=arc("40.26"))
    Path(FILE).write_text(Path(FILE).read_text().replace("arc-end-off-circle", "arc-end-of-circle"))
    options = ("check", "a.nc", "--baseline", FILE)
    result = call(*options)
    assert result.exit_code == 1
    assert result.stderr == (
        f"polarcheck: warning: {FILE}: line 7: unknown rule 'arc-end-of-circle', which silences nothing; "
        "did you mean arc-end-off-circle?\n"
    )
    assert call(*options, "--fail-on-stale", "--fail-on", "never").exit_code == 1
    lines = Path(FILE).read_text().splitlines()
    more = [lines[6].replace("arc-end-of-circle", f"rule-{number}") + "," for number in range(7)]
    Path(FILE).write_text("\n".join([*lines[:6], *more, *more, *lines[6:]]))
    stderr = call(*options).stderr
    assert (
        "line 7 and 1 more: unknown rule 'rule-0', which silences nothing; `polarcheck baseline prune` drops it"
        in stderr
    )
    assert "3 more unknown rules; `polarcheck baseline prune` drops them" in stderr
    assert call("baseline prune", "a.nc", "-o", FILE).stdout == f"{FILE}: 0 findings of 0 files known; 15 gone\n"


@pytest.mark.ci
def test_what_could_not_be_evaluated_is_brought_to_its_new_place() -> None:
    create(a=program(open_ended(60, SOUND), open_ended(66)))
    (before,) = (place.at for entry in read(Path(FILE)).entries for place in entry.places)
    write(a=program(open_ended(90, SOUND), open_ended(60, SOUND), open_ended(66)))
    call("baseline update", ".", "-o", FILE, "--select", "rapid-in-polar")
    (after,) = (place.at for entry in read(Path(FILE)).entries for place in entry.places)
    # Without a finding there are no blocks to compare with: the former ones stay.
    assert after == before
    write(a=program(open_ended(90, "G0 C4.\n" + SOUND), open_ended(60, SOUND), open_ended(66)))
    call("baseline update", ".", "-o", FILE, "--select", "rapid-in-polar")
    places = {entry.rule: entry.places[0].at for entry in read(Path(FILE)).entries}
    assert places["polar-switched-in-offset-mode"] == (before or 0) + len(open_ended(90, "X\nX\n").splitlines())
    assert told() == []


@pytest.mark.ci
def test_an_editor_and_what_watches_files_know_the_baseline() -> None:
    text = program(open_ended(60))
    create(a=text)
    Path("polarcheck.toml").write_text(f'baseline = "{FILE}"\n[tools.1]\nradius = 3\n')

    def settings_of(path: Path) -> Settings:
        return OfPrograms(Options(ignore=("setup", "silence")))(str(path))

    path = Path.cwd() / "a.nc"
    assert FILE in settings_of(Path("a.nc")).read
    shown = [
        judge(OpenText(now), path, settings_of, [Path.cwd()]).report
        for now in (text, program(open_ended(60), open_ended(66)))
    ]
    assert [report and len(report.findings) for report in shown] == [0, 1]
    Path(FILE).unlink()
    assert "baseline: known.json: No such file" in judge(OpenText(text), path, settings_of, [Path.cwd()]).error
