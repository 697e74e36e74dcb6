"""No regular expression of the package costs more than the length of the text that it sees."""

from __future__ import annotations

import contextlib
import functools
import importlib
import re

import numpy as np
import pytest
from cases import looped
from pattern_growth import (
    Used,
    constant_patterns,
    methods_of_others,
    recorded,
    worst,
)
from polarcheck.errors import UsageError
from programs import report_of, tables_of

from polarcheck.checking import survey
from polarcheck.columns.contour import index_patterns
from polarcheck.columns.words import comment_patterns, comment_reader
from polarcheck.editor.structure import mentions, workspace
from polarcheck.editor.words import completions
from polarcheck.program.execution import called_programs, spoken_block
from polarcheck.program.execution.programs import ProgramName
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, with_tool
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading import language_blocks, languages, surroundings, translation, walking
from polarcheck.program.reading.globs import Globs
from polarcheck.program.reading.source import read_source
from polarcheck.rewrite.convert import call_words, heads

pytestmark = pytest.mark.ci

#: What a stranger's job file may hold.
GLOBS = ["O12*.nc", "*a*a*a*b", "lathe7/**/x?/**/*.nc", "[a-z]*[!0-9]", "**/a*b*/**", "??*??", "[[[*"]
#: What a stranger's machine file may hold.
STATEMENTS = (("CYCLE*", "none"), ("*A*A*A*B", "path"), ("A**B", "path"))


@functools.cache
def machines() -> dict[str, Machine]:
    return {name: profiles.load(name).machine for name in profiles.names()}


def build_every_pattern() -> None:
    """Call what builds patterns from machines, jobs, options and programs, past what keeps them."""
    codes = np.frombuffer(b"$1\n!2L1\nX=R1 (A)\n", np.uint8)
    for machine in machines().values():
        if words := tuple(machine.control.native_words.items()):
            translation._translation.__wrapped__(words, True)
            translation._translation.__wrapped__(words, False)
            translation.spans(read_source(words[0][0].encode()), words[0][0])
        if listed := tuple(machine.macro.statements.items()):
            spoken_block._patterns.__wrapped__(listed)
        mentions._flow_pattern(machine.macro)
        call_words._pattern(machine.writing.subprogram_call, machine.writing.subprogram_repeats)
        for head in machine.writing.archive_heads:
            heads._archive_pattern(head)
    spoken_block._patterns.__wrapped__(STATEMENTS)
    translation.spans(read_source(b"G17 X C"), " G17  X C ")
    translation.stands_in("G17 X C", " G17  X C ")
    for language in languages.LANGUAGES:
        for pattern in (*(sign.pattern for sign in language.signs), language.never):
            languages._compiled.__wrapped__(pattern)
    for name in ("high-level", "user-task"):
        language_blocks.extract_statements(codes.copy(), name)
    surroundings._marks_of_channels(codes.copy(), "$", "!")
    survey._begins(None)
    called_programs.names_of(ProgramName(1234, None))
    called_programs.names_of(ProgramName(None, "A.B+C"))
    called_programs._with_head(b"G0\n", "x.nc", ProgramName(None, "OFACE"))
    Globs("/programs", GLOBS)
    for head in (walking._HEAD, walking._STRICT_HEAD):
        walking._reads_as_program("", head)
    workspace.naming([1234, "OFACE"])
    for variable in (500, "R5", "#_UFO"):
        workspace.writing(variable)
    with contextlib.suppress(UsageError):
        with_tool(Job(), "8:radius=x")
    report_of("O1\nG0 X1.\n#1=1\nO2\nM30\n", "fanuc")
    importlib.reload(completions)
    # The words without a size: all patterns are tried, and none is found.
    comment_reader.shapes_in("HEX SQ OCT PENT FLATS BOSS AF", False)
    comment_reader.depth_in("DEPTH DEEP", False)
    for bar in ("BAR", "HEX BAR", "BAR DIA 28"):
        comment_reader.bar_in(bar, False)
    for cutter in ("X", "R5", "CUTTER D12 10 MILL"):
        comment_reader.cutter_radius(cutter, False)
    comment_reader.speaks_of_tool("T7 DRILL")
    list(comment_reader._allowances(" ".join(comment_patterns.ALLOWANCE.words), False))
    index_patterns._is_stated(tables_of("(3 SLOTS)\nG0 X1.\n", "fanuc")["trace"], 3)
    report_of("(BAR DIA 28)\nT0101\nG98 G0 X60. Z2. C0\nG12.1\nG1 X50. F200\nG13.1", "fanuc")


