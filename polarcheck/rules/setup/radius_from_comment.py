from __future__ import annotations

from polarcheck.checking.rule import NOTE, Hits, Trace, rule


@rule(NOTE, "R {taken:length} is taken from the comment: {comment}", at=("T",))
def radius_from_comment(trace: Trace) -> Hits:
    """
    Cutter radius taken from a comment.

    Asked for with --radius-from-comments (or radius_from_comments in polarcheck.toml): where the job knows no radius
    for an offset, the one that the comment beside its T word names is used. What follows holds only if the offset table
    says the same. Give it with --tool, or read the table in with --offsets.

    Source: comments as CAM posts write them; builder's guide to G12.1, T0808 (3/4" DIA. CUTTER).

    Bad, set job.radius_from_comments=true:

        T0808 (D=8. END MILL)   (expect: radius-from-comment)
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Good, set job.radius_from_comments=true, tool 8:radius=4:

        T0808 (D=8. END MILL)
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Good:

        T0808 (D=8. END MILL)
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C-10.
        X60.
        G13.1
    """
    return Hits(trace.has("T") & trace.radius_is_from_comment, values={"taken": trace.radius})
