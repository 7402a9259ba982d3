"""Follow a plan: a law's rates and a planned course of null motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError, UnknownNameError
from nullmotion.law import Claim, Law, Observation, check_parameters


@dataclass(frozen=True)
class FollowPlan(Law):
    """Rates of a base law and null motion of a planned size.

        delta_dot = base rates + 4 k(t) n,    A n = 0,  |n| = sqrt(det(A A^T)) for n = m + 1

    A is divided by the mean momentum; n is the vector of signed minors, which is continuous
    everywhere and vanishes only at singular states. k(t) is k_max times the line through
    the knots, which stand at equal distances over the duration, and 0 from its end on.
    `nullmotion plan` finds the knots.

    Args:
        base: Name of the law whose rates come first.
        base_parameters: Its parameters; the rest keep their defaults.
        knots: Course of the null motion in units of k_max, usually within -1 and 1.
        duration_s: Time from the first knot to the last [s].
        k_max: Unit of the knots [rad/s].
        lag: Take n at the sample before (none at the first), as the paper's complex model does.
    """

    name: ClassVar[str] = "follow-plan"
    full_name: ClassVar[str] = "Planned null motion"
    citation: ClassVar[str] = "Papakonstantinou et al. (2021), Eqs 22-24"
    claims: ClassVar[frozenset[Claim]] = frozenset(
        {Claim.EXACT_TORQUE, Claim.FINITE, Claim.ROTATION, Claim.SCALING}
    )

    base: str = "sr"
    base_parameters: Mapping[str, Any] = field(default_factory=dict)
    knots: tuple[float, ...] = (0.0,)
    duration_s: float = 1.0
    k_max: float = 0.7
    lag: bool = False

    def __post_init__(self) -> None:
        """Check the parameters; put in the base law's defaults."""
        check_parameters(self, positive=("duration_s", "k_max"))
        object.__setattr__(self, "knots", _knots(self.knots))
        base = _created(self.base, self.base_parameters)
        every = {f.name: getattr(base, f.name) for f in fields(base)}
        object.__setattr__(self, "base", base.name)
        object.__setattr__(self, "base_parameters", every)

    @property
    def base_law(self) -> Law:
        """The base law; its parameters may be symbols, which nothing checks again."""
        from nullmotion import laws  # this module is one of its entries

        cls = laws.get(self.base)
        made: Law = object.__new__(cls)
        for name, value in self.base_parameters.items():
            object.__setattr__(made, name, value)
        return made

    def supports(self, array: CmgArray) -> str:
        """Ask for a null space, and for what the base law asks."""
        if self.base_law.turns_wheels:
            return f"plans are of gimbals alone, and {self.base} turns wheels, too"
        return without_null_motion(array) or self.base_law.supports(array)

    def init(self, array: CmgArray, delta: Any) -> Any:
        """Return the base law's state and the null vector of the sample before."""
        return self.base_law.init(array, delta), np.zeros(array.n) if self.lag else ()

    def exact_above(self, array: CmgArray) -> float:
        """Return the base law's bound."""
        return self.base_law.exact_above(array)

    def gain(self, t: Any) -> Any:
        """Return k(t) [rad/s]: every knot adds a hat of its own."""
        place = t * ((len(self.knots) - 1) / self.duration_s)
        k = 0.0
        for i, knot in enumerate(self.knots):
            k = k + knot * ops.maximum(1.0 - ops.absolute(place - float(i)), 0.0)
        return self.k_max * ops.where(ops.less(t, self.duration_s), k, 0.0)

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the base law's rates and the null motion."""
        rates, carried = self.base_law.step(array, obs, state[0])
        return with_null_motion(array, obs, rates, carried, state[1], self.gain(obs.t))


def with_null_motion(
    array: CmgArray, obs: Observation, rates: Any, carried: Any, before: Any, k: Any
) -> tuple[Any, Any]:
    """Return rates + 4 k n and the state; n is ``before`` unless that is ()."""
    n = linalg.null_vector(array.unit_jacobian(obs.delta))
    lags = len(before) > 0
    return rates + 4.0 * k * (before if lags else n), (carried, n if lags else ())


def _knots(given: Any) -> tuple[float, ...]:
    try:
        knots = tuple(float(k) for k in given)
    except (TypeError, ValueError):
        knots = ()
    if not knots or not np.isfinite(knots).all():
        raise InputError("law.knots", given, "at least one finite number")
    return knots


def without_null_motion(array: CmgArray) -> str:
    """Return why an array has no null motion; an empty string if it has."""
    if array.n > array.m:
        return ""
    return f"{array.n} CMGs leave no null motion beside {array.m} torque dimensions"


def _created(name: Any, parameters: Any) -> Law:
    """Return the base law; what is wrong is told under the keys of this law."""
    from nullmotion import laws

    if not isinstance(name, str) or name == FollowPlan.name:
        raise InputError("law.base", name, "the name of a law that follows no plan itself")
    if not isinstance(parameters, Mapping):
        raise InputError("law.base_parameters", parameters, "a table of the base law's parameters")
    try:
        whole = {f.name for f in fields(laws.get(name)) if f.type in ("int", "int | None")}
    except UnknownNameError as error:
        raise InputError("law.base", name, error.allowed) from None
    given = {key: v if key in whole else _floats(v) for key, v in parameters.items()}
    try:
        return laws.create(name, **given)
    except InputError as error:
        key = error.key.replace("law.", "law.base_parameters.", 1)
        raise InputError(key, error.value, error.allowed) from None


def _floats(value: Any) -> Any:
    """Return whole numbers as floats and lists as tuples: a file may write 1 for 1.0."""
    if isinstance(value, (list, tuple)):
        return tuple(map(_floats, value))
    whole = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if whole else value