@functools.cache
def patterns() -> dict[str, Used]:
    """Every pattern of the package; those of one line apart by their number."""
    constants, built = constant_patterns()
    used = {f"{one.place} {number}": one for number, one in enumerate(constants)}
    hits = recorded(build_every_pattern)
    for site in built:
        of_site = [hit for hit in hits if hit.module == site.module and site.spans(hit.line)]
        methods = frozenset({site.function} if site.function != "compile" else methods_of_others(site.module))
        texts = dict.fromkeys(hit.pattern for hit in of_site)
        used |= {f"{site.place} {number}": Used(one, site.place, methods) for number, one in enumerate(texts)}
    return used


@pytest.mark.nightly
def test_every_pattern_of_the_package_is_tried() -> None:
    """A call that builds a pattern at run time, and that build_every_pattern does not reach, is named here."""
    places = {used.place for used in patterns().values()}
    assert not {site.place for site in constant_patterns()[1]} - places
    assert len(patterns()) > 200
    assert {"polarcheck.columns.words", "polarcheck.editor", "polarcheck.program.machines"} <= {
        place.rpartition(".")[0] for place in places
    }


@pytest.mark.nightly
def test_the_methods_of_a_pattern_are_known_after_many_others_were_compiled() -> None:
    before, _ = constant_patterns()
    re.purge()
    assert [used.methods for used in constant_patterns()[0]] == [used.methods for used in before]


@pytest.mark.nightly
@looped("part", range(8), one_in=4)
def test_no_pattern_costs_more_than_the_length_of_its_text(part: int) -> None:
    """Slow, since it tries each part of each pattern: 90,000 texts of nine sizes. A new pattern is tried by itself."""
    tried = {
        name: used
        for name, used in patterns().items()
        if not name.startswith(OF_SHORT_TEXTS) and not str(used.pattern.pattern).startswith(OF_FILE_NAMES)
    }
    slow = {name: worst(used.pattern, used.methods) for name, used in list(tried.items())[part::8]}
    assert not {name: said for name, said in slow.items() if said}


#: Modules whose patterns see comments of at most comment_patterns.LONGEST characters, and docstrings.
OF_SHORT_TEXTS = (
    "polarcheck.columns.words.comment_reader:",
    "polarcheck.reports.pages.json_schema:",
)
#: How the pattern of the names of files begins, which are short.
OF_FILE_NAMES = "O?0*"


def test_a_long_comment_is_not_searched() -> None:
    long = "BAR DIA 28 " * 40
    assert len(long) > comment_patterns.LONGEST
    assert comment_reader.plain_text(long) == ""
    assert not comment_reader.speaks_of_tool(f"T7 END MILL {long}")


#: Patterns that once stood in the package, and shapes known for what they cost.
SLOW = {
    "cubic, an unanchored number and two runs of blanks": (
        r"(\d+\s*/\s*\d+|\d*\.?\d+)\s*(\"|IN\b\.?)?[\s-]*(?:DIA\w*|CUTTER)",
        "search",
    ),
    "a word that gives its digits back": (r"(?:\bDIA\w*\.?|\bD)\s*[=:]?\s*(\d*\.?\d+)MM", "search"),
    "two runs of one character at a fixed place": (r"^\W*T\s*0*(\d+)\b", "match"),
    "blanks before and behind what may be missing": (r"\s*(\d{1,15})\s*(?:[KMGT])?B?\s*", "fullmatch"),
    "an unanchored run of blanks": (r"[ \t]*\(expect: [^()\n]*+\)", "sub"),
    "a bracket that is looked for from each other one": (r"\[(!?)(\]?[^\]/]*)\]|.", "finditer"),
    "a long text without its end": (
        r'"""(?:[^\\]|\\.)*?(?:"""|\Z)|"(?:[^"\\\n]|\\.)*+"?|#[^\n]*+',
        "sub",
    ),
    "letters that are looked at again from each of them": (rb"(?![A-Z][OI]++(?![A-Z0-9_]))[A-Z][A-Z_]", "search"),
    "bytes": (rb"[A-Z]{2,}[ \t]++\d++\Z", "search"),
    "a repeat of a repeat": (r"(?:A+)+B", "match"),
    "two ways through a repeat": (r"(?:A|AA)*B", "match"),
    "words and blanks": (r"(?:\w+\s*)*:", "match"),
    "three stars": (r"A.*A.*A.*B", "fullmatch"),
    "a look ahead from every place": (r"(?=\w*:)", "search"),
}


@pytest.mark.nightly
@looped("name", SLOW)
def test_a_pattern_that_costs_more_is_seen(name: str) -> None:
    pattern, method = SLOW[name]
    assert worst(re.compile(pattern, re.IGNORECASE | re.DOTALL), {method})
