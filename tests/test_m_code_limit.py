"""How many M codes a block takes: the limit of FANUC controls is not that of others."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of

RULE = "too-many-m-codes"
FOUR = "O1\nG0 X100. Z100.\nM5 M9 M46 M110\nM30\n"
NOT_KNOWN = (
    *("okuma-osp", "mitsubishi-m700", "siemens-iso", "siemens-transmit", "fagor-8055t", "mazak-eia", "mazak-integrex"),
    *("mazak-quick-turn", "citizen", "haas-lathe", "gsk-988", "hurco", "lsis"),
)


@pytest.mark.nightly
@looped("machine", NOT_KNOWN)
def test_where_the_limit_is_not_known_nothing_is_said(machine: str) -> None:
    assert not [one for one in report_of(FOUR, machine).findings if one.rule == RULE]
    (told,) = report_of(FOUR, machine, changes={"control": {"m_code_limit": 3}}, only=[RULE]).findings
    assert told.rule == RULE


@looped(("machine", "is_said"), [("fanuc", True), ("fanuc-16i", True), ("turning-center", True), ("fanuc-30i", False)])
def test_a_fanuc_control_has_that_of_its_parameter(machine: str, is_said: bool) -> None:
    assert bool(report_of(FOUR, machine, only=[RULE]).findings) == is_said
    assert not report_of(FOUR.replace(" M110", ""), machine, only=[RULE]).findings
