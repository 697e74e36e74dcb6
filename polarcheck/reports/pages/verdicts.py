"""The pages on the verdicts, which `polarcheck explain` shows: pass, unverified, fail, unreadable."""

from __future__ import annotations

from types import MappingProxyType

#: The page of each verdict; the first line is the title.
PAGES = MappingProxyType(
    {
        "pass": """\
pass: all that matters was looked at, and nothing is wrong.

The rules looked at the polar sections of the program and could judge what matters there. They found
no error and no warning, whatever --fail-on says. Notes may stand in the report; they work, but are
good to know.

A pass is as good as what you gave. It rests on the lathe, the units, the cutter radius of each
section and where that came from, the nearest distance to the center, the highest rate of C with its
limit, and the bar: that of [stock], else what the program itself turns before it mills, else what a
comment states (BAR DIA 28), else none. The report says them: read them once. With the wrong lathe,
the wrong radius or the wrong bar a bad program can pass. `[stock]` with unknown = true takes no bar
from the program.

    polarcheck check --machine lathe3.toml --tool 1:radius=4 --set limits.c_feed=3600 O1234.NC

Outside the polar sections the text of the program, its flow (calls, jumps, loops) and positions are
looked at, and where mills along Z go: through a part that must stand, or through what stands of the
bar. Not looked at anywhere: holder, chuck, tool length, spindle speed, the load of a cut.

pass (no polar section): the program never enters the polar mode, so that there was nothing to judge
in it. If it is meant to, its code for the mode is that of another control: `polarcheck machines`
lists them, --machine names one.

pass (2 silenced): the program, or a baseline, answers for two findings. They may be errors:
--show-silenced lists them, by whom and why; --no-inline does not heed the comments of the program.

The exit code is 0.
""",
        "unverified": """\
unverified: nothing wrong was found, but something that matters could not be judged.

It is no pass. A fault may be there, and polarcheck could not see it, for want of something that
only you know. The report lists under "not evaluated" what was not judged, for which rules, in how
many blocks, and what to give.

Each entry says whether it matters ("matters" in the JSON report). Only those that do make a file
unverified. A nose type that is not given is listed and does not. A limit of the C axis that is not
given is listed only where the highest rate found is more than every C axis manages; the report
tells that rate in any case: compare it with the lathe's manual.

What to give:

    no radius for T0808       --tool 8:radius=9.525 on the command line, or in polarcheck.toml
                              [tools.8] and radius = 9.525; 8 is the number of the offset, the
                              last digits of T0808. From the table that the control punches out:
                              --offsets TOOLOFST.TXT. From comments such as (3/4 DIA. CUTTER):
                              --radius-from-comments.
    no tool offset in force   call the tool with its offset, T0808, in the program before G12.1.
    no limit of the C axis    --set limits.c_feed=3600, or in polarcheck.toml [limits] and
                              c_feed = 3600. It is the highest rate of C at feed in deg/min; 10
                              turns a minute are 3600.
    feed not known            an F in the polar mode, per minute (G98, or G94).
    position not known        X and C in a block before G12.1: G0 X60. C0. If a program that is
                              called positions the tool, the folder that it lies in:
                              --subprograms FOLDER, or [run] and subprograms.
    a program is missing      the same folder.
    a variable is not known   [run.variables] and 500 = 1.0 in polarcheck.toml for #500 = 1.0.
    not simulated             nothing helps: what the control does there is not known. Judge it
                              yourself.
    another control's file    the lathe that it is for: --machine NAME. `polarcheck machines`
                              lists them.
    rules were deselected     check without --select, --ignore, --severity and their variables
                              (POLARCHECK_SELECT). A rule that is off for good has its reason in
                              polarcheck.toml, and then the file can pass:
                              rapid-in-polar = { level = "off", reason = "PARAMETER 5431 IS SET" }
                              under [severities]; ignore = { rules = ["text"], reason = "..." }

Lengths are in the units of the program, unless the job file says `units`.

An example, with a sample of polarcheck and without the job file beside it:

    polarcheck check --no-config sample_programs/hexagon.nc
        unverified: no radius for T0101. The path of the cutter and the rate of C are not known.
    polarcheck check --no-config --tool 1:radius=4 --set limits.c_feed=3600 sample_programs/hexagon.nc
        pass

A code that begins the polar mode on another control and stands alone may be a macro of the builder.
It is a warning, and the file is unverified.

The exit code is 0, and 1 with --strict or where a finding of --fail-on stands in the report.
""",
        "fail": """\
fail: something is wrong, or probably not what was meant.

At least one finding is an error or a warning:

    error      the control stops with an alarm, or the part is scrap
    warning    probably not what was meant
    note       works, but is good to know; it fails no file

The verdict is about the file. --fail-on, --max-warnings and --strict change the exit code only: with
--fail-on never the file fails all the same.

Each finding names the block, what is wrong with it, the alarm that this control shows where one is
known, and what to write instead. `polarcheck explain` with the name of its rule, or with the number
of the alarm, says why:

    polarcheck explain rapid-in-polar
    polarcheck explain PS0146

If your lathe differs, make a rule a note, or leave it out, for one check or in polarcheck.toml for
all programs beside it. By an option the file is unverified then; with a reason in polarcheck.toml it
can pass:

    --severity rapid-in-polar=note     [severities]
                                       rapid-in-polar = { level = "note", reason = "..." }
    --ignore rapid-in-polar            ignore = { rules = ["rapid-in-polar"], reason = "..." }

A file that fails may have entries under "not evaluated", too: `polarcheck explain unverified`.

The exit code is 1, or what --fail-on and --max-warnings make of it.
""",
        "unreadable": """\
unreadable: the file could not be read, or not be checked to its end.

It is a link to nowhere, a device, a folder that may not be entered, larger than --max-size, or not of
its --encoding; or the check took too much time or memory, its process ended, or polarcheck has a
fault. The report says which, beside the verdict and on standard error. Nothing is known of the file.

The other files are checked all the same. The exit code is 2, and 3 for a fault of polarcheck.
""",
    }
)
_ALSO = MappingProxyType({"passed": "pass", "failed": "fail", "not evaluated": "unverified"})


def page(word: str) -> str:
    """Return the page of a verdict, all three for `verdict`, empty for any other word. Case and hyphens are ignored."""
    plain = " ".join(word.lower().replace("-", " ").replace("_", " ").split())
    if plain in ("verdict", "verdicts"):
        return "\n\n".join(map(_headed, PAGES.values()))
    text = PAGES.get(_ALSO.get(plain, plain), "")
    return _headed(text) if text else ""


def _headed(text: str) -> str:
    title, _, rest = text.partition("\n")
    return f"{title}\n{'=' * len(title)}\n{rest}"
