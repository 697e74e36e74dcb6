"""Called programs of a folder: found before anything runs, each read once; what is not called changes nothing."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import ROOT, report_of, said, tables_of, trace_of

from polarcheck.program.execution import called_programs, execute, programs
from polarcheck.program.execution.called_programs import Library
from polarcheck.program.execution.programs import ProgramName
from polarcheck.program.reading import source
from polarcheck.program.reading.joining import joined
from polarcheck.program.reading.words import read_words

SUB = "G0 X{}.\nM99\n"


@pytest.fixture
def counts(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often a text is read into words, a file from the disk, and a listing is executed."""
    found: Counter[str] = Counter()

    def counted(owner: Any, name: str, what: str) -> None:
        original = getattr(owner, name)

        def count(*arguments: Any, **options: Any) -> Any:
            found[what] += 1
            return original(*arguments, **options)

        monkeypatch.setattr(owner, name, count)

    counted(programs, "read_words", "texts")
    counted(called_programs, "_with_head", "files")
    counted(execute, "_run_all", "executions")
    return found


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    found = tmp_path / "folder"
    found.mkdir()
    return found


def write(folder: Path, **texts: str) -> None:
    """O1234="..." writes the file O1234."""
    for name, text in texts.items():
        (folder / name).write_text(text, "utf-8")


def with_folder(folder: Path, **running: Any) -> dict[str, Any]:
    return {"run": {"subprograms": [str(folder)], **running}}


@pytest.mark.parametrize(("skip", "executions"), [("", 1), ("/", 2)])
def test_twenty_programs_are_read_once_and_executed_once_for_each_state(
    folder: Path, counts: Counter[str], skip: str, executions: int
) -> None:
    write(folder, **{f"O{number:04d}": SUB.format(number) for number in range(100, 120)})
    calls = "".join(f"M98 P{number}\n" for number in range(100, 120))
    assert not report_of(f"O1\n{skip}G0 Z5.\n{calls}M30\n", job=with_folder(folder)).findings
    assert counts == {"texts": 21, "files": 20, "executions": executions}


def test_what_called_programs_call_is_found_before_anything_runs(folder: Path, counts: Counter[str]) -> None:
    write(
        folder,
        O0002="G0 X2.\nG65 P9001 A5.\nM99\n",
        O9001="M98 <DEEP>\nG0 X#1\nM98 P3\nM99\n",
        DEEP="G66 P3\nG0 X4.\nG67\nM198 P0005\nM99\n",
        O0003="G0 Z3.\nM99\n",
        O0005="G0 X6.\nM99\n",
    )
    trace = trace_of("O1\nIF[1 EQ 1]GOTO 5\nN5 M98 P10002\nM30\n", job=with_folder(folder))
    np.testing.assert_array_equal(trace.blocks.word("X")[trace.blocks.has("X")], [2, 4, 6, 5])
    assert counts == {"texts": 6, "files": 5, "executions": 1}


def test_a_computed_number_is_executed_once_more_and_its_file_read_once(folder: Path, counts: Counter[str]) -> None:
    write(folder, O9001="G0 X#1\nM98 P2\nM99\n", O0002="/G0 Z1.\nM99\n")
    program = "O1\n/G0 Z5.\n#1=9001\nG65 P#1 A5.\nG65 P[#1+0] A6.\nM98 P[2]\nM30\n"
    assert not report_of(program, job=with_folder(folder)).findings
    # Block skip off: the number is met, then all is executed with its file; block skip on: the file is there.
    assert counts == {"texts": 3, "files": 2, "executions": 3}


