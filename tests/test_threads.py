"""Functions for Python whose first calls of a process come from several threads at once, and what makes them safe."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import msgspec
import pytest
from cases import looped
from click.testing import CliRunner

import polarcheck
from polarcheck.commands import main
from polarcheck.foundation import decoding

pytestmark = pytest.mark.ci

PACKAGE = Path(polarcheck.__file__).parent

#: A process whose threads all begin with the same call; it writes what each of them got, told apart by their texts.
AT_ONCE = """
import faulthandler, sys, threading
faulthandler.enable()
import polarcheck

OFFSET = "G98 G0 X60. C0 T0808\\nG12.1\\nG42 G1 X40. F100\\nG1 C10.\\nG40 X60.\\nG13.1\\nM30\\n"
RAPID = OFFSET.replace("G1 C10.", "G0 C10.")
PART = {"shape": "circle", "diameter": 30}
CALLS = {
    "certify": lambda: polarcheck.certify("post.toml"),
    "check": lambda: polarcheck.check(["a.nc", "b.nc"]),
    "check_text": lambda: polarcheck.check_text(RAPID, machine="fanuc-30i", tools={8: 4.0}),
    "compare": lambda: polarcheck.compare("a.nc", "b.nc"),
    "compare_text": lambda: polarcheck.compare_text(OFFSET, RAPID, tools={8: polarcheck.Tool(radius=4.0)}),
    "compensate": lambda: polarcheck.compensate("a.nc", center=True),
    "compensate_text": lambda: polarcheck.compensate_text(OFFSET, center=True, tools={8: 4.0}),
    "convert": lambda: polarcheck.convert("a.nc", to="haas-lathe"),
    "convert_text": lambda: polarcheck.convert_text(OFFSET, to="haas-lathe", machine="fanuc-30i", tools={8: 4.0}),
    "feeds": lambda: polarcheck.feeds("a.nc"),
    "feeds_text": lambda: polarcheck.feeds_text(OFFSET, limits={"c_feed": 60}),
    "machine": lambda: polarcheck.machine("haas-lathe", changes={"limits.c_feed": 3600}),
    "machine_names": lambda: polarcheck.machine_names(),
    "part": lambda: polarcheck.part("a.nc", part=PART),
    "part_text": lambda: polarcheck.part_text(OFFSET, stock=polarcheck.Stock(diameter=60.0), part=PART),
    "plot": lambda: polarcheck.plot("a.nc"),
    "plot_text": lambda: polarcheck.plot_text(OFFSET, tools={8: 4.0}),
    "render": lambda: polarcheck.render(polarcheck.check_text(RAPID, tools={8: 4.0}), "json"),
    "roll": lambda: polarcheck.roll("a.nc"),
    "roll_text": lambda: polarcheck.roll_text(OFFSET, tools={8: 4.0}),
    "trace": lambda: polarcheck.trace("a.nc"),
    "trace_text": lambda: polarcheck.trace_text(OFFSET, tools={"8": {"radius": 4}}, work_offsets={"G54": 0.0}),
    "unroll": lambda: polarcheck.unroll("a.nc"),
    "unroll_text": lambda: polarcheck.unroll_text(OFFSET, tools={8: 4.0}),
}

def run(call):
    start.wait()
    try:
        result = call()
    except BaseException as error:
        result = f"{type(error).__name__}: {error}"
    results.append(result)

def text(result):
    import msgspec
    return repr(msgspec.to_builtins(result, enc_hook=lambda column: repr(column.tolist())))

if __name__ == "__main__":
    name, count = sys.argv[1], int(sys.argv[2])
    start, results = threading.Barrier(count), []
    threads = [threading.Thread(target=run, args=[CALLS[name]]) for _ in range(count)]
    sys.setswitchinterval(1e-5)
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert len(results) == count, results
    print(*sorted({text(result) for result in results}), sep="\\n")
