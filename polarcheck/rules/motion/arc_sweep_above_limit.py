from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ARC, WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit

#: What the last digit of the coordinates may turn an arc by [deg].
LAST_DIGIT = 0.1


@rule(
    WARNING,
    "arc of {sweep:whole/limit} deg; {title} takes "
    "{fewer}{limit:whole/sweep} deg in one block; write it as several arcs{or_short_arc}",
    values=("sweep", "limit"),
    worse=("sweep",),
    gouges=True,
    at=("X", "U", "C", "H", "I", "J", "R"),
    subject="move",
    only_with=(ARC,),
)
def arc_sweep_above_limit(arcs: Arcs, machine: Machine) -> Hits:
    """
    Arc through more degrees than this control takes in one block.

    Some controls take the shorter of two arcs for a longer one, or go wrong about its center; posts for them cut arcs
    at 180, 120 or 90 degrees. Cut the arc into two. The limit is arcs.sweep_limit of the profile; 360 is none. Where
    an arc by radius must be smaller than that (arcs.takes_sweep_limit), one of exactly 180 degrees is a warning: the
    last digit decides which of two arcs it is. A word that chooses the larger arc (arcs.larger_arc_word) is taken.

    Source: OSP-P200L programming manual 5238-E, p. 93; Autodesk turn-mill posts.

    Bad, set arcs.sweep_limit=180:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 X0 C-20. I-20. J0  (expect: arc-sweep-above-limit)
        G1 X60.
        G13.1

    Bad, set arcs.sweep_limit=180:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G2 I-20.          (expect: arc-sweep-above-limit)
        G1 X60.
        G13.1

    Bad, machine okuma-osp:

        G94 G0 X60. C0
        G137 C0
        G101 X20. Y0 F200
        G103 X-20. L20.   (expect: arc-sweep-above-limit)
        G103 X0 Y20. I20. J0   (expect: arc-sweep-above-limit)
        G136

    Good, machine okuma-osp:

        G94 G0 X60. C0
        G137 C0
        G101 X20. Y0 F200
        G103 X0 Y-20. L20. CALRG
        G136

    Good, set arcs.sweep_limit=180:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 X-40. C0 I-20. J0
        X0 C-20. I20. J0
        G1 X60.
        G13.1
    """
    limit, is_taken = machine.arcs.sweep_limit, machine.arcs.takes_sweep_limit
    above = (arcs.sweep > limit + LAST_DIGIT) & ~arcs.is_larger_by_word
    exactly = arcs.by_radius & (arcs.sweep > limit - LAST_DIGIT) & ~arcs.is_larger_by_word
    return graded(error=above & (not is_taken), warning=above | (exactly & (not is_taken)))


def details(hit: Hit, arcs: Arcs, machine: Machine) -> Details:
    word, sweep = machine.arcs.radius_word, arcs.sweep[hit.row]
    or_short_arc = f", or without the sign of {word}, which makes it one of {360 - sweep:.0f} deg"
    is_negative = arcs.by_radius[hit.row] and hit.trace.blocks.word(word)[hit.row] < 0
    return {
        "sweep": sweep,
        "limit": machine.arcs.sweep_limit,
        "fewer": "" if machine.arcs.takes_sweep_limit else "less than ",
        "or_short_arc": or_short_arc if is_negative else "",
    }
