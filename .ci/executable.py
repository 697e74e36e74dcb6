"""
Build polarcheck as a folder with an executable, for computers without Python, and try it.

    python .ci/executable.py [FOLDER]

The folder is `dist` if none is named. The executable lies in `dist/polarcheck`, and a zip file beside it, named by
version and system, holds the same to be carried away. It is for the system and the processor that it was built on. The
environment that it is built from is made anew, so that nothing gets in that polarcheck does not need.
"""

from __future__ import annotations

import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SAMPLES = "sample_programs"
COMMANDS = re.compile(r"^  ([a-z]+) ", re.MULTILINE)


def main() -> None:
    """Build, try, pack."""
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "dist").resolve()
    with tempfile.TemporaryDirectory() as made:
        python = environment(Path(made) / "venv")
        build(python, out, Path(made) / "work")
        attempt(python, command(out / "polarcheck"))
    version = said(command(out / "polarcheck"), "--version").split()[-1]
    name = f"polarcheck-{version}-{platform.system()}-{platform.machine()}".lower()
    packed = shutil.make_archive(os.fspath(out / name), "zip", out, "polarcheck")
    size = sum(path.stat().st_size for path in (out / "polarcheck").rglob("*") if path.is_file())
    print(f"{out / 'polarcheck'}: {size / 1e6:.0f} MB; {packed}: {Path(packed).stat().st_size / 1e6:.0f} MB")


def environment(folder: Path) -> Path:
    """An environment with polarcheck, what it needs, and PyInstaller; its Python."""
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    subprocess.run(
        [python, "-m", "pip", "install", "-q", "--disable-pip-version-check", f"{ROOT}[server]", "pyinstaller>=6.10"],
        check=True,
    )
    return python


def build(python: Path, out: Path, work: Path) -> None:
    """Run PyInstaller; what has been built there before is replaced."""
    options = ["--noconfirm", "--log-level", "WARN", "--distpath", out, "--workpath", work]
    subprocess.run([python, "-m", "PyInstaller", *options, ROOT / ".ci" / "executable.spec"], check=True, cwd=ROOT)


def command(folder: Path) -> Path:
    return folder / ("polarcheck.exe" if os.name == "nt" else "polarcheck")


def said(*arguments: str | Path, codes: tuple[int, ...] = (0,), given: bytes = b"") -> str:
    """What a command prints to whom this is given; another exit code ends the build."""
    environment = {**os.environ, "PYTHONUTF8": "1"}
    done = subprocess.run(arguments, capture_output=True, cwd=ROOT, env=environment, input=given, timeout=600)
    if done.returncode not in codes or done.stderr:
        sys.exit(f"{arguments}: exit code {done.returncode}\n{done.stderr.decode(errors='replace')}")
    return done.stdout.decode("utf-8").replace("\r\n", "\n")


def attempt(python: Path, built: Path) -> None:
    """The executable says what the installed package says."""
    installed = (python, "-m", "polarcheck")
    commands = COMMANDS.findall(said(built, "--help").partition("Commands:")[2])
    for arguments in (
        *((name, "--help") for name in commands),
        ("rules", "--format", "json"),
        ("machines",),
        ("machines", "fanuc-30i"),
        ("explain", "rapid-in-polar"),
        ("schema",),
        ("completion", "powershell"),
        ("check", SAMPLES, "--format", "json"),
        *(
            [("check", SAMPLES, "--format", "json", "--jobs", "2")]
            if "--jobs" in said(built, "check", "--help")
            else []
        ),
        ("check", f"{SAMPLES}/hexagon.nc"),
        ("trace", f"{SAMPLES}/hexagon.nc"),
    ):
        expected, found = (said(*how, *arguments, codes=(0, 1)) for how in (installed, (built,)))
        if expected != found:
            sys.exit(f"polarcheck {' '.join(arguments)}: the executable says something else than the package")
        print(f"polarcheck {' '.join(arguments)}: the same, {len(found)} characters")
    if "server" in commands:
        talk(built)
    files = json.loads(said(built, "check", SAMPLES, "--format", "json", codes=(0, 1)))["files"]
    print(f"{len(files)} sample programs checked")
    for name, how in (("installed package", installed), ("executable", (built,))):
        times = []
        for _ in range(5):
            begun = time.perf_counter()
            said(*how, "--version")
            times.append(time.perf_counter() - begun)
        print(f"start of the {name}: {sorted(times)[2] * 1000:.0f} ms")


def talk(built: Path) -> None:
    """The language server answers an editor, and ends when it is told to."""
    told = b""
    for number, method in enumerate(("initialize", "shutdown", "exit"), 1):
        parameters = {"capabilities": {}, "processId": None, "rootUri": None} if method == "initialize" else None
        message: dict[str, object] = {"jsonrpc": "2.0", "method": method, "params": parameters}
        body = json.dumps(message if method == "exit" else {**message, "id": number}).encode()
        told += b"Content-Length: %d\r\n\r\n%b" % (len(body), body)
    if "hoverProvider" not in said(built, "server", given=told):
        sys.exit("polarcheck server: it answers no editor")
    print("polarcheck server: it answers an editor")


if __name__ == "__main__":
    main()
