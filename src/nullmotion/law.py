"""What a steering law is, what it sees and what it promises."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError


class Claim(StrEnum):
    """A promise that the contract tests hold a law to, as created by default, on every layout."""

    EXACT_TORQUE = "A delta_dot = hdot at regular states"
    FINITE = "finite rates at every state, singular ones included"
    BOUNDED = "rates stay below a fixed multiple of |hdot| at every state"
    ROTATION = "same rates when body axes and command are turned together"
    SCALING = "same rates when momenta and command grow together"
    HOMOGENEOUS = "rates grow in proportion to the command"
    STATELESS = "the answer depends on the observation alone"
    TIMELESS = "the answer does not depend on the time"


@dataclass(frozen=True)
class Observation:
    """What a law may see at a sample; the first four are always there.

    Attributes:
        delta: Measured gimbal angles [rad], (n,).
        hdot: Wanted rate of the array's momentum [N m], (m,).
        t: Time of the sample [s], a multiple of the period.
        period: Time to the next sample [s].
        delta_dot: Gimbal rates [rad/s], (n,).
        omega_BN_B: Body rate in B [rad/s], (3,).
        wheel_speed: Wheel speeds [rad/s], (n,).
        preview: hdot at this and the coming samples, as far as foreseen [N m], (k, m).
        torque_matrix: Q of hdot = Q [wheel accelerations, gimbal rates] as a controller estimates
            it [N m s^2/rad, N m s/rad], (m, 2n).
    """

    delta: Any
    hdot: Any
    t: Any = 0.0
    period: Any = 0.01
    delta_dot: Any = None
    omega_BN_B: Any = None
    wheel_speed: Any = None
    preview: Any = None
    torque_matrix: Any = None


State = Any  # a float, array, tuple or named tuple of those; () when there is none


@dataclass(frozen=True)
class Law:
    """Base of steering laws: from an observation to gimbal rates.

    A law is one file under ``laws/`` with one frozen dataclass: its fields are the
    parameters, under the paper's names. It implements `step`, and `init` when it
    carries a state. It works in the array's torque space and in units of the
    array's mean momentum (`CmgArray.unit_jacobian`), so that its defaults suit any
    array. It never branches on values: `nullmotion.ops.where` and its kin do that.

    Class attributes:
        name: Name on the command line and in files.
        full_name: Name in the field.
        aliases: Other names it is found under.
        citation: Where it comes from.
        claims: What it promises.
        information: What it reads beyond delta, hdot, t and period.
        traceable: False for a law that solves a problem while it runs (a host law).
        knows_axes: True for a law that must know the axes of the array while it is traced:
            they cannot differ between the runs of a batch.
        turns_wheels: True for a law of variable-speed CMGs: `step` returns gimbal rates and
            wheel accelerations [rad/s^2] as a pair.
    """

    name: ClassVar[str] = ""
    full_name: ClassVar[str] = ""
    aliases: ClassVar[tuple[str, ...]] = ()
    citation: ClassVar[str] = ""
    claims: ClassVar[frozenset[Claim]] = frozenset()
    information: ClassVar[tuple[str, ...]] = ()
    traceable: ClassVar[bool] = True
    knows_axes: ClassVar[bool] = False
    turns_wheels: ClassVar[bool] = False

    @property
    def information_used(self) -> tuple[str, ...]:
        """What of `information` it reads with these parameters."""
        return self.information

    @property
    def preview_samples(self) -> int:
        """How many rows of ``preview`` a host law that reads it looks at."""
        return 0

    def counts(self, state: State) -> Mapping[str, int]:
        """Return what a host law counted on the way, by name; above 0 it is a status of the run."""
        return {}

    def supports(self, array: CmgArray) -> str:
        """Return why this law cannot steer the array; an empty string if it can."""
        return ""

    def init(self, array: CmgArray, delta: Any) -> State:
        """Return the law's state before its first sample."""
        return ()

    def exact_above(self, array: CmgArray) -> float:
        """Return the sigma_min(A / mean momentum) above which EXACT_TORQUE holds."""
        return 0.0

    def step(self, array: CmgArray, obs: Observation, state: State) -> tuple[Any, State]:
        """Return gimbal rates [rad/s], (n,), before any rate limit, and the next state."""
        raise NotImplementedError


def check_parameters(
    record: Any,
    positive: Sequence[str] = (),
    not_negative: Sequence[str] = (),
    kind: str = "law",
) -> None:
    """Refuse parameters that are not finite numbers of their sign; make whole numbers floats.

    Args:
        record: Law (or other frozen dataclass) under construction.
        positive: Fields above 0; one that is None stays None.
        not_negative: Fields from 0 on.
        kind: What the record is called in messages.

    Raises:
        InputError: With the key ``<kind>.<field>``.
    """
    for key in (*positive, *not_negative):
        value = getattr(record, key)
        if value is None:
            continue
        parts = value if isinstance(value, (tuple, list)) else (value,)
        allowed = f"a finite number {'above' if key in positive else 'from'} 0"
        for part in parts:
            number = isinstance(part, (int, float, np.number)) and not isinstance(part, bool)
            least_is_zero = key in not_negative
            if not (number and np.isfinite(part) and (part > 0 or (least_is_zero and part == 0))):
                raise InputError(f"{kind}.{key}", value, allowed)
        floats = tuple(float(part) for part in parts)
        object.__setattr__(record, key, floats if isinstance(value, (tuple, list)) else floats[0])


def command_size(array: CmgArray, obs: Observation) -> Any:
    """Return |hdot| over the mean momentum [rad/s]: the torque asked, in the array's own unit."""
    return np.sqrt(obs.hdot @ obs.hdot) / array.mean_momentum
