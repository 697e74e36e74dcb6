"""The tables of one run, each made when it is first asked for and handed over by its name, as pytest hands fixtures."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from polarcheck.foundation.errors import RuleError
from polarcheck.foundation.states import Motion

if TYPE_CHECKING:
    from polarcheck.columns.contour.overcuts import Overcuts
    from polarcheck.columns.contour.pass_differences import PassDifferences
    from polarcheck.columns.contour.slots import Slots
    from polarcheck.columns.contour.tangency import Tangency
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.since import Since
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.foundation.arrays import Rows
    from polarcheck.program.execution.run import Run
    from polarcheck.program.machines.job import Job
    from polarcheck.program.machines.machine import Machine

#: What a program, its job or its machine must have for anything to be found in some tables, or by some rules.
SECTION, SECTIONS, ARC, COMMENT, PART, BAR, FAULT = "section", "sections", "arc", "comment", "part", "bar", "fault"
C_ACCELERATION, X_ACCELERATION = "limit of C acceleration", "limit of X acceleration"
#: Whether a program has it.
_HAS: dict[str, Callable[[Tables], bool]] = {
    SECTION: lambda tables: len(tables["mode"].sections) > 0,
    SECTIONS: lambda tables: len(tables["mode"].sections) > 1,
    ARC: lambda tables: bool(((tables["axes"].motion == Motion.CW) | (tables["axes"].motion == Motion.CCW)).any()),
    COMMENT: lambda tables: len(tables["text"].comments) > 0,
    PART: lambda tables: len(tables["job"].part) > 0,
    BAR: lambda tables: tables["bar"].known.source not in ("comment", "none"),
    FAULT: lambda tables: len(tables["run"].faults) > 0,
    C_ACCELERATION: lambda tables: tables["machine"].limits.c_acceleration >= 0,
    X_ACCELERATION: lambda tables: tables["machine"].limits.x_acceleration >= 0,
}


class Maker:
    """
    What makes a table.

    path: module and class, or function, as in `polarcheck.columns.path.arcs:Arcs`.
    only_with: what a program must have for anything to be found in the table. Where it has none, a rule that compares
    it finds nothing, and is not run; tests/test_engine.py runs them nevertheless.
    """

    def __init__(self, path: str, *only_with: str) -> None:
        self.module, _, self.name = path.partition(":")
        self.only_with = only_with

    @functools.cached_property
    def function(self) -> Callable[..., Any]:
        """The class or the function."""
        maker: Callable[..., Any] = getattr(importlib.import_module(self.module), self.name)
        return maker


#: Each table by its name. Its parameters name the tables that it is made from. The rules of a long program are run in
#: this order: what is written, contours as programmed, those of the tool, metal, feed.
TABLES = {
    "blocks": Maker("polarcheck.columns.modes.executed_blocks:ExecutedBlocks"),
    "modal": Maker("polarcheck.columns.modes.modal:ModalStates"),
    "tools": Maker("polarcheck.columns.modes.tools:CalledTools"),
    "coordinates": Maker("polarcheck.columns.path.coordinates:Coordinates"),
    "axes": Maker("polarcheck.columns.path.axes:PlaneAxes"),
    "mode": Maker("polarcheck.columns.modes.mode:PolarMode", SECTION),
    "lengths": Maker("polarcheck.columns.path.lengths:Lengths"),
    "path": Maker("polarcheck.columns.path.path:ProgrammedPath"),
    "comments": Maker("polarcheck.columns.words.comments:Comments"),
    "offsets": Maker("polarcheck.columns.modes.offsets:ToolOffsets"),
    "compensation": Maker("polarcheck.columns.path.compensation:CutterCompensation"),
    "feedrate": Maker("polarcheck.columns.feed.feedrate:Feedrate"),
    "trace": Maker("polarcheck.columns.trace:Trace"),
    "upright": Maker("polarcheck.columns.metal.turning_tools:upright"),
    "sections": Maker("polarcheck.columns.modes.mode:sections_of", SECTION),
    "written": Maker("polarcheck.columns.words.written:Written"),
    "dialect": Maker("polarcheck.columns.words.dialect:Dialect"),
    "faults": Maker("polarcheck.columns.words.macro_faults:Faults", FAULT),
    "unpointed": Maker("polarcheck.columns.words.unpointed:Unpointed"),
    "unknown_words": Maker("polarcheck.columns.words.unknown_words:UnknownWords"),
    "tool_comments": Maker("polarcheck.columns.words.tool_comments:ToolComments", COMMENT),
    "stock_comments": Maker("polarcheck.columns.words.stock_comments:StockComments"),
    "other_mode": Maker("polarcheck.columns.modes.other_mode:OtherMode"),
    "switch_slips": Maker("polarcheck.columns.modes.switch_slips:SwitchSlips"),
    "procedure": Maker("polarcheck.columns.modes.procedure:Procedure"),
    "since": Maker("polarcheck.columns.modes.since:Since"),
    "spindles": Maker("polarcheck.columns.modes.spindles:Spindles"),
    "angles": Maker("polarcheck.columns.words.angles:Angles", SECTION),
    "mode_words": Maker("polarcheck.columns.modes.mode_words:ModeWords", SECTION),
    "entry_angles": Maker("polarcheck.columns.modes.entry_angles:EntryAngles", SECTION),
    "skipped_blocks": Maker("polarcheck.columns.modes.skipped_blocks:SkippedBlocks", SECTION),
    "arcs": Maker("polarcheck.columns.path.arcs:Arcs"),
    "passes": Maker("polarcheck.columns.contour.passes:Passes"),
    "arc_words": Maker("polarcheck.columns.path.arc_words:ArcWords"),
    "crossings": Maker("polarcheck.columns.contour.crossings:Crossings", SECTION),
    "increments": Maker("polarcheck.columns.path.increments:Increments", SECTION),
    "contour_depths": Maker("polarcheck.columns.contour.contour_depths:ContourDepths", SECTION),
    "pass_differences": Maker("polarcheck.columns.contour.pass_differences:PassDifferences", SECTION),
    "full_circles": Maker("polarcheck.columns.contour.full_circles:FullCircles", ARC),
    "same_circle": Maker("polarcheck.columns.contour.same_circle:SameCircle", ARC),
    "tangency": Maker("polarcheck.columns.contour.tangency:Tangency", ARC),
    "regularity": Maker("polarcheck.columns.contour.regularity:Regularity", SECTION),
    "misplaced_ramps": Maker("polarcheck.columns.contour.misplaced_ramps:MisplacedRamps", SECTION),
    "infeed": Maker("polarcheck.columns.path.infeed:Infeed", SECTION),
    "switch_words": Maker("polarcheck.columns.modes.switch_words:SwitchWords", SECTION),
    "tool_center": Maker("polarcheck.columns.path.tool_center:ToolCenter", SECTION),
    "moves": Maker("polarcheck.columns.path.tool_center:moves_of"),
    "entry": Maker("polarcheck.columns.modes.entry:Entry", SECTION),
    "ramps": Maker("polarcheck.columns.path.ramps:Ramps", SECTION),
    "implied_units": Maker("polarcheck.columns.metal.implied_units:ImpliedUnits", SECTION),
    "overcuts": Maker("polarcheck.columns.contour.overcuts:Overcuts", SECTION),
    "fitting": Maker("polarcheck.columns.contour.fitting_radius:Fitting"),
    "mirrored": Maker("polarcheck.columns.contour.mirrored:Mirrored", SECTION),
    "slots": Maker("polarcheck.columns.contour.slots:Slots", SECTION),
    "uncompensated_cuts": Maker("polarcheck.columns.contour.uncompensated_cuts:UncompensatedCuts", SECTION),
    "coverage": Maker("polarcheck.columns.metal.coverage:Coverage", SECTION),
    "bar": Maker("polarcheck.columns.metal.bar:Bar"),
    "finished": Maker("polarcheck.columns.metal.finished:Finished"),
    "milled": Maker("polarcheck.columns.metal.milled:Milled"),
    "workpiece": Maker("polarcheck.columns.metal.workpiece:Workpiece", SECTION),
    "strokes": Maker("polarcheck.columns.metal.strokes:Strokes", SECTION),
    "approaches": Maker("polarcheck.columns.metal.approaches:Approaches", SECTION, BAR),
    "earlier_contours": Maker("polarcheck.columns.metal.earlier_contours:EarlierContours", SECTIONS),
    "air_cuts": Maker("polarcheck.columns.metal.air_cuts:AirCuts", SECTION),
    "rapid_contours": Maker("polarcheck.columns.contour.rapid_contours:RapidContours", SECTION),
    "pass_ends": Maker("polarcheck.columns.contour.pass_ends:PassEnds", SECTION),
    "pass_depths": Maker("polarcheck.columns.contour.pass_depths:PassDepths", SECTION),
    "nominal_parts": Maker("polarcheck.parts.nominal_parts:NominalParts"),
    "contour_comparisons": Maker("polarcheck.parts.contour_comparisons:ContourComparisons"),
    "nominal_features": Maker("polarcheck.parts.nominal_features:NominalFeatures"),
    "area_comparisons": Maker("polarcheck.parts.area_comparisons:AreaComparisons"),
    "deviations": Maker("polarcheck.parts.deviations:Deviations", PART),
    "part_comments": Maker("polarcheck.columns.metal.stated_parts:PartComments", SECTION, COMMENT),
    "travel": Maker("polarcheck.columns.path.travel:Travel"),
    "center": Maker("polarcheck.columns.path.center:Center", SECTION),
    "feeds": Maker("polarcheck.columns.feed.programmed_feeds:Feeds", SECTION),
    "feed_ranges": Maker("polarcheck.columns.feed.feed_ranges:FeedRanges", SECTION),
    "dynamics": Maker("polarcheck.columns.feed.dynamics:Dynamics"),
    "highest_feeds": Maker("polarcheck.columns.feed.highest_feeds:HighestFeeds"),
}
#: Where the tables stand that look at contours as wholes, and at the metal that they leave.
_OF_CONTOURS = "polarcheck.columns.contour.", "polarcheck.columns.metal.", "polarcheck.parts."
#: Tables that are made from `upright` in the place of `trace`: they look at depths, and its Z rises away from the part.
_UPRIGHT = frozenset(
    {
        *("bar", "milled", "workpiece", "approaches", "air_cuts", "coverage", "part_comments"),
        *("overcuts", "rapid_contours", "pass_ends", "uncompensated_cuts", "misplaced_ramps", "feed_ranges"),
        "earlier_contours",
    }
)
#: How far a cause reaches, or what one finding stands for: the column whose value its rows have in common; None where
#: rules/places.py finds it otherwise. The narrowest come first: the nearest cause of a finding counts.
SPANS: dict[str, Callable[[Tables], Rows] | None] = {
    "block": None,
    "row": lambda tables: tables.since.row,
    "name": None,
    "X": lambda tables: tables.since.linear_word,
    "C": lambda tables: tables.since.virtual_word,
    "X before": lambda tables: tables.since.linear_word_before,
    "C before": lambda tables: tables.since.virtual_word_before,
    "arc before": lambda tables: tables.since.arc_before,
    "structure": None,
    "pause": lambda tables: tables.ramps.pause,
    "way": lambda tables: tables.ramps.way,
    "motion": lambda tables: tables.modal.motion_word,
    "feed": lambda tables: tables.feedrate.feed_word,
    "wall": lambda tables: tables.overcuts.wall,
    "slot": lambda tables: tables.slots.slot,
    "mesh": lambda tables: tables.ramps.mesh,
    "tight arc": lambda tables: tables.ramps.tight_arc,
    "misfit": lambda tables: tables.tangency.size,
    "twin": lambda tables: tables.pass_differences.twin,
    "narrow loop": lambda tables: tables.ramps.narrow_loop,
    "loop": lambda tables: tables.ramps.loop,
    "compensation": lambda tables: tables.since.compensation,
    "start-up ahead": lambda tables: tables.ramps.start_up_ahead,
    "tool call": lambda tables: tables.since.tool_call,
    "modal state": lambda tables: tables.since.modal_state,
    "plane": lambda tables: tables.since.plane,
    "feed mode": lambda tables: tables.since.feed_mode,
    "origin": lambda tables: tables.since.origin,
    "spindle code": lambda tables: tables.since.spindle_code,
    "c axis code": lambda tables: tables.since.c_axis_code,
    "live tool code": lambda tables: tables.since.live_tool_code,
    "misfitting arcs": lambda tables: tables.arcs.misfit_section,
    "section": lambda tables: tables.mode.whole_section,
    "program": lambda tables: tables.blocks.program,
    "file": None,
}
#: Spans that lead from a row to one above it, and the span of the cause that counts there: the X with which a row
#: begins is the X that is in force behind the row of the cause.
OF_CAUSE = {"X before": "X", "C before": "C", "arc before": "row"}
#: Tables that hang on the text and the machine alone: what is found in them is the same however the program runs.
OF_TEXT = frozenset({"text", "words", "machine", "job", "written", "dialect"})


class Tables(dict[str, Any]):
    """
    The tables of one run on one machine for one job, by name; each is made when it is asked for.

    run, text, words, machine and job are given; what is made outside, once others are known, is given by `give`. Each
    table is an attribute, too.
    """

    if TYPE_CHECKING:
        arcs: Arcs
        blocks: ExecutedBlocks
        feedrate: Feedrate
        modal: ModalStates
        mode: PolarMode
        overcuts: Overcuts
        pass_differences: PassDifferences
        ramps: Ramps
        since: Since
        slots: Slots
        tangency: Tangency

    def __init__(self, run: Run, machine: Machine, job: Job) -> None:
        given = {"run": run, "text": run.text, "words": run.text.words, "machine": machine, "job": job}
        super().__init__(given)
        self._has: dict[str, bool] = {}
        addresses = [machine.address_number(word) for word in machine.arcs.made_corners]
        if addresses and any(number in run.words.address for number in addresses):
            from polarcheck.columns.path.made_corners import with_made_corners

            run = with_made_corners(self["trace"])
            self.clear()
            self.update({**given, "run": run})

    def __missing__(self, name: str) -> Any:
        if name not in TABLES:
            raise RuleError(f"there is no table {name!r}; tables are {', '.join(sorted(self))}")
        maker = TABLES[name].function
        table = self[name] = called(maker, self, {"trace": self["upright"]} if name in _UPRIGHT else {})
        return table

    def __getattr__(self, name: str) -> Any:
        if name not in TABLES and name not in self:
            raise AttributeError(name)
        return self[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of all tables, made or not."""
        return iter(dict.fromkeys((*self.keys(), *TABLES)))

    def __len__(self) -> int:
        return len(list(iter(self)))

    def give(self, name: str, table: Any) -> None:
        """Add a table that was made elsewhere."""
        self[name] = table

    def has(self, needed: Iterable[str]) -> bool:
        """Return True if the program has all that a rule needs (Rule.only_with)."""
        for what in needed:
            if what not in self._has:
                self._has[what] = _HAS[what](self)
            if not self._has[what]:
                return False
        return True

    def computed(self) -> Iterator[tuple[str, Any]]:
        """The tables computed so far, by name."""
        return iter(self.items())

    def forget(self, name: str) -> None:
        """
        Drop the columns of a table: they are made again when they are asked for.

        Polygons of the one section of a program stay: what it makes is told only where they are there.
        """
        table = self.get(name)
        if table is None or (len(self["sections"]) == 1 and getattr(table, "has_areas", False)):
            return
        columns: dict[str, Any] = getattr(table, "__dict__", {})
        for column in [*columns]:
            if isinstance(getattr(type(table), column, None), functools.cached_property):
                del columns[column]
        if not isinstance(TABLES[name].function, type):  # a part of another table
            del self[name]


