"""Names of what F is where linear and rotary axes move together: values of feed.with_rotary."""

from typing import Literal, TypeAlias, get_args

#: inverse-time: F is 1 / time of the block [1/min]. per-minute: F is along the way of X as a radius, Z and C, degrees
#: counting as mm or inch. per-minute-diameter: the same with X as a diameter. per-minute-c: F is that of C alone
#: [deg/min], where C moves.
WithRotary: TypeAlias = Literal["inverse-time", "per-minute", "per-minute-diameter", "per-minute-c"]
WITH_ROTARY: tuple[str, ...] = get_args(WithRotary)
