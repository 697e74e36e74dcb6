"""The pages under docs/ and README: current where they are made, right in what they show, links that lead somewhere."""

from __future__ import annotations

import re
import shlex
import shutil
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import click
import pytest
from cases import looped
from click.testing import CliRunner
from programs import ROOT

from polarcheck.commands import NAMES, main
from polarcheck.foundation import finding
from polarcheck.reports.pages import json_schema

DOCS = ROOT / "docs"
if DOCS.exists():
    sys.path.insert(0, str(DOCS))
    import make as site
    from generators import controls, report_fields

pytestmark = pytest.mark.skipif(not (ROOT / "docs").exists(), reason="the pages lie in a checkout")

_LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")
_SPAN = re.compile(r"`(polarcheck [^`\n]+)`")
_MADE = {"rules", "machines"}


@cache
def text_of(path: Path) -> str:
    return path.read_text("utf-8")


def pages() -> list[Path]:
    return [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]


def written_pages() -> list[Path]:
    """Those that somebody has written, and index pages."""
    return [path for path in pages() if path.name == "index.md" or not _MADE & set(path.relative_to(ROOT).parts)]


@pytest.mark.ci
def test_the_made_pages_are_current() -> None:
    """`python docs/make.py` makes them anew."""
    made = site.pages()
    differ = [name for name, text in made.items() if not (DOCS / name).exists() or text_of(DOCS / name) != text]
    found = {path.relative_to(DOCS).as_posix() for folder in site.FOLDERS for path in (DOCS / folder).rglob("*")}
    gone = {name for name in found - made.keys() if name.endswith(".md")}
    assert (differ, gone) == ([], set())
    of_rules = [text for name, text in made.items() if name.startswith("rules/") and not name.endswith("index.md")]
    assert all("## What it says" in text for text in of_rules)


