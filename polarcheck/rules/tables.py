"""The tables of one run, each made when it is first asked for and handed over by its name, as pytest hands fixtures."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

from polarcheck.foundation.errors import RuleError
from polarcheck.foundation.states import Motion

if TYPE_CHECKING:
    from polarcheck.program.execution.run import Run
    from polarcheck.program.machines.job import Job
    from polarcheck.program.machines.machine import Machine

#: What makes each table; the parameters name the tables that it is made from.
MAKERS = {
    "blocks": "polarcheck.columns.modes.blocks:ExecutedBlocks",
    "modal": "polarcheck.columns.modes.modal:ModalStates",
    "tools": "polarcheck.columns.modes.tools:CalledTools",
    "coordinates": "polarcheck.columns.path.coordinates:Coordinates",
    "axes": "polarcheck.columns.path.axes:PlaneAxes",
    "mode": "polarcheck.columns.modes.mode:PolarMode",
    "lengths": "polarcheck.columns.path.lengths:Lengths",
    "path": "polarcheck.columns.path.path:ProgrammedPath",
    "offsets": "polarcheck.columns.modes.offsets:ToolOffsets",
    "compensation": "polarcheck.columns.path.compensation:CutterCompensation",
    "feedrate": "polarcheck.columns.feed.feedrate:Feedrate",
    "trace": "polarcheck.columns.trace:Trace",
    "infeed": "polarcheck.columns.path.infeed:Infeed",
    "tool_center": "polarcheck.columns.path.tool_center:ToolCenter",
    "dynamics": "polarcheck.columns.feed.dynamics:Dynamics",
    "highest_feeds": "polarcheck.columns.feed.highest_feeds:HighestFeeds",
    "mode_words": "polarcheck.columns.modes.mode_words:ModeWords",
    "switch_words": "polarcheck.columns.modes.switch_words:SwitchWords",
    "other_mode": "polarcheck.columns.modes.other_mode:OtherMode",
    "switch_slips": "polarcheck.columns.modes.switch_slips:SwitchSlips",
    "bar": "polarcheck.columns.metal.bar:Bar",
    "angles": "polarcheck.columns.words.angles:Angles",
    "entry": "polarcheck.columns.modes.entry:Entry",
    "procedure": "polarcheck.columns.modes.procedure:Procedure",
    "since": "polarcheck.columns.modes.since:Since",
    "spindles": "polarcheck.columns.modes.spindles:Spindles",
    "ramps": "polarcheck.columns.path.ramps:Ramps",
    "overcuts": "polarcheck.columns.contour.overcuts:Overcuts",
    "fitting": "polarcheck.columns.contour.fitting:Fitting",
    "entry_angles": "polarcheck.columns.modes.entry_angles:EntryAngles",
    "misplaced_ramps": "polarcheck.columns.contour.misplaced_ramps:MisplacedRamps",
    "mirrored": "polarcheck.columns.contour.mirrored:Mirrored",
    "slots": "polarcheck.columns.contour.slots:Slots",
    "uncompensated_cuts": "polarcheck.columns.contour.uncompensated_cuts:UncompensatedCuts",
    "finished": "polarcheck.columns.metal.finished:Finished",
    "milled": "polarcheck.columns.metal.milled:Milled",
    "workpiece": "polarcheck.columns.metal.workpiece:Workpiece",
    "air_cuts": "polarcheck.columns.metal.air_cuts:AirCuts",
    "rapid_contours": "polarcheck.columns.contour.rapid_contours:RapidContours",
    "pass_ends": "polarcheck.columns.contour.pass_ends:PassEnds",
    "pass_depths": "polarcheck.columns.contour.pass_depths:PassDepths",
    "nominal_parts": "polarcheck.parts.nominal_parts:NominalParts",
    "contour_comparisons": "polarcheck.parts.contour_comparisons:ContourComparisons",
    "nominal_features": "polarcheck.parts.nominal_features:NominalFeatures",
    "area_comparisons": "polarcheck.parts.area_comparisons:AreaComparisons",
    "deviations": "polarcheck.parts.deviations:Deviations",
    "coverage": "polarcheck.columns.metal.coverage:Coverage",
    "arcs": "polarcheck.columns.path.arcs:Arcs",
    "senses": "polarcheck.columns.contour.senses:Senses",
    "regularity": "polarcheck.columns.contour.regularity:Regularity",
    "arc_words": "polarcheck.columns.path.arc_words:ArcWords",
    "crossings": "polarcheck.columns.contour.crossings:Crossings",
    "increments": "polarcheck.columns.path.increments:Increments",
    "contour_depths": "polarcheck.columns.contour.contour_depths:ContourDepths",
    "pass_differences": "polarcheck.columns.contour.pass_differences:PassDifferences",
    "passes": "polarcheck.columns.contour.passes:Passes",
    "same_circle": "polarcheck.columns.contour.same_circle:SameCircle",
    "tangency": "polarcheck.columns.contour.tangency:Tangency",
    "part_comments": "polarcheck.columns.metal.part_comments:PartComments",
    "travel": "polarcheck.columns.path.travel:Travel",
    "center": "polarcheck.columns.path.center:Center",
    "feeds": "polarcheck.columns.feed.feeds:Feeds",
    "feed_ranges": "polarcheck.columns.feed.feed_ranges:FeedRanges",
    "unpointed": "polarcheck.columns.words.unpointed:Unpointed",
    "stock_comments": "polarcheck.columns.words.stock_comments:StockComments",
    "tool_comments": "polarcheck.columns.words.tool_comments:ToolComments",
    "written": "polarcheck.columns.words.written:Written",
    "dialect": "polarcheck.columns.words.dialect:Dialect",
    "faults": "polarcheck.columns.words.macro_faults:Faults",
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

    # `cached_property` and `is_among` of arrays would load NumPy, which `explain` and `rules` do without.
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
