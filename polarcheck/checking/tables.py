"""The tables of one run, each made when it is first asked for and handed over by its name, as pytest hands fixtures."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

from polarcheck.errors import RuleError
from polarcheck.machines.modal import Motion

if TYPE_CHECKING:
    from polarcheck.execution.run import Run
    from polarcheck.machines.job import Job
    from polarcheck.machines.machine import Machine

#: What makes each table; the parameters name the tables that it is made from.
MAKERS = {
    "blocks": "polarcheck.columns.blocks:ExecutedBlocks",
    "modal": "polarcheck.columns.modal:ModalStates",
    "tools": "polarcheck.columns.tools:CalledTools",
    "coordinates": "polarcheck.columns.coordinates:Coordinates",
    "axes": "polarcheck.columns.axes:PlaneAxes",
    "mode": "polarcheck.columns.mode:PolarMode",
    "lengths": "polarcheck.columns.lengths:Lengths",
    "path": "polarcheck.columns.path:ProgrammedPath",
    "offsets": "polarcheck.columns.offsets:ToolOffsets",
    "compensation": "polarcheck.columns.compensation:CutterCompensation",
    "feedrate": "polarcheck.columns.feedrate:Feedrate",
    "trace": "polarcheck.columns.trace:Trace",
    "infeed": "polarcheck.table.infeed:Infeed",
    "tool_center": "polarcheck.table.tool_center:ToolCenter",
    "dynamics": "polarcheck.table.dynamics:Dynamics",
    "highest_feeds": "polarcheck.table.highest_feeds:HighestFeeds",
    "mode_words": "polarcheck.table.mode_words:ModeWords",
    "switch_words": "polarcheck.table.switch_words:SwitchWords",
    "other_mode": "polarcheck.table.other_mode:OtherMode",
    "switch_slips": "polarcheck.table.switch_slips:SwitchSlips",
    "bar": "polarcheck.table.bar:Bar",
    "angles": "polarcheck.table.angles:Angles",
    "entry": "polarcheck.table.entry:Entry",
    "procedure": "polarcheck.table.procedure:Procedure",
    "since": "polarcheck.table.since:Since",
    "spindles": "polarcheck.table.spindles:Spindles",
    "ramps": "polarcheck.table.ramps:Ramps",
    "overcuts": "polarcheck.table.overcuts:Overcuts",
    "fitting": "polarcheck.table.fitting:Fitting",
    "entry_angles": "polarcheck.table.entry_angles:EntryAngles",
    "misplaced_ramps": "polarcheck.table.misplaced_ramps:MisplacedRamps",
    "mirrored": "polarcheck.table.mirrored:Mirrored",
    "slots": "polarcheck.table.slots:Slots",
    "uncompensated_cuts": "polarcheck.table.uncompensated_cuts:UncompensatedCuts",
    "finished": "polarcheck.table.finished:Finished",
    "milled": "polarcheck.table.milled:Milled",
    "workpiece": "polarcheck.table.workpiece:Workpiece",
    "air_cuts": "polarcheck.table.air_cuts:AirCuts",
    "rapid_contours": "polarcheck.table.rapid_contours:RapidContours",
    "pass_ends": "polarcheck.table.pass_ends:PassEnds",
    "pass_depths": "polarcheck.table.pass_depths:PassDepths",
    "nominal_parts": "polarcheck.inspection.nominal_parts:NominalParts",
    "contour_comparisons": "polarcheck.inspection.contour_comparisons:ContourComparisons",
    "nominal_features": "polarcheck.inspection.nominal_features:NominalFeatures",
    "area_comparisons": "polarcheck.inspection.area_comparisons:AreaComparisons",
    "deviations": "polarcheck.inspection.deviations:Deviations",
    "coverage": "polarcheck.table.coverage:Coverage",
    "arcs": "polarcheck.table.arcs:Arcs",
    "senses": "polarcheck.table.senses:Senses",
    "regularity": "polarcheck.table.regularity:Regularity",
    "arc_words": "polarcheck.table.arc_words:ArcWords",
    "crossings": "polarcheck.table.crossings:Crossings",
    "increments": "polarcheck.table.increments:Increments",
    "contour_depths": "polarcheck.table.contour_depths:ContourDepths",
    "pass_differences": "polarcheck.table.pass_differences:PassDifferences",
    "passes": "polarcheck.table.passes:Passes",
    "same_circle": "polarcheck.table.same_circle:SameCircle",
    "tangency": "polarcheck.table.tangency:Tangency",
    "part_comments": "polarcheck.table.part_comments:PartComments",
    "travel": "polarcheck.table.travel:Travel",
    "center": "polarcheck.table.center:Center",
    "feeds": "polarcheck.table.feeds:Feeds",
    "feed_ranges": "polarcheck.table.feed_ranges:FeedRanges",
    "unpointed": "polarcheck.table.unpointed:Unpointed",
    "stock_comments": "polarcheck.table.stock_comments:StockComments",
    "tool_comments": "polarcheck.table.tool_comments:ToolComments",
    "written": "polarcheck.table.written:Written",
    "dialect": "polarcheck.table.dialect:Dialect",
    "faults": "polarcheck.checking.macro_faults:Faults",
}
#: Tables that are a column of another one.
PARTS = {"sections": "mode.sections", "moves": "tool_center.moves"}
#: How far a cause reaches, or what one finding stands for: the column whose value its rows have in
#: common. The narrowest come first: the nearest cause of a finding counts.
SPANS = {
    "block": "run.block",
    "row": "since.row",
    "name": "",
    "X": "since.linear_word",
    "C": "since.virtual_word",
    "X before": "since.linear_word_before",
    "C before": "since.virtual_word_before",
    "arc before": "since.arc_before",
    "structure": "",
    "pause": "ramps.pause",
    "way": "ramps.way",
    "motion": "modal.motion_word",
    "feed": "feedrate.feed_word",
    "wall": "overcuts.wall",
    "slot": "slots.slot",
    "mesh": "ramps.mesh",
    "tight arc": "ramps.tight_arc",
    "misfit": "tangency.size",
    "twin": "pass_differences.twin",
    "narrow loop": "ramps.narrow_loop",
    "loop": "ramps.loop",
    "compensation": "since.compensation",
    "first start-up": "ramps.first_start_up",
    "tool call": "since.tool_call",
    "modal state": "since.modal_state",
    "plane": "since.plane",
    "feed mode": "since.feed_mode",
    "origin": "since.origin",
    "spindle code": "since.spindle_code",
    "c axis code": "since.c_axis_code",
    "live tool code": "since.live_tool_code",
    "misfitting arcs": "arcs.misfit_section",
    "section": "mode.whole_section",
    "program": "blocks.program",
    "file": "",
}
#: Spans that lead from a row to one above it, and the span of the cause that counts there: the X with which a row
#: begins is the X that is in force behind the row of the cause.
OF_CAUSE = {"X before": "X", "C before": "C", "arc before": "row"}
#: Tables that hang on the text and the machine alone: what is found in them is the same however the program runs.
OF_TEXT = frozenset({"text", "words", "machine", "job", "written", "dialect"})

#: What a program, or its job, must have for anything to be found in some tables. Where it has none, a rule that
#: compares one of them finds nothing, and is not run; tests/test_engine.py runs them nevertheless.
ONLY_WITH = {
    "section": frozenset(
        {
            *("air_cuts", "angles", "center", "contour_depths", "coverage", "crossings", "entry", "entry_angles"),
            *("feed_ranges", "feeds", "increments", "infeed", "mirrored", "misplaced_ramps", "mode", "mode_words"),
            *("overcuts", "part_comments", "pass_depths", "pass_differences", "pass_ends", "ramps", "rapid_contours"),
            *("regularity", "sections", "slots", "switch_words", "tool_center", "uncompensated_cuts", "workpiece"),
        }
    ),
    "arc": frozenset({"same_circle", "senses", "tangency"}),
    "comment": frozenset({"part_comments", "tool_comments"}),
    "part": frozenset({"deviations"}),
}


class Tables(dict[str, Any]):
    """
    The tables of one run on one machine for one job, by name; each is made when it is asked for.

    run, text, words, machine and job are given; what is made outside, once others are known, is given by `give`.
    """

    def __init__(self, run: Run, machine: Machine, job: Job) -> None:
        super().__init__(run=run, text=run.text, words=run.text.words, machine=machine, job=job)

    def __missing__(self, name: str) -> Any:
        table = self[name] = self.column(PARTS[name]) if name in PARTS else self._make(name)
        return table

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of all tables, made or not."""
        return iter(dict.fromkeys((*self.keys(), *MAKERS, *PARTS)))

    def __len__(self) -> int:
        return len(list(iter(self)))

    def give(self, name: str, table: Any) -> None:
        """Add a table that was made elsewhere."""
        self[name] = table

    def may_hold(self, names: Iterable[str]) -> bool:
        """Return False where one of these tables holds nothing since the program has nothing that it is about."""
        wanted = frozenset(names)
        return not any(wanted & of_it and not self._has[what] for what, of_it in ONLY_WITH.items())

    # `cached_property` and `is_among` of polarcheck.arrays would load NumPy, which `explain` and `rules` do without.
    @functools.cached_property
    def _has(self) -> dict[str, bool]:
        """For each key of ONLY_WITH: the program has it."""
        trace = self["trace"]
        is_arc = (trace.axes.motion == Motion.CW) | (trace.axes.motion == Motion.CCW)
        return {
            "section": len(trace.mode.sections) > 0,
            "arc": bool(is_arc.any()),
            "comment": len(trace.text.comments) > 0,
            "part": len(trace.job.part) > 0,
        }

    def computed(self) -> Iterator[tuple[str, Any]]:
        """The tables computed so far, by name."""
        return iter(self.items())

    def _make(self, name: str) -> Any:
        if name not in MAKERS:
            raise RuleError(f"there is no table {name!r}; tables are {', '.join(sorted(self))}")
        maker = _maker(MAKERS[name])
        return maker(*(self[parameter] for parameter in parameters(maker)))

    def column(self, path: str) -> Any:
        """A column by its path, as in `compensation.radius` or `machine.limits.c_feed`."""
        name, _, rest = path.partition(".")
        found = self[name]
        for attribute in rest.split(".") if rest else ():
            found = getattr(found, attribute)
        return found


@functools.cache
def _maker(path: str) -> Callable[..., Any]:
    module, _, name = path.partition(":")
    maker: Callable[..., Any] = getattr(importlib.import_module(module), name)
    return maker


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