def test_the_pages_are_written_and_those_of_what_is_gone_taken_away(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = {"controls.md": "c\n", "rules/polar/one.md": "1\n", "machines/two.md": "2\n"}
    monkeypatch.setattr(site, "pages", lambda: made)
    for name in ("rules/polar/gone.md", "rules/old/gone.md", "own.md"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("before")
    site.write(tmp_path)
    found = {path.relative_to(tmp_path).as_posix(): path.read_text() for path in tmp_path.rglob("*.md")}
    assert found == {**made, "own.md": "before"}


def test_the_table_of_controls_is_up_to_date() -> None:
    """`python docs/make.py` writes it anew."""
    assert text_of(DOCS / "controls.md") == controls.text()


def test_each_field_of_the_schema_is_explained_in_the_docstring_of_its_type() -> None:
    definitions = json_schema.schema("report")["$defs"]
    assert {"makes", "outline"}.isdisjoint(definitions["FileReport"]["properties"])
    for name, definition in definitions.items():
        about, meanings = report_fields.documented(getattr(finding, name))
        assert about
        assert definition["properties"].keys() <= meanings.keys(), name


def test_the_page_of_the_fields_has_a_link_for_each_type() -> None:
    page = report_fields.text()
    headings = re.findall(r"^## (\w+)$", page, re.MULTILINE)
    assert set(re.findall(r"\(#(\w+)\)", page)) == {name.lower() for name in headings}
    assert "It has all fields of [Finding](#finding), and:" in page
    assert "| `machine_file` \\* | text |" in page


# ---- links ----


def anchors(path: Path) -> set[str]:
    """What the headings of a page are called in links, as GitHub makes it."""
    heads = re.findall(r"^#+ (.+)$", text_of(path), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.ci
def test_every_link_leads_somewhere() -> None:
    lost = []
    for page in pages():
        for target in _LINK.findall(text_of(page)):
            name, _, anchor = target.partition("#")
            if "://" in name or name.startswith("mailto:"):
                continue
            path = (page.parent / name).resolve() if name else page
            if not path.exists() or (anchor and anchor not in anchors(path)):
                lost.append(f"{page.relative_to(ROOT)}: {target}")
    assert not lost


def test_the_index_names_every_page() -> None:
    named = set(_LINK.findall(text_of(DOCS / "index.md")))
    own = {path.relative_to(DOCS).as_posix() for path in written_pages() if path.is_relative_to(DOCS)}
    assert own - {"index.md"} <= named


# ---- commands ----


def blocks(text: str) -> Iterator[list[str]]:
    """The blocks of code of a page, indented or fenced, without their indentation."""
    block: list[str] = []
    fenced = False
    for line in [*text.split("\n"), "end"]:
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            block.append(line if fenced else line[4:])
            continue
        elif not line and block and not fenced:
            block.append("")
            continue
        if block:
            yield block
        block = []


def commands(page: Path) -> Iterator[tuple[str, bool]]:
    """The command lines of a page, and whether each stands by itself."""
    for block in blocks(text_of(page)):
        for line in block:
            if line.startswith(("polarcheck ", "$ polarcheck ")):
                # Behind two blanks stands what it does; behind these signs, what the shell does with it.
                yield re.split(r"\s{2,}|\s[|>;]\s", line.removeprefix("$ "))[0].strip(), True
    for span in _SPAN.findall(text_of(page)):
        yield re.split(r"\s[|>;&]|;", span)[0].strip(), False


def parsed(line: str) -> str:
    """What is wrong with a command line, or empty."""
    words = shlex.split(line.replace("\\", "/"), comments=True)[1:]
    command = main.get_command(click.Context(main), words[0]) if words[0] in NAMES else main
    assert command is not None
    try:
        with command.make_context(words[0], words[1:] if command is not main else words):
            return ""
    except click.exceptions.Exit:
        return ""
    except click.UsageError as error:
        # The pages name files of their readers.
        return "" if "does not exist" in error.format_message() else error.format_message()


@pytest.mark.ci
@looped("page", written_pages(), ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_command_line_is_understood(page: Path) -> None:
    wrong = []
    for line, is_whole in commands(page):
        said = parsed(line)
        if not said:
            continue
        if is_whole or not said.startswith("Missing argument"):
            wrong.append(f"{line}: {said}")
    assert not wrong


SAMPLES = "sample_programs"


@cache
def ran(line: str) -> tuple[int, str, str]:
    """Exit code, output and standard error of a command line, beside the sample programs."""
    result = CliRunner().invoke(main, shlex.split(line)[1:], env={"TERM": "xterm"})
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture
def beside_samples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with the sample programs, and with what commands write."""
    shutil.copytree(ROOT / SAMPLES, tmp_path / SAMPLES)
    monkeypatch.chdir(tmp_path)


@pytest.mark.nightly
@pytest.mark.usefixtures("beside_samples")
def test_those_on_sample_programs_run() -> None:
    lines = {line for page in written_pages() for line, _ in commands(page) if SAMPLES in line}
    assert len(lines) >= 4
    failed = [line for line in lines if ran(line)[0] > 1 or ran(line)[2]]
    assert not failed


@pytest.mark.ci
@pytest.mark.usefixtures("beside_samples")
def test_shown_reports_are_what_is_said_today(pytestconfig: pytest.Config) -> None:
    """`pytest --accept` writes them into the pages."""
    for page in written_pages():
        text = shown = text_of(page)
        for block in blocks(text):
            # Others are of programs that their own tests make.
            if block[0].startswith("$ polarcheck ") and SAMPLES in block[0]:
                block = "\n".join(block).rstrip("\n").split("\n")
                said = [block[0], *ran(block[0].removeprefix("$ "))[1].rstrip("\n").split("\n")]
                before, after = ("\n".join(f"    {line}".rstrip() for line in lines) for lines in (block, said))
                assert before in shown
                shown = shown.replace(before, after)
        if pytestconfig.option.update_snapshots and shown != text:
            page.write_text(shown, "utf-8", newline="\n")
        else:
            assert text == shown


# ---- the comparison ----


def test_each_feature_is_shown_by_a_test_that_there_is() -> None:
    """A file alone is one that is still to be written: once it is there, the test in it is to be named."""
    wrong = []
    rows = re.findall(r"^\| ([^|*]+) \| [^|]+ \| ([^|]*) \|", text_of(DOCS / "comparison.md"), re.MULTILINE)
    assert len(rows) > 50
    for feature, shown_by in rows[2:]:
        for name in re.findall(r"`([^`]+)`", shown_by) or [""]:
            file, _, test = name.partition("::")
            path = ROOT / "tests" / file
            if not file or (path.exists() and f"def {test}(" not in text_of(path)):
                wrong.append(f"{feature}: {name or 'no test'}")
    assert not wrong