@functools.cache
def made_from(name: str) -> frozenset[str]:
    """Return the names of the tables that a table is made from, and its own; none for what is given."""
    if name not in TABLES:
        return frozenset()
    names = parameters(TABLES[name].function)
    sources = ("upright" if source == "trace" and name in _UPRIGHT else source for source in names)
    return frozenset({name}).union(*map(made_from, sources))


def only_with(names: Iterable[str]) -> tuple[str, ...]:
    """Return what a program needs so that each of these tables holds something."""
    return tuple(dict.fromkeys(what for name in names if name in TABLES for what in TABLES[name].only_with))


def of_contours(names: Iterable[str]) -> bool:
    """Return True if one of these tables looks at contours as wholes."""
    return any(name in TABLES and TABLES[name].module.startswith(_OF_CONTOURS) for name in names)


@functools.cache
def parameters(maker: Callable[..., Any]) -> tuple[str, ...]:
    """The names of the parameters of a function, or of what makes an object of a class."""
    # inspect.signature costs more than most rules.
    fields: tuple[str, ...] | None = getattr(maker, "__struct_fields__", None)
    if fields is not None:
        return fields
    function: Any = getattr(maker, "__init__") if isinstance(maker, type) else maker  # noqa: B009 - mypy distrusts the dot
    code = function.__code__
    names: tuple[str, ...] = code.co_varnames[: code.co_argcount]
    return names[1:] if isinstance(maker, type) else names


def called(function: Callable[..., Any], tables: Mapping[str, Any], given: Mapping[str, Any]) -> Any:
    """A function with what its parameters name, given values first, then tables."""
    return function(*[given[name] if name in given else tables[name] for name in parameters(function)])
