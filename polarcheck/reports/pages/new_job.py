"""The polarcheck.toml that `polarcheck init` writes: what the programs say about the job, and a place for the rest."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence

import msgspec

from polarcheck.checking.survey import StatedOffset, Survey
from polarcheck.foundation.errors import counted, first_of
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.machines import profiles
from polarcheck.program.reading import files
from polarcheck.program.reading.excerpt import shortened, visible

SCHEMA_FILE = "polarcheck.schema.json"
COLUMNS = 100
#: How many programs are named; of the others the number is given.
_NAMED = 3
#: The most entries for programs whose comments give different radii.
_ENTRIES = 20
_LONGEST = 60
_DECIMALS = 6


def text(survey: Survey, machine: str | None, outer: str | None, schema: bool, extensions: Sequence[str] = ()) -> str:
    """
    Return the file, valid as it is: unknown values are commented out, to be filled in.

    survey: what the programs say.
    machine: the machine as it is to be written; None if unknown.
    outer: the path of the job file that has applied so far, if there is one.
    schema: its schema lies beside it.
    extensions: those of the programs, if not the usual ones.
    """
    lines = [
        *([f"#:schema ./{SCHEMA_FILE}", ""] if schema else []),
        *prose(
            "What polarcheck knows of these programs beside their text. Take the # away from a line to give a value."
            " `polarcheck config show PROGRAM` tells what applies to one of them, and why."
        ),
        *_outer(outer),
        "",
        *_machine(survey, machine),
        "",
        *_units(survey),
        "",
        '#exclude = ["old", "*.bak"]  # what is passed over in folders',
        f"{_extensions(extensions)}  # endings of the programs, instead of the usual ones",
        '#fail_on = "error"  # the least severity that fails; warning where nothing is said',
        "#strict = true  # fail where something that matters could not be judged, too",
        '#offsets = "TOOLOFST.TXT"  # R and T from the offset table of the control, punched out or copied as text',
        "",
        "[limits]",
        "#c_feed =  # how fast the C axis may turn, from the papers of the builder, in deg/min",
        "",
        "[stock]",
        f"#diameter =  # of the bar or blank, in {_unit_of_lengths(survey)}",
        "",
        "[run]",
        '#subprograms = ["subs"]  # folders in which programs called by M98 or G65 lie',
        "",
        *_tools(survey),
        *_programs(survey),
    ]
    return "\n".join(map(visible, lines)) + "\n"


def _extensions(extensions: Sequence[str]) -> str:
    names = ", ".join(toml(name) for name in extensions)
    return f"extensions = [{names}]" if extensions else '#extensions = ["nc", "tap"]'


def relative(survey: Survey, names: Mapping[str, str]) -> Survey:
    """Return the same survey with the paths of its programs as seen from the new file."""
    offsets = {
        key: [msgspec.structs.replace(call, path=names.get(call.path, call.path)) for call in calls]
        for key, calls in survey.offsets.items()
    }
    return msgspec.structs.replace(survey, offsets=offsets)


def summary(survey: Survey) -> str:
    """Return a line such as `12 of 2000 programs use the polar mode, with offsets 8, 12`."""
    programs = f"{len(survey.polar)} of {counted(survey.programs, 'program')}"
    keys = ", ".join(sorted(survey.offsets, key=_order))
    called = f", with offset{'s' if len(survey.offsets) > 1 else ''} {keys}" if keys else ""
    return f"{programs} use{'s' if len(survey.polar) == 1 else ''} the polar mode{called}"


def left_open(survey: Survey, machine: str | None) -> list[str]:
    """Return a line for each value that is still to be filled in."""
    lines = []
    if machine is None and _certain(survey) is None:
        lines.append("machine: which lathe it is; `polarcheck machines` lists those that are known")
    if survey.offsets:
        keys = ", ".join(sorted(survey.offsets, key=_order))
        plural = "s" if len(survey.offsets) > 1 else ""
        lines.append(f"radius of offset{plural} {keys}: R of the cutter, by [tools.N] or by the offset table (offsets)")
    lines.append("c_feed of the lathe under [limits]: how fast its C axis may turn, in deg/min")
    return lines


def _certain(survey: Survey) -> str | None:
    """
    Return the machine if there is no doubt: the only one that can run the programs, or the best if the default cannot.
    """
    fits = survey.fitting
    return survey.machine if fits and (len(fits) == 1 or profiles.DEFAULT not in fits) else None


def _outer(outer: str | None) -> Iterator[str]:
    if outer is not None:
        yield ""
        yield from prose(f"{outer} has applied to these programs so far. This line lets it apply under this file:")
        yield f"#extend = {toml(outer)}"


def _machine(survey: Survey, machine: str | None) -> Iterator[str]:
    certain = machine or _certain(survey)
    rivals = [name for name in survey.fitting if name != certain]
    if machine is None and not survey.polar:
        yield from prose("No program here uses the polar mode, so none tells which lathe it is for.")
    elif machine is None and not survey.fitting:
        yield from prose("No one machine reads all of these programs: give each lathe its own, under [[programs]].")
    elif machine is None and rivals:
        which = "These read the programs" if certain is None else "These read them as well"
        yield from prose(f"{which}: {', '.join(rivals)}.")
    yield from prose(
        "The lathe: one of `polarcheck machines`, or a file of your own, which `polarcheck machines new` writes."
    )
    yield f"machine = {toml(certain)}" if certain else f"#machine = {toml(profiles.DEFAULT)}"


def _unit(survey: Survey) -> str:
    """Return the unit of the lengths in this file."""
    return "inch" if survey.units == ["inch"] else "mm"


def _unit_of_lengths(survey: Survey) -> str:
    return _unit(survey) if survey.units else "the units of the program"


def _units(survey: Survey) -> Iterator[str]:
    reasons = {1: f"the programs say {_unit(survey)}", 2: "of the programs some say mm, some inch"}
    if survey.units:
        yield f"units = {toml(_unit(survey))}  # of the lengths in this file; {reasons[len(survey.units)]}"
    else:
        yield '#units = "mm"  # of the lengths in this file; else they are in those of each program'
        yield '#program_units = "mm"  # of programs with neither G20 nor G21'


def _tools(survey: Survey) -> Iterator[str]:
    yield from prose(
        "The tool offsets that are called in the polar mode: T0808 calls offset 8. R decides where the center of the"
        " cutter goes; without it such a program is unverified."
    )
    for key in sorted(survey.offsets, key=_order):
        calls = survey.offsets[key]
        by_radius = _radii(calls)
        yield from prose(_paths([call.path for call in calls]))
        yield f"[tools.{_key(key)}]"
        if len(by_radius) > 1:
            yield "# the comments of the programs differ: see [[programs]] below"
        for radius, of_radius in by_radius.items():
            path, comment = files.display_path(of_radius[0].path), shortened(of_radius[0].comment, _LONGEST)
            yield f"#radius = {_length(radius, survey)}  # {path} says {comment}"
        if not by_radius:
            yield f"#radius =  # R on the offset page of the control, in {_unit_of_lengths(survey)}"
        yield ""


def _programs(survey: Survey) -> Iterator[str]:
    yield from prose(
        "What holds for some of the programs only. Patterns are relative to this file; a name without a folder is found"
        " in every folder; capitals make no difference. Of several entries for a program the last one counts."
    )
    entries = list(_differing(survey))
    for files_of_entry, key, radius, comment in entries[:_ENTRIES]:
        yield "#[[programs]]"
        yield f"#files = {toml(files_of_entry)}"
        yield f"#[programs.tools.{_key(key)}]"
        yield f"#radius = {_length(radius, survey)}  # {shortened(comment, _LONGEST)}"
    if len(entries) > _ENTRIES:
        yield f"# ... and {len(entries) - _ENTRIES} more, which --radius-from-comments takes as they are"
    if not entries:
        yield "#[[programs]]"
        yield '#files = ["O12*.nc", "lathe7/**"]'
        yield f"#machine = {toml(profiles.DEFAULT)}"


def _differing(survey: Survey) -> Iterator[tuple[list[str], str, float, str]]:
    """Yield programs, offset, R and comment for each offset whose R differs between the comments of programs."""
    for key in sorted(survey.offsets, key=_order):
        by_radius = _radii(survey.offsets[key])
        for radius, calls in by_radius.items() if len(by_radius) > 1 else ():
            yield [files.display_path(call.path) for call in calls], key, radius, calls[0].comment


def _radii(calls: Sequence[StatedOffset]) -> dict[float, list[StatedOffset]]:
    """Return the calls by the R that their comment gives [mm]."""
    by_radius: dict[float, list[StatedOffset]] = {}
    for call in calls:
        if call.radius is not None:
            by_radius.setdefault(round(call.radius, _DECIMALS), []).append(call)
    return by_radius


def _length(millimeters: float, survey: Survey) -> str:
    value = millimeters / MM_PER_INCH if _unit(survey) == "inch" else millimeters
    return f"{round(value, _DECIMALS)!r}"


def _paths(paths: Sequence[str]) -> str:
    return f"called by {first_of([*map(files.display_path, paths)], _NAMED)}"


def _order(key: str) -> tuple[int, str]:
    return (int(key), "") if key.isdecimal() else (10**9, key)


def _key(key: str) -> str:
    return key if key.isascii() and key.isdecimal() else toml(key)


def toml(value: object) -> str:
    """Return a value as TOML writes it."""
    # JSON allows characters that TOML does not, and some that control a terminal.
    text = msgspec.json.encode(value).decode()
    return "".join(character if character.isprintable() else f"\\U{ord(character):08x}" for character in text)


def prose(text: str) -> list[str]:
    """Return a text as lines of comments."""
    return [f"# {line}" for line in textwrap.wrap(text, COLUMNS - 2, break_on_hyphens=False)]
