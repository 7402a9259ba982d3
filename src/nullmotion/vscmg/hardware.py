"""What a VSCMG unit weighs and how it is driven, beside its flywheel (`array.wheels`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from nullmotion.array.checks import per_cmg
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.vscmg.unit_axes import axes, outer_sum

Drive = Literal["rate", "torque"]
Terms = Literal["all", "published"]


@dataclass(frozen=True, eq=False)
class Units:
    """Inertias of the VSCMG units (wheel and gimbal together) and their drives.

    With the unit's axes s (spin), t (transverse) and g (gimbal) the unit's inertia is
    J_s s s^T + J_t t t^T + J_g g g^T.

    Args:
        spin_inertia: J_s, the wheel's own spin inertia included [kg m^2], one number or (n,).
        transverse_inertia: J_t [kg m^2].
        gimbal_inertia: J_g [kg m^2].
        drive: ``rate``: gimbal rates and wheel accelerations are as commanded (ideal servos);
            ``torque``: motors follow them with limited torque, the units turn freely otherwise.
        terms: ``all``, or ``published``: without the gimbals' acceleration torque, as the
            literature on VSCMGs leaves it out (rate-driven only).
        gimbal_torque_limit: Of the gimbal motors [N m].
        gimbal_bandwidth: Of the gimbal rate loop [rad/s].
        gimbal_friction: Coulomb friction [N m].
        gimbal_drag: Viscous friction [N m s].
        wheel_friction: Coulomb friction of the wheel's bearing [N m].
        wheel_drag: Its viscous friction [N m s].
        inertia_includes_units: Whether the spacecraft's inertia is that of everything on board
            (units at the start angles included) or without the units.

    Raises:
        InputError: For signs and names that cannot be.
    """

    spin_inertia: Any
    transverse_inertia: Any
    gimbal_inertia: Any
    drive: Drive = "rate"
    terms: Terms = "all"
    gimbal_torque_limit: Any = np.inf
    gimbal_bandwidth: Any = 20.0
    gimbal_friction: Any = 0.0
    gimbal_drag: Any = 0.0
    wheel_friction: Any = 0.0
    wheel_drag: Any = 0.0
    inertia_includes_units: bool = True

    def __post_init__(self) -> None:
        """Check signs and names."""
        if self.drive not in ("rate", "torque"):
            raise InputError("vscmg.drive", self.drive, "'rate' or 'torque'")
        if self.terms not in ("all", "published"):
            raise InputError("vscmg.terms", self.terms, "'all' or 'published'")
        if self.drive == "torque" and self.terms != "all":
            raise InputError("vscmg.terms", self.terms, "'all' for torque-driven units")
        for key in self._numbers():
            positive = key.endswith(("bandwidth", "limit"))
            value = np.asarray(getattr(self, key), float)
            finite = np.isfinite(value) if key != "gimbal_torque_limit" else ~np.isnan(value)
            if not np.all(finite & ((value > 0) if positive else (value >= 0))):
                allowed = f"{'above' if positive else 'from'} 0"
                raise InputError(f"vscmg.{key}", value.tolist(), allowed)
            object.__setattr__(self, key, value)

    def check_beside(self, array: CmgArray, inertia: np.ndarray, delta: np.ndarray) -> None:
        """Refuse inertias that do not go with the wheels, or with the body that holds them.

        Raises:
            InputError: Naming the key, the value and the bound.
        """
        wheel = array.flywheels.inertia
        if np.any(self.spin_inertia > 0) and not np.all(self.spin_inertia >= wheel):
            allowed = f"from the wheel's own, {wheel.tolist()} kg m^2"
            raise InputError("vscmg.spin_inertia", self.spin_inertia.tolist(), allowed)
        if self.drive == "torque":
            for key in ("spin_inertia", "gimbal_inertia"):
                value = getattr(self, key)
                if not np.all(value > 0):
                    allowed = "above 0 for torque-driven units"
                    raise InputError(f"vscmg.{key}", value.tolist(), allowed)
        rest = np.linalg.eigvalsh(rest_inertia(array, self, inertia, delta))
        if not rest[0] > 0:
            allowed = "more than the units' own inertia in every direction"
            raise InputError("spacecraft.inertia", np.diag(inertia).tolist(), allowed)

    def _numbers(self) -> list[str]:
        return [
            key
            for key in self.__dataclass_fields__
            if key not in ("drive", "terms", "inertia_includes_units")
        ]

    def for_n(self, n: int) -> Units:
        """Return the units of n CMGs: one value for each."""
        own = {key: getattr(self, key) for key in self.__dataclass_fields__}
        for key in self._numbers():
            own[key] = per_cmg(f"vscmg.{key}", own[key], n, "numbers", lambda v: ~np.isnan(v))
        return Units(**own)


def rest_inertia(array: CmgArray, units: Units, inertia: Any, delta: Any) -> Any:
    """Return the inertia without the units, (3, 3), from the spacecraft's as its file has it."""
    if not units.inertia_includes_units:
        return inertia
    a = axes(array, delta)
    moving = outer_sum(units.spin_inertia, a.s) + outer_sum(units.transverse_inertia, a.t)
    return inertia - moving - outer_sum(units.gimbal_inertia, a.g)


def torque_matrix(array: CmgArray, delta: Any, speed: Any) -> Any:
    """Return Q of hdot = Q [wheel accelerations, gimbal rates] = [C_W I_W, C_T I_W Omega], (m, 2n).

    Body rate and the units' inertias are left out.

    Args:
        array: An array with flywheels.
        delta: Gimbal angles [rad], (n,).
        speed: Wheel speeds Omega [rad/s], (n,).
    """
    inertia = array.flywheels.inertia
    wheel = array.wheel_axes(delta) * inertia
    return np.concatenate([wheel, array.transverse_directions(delta) * (inertia * speed)], axis=1)
