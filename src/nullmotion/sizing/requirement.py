"""What an array has to do: a requirement file, checked, in SI and radians."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.array import layouts
from nullmotion.scenario.source import Source

_DEG = np.pi / 180
_FEEDBACK = 20.0  # natural frequency times the slew's time: a fifth of a radian a step and less
_STEPS = 300  # law periods in a slew, at least
_SETTLED = 0.95  # share of the time allowed after which the profile has ended


@dataclass(frozen=True)
class Requirement:
    """A requirement; sections as in the file (`nullmotion.sizing.schema`), and SI beside.

    Attributes:
        source: Text and file.
        sections: The checked sections by name.
    """

    source: Source
    sections: dict[str, Any]

    def __getattr__(self, name: str) -> Any:
        """Return a section."""
        try:
            return self.__dict__["sections"][name]
        except KeyError:
            raise AttributeError(name) from None

    @property
    def name(self) -> str:
        """Short name: that of the file without its ending."""
        return Path(self.source.name).stem or "requirement"

    @property
    def title(self) -> str:
        """Title, or the name where the file gives none."""
        return str(self.requirement.title or self.name)

    @cached_property
    def inertia(self) -> np.ndarray:
        """Inertia in B [kg m^2], (3, 3)."""
        given = np.asarray(self.spacecraft.inertia_kg_m2, float)
        return np.diag(given) if given.ndim == 1 else given

    @property
    def angle(self) -> float:
        """Angle of the slew [rad]."""
        return float(self.slew.angle_deg * _DEG)

    @property
    def time(self) -> float:
        """Time from the command until settled [s]."""
        return float(self.slew.time_s + self.settling.time_s)

    @property
    def profile_time(self) -> float:
        """Time until the rate profile has ended [s]."""
        return float(min(self.slew.time_s, _SETTLED * self.time))

    @cached_property
    def axis(self) -> np.ndarray:
        """Middle of the cone of slew axes, a unit vector in B."""
        given = np.asarray(self.slew.axis, float)
        unit: np.ndarray = given / np.linalg.norm(given)
        return unit

    @property
    def cone(self) -> float:
        """Half angle of the cone [rad]; pi for any axis."""
        return float(self.slew.cone_half_angle_deg * _DEG)

    @property
    def torque(self) -> np.ndarray:
        """Constant torque from outside in B [N m], (3,)."""
        return np.array(self.disturbance.torque_Nm or (0.0, 0.0, 0.0), float)

    @property
    def layouts(self) -> tuple[str, ...]:
        """Names of the layouts."""
        return tuple(layouts.get(name).name for name in self.array.layouts)

    @property
    def failures(self) -> int:
        """Number of CMGs that may have failed."""
        return int(self.failure.failed_cmgs)

    @property
    def natural_frequency(self) -> float:
        """Natural frequency of the attitude feedback [rad/s]."""
        return float(self.controller.natural_frequency_rad_s or _FEEDBACK / self.time)

    @property
    def period(self) -> float:
        """Sampling period of law and controller [s]: 1, 2 or 5 times a power of ten by default."""
        if self.law.period_s is not None:
            return float(self.law.period_s)
        most = self.slew.time_s / _STEPS
        power = 10.0 ** np.floor(np.log10(most))
        return float(round(max(k for k in (1, 2, 5) if k * power <= most * 1.001) * power, 12))

    @property
    def gimbal_rates(self) -> tuple[float, float]:
        """Least and greatest gimbal rate that may be chosen [rad/s]."""
        return _ends(self.array.gimbal_rate_deg_s)

    @property
    def skews(self) -> tuple[float, float]:
        """Least and greatest skew or roof angle [rad]."""
        return _ends(self.array.skew_deg)

    def held_back(self, h0: Any, rate: Any) -> tuple[Any, Any]:
        """Return momentum [N m s] and rate [rad/s] of a CMG with the margins held back.

        What has to fly is an array with h0 / (1 + momentum margin), whose h0 times rate is
        that of the design / (1 + torque margin).
        """
        momentum, torque = 1.0 + self.margin.momentum, 1.0 + self.margin.torque
        return h0 / momentum, rate * (momentum / torque)

    def with_margins(self, h0: Any, rate: Any) -> tuple[Any, Any]:
        """Return momentum and rate of the design of which these are left: see `held_back`."""
        momentum, torque = 1.0 + self.margin.momentum, 1.0 + self.margin.torque
        return h0 * momentum, rate * (torque / momentum)


def _ends(value: Any) -> tuple[float, float]:
    low, high = value if isinstance(value, tuple) else (value, value)
    return float(low * _DEG), float(high * _DEG)
