"""A manifest may name any file: of one outside of its folder and of the working folder no route quotes any text."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest
from click.testing import CliRunner
from polarcheck.errors import PolarcheckError
from test_certify import EXAMPLE
from test_cli import GOOD, RAPID

import polarcheck
from polarcheck.checking import check
from polarcheck.commands import main

#: Stands in each file outside, where a message quotes it if the file lies inside.
MARK = "7177"
PASSWORDS = f"root:x:{MARK}\nG98 G0 X{MARK}Z.\nG12.1\nG1 X40. F200\nG{MARK}\n"
HEAD = 'title = "post"\n[controls.c]\nmachine = "fanuc-30i"\n'
MANIFEST = f'{HEAD}[[case]]\nfeature = "contour"\ncontrol = "c"\nprogram = "in.nc"\n'
WITH_CONFIG = f'config = "j.toml"\n{MANIFEST}'
CALLING = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P9001\nG13.1\nM30\n"
FORMATS = ("text", "json", "html")


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The manifest and the working folder lie beside a folder of somebody else."""
    for name in ("work", "secret"):
        (tmp_path / name).mkdir()
    monkeypatch.chdir(tmp_path / "work")
    for name in [name for name in os.environ if name.startswith("POLARCHECK_")]:
        monkeypatch.delenv(name)
    Path("in.nc").write_text(GOOD)


def outputs(*arguments: str) -> list[str]:
    """All that certify prints and writes in its formats, and what the function for Python gives or raises."""
    said = []
    for form in FORMATS:
        result = CliRunner().invoke(main, ["certify", "post.toml", "--format", form, "-o", f"{form}:out", *arguments])
        assert result.exit_code in (1, 2, 3), result.output
        said += [result.stdout, result.stderr]
        said += [Path("out").read_text()] if Path("out").exists() else []
    try:
        names = [name for option, name in pairwise(arguments) if option == "--case"]
        said.append(repr(polarcheck.certify("post.toml", cases=names)))
    except (PolarcheckError, RuntimeError) as error:
        said += [str(error), repr(error.__context__), repr(error.__cause__)]
    return said


def quotes(secret: str, *arguments: str) -> bool:
    """Return True if the text of the secret file is quoted; else the certificate says that it is not."""
    said = outputs(*arguments)
    is_quoted = any(secret in text for text in said)
    assert is_quoted or all("nothing is quoted of" in " ".join(text.split()) for text in said if len(text) > 200)
    return is_quoted


def of_program(path: str) -> str:
    return MANIFEST.replace("in.nc", path)


def of_machine(path: str) -> str:
    return MANIFEST.replace("fanuc-30i", path)


def linked(path: str) -> str:
    Path("link.nc").symlink_to(path)
    return of_program("link.nc")


def in_a_linked_folder(path: str) -> str:
    Path("folder").symlink_to("../secret")
    return of_program(f"folder/{Path(path).name}")


def beside(**texts: str) -> Callable[[str], str]:
    """A manifest with files beside it, `__` for the point; `@` is the path of the file outside."""
    manifest = texts.pop("manifest")

    def written(path: str) -> str:
        for name, text in texts.items():
            Path(name.replace("__", ".")).write_text(text.replace("@", path))
        return manifest.replace("@", path)

    return written


