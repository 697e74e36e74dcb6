"""The polarcheck.toml that `polarcheck init` writes: what the programs tell of the job, and a place for the rest."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence

import msgspec

from polarcheck.checking.survey import Survey, Told
from polarcheck.machines import profiles
from polarcheck.machines.modal import MM_PER_INCH
from polarcheck.reading import files
from polarcheck.reading.excerpt import shortened, visible
from polarcheck.reports import counted

SCHEMA_FILE = "polarcheck.schema.json"
_COLUMNS = 100
#: Programs that are named; of more the count is told.
_NAMED = 3
#: Entries for programs whose cutter another program has not.
_ENTRIES = 20
_LONGEST = 60
_DECIMALS = 6


def text(survey: Survey, machine: str | None, outer: str | None, schema: bool, extensions: Sequence[str] = ()) -> str:
    """
    The file, valid as it stands: what nobody knows is left out, and can be filled in.

    machine: as it is to be written, where somebody knows it. outer: the job file that has applied so far, from here.
    schema: whether its schema lies beside it. extensions: of the programs, if not the usual ones.
    """
    lines = [
        *([f"#:schema ./{SCHEMA_FILE}", ""] if schema else []),
        *_prose(
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


def _extensions(given: Sequence[str]) -> str:
    names = ", ".join(_toml(name) for name in given)
    return f"extensions = [{names}]" if given else '#extensions = ["nc", "tap"]'


def relative(survey: Survey, names: Mapping[str, str]) -> Survey:
    """The same with other names of its programs: those that they have from where the file will lie."""
    offsets = {
        key: [msgspec.structs.replace(one, path=names.get(one.path, one.path)) for one in told]
        for key, told in survey.offsets.items()
    }
    return msgspec.structs.replace(survey, offsets=offsets)


def summary(survey: Survey) -> str:
    """`12 of 2000 programs use the polar mode, with offsets 8, 12`."""
    programs = f"{len(survey.polar)} of {counted(survey.programs, 'program')}"
    keys = ", ".join(sorted(survey.offsets, key=_order))
    called = f", with offset{'s' if len(survey.offsets) > 1 else ''} {keys}" if keys else ""
    return f"{programs} use{'s' if len(survey.polar) == 1 else ''} the polar mode{called}"


def left_open(survey: Survey, machine: str | None) -> list[str]:
    """What is still to be filled in, a line each."""
    found = []
    if machine is None and _certain(survey) is None:
        found.append("machine: which lathe it is; `polarcheck machines` lists those that are known")
    if survey.offsets:
        keys = ", ".join(sorted(survey.offsets, key=_order))
        plural = "s" if len(survey.offsets) > 1 else ""
        found.append(f"radius of offset{plural} {keys}: R of the cutter, by [tools.N] or by the offset table (offsets)")
    found.append("c_feed of the lathe under [limits]: how fast its C axis may turn, in deg/min")
    return found


def _certain(survey: Survey) -> str | None:
    """The machine that is not in doubt: the only one that reads the programs, or the first where the default fails."""
    fits = survey.fitting
    return survey.machine if fits and (len(fits) == 1 or profiles.DEFAULT not in fits) else None


def _outer(outer: str | None) -> Iterator[str]:
    if outer is not None:
        yield ""
        yield from _prose(f"{outer} has applied to these programs so far. This line lets it apply under this file:")
        yield f"#extend = {_toml(outer)}"


def _machine(survey: Survey, machine: str | None) -> Iterator[str]:
    certain = machine or _certain(survey)
    others = [name for name in survey.fitting if name != certain]
    if machine is None and not survey.polar:
        yield from _prose("No program here uses the polar mode, so none tells which lathe it is for.")
    elif machine is None and not survey.fitting:
        yield from _prose("No one machine reads all of these programs: give each lathe its own, under [[programs]].")
    elif machine is None and others:
        which = "These read the programs" if certain is None else "These read them as well"
        yield from _prose(f"{which}: {', '.join(others)}.")
    yield from _prose(
        "The lathe: one of `polarcheck machines`, or a file of your own, which `polarcheck machines new` writes."
    )
    yield f"machine = {_toml(certain)}" if certain else f"#machine = {_toml(profiles.DEFAULT)}"


def _unit(survey: Survey) -> str:
    """Of the lengths in this file."""
    return "inch" if survey.units == ["inch"] else "mm"


def _unit_of_lengths(survey: Survey) -> str:
    return _unit(survey) if survey.units else "the units of the program"


def _units(survey: Survey) -> Iterator[str]:
    said = {1: f"the programs say {_unit(survey)}", 2: "of the programs some say mm, some inch"}
    if survey.units:
        yield f"units = {_toml(_unit(survey))}  # of the lengths in this file; {said[len(survey.units)]}"
    else:
        yield '#units = "mm"  # of the lengths in this file; else they are in those of each program'
        yield '#program_units = "mm"  # of programs with neither G20 nor G21'


def _tools(survey: Survey) -> Iterator[str]:
    yield from _prose(
        "The tool offsets that are called in the polar mode: T0808 calls offset 8. R decides where the center of the"
        " cutter goes; without it such a program is unverified."
    )
    for key in sorted(survey.offsets, key=_order):
        told = survey.offsets[key]
        named = _radii(told)
        yield from _prose(_paths([one.path for one in told]))
        yield f"[tools.{_key(key)}]"
        if len(named) > 1:
            yield "# the comments of the programs differ: see [[programs]] below"
        for radius, of_radius in named.items():
            path, comment = files.shown(of_radius[0].path), shortened(of_radius[0].comment, _LONGEST)
            yield f"#radius = {_length(radius, survey)}  # {path} says {comment}"
        if not named:
            yield f"#radius =  # R on the offset page of the control, in {_unit_of_lengths(survey)}"
        yield ""


def _programs(survey: Survey) -> Iterator[str]:
    yield from _prose(
        "What holds for some of the programs only. Patterns are relative to this file; a name without a folder is found"
        " in every folder; capitals make no difference. Of several entries for a program the last one counts."
    )
    entries = list(_differing(survey))
    for files_of_entry, key, radius, comment in entries[:_ENTRIES]:
        yield "#[[programs]]"
        yield f"#files = {_toml(files_of_entry)}"
        yield f"#[programs.tools.{_key(key)}]"
        yield f"#radius = {_length(radius, survey)}  # {shortened(comment, _LONGEST)}"
    if len(entries) > _ENTRIES:
        yield f"# ... and {len(entries) - _ENTRIES} more, which --radius-from-comments takes as they are"
    if not entries:
        yield "#[[programs]]"
        yield '#files = ["O12*.nc", "lathe7/**"]'
        yield f"#machine = {_toml(profiles.DEFAULT)}"


def _differing(survey: Survey) -> Iterator[tuple[list[str], str, float, str]]:
    """Programs, offset, R and comment, where the comments of other programs say another R."""
    for key in sorted(survey.offsets, key=_order):
        named = _radii(survey.offsets[key])
        for radius, told in named.items() if len(named) > 1 else ():
            yield [files.shown(one.path) for one in told], key, radius, told[0].comment


def _radii(told: Sequence[Told]) -> dict[float, list[Told]]:
    """What says each R [mm]."""
    found: dict[float, list[Told]] = {}
    for one in told:
        if one.radius is not None:
            found.setdefault(round(one.radius, _DECIMALS), []).append(one)
    return found


def _length(millimeters: float, survey: Survey) -> str:
    value = millimeters / MM_PER_INCH if _unit(survey) == "inch" else millimeters
    return f"{round(value, _DECIMALS)!r}"


def _paths(paths: Sequence[str]) -> str:
    named = ", ".join(files.shown(path) for path in paths[:_NAMED])
    more = len(paths) - _NAMED
    return f"called by {named}{f' and {more} more' if more > 0 else ''}"


def _order(key: str) -> tuple[int, str]:
    return (int(key), "") if key.isdecimal() else (10**9, key)


def _key(key: str) -> str:
    return key if key.isascii() and key.isdecimal() else _toml(key)


def _toml(value: object) -> str:
    # JSON lets stand as it is what TOML does not.
    text = msgspec.json.encode(value).decode()
    return "".join(one if one.isprintable() else f"\\U{ord(one):08x}" for one in text)


def _prose(text: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(text, _COLUMNS - 2, break_on_hyphens=False)]
