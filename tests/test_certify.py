"""A post and its manifest: what passes, what fails and why, golden traces, the suite of `certify init`."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import jsonschema
import msgspec
import pytest
from cases import looped
from click.testing import CliRunner, Result
from polarcheck.errors import TooHardError
from programs import ROOT

import polarcheck
from polarcheck.commands import main
from polarcheck.foundation.time_limit import current_limit
from polarcheck.program.machines.part_keys import Part
from polarcheck.rewrite.certify import near_path

EXAMPLE = ROOT / "docs" / "certify"
PAGE = (ROOT / "docs" / "certify.md").read_text("utf-8")

#: The coverage counts all cases: each is a way of its own through the package.
pytestmark = [pytest.mark.one_in(1), pytest.mark.usefixtures("own_folder")]


@pytest.fixture
def example() -> Path:
    """The example of the page, in the working folder."""
    shutil.copytree(EXAMPLE, ".", dirs_exist_ok=True)
    return Path("post.toml")


def certify(*arguments: Any, **environment: str) -> Result:
    result = CliRunner().invoke(main, ["certify", *map(str, arguments)], env=environment)
    assert result.exception is None or isinstance(result.exception, SystemExit), result.output
    return result


def certificate(*arguments: Any) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(certify(*arguments, "--format", "json").stdout)
    return found


def reasons(name: str) -> list[str]:
    """Why a case does not pass."""
    (case,) = certificate("post.toml", "--case", name)["cases"]
    assert (case["state"] == "pass") == (case["reasons"] == [])
    found: list[str] = case["reasons"]
    return found


def edit(path: str, before: str, after: str, count: int = -1) -> None:
    text = Path(path).read_text("utf-8")
    assert before in text
    Path(path).write_text(text.replace(before, after, count), "utf-8")


# ---- the page ----


@pytest.mark.nightly
def test_the_example_prints_what_its_page_shows(example: Path) -> None:
    result = certify(example)
    assert result.exit_code == 0
    shown = re.search(r"    \$ polarcheck certify post.toml\n((?:    .*\n|\n)+)", PAGE)
    assert shown is not None
    assert result.stdout.split("\n") == [line.removeprefix("    ") for line in shown[1].rstrip().split("\n")] + [""]


@pytest.mark.ci
def test_the_manifest_of_the_page_is_one(example: Path) -> None:
    """The page shows the example without two of its features."""
    block = re.search(r"((?:    .*\n|\n)+)", PAGE[PAGE.index('    title = "Example') :])
    assert block is not None
    example.write_text("\n".join(line.removeprefix("    ") for line in block[1].split("\n")), "utf-8")
    found = certificate(example)
    assert found["summary"]["cases"] == found["summary"]["pass"] == 7


# ---- what a change of the post does ----

CONTOUR, ROUND, INDEXED = "fanuc/contour.nc", "fanuc/arc-above-180.nc", "fanuc/indexing.nc"


@pytest.mark.one_in(6)
@pytest.mark.ci
@pytest.mark.parametrize(
    ("file", "before", "after"),
    [
        (CONTOUR, "\nG", "\nN10 G"),
        (CONTOUR, "T0101", "T0101 (MILL 8)\n(A COMMENT)\n"),
        (CONTOUR, "G1 C-6.928\n", "G1 C2.\nG1 C-6.928\n"),
        (ROUND, "G3 C-9.798 I-10.000 J-9.798", "G3 X-28. C0 I-10. J-9.798\nX20. C-9.798 I14. J0"),
        (ROUND, "G3 C-9.798 I-10.000 J-9.798", "G3 C-9.798 R-14."),
        (INDEXED, "C240.0", "C-120."),
    ],
)
def test_other_words_for_the_same_path_pass(example: Path, file: str, before: str, after: str) -> None:
    edit(file, before, after)
    assert reasons(f"{Path(file).stem}/lathe-7") == []


@pytest.mark.one_in(9)
@pytest.mark.ci
@pytest.mark.parametrize(
    ("file", "before", "after", "said"),
    [
        (
            CONTOUR,
            "G1 C6.928 F200.000",
            "G1 C6.928 F250.",
            "line 13: F is 250 mm/min, in golden/contour.jsonl 200 mm/min",
        ),
        (CONTOUR, "G1 G42 X24.000", "G1 G41 X24.000", "error: "),
        (CONTOUR, "G1 G40 X50.000", "G1 X50.000", "error: "),
        (CONTOUR, "Z-3.000", "Z-3.050", "0.050 mm from golden/contour.jsonl"),
        (
            CONTOUR,
            "X50.000 C0. F1000.000\nG1 Z-3",
            "X52.000 C0. F1000.000\nG1 Z-3",
            "1.000 mm from golden/contour.jsonl",
        ),
        (ROUND, "G3 C-9.798", "G2 C-9.798", "error: "),
        (ROUND, "I-10.000 J-9.798", "R14.", "error: "),
        (INDEXED, "C120.0", "C125.0", "error: "),
        (INDEXED, "G1 C20.000 F200.000", "G1 C20.000 F60000.", "line 13: warning: C axis would turn"),
    ],
)
def test_another_path_fails(example: Path, file: str, before: str, after: str, said: str) -> None:
    edit(file, before, after)
    found = reasons(f"{Path(file).stem}/lathe-7")
    assert any(said in reason for reason in found), found


@pytest.mark.ci
@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("M13", "M14", "line 7: G97 S3000 M13 has become G97 S3000 M14 against golden/contour.jsonl"),
        ("S3000", "S3100", "line 7: G97 S3000 M13 has become G97 S3100 M13 against golden/contour.jsonl"),
        ("G28 H0\n", "", "G28 H0 is missing against golden/contour.jsonl"),
        (
            "X100.000 Z50",
            "X90.000 Z50",
            "line 23: rapid to X50 Z50 C0 has become rapid to X45 Z50 C0 against golden/contour.jsonl",
        ),
        (
            "M5\n",
            "M5\nG1 X80. Z5. F100\n",
            "line 6: line to X40 Z5 C0 F100 mm/min is added against golden/contour.jsonl",
        ),
        ("G28 H0\n", "G28 H0\nM8\n", "line 7: M8 is added against golden/contour.jsonl"),
        ("G12.1\n", "G4 X.5\nG12.1\n", "line 9: G4 X0.5 is added against golden/contour.jsonl"),
    ],
)
def test_other_orders_fail(example: Path, before: str, after: str, said: str) -> None:
    edit(CONTOUR, before, after)
    assert said in reasons("contour/lathe-7")


@pytest.mark.nightly
def test_an_order_elsewhere_on_the_path_fails(example: Path) -> None:
    edit(CONTOUR, "F1000.000\n", "F1000.000\nM8\n")
    assert certify(example, "--update", "--case", "contour/lathe-7").exit_code == 0
    edit(CONTOUR, "M8\nG1 Z-3.000 F300.000\n", "G1 Z-3.000 F300.000\nM8\n")
    assert reasons("contour/lathe-7") == [
        "line 12: M8 stands elsewhere on the path against golden/contour.jsonl",
    ]


@pytest.mark.nightly
@pytest.mark.parametrize("orders", [True, False])
def test_a_golden_trace_of_an_earlier_version_is_to_be_written_anew(example: Path, orders: bool) -> None:
    golden = Path("golden/contour.jsonl")
    text = golden.read_text("utf-8")
    old = [line for line in text.splitlines(keepends=True)[1:] if orders or '"order"' not in line]
    golden.write_text("".join(old), "utf-8")
    edit(CONTOUR, "M13", "M14")
    (case,) = json.loads(certify(example, "--case", "contour/lathe-7", "--format", "json").stdout)["cases"]
    said = "golden/contour.jsonl is of an earlier version, without what stands outside: certify --update"
    assert (case["state"], case["reasons"], case["remarks"]) == ("no golden trace", [said], [])
    edit(CONTOUR, "M14", "M13")
    assert certify(example, "--update", "--case", "contour/lathe-7").exit_code == 0
    assert golden.read_text("utf-8") == text


@pytest.mark.ci
@pytest.mark.parametrize(
    ("turned", "said"),
    [("C235.0", "section 2: it is turned by 5.000 deg against indexing/lathe-7"), ("C240.0", "line 25: 2.793 mm from")],
)
def test_an_index_of_the_other_control_that_is_another(example: Path, turned: str, said: str) -> None:
    """No part is given. Where C of the approach is turned as well, the whole section is."""
    text = example.read_text("utf-8")
    example.write_text(text[: text.index("[[feature.indexing.part]]")] + text[text.index("[[case]]") :], "utf-8")
    edit("sinumerik/indexing.mpf", "C240.0", turned)
    edit("sinumerik/indexing.mpf", "ROT RPL=120", "ROT RPL=125")
    (reason,) = reasons("indexing/lathe-8")
    assert reason.startswith(said)


@pytest.mark.nightly
def test_a_fault_of_one_control_is_none_of_the_other_that_runs_its_golden_trace(example: Path) -> None:
    edit("post.toml", 'same_path_as = "lathe-7"', 'same_path_as = "lathe-7"\ngolden = "golden/8-{feature}.jsonl"')
    assert certify(example, "--update", "--case", "contour/lathe-8").exit_code == 0
    edit(CONTOUR, "Z-3.000", "Z-3.100")
    (case,) = certificate(example, "--case", "contour/lathe-8")["cases"]
    assert case["state"] == "pass"
    assert case["remarks"] == ["the path is not that of contour/lathe-7, which fails itself"]
    Path("golden/8-contour.jsonl").unlink()
    assert re.match(r"line \d+: 0\.100 mm from contour/lathe-7", reasons("contour/lathe-8")[0])


@pytest.mark.nightly
def test_the_start_angle_of_the_whole_part_is_free(example: Path) -> None:
    manifest = example.read_text("utf-8").replace("turned = 0.0\n", "")
    example.write_text(manifest, "utf-8")
    edit(ROUND, "X70.000 Z2.000 C0.0", "X70.000 Z2.000 C30.0")
    assert reasons("arc-above-180/lathe-8") == []
    against = "against golden/arc-above-180.jsonl"
    assert reasons("arc-above-180/lathe-7") == [
        f"section 1: it is turned by 30.000 deg {against}",
        f"line 8: rapid to X35 Z2 C0 has become rapid to X35 Z2 C30 {against}",
        f"line 19: rapid to X50 Z50 C0 has become rapid to X50 Z50 C30 {against}",
    ]


@pytest.mark.nightly
def test_corners_that_controls_go_round_in_another_way_are_named(example: Path) -> None:
    edit("post.toml", 'path = "programmed"', "")
    found = {entry["name"]: entry["reasons"] for entry in certificate(example)["cases"] if entry["reasons"]}
    assert list(found) == ["contour/lathe-8", "arc-above-180/lathe-8"]
    for lines in found.values():
        assert "mm from" in lines[0]
        assert 'path = "programmed" compares' in lines[1]


# ---- findings and verdicts ----

NEGATIVE = 'findings = [{ rule = "rapid-in-polar", block = "G0 G40 X50.000" }]'


@pytest.mark.one_in(2)
@pytest.mark.nightly
@pytest.mark.parametrize(
    ("findings", "said"),
    [
        ('findings = [{ rule = "rapid-in-polar", line = 20 }]', None),
        ('findings = [{ rule = "rapid-in-polar" }]', None),
        ('verdict = "fail"\nfindings = [{ rule = "rapid-in-polar", block = "n20 g0g40 x50.000 (OUT)" }]', None),
        ('findings = [{ rule = "rapid-in-polar", line = 12 }]', "expected rapid-in-polar in line 12: it is in line 20"),
        (
            'findings = [{ rule = "rapid-in-polar" }, { rule = "bad-number", block = "X1" }]',
            "expected bad-number in the block X1: it is not found",
        ),
        ("findings = []", "line 20: error: "),
        (
            'verdict = "unverified"\nfindings = [{ rule = "rapid-in-polar" }]',
            "expected the verdict unverified, found fail",
        ),
    ],
)
def test_a_program_that_must_fail(example: Path, findings: str, said: str | None) -> None:
    edit("post.toml", NEGATIVE, findings)
    found = reasons("rapid inside the mode")
    assert (found == []) if said is None else found[0].startswith(said)
    assert len(found) <= 1


@pytest.mark.ci
def test_a_radius_that_is_not_known_is_no_pass(example: Path) -> None:
    edit("post.toml", "[tools.1]\nradius = 4.0\n", "")
    first, second = reasons("contour/lathe-7")
    assert first.startswith("expected the verdict pass, found unverified: no radius")
    assert second == "R of a cutter is not known in this program: its path is the programmed one"
    edit("post.toml", NEGATIVE, 'verdict = "unverified"')
    edit("post.toml", "fanuc/rapid.nc", "fanuc/contour.nc")
    assert reasons("rapid inside the mode") == []


# ---- exit codes ----


@pytest.mark.nightly
def test_a_program_that_is_not_there(example: Path) -> None:
    Path(CONTOUR).unlink()
    result = certify(example)
    assert result.exit_code == 2
    assert re.search(r"^contour +not run 1 of 2 +fail", result.stdout, re.MULTILINE)
    assert "the path is not compared: contour/lathe-7 was not run" in " ".join(result.stdout.split())


@pytest.mark.one_in(4)
@pytest.mark.nightly
@pytest.mark.parametrize(
    ("arguments", "status"),
    [((), 0), (("--strict",), 1), (("--case", "contour/lathe-8"), 0), (("--case", "contour/lathe"), 2)],
)
def test_what_is_missing_fails_where_it_is_asked_for(example: Path, arguments: tuple[str, ...], status: int) -> None:
    assert certify(example, *arguments).exit_code == status


@pytest.mark.nightly
def test_a_certificate_of_nothing_is_none(example: Path) -> None:
    edit("post.toml", "{feature}.nc", "{feature}.tap")
    edit("post.toml", "golden = ", "# golden = ")
    result = certify(example)
    assert "warning: post.toml:13: controls.lathe-7.programs: there is no file fanuc/{feature}.tap" in result.stderr
    example.write_text('[controls.a]\nmachine = "fanuc"\nprograms = "a/{feature}.nc"\n', "utf-8")
    result = certify(example)
    assert result.exit_code == 2
    assert "post.toml: no cases" in result.stderr


@looped(
    ("manifest", "said"),
    [
        ("title = \n", 'post.toml:1: Invalid value at column 9; "title" has no value behind the =: write one'),
        ("titel = 'x'", "post.toml:1: unknown key titel; did you mean title?"),
        ("title = 'x'", "post.toml: controls: expected at least one"),
        ("features = ['a', 'a']\n[controls.a]", "post.toml:1: features: 'a' is there twice"),
        ("features = ['../a']", "post.toml:1: features: expected"),
        ("strict = true\n[controls.a]", "post.toml:1: strict: no key of a manifest: verdict says"),
        ("[controls.a]\nselect = ['polar']", "post.toml:2: controls.a.select: no key of a manifest: all rules run"),
        ("[controls.a]\nmachin = 'x'", "post.toml:2: unknown key controls.a.machin; did you mean machine?"),
        ("[controls.a]\nprograms = 'a.nc'", "post.toml:2: controls.a.programs: expected {feature} in the name"),
        ("[controls.a]\ngolden = '{feature}'", "post.toml:2: controls.a.golden: is for the programs of controls.a"),
        ("[controls.a]\nsame_path_as = 'b'", "post.toml:2: controls.a.same_path_as: no other control 'b'"),
        ("[controls.a]\nnot_offered = { pockets = '' }", "post.toml:2: controls.a.not_offered.pockets: no feature"),
        ("[controls.a]\n[feature.contuor]", "post.toml:2: feature.contuor: no feature 'contuor'; did you mean"),
        (
            "[controls.a]\n[[feature.contour.part]]\nshape = 'hexagon'\nacross_flats = 24\nfiles = ['a.nc']",
            "post.toml:5: feature.contour.part.1.files: no key of a manifest: a part is for the cases of its table",
        ),
        ("[controls.a]\ntolerance = 0", "post.toml:2: controls.a.tolerance: expected a number above 0, 100 at most"),
    ],
)  # fmt: skip
def test_a_fault_of_the_manifest_is_one_line(manifest: str, said: str) -> None:
    assert_is_refused(manifest, said)


def assert_is_refused(manifest: str, said: str) -> None:
    Path("post.toml").write_text(manifest, "utf-8")
    result = certify("post.toml")
    assert result.exit_code == 2
    assert result.stderr.startswith(f"polarcheck: {said}"), result.stderr
    assert result.stderr.count("\n") == 1


CASE = "[controls.a]\n[[case]]\nfeature = 'contour'\ncontrol = 'a'\nprogram = 'a.nc'\n"


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("featur = 1", "post.toml:6: unknown key case.1.featur; did you mean feature?"),
        ("verdict = 'fail'", "post.toml:6: case.1.verdict: expected findings beside \"fail\""),
        ("verdict = 'passed'", "post.toml:6: case.1.verdict: expected pass, fail or unverified, found 'passed'"),
        ("findings = [{ rule = 'rapid-in-pola' }]", "post.toml:6: case.1.findings.1.rule: no rule 'rapid-in-"),
        ("findings = [{ rule = 'bad-number', line = 1, block = 'X' }]", "post.toml:6: case.1.findings.1.block: a"),
        ("same_path_as = 'contour/b'", "post.toml:6: case.1.same_path_as: no case 'contour/b'; did you"),
        ("same_path_as = 'contour/a'", "post.toml:6: case.1.same_path_as: contour/a is compared with itself"),
        ("[[case]]\nfeature = 'contour'\ncontrol = 'a'\nprogram = 'b.nc'", "post.toml:6: case.2: a case"),
        ("machine = 'fanuc-30'", "post.toml:6: machine: unknown machine"),
        ("config = 'there.toml'", "post.toml:6: case.1.config: there.toml: No such file"),
        ("[[case.part]]\nshape = 'hexagon'", "post.toml:6: case.1.part.1: the shape hexagon needs across_flats"),
    ],
)  # fmt: skip
def test_a_fault_of_a_case_is_one_line(more: str, said: str) -> None:
    assert_is_refused(CASE + more, said)


@pytest.mark.ci
def test_a_job_file_applies_where_the_manifest_names_it(example: Path) -> None:
    edit("post.toml", "[tools.1]\nradius = 4.0\n", 'config = "lathes/jobs.toml"\n')
    Path("lathes").mkdir()
    Path("polarcheck.toml").write_text("[tools.1]\nradius = 3.0\n", "utf-8")
    Path("lathes/jobs.toml").write_text('units = "mm"\n[[programs]]\nfiles = ["*"]\n', "utf-8")
    assert reasons("contour/lathe-7")[0].startswith("expected the verdict pass, found unverified: no radius")
    Path("lathes/jobs.toml").write_text('units = "inch"\n[tools.1]\nradius = 0.157480315\n', "utf-8")
    assert reasons("contour/lathe-7") == []
    Path("lathes/jobs.toml").write_text("[tool.1]\n", "utf-8")
    result = certify(example)
    assert result.exit_code == 2
    assert result.stderr.startswith("polarcheck: post.toml:5: config: lathes/jobs.toml:1: unknown key tool")
    Path("lathes/jobs.toml").write_text("", "utf-8")
    edit("post.toml", "c_feed = 14400", "c_fed = 14400")
    assert "post.toml:16: controls.lathe-8: unknown key limits.c_fed; did you mean c_feed?" in certify(example).stderr


# ---- golden traces ----


@pytest.mark.nightly
def test_an_update_says_what_changes_and_keeps_what_fails(example: Path) -> None:
    before = Path("golden/indexing.jsonl").read_bytes()
    edit(CONTOUR, "X50.000 C0. F1000.000\nG1 Z-3", "X52.000 C0. F1000.000\nG1 Z-3")
    edit(INDEXED, "C120.0", "C125.0")
    Path("golden/arc-above-180.jsonl").unlink()
    result = certify(example, "--update")
    assert result.exit_code == 1
    contour, round_, indexed = result.stderr.splitlines()
    # As far apart are all the points of the approach.
    assert re.match(r"golden/contour\.jsonl: rewritten: largest deviation 1\.000 mm; line 1\d: 1\.000 mm from", contour)
    assert round_ == "golden/arc-above-180.jsonl: new"
    assert indexed.startswith("golden/indexing.jsonl: not written, indexing/lathe-7 fails: line ")
    assert Path("golden/indexing.jsonl").read_bytes() == before
    assert "line" not in json.loads(Path("golden/contour.jsonl").read_text("utf-8").splitlines()[0])
    edit(CONTOUR, "G42 X24.000 F200.000\nG1 C6.928 F200.000", "G42 X24.000 F200.000\nG1 C3.\nG1 C6.928")
    lines = certify(example, "--update", "--case", "contour/lathe-7").stderr.splitlines()
    assert lines == ["golden/contour.jsonl: rewritten: the same path within 0.000 mm"]
    assert certify(example, "--update", "--case", "contour/lathe-7").stderr == "golden/contour.jsonl: unchanged\n"


@pytest.mark.one_in(3)
@pytest.mark.nightly
@pytest.mark.parametrize(
    ("golden", "said"),
    [
        ('"post.toml"', "post.toml: is no golden trace, and stays as it is: contour/lathe-8 names another file"),
        ('"golden/indexing.jsonl"', "golden/indexing.jsonl: is the golden trace of contour/lathe-8 and of"),
        ('"../new/contour.jsonl"', "../new/contour.jsonl: lies outside of the folder of the manifest"),
    ],
)  # fmt: skip
def test_an_update_overwrites_no_other_file(example: Path, golden: str, said: str) -> None:
    text = example.read_text("utf-8")
    entry = f'feature = "contour"\ncontrol = "lathe-8"\nprogram = "sinumerik/contour.mpf"\ngolden = {golden}\n'
    example.write_text(f"{text}\n[[case]]\n{entry}", "utf-8")
    result = certify(example, "--update")
    assert result.exit_code == 2
    assert result.stderr.startswith(f"polarcheck: {said}")
    assert example.read_text("utf-8").startswith(text)


@pytest.mark.nightly
def test_a_golden_trace_that_is_none(example: Path) -> None:
    Path("golden/contour.jsonl").write_text('{"section": 0}\n', "utf-8")
    (reason,) = reasons("contour/lathe-7")
    assert reason.startswith("golden/contour.jsonl:1: expected a move of a golden trace: ")
    shutil.copy("golden/indexing.jsonl", "golden/contour.jsonl")
    assert reasons("contour/lathe-7") == ["the path has 1 polar section, golden/contour.jsonl has 3 polar sections"]


# ---- reports ----


@pytest.mark.nightly
def test_the_page_escapes_what_others_have_written(example: Path) -> None:
    edit("post.toml", "Example post 1.0", "<script>alert(1)</script>\\u001b[31m")
    edit("post.toml", "the control takes no Z", "<b>no Z</b>")
    assert certify(example, "-o", "html:certificate.html", "-o", "json:certificate.json").exit_code == 0
    page = Path("certificate.html").read_text("utf-8")
    assert "&lt;script&gt;alert(1)&lt;/script&gt;\\x1b[31m" in page
    assert "&lt;b&gt;no Z&lt;/b&gt;" in page
    assert "<script" not in page
    assert json.loads(Path("certificate.json").read_text("utf-8"))["summary"]["missing"] == 1
    assert certify(example, "--format", "html").stdout == page
    assert "\x1b[31m" not in certify(example, "--color", "always").stdout


@pytest.mark.parametrize(
    "output", ["html:post.toml", "json:fanuc/contour.nc", "json:golden/contour.jsonl", "html:a.nc", "pdf:a"]
)
def test_a_report_overwrites_no_file_of_the_run(example: Path, output: str) -> None:
    assert certify(example, "-o", output).exit_code == 2


@pytest.mark.nightly
def test_many_controls_stand_below_each_other(example: Path) -> None:
    controls = "".join(f"[controls.a-lathe-with-a-long-name-{number}]\n" for number in range(9))
    edit("post.toml", "[feature.contour]\n", f"{controls}\n[feature.contour]\n")
    shown = certify(example).stdout.split("\n\n")
    assert [part.split()[0] for part in shown[1:4]] == [
        "lathe-7",
        "a-lathe-with-a-long-name-2",
        "a-lathe-with-a-long-name-5",
    ]
    assert all(len(line) <= 100 for part in shown for line in part.splitlines())


@pytest.mark.nightly
def test_the_certificate_and_the_manifest_fit_their_schemas(example: Path) -> None:
    import tomllib

    edit(ROUND, "G3 C-9.798", "G2 C-9.798")
    Path(CONTOUR).unlink()
    for name, value in (("certificate", certificate(example)), ("manifest", tomllib.loads(example.read_text("utf-8")))):
        schema = json.loads(CliRunner().invoke(main, ["schema", name]).stdout)
        jsonschema.Draft202012Validator.check_schema(schema)
        jsonschema.validate(value, schema)


@pytest.mark.nightly
def test_the_matrix_of_some_cases_has_no_others(example: Path) -> None:
    shown = certify(example, "--case", "contour/lathe-8").stdout
    assert shown == "Example post 1.0\n\n         lathe-8\ncontour  pass\n\n1 case: 1 pass, 0 fail\n"


@pytest.mark.nightly
def test_python_gives_the_certificate_of_the_command(example: Path) -> None:
    found = polarcheck.certify("post.toml", cases=["contour/lathe-7"])
    assert json.loads(msgspec.json.encode(found)) == certificate(example, "--case", "contour/lathe-7")
    with pytest.raises(polarcheck.errors.UsageError, match="no case of this name; did you mean contour/lathe-7"):
        polarcheck.certify(example, cases=["contour/lathe-"])


# ---- certify init ----


@pytest.mark.nightly
def test_the_suite_is_a_manifest_with_drawings(tmp_path: Path) -> None:
    from polarcheck.program.machines import drawing_file
    from polarcheck.rewrite.certify.jobs import JOBS
    from polarcheck.rewrite.certify.manifest import FEATURES

    result = certify("init", "suite", "--machine", "fanuc-30i", "--machine", "siemens-transmit")
    assert result.exit_code == 0
    words = Path("suite/jobs.md").read_text("utf-8")
    assert tuple(JOBS) == FEATURES
    for name in JOBS:
        assert f"\n## {name}\n" in words
        drawn = drawing_file.part_of(Path(f"suite/jobs/{name}.dxf"), name, Part(drawing=""))
        assert len(drawn.curves) == 1
    assert "no cases" in certify("suite/post.toml").stderr
    again = certify("init", "suite")
    assert again.exit_code == 2
    assert "suite/post.toml: is there already, and stays as it is" in again.stderr
    shutil.copytree(EXAMPLE / "fanuc", "suite/fanuc-30i")
    found = certificate("suite/post.toml")
    assert found["summary"]["cases"] == 3
    assert {reason for case in found["cases"] for reason in case["reasons"]} == {
        "no golden trace yet: certify --update"
    }
    assert {case["state"] for case in found["cases"]} == {"no golden trace"}
    assert (found["summary"]["no_golden"], found["summary"]["fail"]) == (3, 0)
    first = certify("suite/post.toml")
    assert (first.exit_code, first.stdout.count("no golden trace yet: certify --update")) == (1, 1)


@pytest.mark.nightly
def test_files_are_relative_to_the_manifest(example: Path) -> None:
    certify("init", "suite")
    part = 'shape = "hexagon"\nacross_flats = 24.0\nturned = 0.0\nz = -3.0\n'
    edit("post.toml", part, 'drawing = "../suite/jobs/contour.dxf"\nz = -3.0\n')
    Path("below").mkdir()
    for name in ("post.toml", "fanuc", "golden"):
        shutil.move(name, f"below/{name}")
    assert certify("below/post.toml", "--case", "contour/lathe-7").exit_code == 0
    edit("below/fanuc/contour.nc", "C6.928", "C6.828")
    found = certificate("below/post.toml", "--case", "contour/lathe-7")["cases"][0]
    assert found["program"] == "below/fanuc/contour.nc"
    assert found["state"] == "fail"


@pytest.mark.nightly
@looped("name", ["contour", "arc-above-180"])
def test_drawing_and_part_of_a_job_are_one(example: Path, name: str) -> None:
    certify("init", "suite")
    arguments = [
        "part",
        "--no-config",
        "--tool",
        "1:radius=4",
        "--drawing",
        f"suite/jobs/{name}.dxf",
        f"fanuc/{name}.nc",
    ]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0
    assert "agrees with" in result.stdout


@looped(
    ("arguments", "said"),
    [
        (("post.toml", "x"), "x: expected one manifest"),
        (("init",), "init: give a folder"),
        (("post.toml", "--machine", "fanuc"), "--machine: is for `certify init DIR`"),
        (("init", "a", "--machine", "fanuc-99"), "unknown machine 'fanuc-99'"),
        (("init", "a", "--machine", "fanuc", "--machine", "fanuc"), "--machine fanuc: there are two controls fanuc"),
    ],
)
def test_arguments_that_do_not_fit(arguments: tuple[str, ...], said: str) -> None:
    result = certify(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr
    assert not Path("a").exists()


# ---- the time of a case ----


@pytest.mark.nightly
def test_paths_are_compared_within_the_time_of_their_case(example: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two paths that cross each other by the thousand took minutes, in which nothing ended the run."""
    limits: list[float] = []

    def compared(*arguments: Any) -> Any:
        limit = current_limit()
        limits.append(0.0 if limit is None else limit.seconds)
        raise TooHardError("these take too long")

    edit("post.toml", "[controls.lathe-7]\n", "[controls.lathe-7]\nrun.max_seconds = 6.5\n")
    monkeypatch.setattr(near_path, "path_deviation", compared)
    found = certificate("post.toml")
    assert set(limits) == {6.5, 8.0}
    texts = [reason for case in found["cases"] for reason in case["reasons"]]
    assert any("not compared with golden/" in text and "these take too long" in text for text in texts)
    assert any("not compared with" in text and "golden/" not in text for text in texts)