def drawing(path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.layers.add(f"L{MARK}")
    document.modelspace().add_line((0, 0), (1, 1), dxfattribs={"layer": f"L{MARK}"})
    document.saveas(path)


CALLED = f"O9001\nG0 C5.\nG{MARK}\nM99\n"
OFFSETS = f"%\nG10 P1 R4.\nQ{MARK} Q0\n%\n"
#: How a manifest leads to a file: its name and its text, and a function from its path to the manifest.
ROUTES: dict[str, tuple[str, str | Callable[[Path], None], Callable[[str], str]]] = {
    "program": ("x", PASSWORDS, of_program),
    "program by a link": ("x", PASSWORDS, linked),
    "program in a linked folder": ("x", PASSWORDS, in_a_linked_folder),
    "program with backslashes": ("x", PASSWORDS, lambda path: of_program("..\\\\secret\\\\x")),
    "program by a pattern": (
        "contour", PASSWORDS,
        beside(manifest=f'{HEAD}programs = "../secret/{{feature}}"\n'),
    ),
    "program that is unverified": (
        "x", f"T{MARK}\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\nM30\n",
        of_program,
    ),
    "program beside its expected findings": (
        "x", PASSWORDS,
        lambda path: of_program(path) + 'findings = [{ rule = "rapid-in-polar", line = 3 }]\n',
    ),
    "called program": (
        "O9001", CALLED,
        beside(in__nc=CALLING, manifest=f'{MANIFEST}[run]\nsubprograms = ["../secret"]\n'),
    ),
    "called program by a config": (
        "O9001", CALLED,
        beside(in__nc=CALLING, j__toml='[run]\nsubprograms = ["../secret"]\n', manifest=WITH_CONFIG),
    ),
    "machine": ("m.toml", f"inherits = QZ{MARK}\n", of_machine),
    "machine with an unknown key": ("m.toml", f'inherits = "fanuc"\n{MARK} = 1\n', of_machine),
    "machine with a wrong value": (
        "m.toml", f'inherits = "fanuc"\n[limits]\nc_feed = "{MARK}"\n',
        of_machine,
    ),
    "inherited machine": (
        "m.toml", f"{MARK} = 1\n",
        beside(n__toml='inherits = "@"\n', manifest=of_machine("n.toml")),
    ),
    "codes of a sound machine": (
        "m.toml", f'inherits = "fanuc"\n[polar]\non = ["M{MARK[:3]}"]\noff = ["M718"]\n',
        beside(in__nc=RAPID.replace("G12.1", "G112"), manifest=of_machine("@")),
    ),
    "config": ("x.toml", f"{MARK} = 1\n", beside(manifest=f'config = "@"\n{MANIFEST}')),
    "config that is no TOML": ("x.toml", f"machine = QZ{MARK}\n", beside(manifest=f'config = "@"\n{MANIFEST}')),
    "extended config": (
        "x.toml", f"units = '{MARK}'\n",
        beside(j__toml='extend = "@"\n', manifest=WITH_CONFIG),
    ),
    "offsets": ("x", OFFSETS, beside(manifest=f'offsets = "@"\n{MANIFEST}')),
    "offsets of a config": ("x", OFFSETS, beside(j__toml='offsets = "@"\n', manifest=WITH_CONFIG)),
    "drawing": ("x.dxf", drawing, beside(manifest=f'{MANIFEST}[[case.part]]\ndrawing = "@"\nlayers = ["z"]\n')),
    "drawing of a config": (
        "x.dxf", drawing,
        beside(j__toml='[[part]]\ndrawing = "@"\nlayers = ["z"]\n', manifest=WITH_CONFIG),
    ),
}  # fmt: skip


def lead_to(route: str, folder: str) -> None:
    """Write the file of a route into a folder, and the manifest that leads to it."""
    name, text, manifest = ROUTES[route]
    path = Path(folder, name).resolve()
    if callable(text):
        text(path)
    else:
        path.write_text(text)
    Path("post.toml").write_text(manifest(path.as_posix()))


@pytest.mark.one_in(21)
@pytest.mark.nightly
@pytest.mark.parametrize("route", ROUTES)
def test_no_text_of_a_file_outside_is_quoted(route: str) -> None:
    lead_to(route, "../secret")
    assert not quotes(secret_of(route))
    assert not quotes(secret_of(route), "--update")


@pytest.mark.one_in(7)
@pytest.mark.parametrize("route", ROUTES)
def test_the_same_text_is_quoted_where_the_working_folder_is_above(route: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each route would quote: a file in the working folder or the folder of the manifest has its messages."""
    lead_to(route, "../secret")
    monkeypatch.chdir("..")
    result = CliRunner().invoke(main, ["certify", "work/post.toml"])
    assert "nothing is quoted" not in result.output
    assert secret_of(route) in result.output


def secret_of(route: str) -> str:
    return MARK[:3] if route == "codes of a sound machine" else MARK


def certificate() -> tuple[str, list[str], list[str]]:
    """State, reasons and remarks of the first case."""
    case = polarcheck.certify("post.toml").cases[0]
    return case.state, case.reasons, case.remarks


def test_what_can_be_judged_is_judged() -> None:
    Path("../secret/x").write_text(RAPID)
    Path("post.toml").write_text(of_program("../secret/x"))
    state, reasons, remarks = certificate()
    assert (state, reasons) == ("fail", ["line 4: error: Rapid traverse in the polar mode [rapid-in-polar]"])
    assert "../secret/x" in remarks[0]
    finding = 'verdict = "fail"\nfindings = [{ rule = "rapid-in-polar", block = "G0C5." }]\n'
    Path("post.toml").write_text(of_program("../secret/x") + finding)
    assert certificate()[:2] == ("pass", [])


def test_files_beside_the_manifest_are_quoted_from_any_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("below").mkdir()
    Path("below/x").write_text(PASSWORDS)
    Path("post.toml").write_text(of_program("below/x"))
    monkeypatch.chdir("../secret")
    result = CliRunner().invoke(main, ["certify", "../work/post.toml"])
    assert MARK in result.stdout
    assert "nothing is quoted" not in result.stdout


@pytest.fixture
def golden() -> None:
    """The example of the page, whose golden traces lie outside."""
    shutil.copytree(EXAMPLE, ".", dirs_exist_ok=True)
    Path("golden").rename("../secret/golden")
    text = Path("post.toml").read_text("utf-8")
    Path("post.toml").write_text(text.replace('golden = "golden/', 'golden = "../secret/golden/'), "utf-8")


@pytest.mark.nightly
@pytest.mark.usefixtures("golden")
def test_a_golden_trace_outside_is_compared_and_not_quoted() -> None:
    assert certificate()[0] == "pass"
    path = Path("../secret/golden/contour.jsonl")
    text = path.read_text()
    for changed in (text.replace('"feed":', f'"feed":{MARK}'), text.replace('"z":[', f'"z":[{MARK}'), PASSWORDS):
        assert changed != text
        path.write_text(changed)
        (case,) = polarcheck.certify("post.toml", cases=["contour/lathe-7"]).cases
        state, reasons, remarks = case.state, case.reasons, case.remarks
        assert (state, reasons) == ("fail", ["the path is not that of ../secret/golden/contour.jsonl"])
        assert "nothing is quoted of" in remarks[0]
        assert not quotes(MARK, "--case", "contour/lathe-7")
        assert not quotes(MARK, "--case", "contour/lathe-7", "--update")


@pytest.mark.nightly
def test_the_path_of_a_program_outside_is_compared_and_not_quoted() -> None:
    shutil.copytree(EXAMPLE, ".", dirs_exist_ok=True)
    text = Path("sinumerik/contour.mpf").read_text("utf-8")
    Path("../secret/contour.mpf").write_text(text.replace("Z-3", "Z-3.7177"), "utf-8")
    manifest = Path("post.toml").read_text("utf-8")
    Path("post.toml").write_text(manifest.replace("sinumerik/{feature}.mpf", "../secret/{feature}.mpf"), "utf-8")
    (case,) = polarcheck.certify("post.toml", cases=["contour/lathe-8"]).cases
    assert case.state == "fail"
    assert "the path is not that of contour/lathe-7" in case.reasons
    assert not quotes(MARK, "--case", "contour/lathe-8")


def test_a_bug_in_a_file_outside_is_reported_without_its_text(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ValueError(f"could not convert string to float: {MARK}")

    Path("../secret/x").write_text(PASSWORDS)
    Path("post.toml").write_text(of_program("../secret/x"))
    monkeypatch.setattr(check, "read", fail)
    said = [*outputs(), *outputs("--debug")]
    assert any("RuntimeError: ValueError in " in text for text in said)
    assert not any(MARK in text for text in said)


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="a file of Linux")
def test_the_environment_is_not_quoted(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("post.toml").write_text(of_program("/proc/self/environ"))
    assert not quotes("PATH=")
