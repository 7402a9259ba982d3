"""The startups of Kim et al. 2012, cases 1 and 2, and what the paper shows of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from nullmotion.metrics.base import Metric
from nullmotion.metrics.momentum_settling import MomentumSettling
from nullmotion.metrics.peak_rate import PeakRate
from nullmotion.metrics.settling_time import SettlingTime
from nullmotion.metrics.wheel_settling import WheelSettling
from nullmotion.metrics.wheel_torque import WheelTorque
from nullmotion.papers import kim2014_steering as steering
from nullmotion.scenario import build, load_scenario
from nullmotion.sim import Setup, Trajectory, run
from nullmotion.vscmg.lyapunov import LyapunovMonitor, monitor

CASES = {"case1": "kim2014-case1", "case2": "kim2014-case2"}
ATTITUDE = 0.01  # |e_v| that counts as settled
METRICS: tuple[Metric, ...] = (
    MomentumSettling(),
    WheelSettling(),
    SettlingTime(2.0 * float(np.arcsin(ATTITUDE))),
    PeakRate(),
    WheelTorque(),
)
_FIT = float(np.exp(-1.0)), 0.01  # of |mu(0)|: where its decay is fitted


@dataclass(frozen=True, eq=False)
class Startup:
    """One startup; rows of its signals are samples, (k,) or (k, n)."""

    run: Trajectory

    @property
    def inertia(self) -> float:
        """I_W [kg m^2]; that of all wheels."""
        return float(self.run.setup.array.flywheels.inertia[0])

    @property
    def gain(self) -> float:
        """I_W k_m [1/s], the rate at which Eq 46 lets |mu| fall."""
        law: Any = self.run.setup.law
        return float(law.k_m * self.inertia)

    @cached_property
    def speed(self) -> np.ndarray:
        """Wheel speeds [rad/s]."""
        assert self.run.wheel_speed is not None
        return self.run.wheel_speed

    @cached_property
    def error(self) -> np.ndarray:
        """|e_v|, (k,)."""
        assert self.run.q_BR is not None
        return np.linalg.norm(self.run.q_BR[:, 1:], axis=1)

    @cached_property
    def mu(self) -> np.ndarray:
        """Momentum error I_W (Omega_d - Omega) [N m s]."""
        return self.inertia * (self.run.setup.array.design_speed - self.speed)

    @cached_property
    def share(self) -> np.ndarray:
        """|mu| / |mu(0)|, (k,)."""
        size = np.linalg.norm(self.mu, axis=1)
        return size / size[0]

    @cached_property
    def decay(self) -> tuple[float, float]:
        """Rate of |mu| between 1/e and 1 % [1/s], and its farthest share off that exponential."""
        first, last = (int(np.argmax(self.share < level)) for level in _FIT)
        t, size = self.run.t[first : last + 1], np.log(self.share[first : last + 1])
        slope, start = np.polyfit(t, size, 1)
        return -float(slope), float(np.abs(np.expm1(size - start - slope * t)).max())

    @cached_property
    def saturated(self) -> np.ndarray:
        """Whether a gimbal is asked for more than its limit, (k,)."""
        asked = np.nan_to_num(np.abs(self.run.rates_asked))
        return np.any(asked > self.run.setup.array.rate_limit, axis=1)

    @cached_property
    def det(self) -> np.ndarray:
        """det(C_T C_T^T) = -f, (k,)."""
        return steering.determinant(self.run.setup.array, self.run.delta)

    @cached_property
    def weights(self) -> np.ndarray:
        """s_w and s_g of Eq 33, (k, 2)."""
        return steering.weights(self.run.setup.law, self.det)

    @cached_property
    def null_motion(self) -> np.ndarray:
        """What null motion adds to the gimbal rates, before their limit [rad/s]."""
        return self.run.rates_asked - steering.ranged(self.run, self.det)[1]

    @cached_property
    def lyapunov(self) -> LyapunovMonitor:
        """Lyapunov's function and its bound."""
        return monitor(self.run)

    def time(self, marks: np.ndarray) -> float:
        """Return for how long marks (k,) are set [s]."""
        return float(np.count_nonzero(marks) * (self.run.t[1] - self.run.t[0]))

    def last(self, marks: np.ndarray) -> float | None:
        """Return the time of the last mark [s]; None without any."""
        found = np.flatnonzero(marks)
        return float(self.run.t[found[-1]]) if len(found) else None


def setup(case: str, **values: Any) -> Setup:
    """Return a case as its scenario has it, or with other values."""
    scenario = load_scenario(CASES[case]).with_values(values)
    return replace(build.setup(scenario), metrics=METRICS)


def fly(done: Callable[[], None] = lambda: None) -> dict[str, Startup]:
    """Return both startups."""
    found = {}
    for case in CASES:
        found[case] = Startup(run(setup(case)))
        done()
    return found
