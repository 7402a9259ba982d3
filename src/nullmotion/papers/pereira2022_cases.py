"""The flights of Pereira 2022: the attitude steps of Eq 45 under several allocations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from nullmotion import singular_lines
from nullmotion.scenario import build, load_scenario
from nullmotion.sim import Trajectory, run

SCENARIO = "pereira-eq45"
_ACCELERATION = 7.0  # [rad/s^2]: 0.7 rad/s a sample

# name: N_p and rho, in the order of the paper's figures
CASES: dict[str, dict[str, Any]] = {
    "N = 1, no term": {"N_p": 1, "rho": 0.0},
    "N = 1, term": {"N_p": 1},
    "N = 5, term": {"N_p": 5},
    "N = 5, no term": {"N_p": 5, "rho": 0.0},
}
BEYOND: dict[str, dict[str, Any]] = {
    "N = 5, term, middle of the moves": {"N_p": 5, "midpoint": True},
    "N = 20, term": {"N_p": 20},
    "action governor": {"name": "action-governor"},
    "action governor, kappa = 1": {"name": "action-governor", "kappa": 1.0},
    "pseudo-inverse": {"name": "pseudo-inverse"},
}


@dataclass(frozen=True, eq=False)
class Flight:
    """One flight and what the paper shows of it; values at samples, (k,)."""

    run: Trajectory

    @cached_property
    def t(self) -> np.ndarray:
        """Times of the samples at which rates begin to act [s]."""
        return self.run.t[:-1]

    @cached_property
    def rates(self) -> np.ndarray:
        """Gimbal rates [rad/s], (k, 3)."""
        return self.run.rates[:-1]

    @cached_property
    def mismatch(self) -> np.ndarray:
        """|J gamma_dot - hdot_c| at the start of each sample [N m]."""
        return np.linalg.norm(self.run.torque[:-1] - self.run.hdot[:-1], axis=1)

    @cached_property
    def mean_error(self) -> np.ndarray:
        """|change of h over a sample / T_s - hdot_c| [N m]."""
        mean = np.diff(self.run.momentum, axis=0) / self.run.setup.dt
        return np.linalg.norm(mean - self.run.hdot[:-1], axis=1)

    @cached_property
    def relative_error(self) -> float:
        """Greatest `mean_error` over |hdot_c|, where that is above a hundredth of its peak."""
        command = np.linalg.norm(self.run.hdot[:-1], axis=1)
        there = command > 0.01 * command.max()
        return float((self.mean_error[there] / command[there]).max())

    @cached_property
    def distance(self) -> np.ndarray:
        """Distance to the nearest singular line [rad], (k + 1,)."""
        return np.asarray(singular_lines.nearest(self.run.setup.array, self.run.delta).distance)

    @cached_property
    def peak_rate(self) -> float:
        """Greatest gimbal rate [rad/s]."""
        return float(np.abs(self.rates).max())

    @cached_property
    def peak_acceleration(self) -> float:
        """Greatest change of a gimbal rate from sample to sample over T_s [rad/s^2]."""
        return float(np.abs(np.diff(self.rates, axis=0)).max() / self.run.setup.dt)

    @cached_property
    def energy(self) -> float:
        """Integral of |gamma_dot|^2 [rad^2/s]."""
        return float((self.rates**2).sum() * self.run.setup.dt)

    @cached_property
    def least_energy(self) -> float:
        """The same for the least rates that give hdot_c at the same gimbal angles."""
        inverse = np.linalg.pinv(self.run.setup.array.jacobian(self.run.delta[:-1]))
        least = np.einsum("kij,kj->ki", inverse, self.run.hdot[:-1])
        return float((least**2).sum() * self.run.setup.dt)

    def row(self, name: str) -> dict[str, Any]:
        """Return what the paper does not print of a flight."""
        assert self.run.pointing_error is not None and self.run.wheel_momentum is not None
        return {
            "case": name,
            "peak_torque_mismatch_Nm": float(self.mismatch.max()),
            "at_time_s": float(self.t[np.argmax(self.mismatch)]),
            "least_distance_rad": float(self.distance.min()),
            "peak_rate_rad_s": self.peak_rate,
            "rate_energy_rad2_s": self.energy,
            "peak_mean_torque_error_Nm": float(self.mean_error.max()),
            "peak_mean_torque_error_fraction": self.relative_error,
            "final_pointing_error_deg": float(np.degrees(self.run.pointing_error[-1])),
            "wheel_momentum_Nms": float(np.abs(self.run.wheel_momentum).max()),
            "fall_backs": sum(self.run.law_counts.values()),
        }


def fly(law: Mapping[str, Any]) -> Flight:
    """Fly the scenario under a law: `allocation-mpc` unless it has another name."""
    name = law.get("name", "allocation-mpc")
    limit = {} if name == "pseudo-inverse" else {"acceleration_limit_rad_s2": _ACCELERATION}
    scenario = load_scenario(SCENARIO).with_values({"law": {"name": name, **limit, **law}})
    return Flight(run(replace(build.setup(scenario), metrics=())))


def flights(cases: Mapping[str, Mapping[str, Any]], done: Callable[[], None]) -> dict[str, Flight]:
    """Fly cases, one after another."""
    found = {}
    for name, law in cases.items():
        found[name] = fly(law)
        done()
    return found
