from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word} calls no radius on a lathe: R comes with the tool offset; delete it, and call the offset with T, as in "
    "T0808",
    values=("word",),
    at=("D",),
)
def d_word_on_lathe(modal: ModalStates, tools: CalledTools, mode: PolarMode, entry: Entry) -> Mask:
    """
    D word for cutter compensation.

    On machining centers D calls the radius of the cutter. A lathe takes R from the tool offset that T calls, and does
    not know D: it is an alarm, or the radius is not the one that D was to call. Delete D, put R into the offset table,
    and call the offset with T before G12.1. Before the mode D is meant so where it stands alone in its block,
    or beside T, S, M codes and positions; a cycle or a call has a D of its own.

    Source: builder's guide to G12.1, cutter compensation data setting and notes.

    Bad:

        T0808
        G98 G0 X60. C0
        G12.1
        G1 G41 D8 X40. F200   (expect: d-word-on-lathe)
        C-10.
        G40 X60.
        G13.1

    Bad, tool 8:radius=4:

        T0808
        D8                (expect: d-word-on-lathe)
        G98 G0 X60. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C-20.
        G40 X60.
        G13.1

    Good:

        T0808
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
    """
    return (mode.in_polar & modal.uses_axes & tools.means_cutter_by_d) | entry.calls_d_before_mode


def details(hit: Hit) -> Details:
    return {"word": hit.written("D")}
