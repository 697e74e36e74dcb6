"""
The settings that users give, declared once.

Of a declaration are made the option of the command line and of the environment (commands/options.py), the checks of the
keyword of Python (api/keywords.py), and the names by which messages and `config show` speak of it. The types that
polarcheck.toml may hold are those of program/machines/job.py; a test holds both to the same names.
"""

from typing import NamedTuple


class Setting(NamedTuple):
    """
    One setting.

    name: the keyword of Python, the value of the option, and the field of Options.
    kind: one of the kinds of commands/options.py, or the choices.
    help: what help says of the option.
    metavar: what stands for the value in help.
    key: the key of polarcheck.toml with the same value; "" for a setting that is a part of several, or none.
    option: the option, where it is not --name.
    files: the keys of a value in Python that name files or folders; "" for the value itself.
    """

    name: str
    kind: str | tuple[str, ...]
    help: str
    metavar: str | None = None
    key: str = ""
    option: str = ""
    files: tuple[str, ...] = ()

    @property
    def flag(self) -> str:
        """The option as messages write it."""
        return self.option or f"--{self.name.replace('_', '-')}"

    @property
    def is_list(self) -> bool:
        """Several values may be given."""
        return self.kind in ("texts", "names", "files", "folders")


_ONE = ("",)

SETTINGS = {
    setting.name: setting
    for setting in (
        Setting("machine", "text", metavar="NAME|FILE", key="machine", files=_ONE,
                help="The lathe: one of `polarcheck machines`, or a TOML file of your own."),
        Setting("changes", "texts", "A value of the machine: limits.c_feed=3600.", metavar="KEY=VALUE", option="--set"),
        Setting("tools", "texts", metavar="N:KEY=VALUE", option="--tool",
                help="Tool offset N: 8:radius=0.375,nose=0; or an edge: MILL_8/1:radius=4."),
        Setting("offsets", "file", "Offset table from the control.", files=_ONE),
        Setting("units", ("mm", "inch"), "Of programs with neither G20 nor G21.", key="program_units"),
        Setting("config", "file", "Instead of the nearest polarcheck.toml.", files=_ONE),
        Setting("block_skip", ("off", "on", "both"), "Of blocks with /; both is the default.", key="run.block_skip"),
        Setting("subprograms", "folders", metavar="FOLDER", key="run.subprograms", files=_ONE,
                help="Where programs that are called lie."),
        Setting("max_blocks", "count", key="run.max_blocks",
                help="Executed blocks, beyond those of the file, after which a run is given up."),
        Setting("max_statements", "count", "The same for macro statements and calls.", key="run.max_statements"),
        Setting("max_seconds", "seconds", key="run.max_seconds",
                help=("The same for seconds of processor time, and for the whole check; a file has so long for "
                "each MB.")),
        Setting("radius_from_comments", "switch", key="radius_from_comments",
                help="Take unknown radii from comments such as 3/4 DIA. CUTTER."),
        Setting("encoding", "encoding", "Of the {}: cp1252, shift_jis, ...", metavar="NAME", key="encoding"),
        Setting("drawings", "files", metavar="FILE.dxf", option="--drawing", files=_ONE,
                help="What the programs should make, in place of [[part]] in polarcheck.toml."),
        Setting("drawing_layers", "texts", metavar="LAYER", option="--drawing-layer",
                help="Of each --drawing only what lies on this layer."),
        Setting("tolerance", "length", metavar="LENGTH",
                help=("How far a part may differ from a drawing or [[part]] that says nothing else, in the units "
                "of the programs, or of polarcheck.toml where that names them; else 0.02 mm.")),
        Setting("select", "names", "Only these rules, groups or alarms (PS0146).", metavar="RULE", key="select"),
        Setting("ignore", "names", "All but these.", metavar="RULE", key="ignore"),
        Setting("severities", "names", "error, warning, note or off.", metavar="RULE=LEVEL", option="--severity"),
        Setting("fail_on", ("error", "warning", "note", "never"), "The least severity that fails.", key="fail_on"),
        Setting("max_warnings", "number", metavar="N", key="max_warnings",
                help="More warnings than N, over all programs, fail; up to N do not."),
        Setting("strict", "switch", "Fail where a file is unverified, too.", key="strict"),
        Setting("inline", "switch", key="inline", option="--no-inline",
                help="Whether the allow comments of programs are heeded."),
        Setting("extensions", "names", metavar="EXT", key="extensions",
                help="Of the programs in a folder, instead of .nc, .tap, .eia and others."),
        Setting("exclude", "texts", metavar="PATTERN",
                help="Files or folders that a walk passes over, beside those of the job."),
    )
}  # fmt: skip
