"""The hooks in real commits, and the steps of the CI files as a shell runs them, but for what they install."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from programs import ROOT
from test_cli import GOOD, IMPORTED_FROM, RAPID
from test_diff_base import git

yaml = pytest.importorskip("yaml")
pytest.importorskip("pre_commit")

pytestmark = [
    pytest.mark.ci,
    pytest.mark.usefixtures("own_folder"),
    pytest.mark.skipif(sys.platform == "win32", reason="the steps are for a shell"),
]

#: The reason keeps the pass: without one, programs are unverified, which `strict` does not let through.
FAULTS_ONLY = "select = { rules = ['rapid-in-polar'], reason = 'only rapids' }\n"


def read(path: str) -> Any:
    """A YAML file of this repository."""
    return yaml.safe_load((ROOT / path).read_text("utf-8"))


def hooks() -> dict[str, dict[str, Any]]:
    return {hook["id"]: hook for hook in read(".pre-commit-hooks.yaml")}


def make_command(path: Path) -> None:
    """A program polarcheck that is this checkout, as an installation makes one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f'#!/bin/sh\nPYTHONPATH="{IMPORTED_FROM}" exec "{sys.executable}" -m polarcheck "$@"\n')
    path.chmod(0o755)


def run(*words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, text=True, check=False, env={**os.environ, **environment})


# ---- pre-commit ----


def with_hooks(tmp_path: Path, **changes: Any) -> None:
    """A repository in which the hooks of the manifest run this checkout."""
    make_command(tmp_path / "installed" / "polarcheck")
    own = [{**hook, "language": "system", **changes.get(name, {})} for name, hook in hooks().items()]
    Path("repository").mkdir()
    os.chdir("repository")
    git("init", "-q", "-b", "main")
    Path(".pre-commit-config.yaml").write_text(yaml.safe_dump({"repos": [{"repo": "local", "hooks": own}]}))
    Path("polarcheck.toml").write_text(FAULTS_ONLY)
    git("add", "-A")
    git("commit", "-q", "-m", "x")
    run(sys.executable, "-m", "pre_commit", "install")


def commit(tmp_path: Path, *paths: str) -> tuple[bool, dict[str, str]]:
    """Whether a commit of these files succeeds, and what the hooks say of themselves: Passed, Failed, Skipped."""
    git("add", *(paths or ("-A",)))
    places = f"{tmp_path / 'installed'}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    own = {"GIT_CONFIG_GLOBAL": os.devnull, "PRE_COMMIT_HOME": str(tmp_path / "home"), "PRE_COMMIT_COLOR": "never"}
    words = ("git", "-c", "user.name=a", "-c", "user.email=a@localhost", "commit", "-m", "x")
    done = run(*words, PATH=places, **own)
    said = re.findall(r"^polarcheck(,?).*\.{3}.*?(Passed|Failed|Skipped)$", done.stderr, re.MULTILINE)
    assert [mark for mark, _ in said] == ["", ","], done.stdout + done.stderr
    of_programs, of_settings = (outcome for _, outcome in said)
    return done.returncode == 0, {"polarcheck": of_programs, "polarcheck-config": of_settings}


def test_a_commit_with_a_faulty_program_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with_hooks(tmp_path)
    for name, text in (("O1234.NC", RAPID), ("b \u00e4.nc", GOOD), ("notes.md", "G0")):
        Path(name).write_text(text)
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": "Skipped"})
    Path("O1234.NC").write_text(GOOD)
    assert commit(tmp_path) == (True, {"polarcheck": "Passed", "polarcheck-config": "Skipped"})


@pytest.mark.nightly
def test_what_the_job_file_excludes_is_no_matter_of_the_hook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with_hooks(tmp_path)
    Path("polarcheck.toml").write_text(FAULTS_ONLY + 'exclude = ["old"]\n')
    Path("old").mkdir()
    Path("old", "a.nc").write_text(RAPID)
    assert commit(tmp_path) == (True, {"polarcheck": "Passed", "polarcheck-config": "Passed"})


