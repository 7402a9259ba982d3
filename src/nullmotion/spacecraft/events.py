"""Things that happen to a CMG at a stated time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from nullmotion.errors import InputError

Kind = Literal["stuck", "slow", "spin-down", "wheel-dead"]
KINDS = ("stuck", "slow", "spin-down", "wheel-dead")


@dataclass(frozen=True, eq=False)
class Event:
    """A fault of one CMG from a time on, and when the law is told.

    ``stuck``: the gimbal stands still, its wheel spins on. Once found, the law steers with
    the others; the stuck CMG's momentum stays as a bias.
    ``slow``: the gimbal turns at most `rate_limit`; the law then knows this limit.
    ``spin-down``: the wheel loses speed, its momentum is h0 (f + (1 - f) exp(-(t - at) / tau));
    what it loses goes to the body. The law then knows the momentum.
    ``wheel-dead``: the motor of a VSCMG's wheel gives no torque; the wheel keeps its speed. The
    law then uses the others.

    Args:
        kind: What happens.
        cmg: Which CMG, from 0.
        at: When [s].
        detected_after: Time until the law knows [s]; infinite if never.
        rate_limit: Of a slow gimbal [rad/s].
        time_constant: tau of a wheel that spins down [s].
        final_fraction: f, share of the momentum that stays.
    """

    kind: Kind
    cmg: int
    at: Any
    detected_after: Any = 0.0
    rate_limit: Any = 0.0
    time_constant: Any = 1.0
    final_fraction: Any = 0.0

    def __post_init__(self) -> None:
        """Check kind and signs."""
        if self.kind not in KINDS:
            raise InputError("event.kind", self.kind, f"one of {', '.join(KINDS)}")
        for key in ("at", "detected_after", "rate_limit"):
            value = float(getattr(self, key))
            if not value >= 0:
                raise InputError(f"event.{key}", value, "from 0")
            object.__setattr__(self, key, value)
        if self.kind == "slow" and not self.rate_limit > 0:
            raise InputError("event.rate_limit", self.rate_limit, "above 0 for a slow gimbal")
        if self.kind == "spin-down" and not (self.time_constant > 0 and np.isfinite(self.at)):
            raise InputError("event.time_constant", self.time_constant, "above 0 s")
        object.__setattr__(self, "time_constant", float(self.time_constant))
        if not 0 <= self.final_fraction <= 1:
            raise InputError("event.final_fraction", self.final_fraction, "between 0 and 1")
        object.__setattr__(self, "final_fraction", float(self.final_fraction))