"""

OFFSET = "G98 G0 X60. C0 T0808\nG12.1\nG42 G1 X40. F100\nG1 C10.\nG40 X60.\nG13.1\nM30\n"
MANIFEST = """
title = "post"
features = ["first"]
[controls.fanuc]
machine = "fanuc-30i"
[[case]]
feature = "first"
control = "fanuc"
program = "a.nc"
verdict = "unverified"
golden = "golden.jsonl"
"""

FUNCTIONS = [name for name in polarcheck.__all__ if inspect.isfunction(getattr(polarcheck, name))]
FUNCTIONS.sort(key=lambda name: name != "machine")  # the quickest, which each run takes
PROCESSES = 20


@pytest.fixture
def post(own_folder: None) -> None:
    """A folder with two programs, a job file and a manifest with a golden trace."""
    Path("a.nc").write_text(OFFSET, "utf-8")
    Path("b.nc").write_text(OFFSET.replace("X40.", "X42."), "utf-8")
    Path("polarcheck.toml").write_text('machine = "fanuc-30i"\ntools.8.radius = 4.0\n', "utf-8")
    Path("post.toml").write_text(MANIFEST, "utf-8")
    CliRunner().invoke(main, ["certify", "post.toml", "--update"])
    assert Path("golden.jsonl").stat().st_size


def results_of(name: str, threads: int) -> tuple[int, str, str]:
    """Return how a process ended whose threads begin with this function, and the different results that they got."""
    command = [sys.executable, "-c", AT_ONCE, name, str(threads)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=300)
    return ended.returncode, ended.stdout, ended.stderr


@pytest.mark.nightly
def test_threads_may_begin_with_the_same_function(post: None) -> None:
    assert results_of("machine", 2) == results_of("machine", 1)


@pytest.mark.nightly
@pytest.mark.one_in(28)
@pytest.mark.parametrize("threads", [2, 8])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_threads_of_many_processes_begin_with_the_same_function(name: str, threads: int, post: None) -> None:
    code, result, told = results_of(name, 1)
    assert (code, told) == (0, "")
    assert result.count("\n") == 1
    assert "Error: " not in result[:40] or name.startswith("roll")  # there is nothing to roll
    for _ in range(PROCESSES):
        assert results_of(name, threads) == (code, result, told)


# ---- the one place that decodes ----

#: What msgspec learns a type by. Its encoders, and `to_builtins`, learn nothing.
LEARNING = ("Decoder", "convert", "decode")
#: Modules of msgspec that have these.
FORMATS = ("json", "msgpack", "toml", "yaml")

#: What a module holds that may decode: few do, and to read their syntax takes a while.
SIGNS = re.compile(rf"msgspec\b.*\b({'|'.join(LEARNING)}|as)\b|from msgspec")
MODULE = re.compile(r"msgspec(\.\w+)*")


def decoded_by(text: str) -> list[int]:
    """Return the lines of a module in which it decodes by msgspec."""
    lines = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Attribute) and node.attr in LEARNING and MODULE.fullmatch(ast.unparse(node.value)):
            lines.append(node.lineno)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "msgspec":
            if {alias.name for alias in node.names} & {*LEARNING, *FORMATS}:
                lines.append(node.lineno)
        elif isinstance(node, ast.Import):
            lines += [node.lineno for alias in node.names if alias.name.startswith("msgspec") and alias.asname]
    return lines


@looped(
    "planted",
    [
        "value = msgspec.convert(table, Kind)",
        "value = msgspec.json.decode(data, type=Kind)",
        "DECODER = msgspec.msgpack.Decoder(Kind)",
        "from msgspec import convert",
        "from msgspec import json",
        "from msgspec.json import decode as read",
        "import msgspec as fast",
        "def late():\n    return map(msgspec.toml.decode, texts)",
    ],
)
def test_a_planted_decoder_is_seen(planted: str) -> None:
    assert SIGNS.search(planted)
    assert decoded_by(f"import msgspec\nmsgspec.json.encode(1).decode()\ndata.decode()\n{planted}\n")


def test_only_one_module_decodes_by_msgspec() -> None:
    texts = {path: path.read_text("utf-8") for path in PACKAGE.rglob("*.py")}
    found = [
        path.relative_to(PACKAGE).as_posix() for path, text in texts.items() if SIGNS.search(text) and decoded_by(text)
    ]
    assert found == ["foundation/decoding.py"]


@pytest.fixture
def learnt(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The types for which a decoder is made, in order; a failed assertion stands among them as text."""
    kinds: list[Any] = []

    def observed(make: Any) -> Any:
        def decoder(kind: Any) -> Any:
            kinds.append((make, kind) if decoding._LEARNING._is_owned() else f"{kind} without the lock")  # type: ignore[attr-defined]
            return make(kind)

        return decoder

    convert = msgspec.convert

    def converted(value: Any, kind: Any, **options: Any) -> Any:
        if (msgspec_json, kind) not in kinds:
            kinds.append(f"{kind} converted before it was learnt")
        return convert(value, kind, **options)

    msgspec_json = msgspec.json.Decoder
    monkeypatch.setattr(msgspec, "convert", converted)
    monkeypatch.setattr(msgspec.json, "Decoder", observed(msgspec.json.Decoder))
    monkeypatch.setattr(msgspec.msgpack, "Decoder", observed(msgspec.msgpack.Decoder))
    decoding._json_decoder.cache_clear()
    decoding._msgpack_decoder.cache_clear()
    return kinds


def test_each_type_is_learnt_once_behind_the_lock(learnt: list[Any]) -> None:
    def run() -> None:
        polarcheck.check_text("M30\n", machine="fanuc-30i", tools={1: 4.0}, stock={"hexagon": 27})
        with pytest.raises(polarcheck.errors.UsageError):
            polarcheck.check_text("M30\n", tools={1: {"radus": 1}})
        polarcheck.machine("haas-lathe", changes={"limits.c_feed": 60})

    threads = [threading.Thread(target=run) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {kind.__name__ for _, kind in learnt} >= {"Job", "Machine"}
    assert [kind for kind in learnt if isinstance(kind, str)] == []
    assert len(learnt) == len(set(learnt))