@pytest.mark.nightly
def test_a_commit_that_changes_the_lathe_checks_all_programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with_hooks(tmp_path)
    Path("cell").mkdir()
    Path("cell", "polarcheck.toml").write_text("machine = 'lathe.toml'\nselect = ['c-feed-above-limit']\n")
    Path("cell", "lathe.toml").write_text("inherits = 'fanuc-30i'\n[limits]\nc_feed = 36000\n")
    Path("cell", "a.nc").write_text("G98 G0 X60. C0\nG12.1\nG1 X4. C5. F100\nC-5. F500\nG13.1\nM30\n")
    assert commit(tmp_path) == (True, {"polarcheck": "Passed", "polarcheck-config": "Passed"})
    for limits in ("c_feed = 3600", "c_fed = 3600"):
        Path("cell", "lathe.toml").write_text(f"inherits = 'fanuc-30i'\n[limits]\n{limits}\n")
        assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": "Failed"})


@pytest.mark.nightly
@pytest.mark.one_in(6)
@pytest.mark.parametrize("args", [[], ["--strict", "--machine", "fanuc-30i"]])
@pytest.mark.parametrize(
    "name",
    ["--fail-on=never", "--no-config", "--select=overcut", "-ojson:NOTES", "--fix", "--version", "-", "--", "--strict"],
)
def test_no_name_of_a_file_is_an_option_of_the_hook(
    name: str, args: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with_hooks(tmp_path, **{one: {"args": args} for one in hooks()})
    for path, text in (("a.nc", RAPID), ("NOTES", "mine"), (f"./{name}", ""), ("polarcheck.toml", f"{FAULTS_ONLY}#")):
        Path(path).write_text(text)
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": "Failed"})
    assert (Path("NOTES").read_text(), Path("a.nc").read_text()) == ("mine", RAPID)
    Path("a.nc").write_text(GOOD)
    assert commit(tmp_path)[1]["polarcheck"] == "Failed"
    Path("folder").mkdir()
    Path(f"./{name}").rename(Path("folder", name))
    assert commit(tmp_path) == (True, {"polarcheck": "Passed", "polarcheck-config": "Passed"})


@pytest.mark.nightly
def test_a_commit_that_changes_a_subprogram_or_an_offset_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with_hooks(tmp_path)
    job = "select = ['rapid-in-polar', 'subprogram-missing', 'start-up-shorter-than-radius']\nextensions = ['sub']\n"
    Path("polarcheck.toml").write_text(job + "offsets = 'TABLE.DAT'\n[run]\nsubprograms = ['subs']\n")
    Path("subs").mkdir()
    texts = {
        "TABLE.DAT": "%\nG10 L10 P1 R4.\n%\n",
        "CALLS.SUB": "O0001\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P9001\nG13.1\nM30\n",
        "TOOL": "O0002\nT0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\nM30\n",
        "subs/README": "Called programs.",
        "subs/O9001": "O9001\nG1 C5.\nM99\n",
    }
    for name, text in texts.items():
        Path(name).write_text(text)
    skipped = "Skipped"
    assert commit(tmp_path)[0]
    Path("subs/O9001").write_text("O9001\nG0 C5.\nM99\n")
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": skipped})
    Path("subs/O9001").unlink()
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": skipped})
    git("reset", "-q", "--hard")
    Path("TABLE.DAT").write_text("%\nG10 L10 P1 R44.\n%\n")
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": skipped})
    git("reset", "-q", "--hard")
    # What stays out of the commit is no matter of it.
    Path("TABLE.DAT").write_text("%\nG10 L10 P1 R44.\n%\n")
    Path("new.md").write_text("x")
    assert commit(tmp_path, "new.md") == (True, {"polarcheck": "Passed", "polarcheck-config": skipped})


@pytest.mark.nightly
def test_with_diff_base_only_programs_that_it_concerns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Arguments of the hook of settings for folders of many programs."""
    monkeypatch.chdir(tmp_path)
    with_hooks(tmp_path, **{"polarcheck-config": {"args": ["--diff-base", "HEAD"]}})
    for cell in ("one", "two"):
        Path(cell).mkdir()
        Path(cell, "a.nc").write_text(GOOD)
        Path(cell, "polarcheck.toml").write_text(FAULTS_ONLY)
    Path("one", "a.nc").write_text(RAPID)
    Path("one", "polarcheck.toml").write_text("select = ['overcut']\n")
    assert commit(tmp_path)[0]
    Path("two", "polarcheck.toml").write_text(FAULTS_ONLY + "strict = true\n")
    assert commit(tmp_path) == (True, {"polarcheck": "Passed", "polarcheck-config": "Passed"})
    Path("one", "polarcheck.toml").write_text(FAULTS_ONLY)
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": "Failed"})


@looped("name", ["polarcheck.toml", "a/polarcheck.toml", "lathe 3.toml", "pyproject.toml"])
def test_the_hook_of_settings_takes_all_that_settles_a_verdict(name: str) -> None:
    assert re.search(hooks()["polarcheck-config"]["files"], name)


# ---- the action ----

ACTION = "action.yml"


def step(name: str) -> dict[str, Any]:
    (found,) = [one for one in read(ACTION)["runs"]["steps"] if one.get("id") == name]
    return dict(found)


def run_step(name: str, outputs: dict[str, str] | None = None, **inputs: str) -> tuple[int, str, dict[str, str]]:
    """Exit code and output of a step of the action as the runner runs it, and what it hands on."""
    defaults = {key: str(one["default"]) for key, one in read(ACTION)["inputs"].items()}
    known = {f"inputs.{key}": value for key, value in {**defaults, **inputs}.items()}
    known |= {"github.action_path": str(ROOT), "steps.python.outputs.python-path": sys.executable, **(outputs or {})}
    found = step(name)
    given = {key: re.sub(r"\$\{\{ (.*?) \}\}", lambda one: known[one[1]], value) for key, value in found["env"].items()}
    assert "${{" not in found["run"], "what is given must come by the environment"
    assert found["shell"] == "bash"
    Path("outputs").write_text("")
    Path("step.sh").write_text(found["run"])
    done = run(
        *("bash", "--noprofile", "--norc", "-eo", "pipefail", "step.sh"),
        RUNNER_TEMP=str(Path.cwd()),
        GITHUB_OUTPUT="outputs",
        **given,
    )
    handed = dict(line.split("=", 1) for line in Path("outputs").read_text().splitlines())
    return done.returncode, done.stdout + done.stderr, handed


def run_check(**inputs: str) -> tuple[int, str, dict[str, str]]:
    make_command(Path("bin/polarcheck"))
    command = {"steps.install.outputs.command": str(Path("bin/polarcheck").absolute())}
    return run_step("check", command, **{"args": "--select rapid-in-polar", **inputs})


def test_the_action_checks_and_hands_on_what_it_found() -> None:
    Path("a b.nc").write_text(RAPID)
    Path("c.nc").write_text(GOOD)
    status, said, handed = run_check()
    assert (status, handed) == (1, {"exit-code": "1", "sarif": "polarcheck.sarif"})
    assert said.startswith("::error title=rapid-in-polar%2C alarm PS0146,file=a b.nc,line=4")
    assert len(json.loads(Path("polarcheck.sarif").read_text())["runs"][0]["results"]) == 1
    assert run_check(paths="c.nc\r\n\n./c.nc\n")[::2] == (0, {"exit-code": "0", "sarif": "polarcheck.sarif"})
    Path("polarcheck.sarif").unlink()
    assert run_check(paths="a b.nc", sarif="")[::2] == (1, {"exit-code": "1"})


def test_nothing_that_is_given_to_the_action_is_a_command() -> None:
    names = ("$(touch ran).nc", "`touch ran`.nc", "; touch ran; .nc", "-h", "* .nc")
    for name in names:
        Path(name).write_text(GOOD)
    assert run_check(paths="\n".join(names))[0] == 0
    assert run_check(args="--select rapid-in-polar $(touch ran) *")[0] == 2
    assert not Path("ran").exists()
    status, said, handed = run_check(args="--no-such-option", sarif="x.sarif")
    assert (status, handed) == (2, {"exit-code": "2"})
    assert "No such option" in said


def test_the_action_checks_what_has_changed() -> None:
    git("init", "-q", "-b", "main")
    Path("a.nc").write_text(RAPID)
    git("add", "-A")
    git("commit", "-q", "-m", "x")
    assert run_check(**{"diff-base": "main"})[2]["exit-code"] == "0"
    condition = read(ACTION)["runs"]["steps"][-1]["if"]
    assert "always()" in condition
    assert "inputs.diff-base == ''" in condition


def test_all_that_the_action_names_is_there() -> None:
    action = read(ACTION)
    steps = action["runs"]["steps"]
    assert action["runs"]["using"] == "composite"
    text = (ROOT / ACTION).read_text("utf-8")
    for name in re.findall(r"\binputs\.([a-z-]+)", text):
        assert name in action["inputs"], name
    for name, output in re.findall(r"\bsteps\.([a-z]+)\.outputs\.([a-z-]+)", text):
        (found,) = [one for one in steps if one.get("id") == name]
        assert f"{output}=" in found.get("run", "python-path="), output
    for one in steps:
        assert ("uses" in one) != ("run" in one and "shell" in one)


# ---- the job of GitLab ----


def job() -> dict[str, Any]:
    (found,) = read("docs/ci/gitlab.yml").values()
    return dict(found)


def run_job(part: str, **changes: str) -> subprocess.CompletedProcess[str]:
    given = {key: str(value) for key, value in job()["variables"].items()}
    return run("sh", "-e", "-c", "\n".join(job()[part]), **{**given, **changes})


def test_the_job_of_gitlab_writes_what_it_hands_over() -> None:
    make_command(Path(".polarcheck/bin/polarcheck"))
    Path("a.nc").write_text(RAPID)
    done = run_job("script", CHECK_ARGS="--select rapid-in-polar")
    assert done.returncode == 1, done.stderr
    assert job()["artifacts"]["when"] == "always"
    reports = job()["artifacts"]["reports"]
    assert len(json.loads(Path(reports["codequality"]).read_text())) == 1
    root = ElementTree.fromstring(Path(reports["junit"]).read_text())  # noqa: S314
    assert root.attrib["failures"] == "1"
    Path("b.nc").write_text(GOOD)
    assert run_job("script", CHECK_ARGS="--machine fanuc --strict", CHECK_PATHS="b.nc ./b.nc").returncode == 0
    assert run_job("script", CHECK_ARGS="--select rapid-in-polar --strict", CHECK_PATHS="b.nc ./b.nc").returncode == 1


# ---- with an installation ----


@pytest.mark.installs
def test_the_hooks_as_pre_commit_installs_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not (ROOT / ".git").exists():
        pytest.skip("this is no checkout")
    monkeypatch.setenv("PRE_COMMIT_HOME", str(tmp_path / "home"))
    monkeypatch.setenv("PRE_COMMIT_COLOR", "never")
    Path("repository").mkdir()
    monkeypatch.chdir("repository")
    git("init", "-q", "-b", "main")
    Path("a.nc").write_text(RAPID)
    Path("polarcheck.toml").write_text(FAULTS_ONLY)
    git("add", "-A")
    tried = run(sys.executable, "-m", "pre_commit", "try-repo", str(ROOT), "--files", "a.nc", "polarcheck.toml")
    assert tried.returncode == 1
    assert tried.stdout.count("Failed") == 2, tried.stdout + tried.stderr
    revision = run("git", "-C", str(ROOT), "rev-parse", "HEAD").stdout.strip()
    ours = {"repo": ROOT.as_uri(), "rev": revision, "hooks": [{"id": name} for name in hooks()]}
    Path(".pre-commit-config.yaml").write_text(yaml.safe_dump({"repos": [ours]}))
    run(sys.executable, "-m", "pre_commit", "install")
    assert commit(tmp_path) == (False, {"polarcheck": "Failed", "polarcheck-config": "Failed"})
    Path("a.nc").write_text(GOOD)
    assert commit(tmp_path) == (True, {"polarcheck": "Passed", "polarcheck-config": "Passed"})


@pytest.mark.installs
def test_the_action_as_it_installs_itself() -> None:
    status, said, handed = run_step("install")
    assert status == 0, said
    Path("a.nc").write_text(RAPID)
    command = {"steps.install.outputs.command": handed["command"]}
    status, said, _ = run_step("check", command, paths="a.nc", args="--select rapid-in-polar")
    assert status == 1
    assert said.startswith("::error title=rapid-in-polar")


@pytest.mark.installs
def test_the_job_of_gitlab_as_it_installs_the_package() -> None:
    if shutil.which("python") is None:
        pytest.skip("there is no command python")
    done = run_job("before_script", CHECK_PACKAGE=str(ROOT))
    assert done.returncode == 0, done.stderr
    Path("a.nc").write_text(RAPID)
    assert run_job("script", CHECK_PATHS="a.nc").returncode == 1