def test_what_is_not_there_is_looked_for_once(
    folder: Path, counts: Counter[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = []
    find = Library.find
    monkeypatch.setattr(Library, "find", lambda self, called: looked.append(called) or find(self, called))
    report = report_of("O1\n/G0 Z5.\nM98 P7\nM98 P7\n#1=7\nM98 P#1\nM30\n", job=with_folder(folder))
    assert said(report) == [(3, "subprogram-missing")]
    assert "O0007 in 3 blocks" in report.findings[0].message
    assert looked == [ProgramName(7, None)]
    assert counts == {"texts": 1, "executions": 2}


HOSTILE = """%
O1234 (D=99. CUTTER)
G137 (of another control)
N5 N5 GOTO 5
M98 P2
TRANSMIT
#50=1/0
g0 x5. ? \u2013
O5
G12.1
G0 X1.
"""


@pytest.mark.ci
@looped("skips", [False, True])
def test_a_program_that_is_never_called_changes_nothing(folder: Path, skips: bool) -> None:
    """Named behind a jump, its file is read; nothing of it is reported, executed, or decides what is."""
    program = "O1\nT0101\nG98 G0 X60. C0\n{}G4 X1.\nGOTO 10\nM98 P1234\nN10 M98 P5\nG12.1\nG1 X40. F200\nG13.1\nM30\n"
    program = program.format("/" if skips else "") + "O2\nG0 X70.\nM99\n"
    job = with_folder(folder) | {"radius_from_comments": True}
    before = report_of(program, job=job)
    write(folder, O1234=HOSTILE)
    assert report_of(program, job=job) == before
    assert ("subprogram-missing", 7) in [(finding.rule, finding.line) for finding in before.findings]


def test_what_one_state_of_block_skip_calls_is_no_part_of_the_other(folder: Path) -> None:
    write(folder, O0002="G0 X5.\nG0 X#1\nM99\n")
    program = "O1\nG0 X50.\n/M98 P2\nM30\n"
    (finding,) = report_of(program, job=with_folder(folder)).findings
    assert (finding.line, finding.rule) == (3, "vacant-variable")
    assert finding.message.endswith("(with block skip off)")
    off, on = (tables_of(program, job=with_folder(folder, block_skip=state))["text"] for state in ("off", "on"))
    assert [len(text.source.parts) for text in (off, on)] == [1, 0]


@pytest.mark.ci
@looped(
    ("block", "rule"),
    [("(A (B)", ""), ("g0 x5.", "lower-case-word"), ("G0 X1. X2.", "word-repeated"), ("(AB", "")],
    one_in=2,
)
def test_what_is_wrong_in_a_text_that_one_state_of_block_skip_calls(folder: Path, block: str, rule: str) -> None:
    # What the rules of the text have found in one text was taken for what is in the other, shorter one.
    write(folder, O0002=f"G0 X5. Z1.\n{block}\nM99\n")
    for program in ("O1\n/M98 P2\nM30\n", "O1\nx5.\n/M98 P2\nM30\n"):
        found = [finding.rule for finding in report_of(program, job=with_folder(folder)).findings]
        assert [name for name in found if name != "program-end-missing"] == sorted(
            {*(["lower-case-word"] * ("x" in program)), rule} - {""}
        )


def test_places_move_with_the_files_that_are_left_out(folder: Path) -> None:
    """O2 is never called, O3 behind it is: its faults stand at its own lines, with what is written there."""
    write(folder, O0002="(MANY)\n" * 7 + SUB.format(2), O0003="G0 X3.\nG0 Z#50\nG0 X[5/0]\nIF[#500 EQ 1]GOTO 9\nM99\n")
    program = "O1\nGOTO 10\nM98 P2\nN10 M98 P3\nM30\n"
    report = report_of(program, job=with_folder(folder))
    messages = {finding.rule: finding.message for finding in report.findings}
    assert messages["variable-out-of-range"].startswith("in O0003, line 2, G0 Z#50: #50 does not exist")
    assert messages["arithmetic-error"].startswith("in O0003, line 3, G0 X[5/0]: G0 X[5/0] divides by zero")
    assert [(entry.reason[:13], entry.blocks) for entry in report.not_evaluated] == [("the condition", 1)]
    tables = tables_of(program, job=with_folder(folder))
    trace, run, text = tables["trace"], tables["run"], tables["text"]
    assert [trace.text.source.part_of(int(line)) for line in trace.blocks.line[3:5]] == [("O0003", 1), ("O0003", 2)]
    written = [text.source.excerpt(int(run.words.start[i]), int(run.words.end[i])) for i in range(len(run.words))]
    assert written == ["O1", "N10", "M98", "P3", "O0003", "G0", "X3.", "G0", "Z#50", "G0", "X[5/0]", "M99", "M30"]
    assert [int(run.words.block[i]) for i in range(len(written))] == run.block[run.row].tolist()
    (remark,) = run.remarks
    assert text.source.part_of(int(text.blocks.line[remark.block])) == ("O0003", 4)


def test_a_program_in_a_file_counts_where_the_file_is_used(folder: Path) -> None:
    """O5 stands in the file of O4: it is there once O4 is called anywhere, as if the file had been loaded."""
    write(folder, O0004="O4\nG0 X4.\nM99\nO5\nG0 X5.\nM99\n")
    called = "O1\nM98 P5\nM98 P4\nM30\n"
    assert not report_of(called, job=with_folder(folder)).findings
    trace = trace_of(called, job=with_folder(folder))
    np.testing.assert_array_equal(trace.blocks.word("X")[trace.blocks.has("X")], [5, 4])
    assert said(report_of("O1\nM98 P5\nGOTO 9\nM98 P4\nN9 M30\n", job=with_folder(folder)))[0] == (
        2,
        "subprogram-missing",
    )


def test_programs_of_a_called_file_are_not_run_by_themselves(folder: Path) -> None:
    write(folder, O0004="O4\nG0 X4.\nM99\nO6\nG12.1\nG0 X5.\nM30\n")
    program = "O1\nM98 P4\nM30\n"
    assert not report_of(program, job=with_folder(folder)).findings
    assert report_of(program, job=with_folder(folder)).programs == ["O1"]


def test_a_file_is_read_as_it_is_whatever_stands_before_it(folder: Path) -> None:
    """Line ends of CR alone, an end of data, text behind the last %: each file has its own."""
    write(folder, O0002="%\nO2\nG0 X2.\nM99\n%\nLEFT OVER\n")
    program = b"%\rO1\rG0 X1.\rM98 P2\rG0 X3.\rM30\r%\rA NOTE\r\x1a"
    tables = tables_of(program, job=with_folder(folder))
    trace = tables["trace"]
    np.testing.assert_array_equal(trace.blocks.word("X")[trace.blocks.has("X")], [1, 2, 3])
    assert trace.blocks.line[trace.blocks.has("X")].tolist() == [3, 12, 5]
    report = report_of(program, job=with_folder(folder))
    assert said(report) == said(report_of(program.replace(b"M98 P2", b"(M98)")))


def test_nothing_outside_the_folders_is_read(folder: Path, counts: Counter[str]) -> None:
    outside = folder.parent / "outside"
    outside.mkdir()
    write(outside, O0002=SUB.format(2), O0003=SUB.format(3))
    (folder / "O0002").symlink_to(outside / "O0002")
    report = report_of("O1\nM98 P2\nM98 P3\nM98 <../outside/O0003>\nM30\n", job=with_folder(folder))
    assert said(report) == [(line, "subprogram-missing") for line in (2, 3, 4)]
    assert counts["files"] == 0


@pytest.mark.ci
def test_not_more_than_a_hundred_files_are_looked_for(folder: Path, counts: Counter[str]) -> None:
    write(folder, **{f"O{number}": SUB.format(1) for number in range(1000, 1150)})
    calls = "".join(f"M98 P{number}\n" for number in range(1000, 1150))
    report = report_of(f"O1\n{calls}M30\n", job=with_folder(folder))
    assert counts["files"] <= 101
    assert {finding.rule for finding in report.findings} == {"subprogram-missing"}


@looped("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
def test_joined_texts_are_those_that_were_read(encoding: str) -> None:
    sample = (ROOT / "sample_programs" / "macro_polygon.nc").read_bytes()
    files = [
        read_words(source.read_source(text, name))
        for name, text in [
            ("main", "%\nO1 (\u00c4NDERUNG 3/4)\nG0 X#1 ?\n\n<NAME> Z-5.,C2.\n%".encode(encoding)),
            ("first", sample),
            ("empty", b""),
            ("last", b"O2\nG0 X\x96 5.\nM99"),
        ]
    ]
    whole = joined(files)
    assert [part.name for part in whole.source.parts] == ["first", "empty", "last"]
    assert len(whole.blocks) == sum(len(file.blocks) for file in files)
    for name in ("words", "comments", "names", "strays", "foreign", "dots", "outside"):
        ours, theirs = getattr(whole, name), [getattr(file, name) for file in files]
        at = 0
        for file, table in zip(files, theirs, strict=True):
            for index in range(len(table)):
                written = file.source.excerpt(int(table.start[index]), int(table.end[index]))
                assert whole.source.excerpt(int(ours.start[at]), int(ours.end[at])) == written
                line = whole.blocks.line[ours.block[at]]
                part = whole.source.part_of(int(line))
                own = (file.source.path, int(file.blocks.line[table.block[index]]))
                assert (part or ("main", int(line))) == own
                at += 1
        assert at == len(ours)
    assert joined(files[:1]) is files[0]


def test_a_folder_that_is_not_there_holds_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("O2\nM99\n", "utf-8")
    for name in ("nowhere", "file"):
        report = report_of("O1\nM98 P2\nM30\n", job=with_folder(tmp_path / name))
        assert said(report) == [(2, "subprogram-missing")]


def test_many_missing_programs_are_one_finding_with_their_numbers() -> None:
    """38 calls and no folder are one mistake; a few are each looked at."""
    calls = "".join(f"M98 P{number}\n" for number in [7001, *range(7010, 7046), 8000])
    report = report_of(f"O1\n{calls}M30\n")
    assert said(report) == [(2, "subprogram-missing")]
    assert report.findings[0].message.endswith("; O7010 to O7045, O8000 are missing as well")
    few = report_of("O1\nM98 P2\nM98 P3\nM98 P2\nM30\n")
    assert said(few) == [(2, "subprogram-missing"), (3, "subprogram-missing")]


RAMP = "G12.1\nG1 G42 X40. F200\nC10.\nX-40.\nC-10.\nX40.\nC0\nG40 X60.\nG13.1\nM99\n"
"""Its start-up needs 4 mm in X: too short where X is 41 before it."""


@pytest.mark.one_in(4)
@pytest.mark.ci
@pytest.mark.parametrize(
    ("starts", "ends"),
    [
        ([60, 41], " (in the call of line 7)"),
        ([41, 60], " (in the call of line 5)"),
        ([41, 60, 41], " (in the call of line 5 and 1 more)"),
        ([41, 41], "on the diameter"),
    ],
)
def test_a_finding_of_one_call_says_of_which(folder: Path, starts: list[int], ends: str) -> None:
    calls = "".join(f"G0 X{x}. C0\n{{}}\n" for x in starts)
    head = "O1\nG98 G40 T0101\nG0 Z5.\n" + calls + "M30\n"
    for call, more in (("M98 P2", "O2\n"), ("M98 Q2", "N2")):
        report = report_of(head.replace("{}", call) + more + RAMP, "fanuc", "1:radius=2,nose=0")
        assert [one.rule for one in report.findings] == ["start-up-shorter-than-radius"]
        assert report.findings[0].message.endswith(ends)
    write(folder, O0002="O2\n" + RAMP)
    program = head.replace("{}", "M98 P2")
    report = report_of(program, "fanuc", "1:radius=2,nose=0", job=with_folder(folder))
    assert [one.line for one in report.findings] == [5 + 2 * starts.index(41)]
    assert "(in the call" not in report.findings[0].message


@pytest.mark.nightly
def test_the_call_may_stand_in_a_called_program() -> None:
    main = "O1\nG98 G40 T0101\nM98 P3\nM30\nO3\nG0 Z5. X60. C0\nM98 P2\nG0 X41. C0\nM98 P2\nM99\n"
    report = report_of(main + "O2\n" + RAMP, "fanuc", "1:radius=2,nose=0")
    assert [one.message.partition("(")[2] for one in report.findings] == ["in the call of line 9)"]


def test_what_the_text_has_wrong_is_of_no_call() -> None:
    report = report_of("O1\nM98 P2\n#1=5\nM98 P2\nM30\nO2\nIF[#1 EQ 5]#1=5\nM99\n")
    assert [one.rule for one in report.findings] == ["macro-syntax"]
    assert "(in the call" not in report.findings[0].message
