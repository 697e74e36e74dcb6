from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.program.execution.run import Run
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit

#: What the codes of a list of G-code system B are in system A, and what stands for them there.
_IN_SYSTEM_A = {
    "absolute": "a turning cycle in G-code system A, where {axes} are absolute and {increments} incremental",
    "incremental": "no code of G-code system A, where {increments} incremental",
    "feed_per_minute": "a facing cycle in G-code system A, where {codes} is feed per minute",
    "feed_per_revolution": "no code of G-code system A, where {codes} is feed per revolution",
}


@rule(
    ERROR,
    "{meaning}; if the lathe runs another system, set control.g_code_system",
    values=("word",),
    once="program",
    doubts=(("word", "block"),),
)
def incremental_word_of_other_code_system(
    modal: ModalStates, axes: PlaneAxes, mode: PolarMode, mode_words: ModeWords, machine: Machine
) -> Hits:
    """
    Absolute, incremental or feed word of another G-code system.

    Lathe controls know three G-code systems. In system A, X and C are absolute, U and H incremental, G90 and G94 are
    turning cycles, and feed is per minute with G98. In systems B and C, G90 and G91 choose between absolute and
    incremental, and feed is per minute with G94. A word of the wrong system in the polar mode is an alarm or a move to
    another place. One finding stands for the program, since the mistake is one: the program was written for another
    lathe, or the profile names the wrong system.

    Source: FANUC B-62754EN/01, G-code systems; builder's guide to G12.1, incremental axis move command; 30i alarm
    list, PS0146.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G91 C10.          (expect: incremental-word-of-other-code-system)
        X20.
        G90
        G13.1

    Bad, set control.g_code_system="B":

        G94 G90 G0 X60. C0
        G12.1
        G1 X40. F200
        H10.              (expect: incremental-word-of-other-code-system)
        U20.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        H10.
        U20.
        G13.1

    Good, set control.g_code_system="B":

        G94 G90 G0 X60. C0
        G12.1
        G1 X40. F200
        G91 C10.
        X20.
        G90
        G13.1
    """
    in_system_a = machine.control.g_code_system == "A"
    polar, of_b = machine.polar, machine.g_code_system_b
    of_axis = (polar.virtual_axis_incremental, *(pair[1] for pair in polar.virtual_axis_by_word.values()))
    increments = ("U", "W", *filter(None, of_axis))
    codes = (*of_b.absolute, *of_b.incremental, *of_b.feed_per_minute, *of_b.feed_per_revolution)
    # The address of another control has a rule of its own: wrong-axis-address-in-polar.
    wrong = mode_words.first_of(*(codes if in_system_a else increments)) & ~mode_words.of_other_axis
    # U is no increment beside a code that takes it for something else, such as G4, nor where it is an axis.
    is_meant = (in_system_a | modal.uses_axes) & axes.linear_is_known
    return Hits(mode.in_polar & mode_words.rows(wrong) & is_meant, at=wrong)


def details(hit: Hit, run: Run, machine: Machine) -> Details:
    from polarcheck.program.machines.code_tables import spelled

    word, first = run.words, hit.words[0]
    address = chr(int(word.address[first]))
    name = spelled("G", round(float(word.value[first]) * 10)) if address == "G" else address
    axis, increment = machine.polar.rotary_words
    axes, increments = f"X and {axis}", f"U and {increment} are" if increment else "U is"
    for key, text in _IN_SYSTEM_A.items():
        if name in getattr(machine.g_code_system_b, key):
            code = next(iter(machine.codes(key)), "")
            return {"meaning": f"{name} is {text.format(axes=axes, increments=increments, codes=code)}"}
    system = machine.control.g_code_system
    return {"meaning": f"{name} is no incremental word of G-code system {system}, where G91 makes {axes} incremental"}
