"""Beyond Kim et al. 2012: the same startups on full plants, within limits of real motors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from itertools import groupby
from typing import Any

import numpy as np

from nullmotion.papers.kim2014_cases import ATTITUDE, CASES, Startup, setup
from nullmotion.sim import Setup, Trajectory, run_batch
from nullmotion.sim.run import histories
from nullmotion.sim.state import Record

NOTE = """\
The two cases for 700 s each on the paper's plant (`reduced`: no torque from accelerating gimbals)
and on the full one, with ideal servos (`rate`) or torque-driven units (`torque`); with its limits
(25 rad/s on gimbals, none on wheels) and with those of small motors (5 rad/s, 5 mN m); with both
readings of the signs of delta(0), lost in the scan. Control `published` has the paper's law, whose
commands the hardware clips; `direction kept` has limits within the law, which scales what is too
much, and softer gains: kp = 0.005 N m, k = 0.02 N m s in place of 1 and 0.05.

`settled`: |e_v| < 0.01 and every wheel within 2 % at the end. Wheel torque is that of the motor
where units are torque-driven, I_W Omega_dot otherwise. Limited is a sample where a limit cut the
torque or a gimbal's rate. Drift is the greatest change of the total angular momentum, no torque
acting from outside, over I_W Omega_d = 0.139 N m s; `final` what is left of it at the end. The
gimbal of a torque-driven unit may pass its rate limit by what its rate loop overshoots. While
gimbals flip between their limits a run hangs on rounding: its times may move by some seconds."""

_LIMITS = {"array.rate_limit_deg_s": float(np.degrees(5.0)), "array.wheel_torque_limit_Nm": 5e-3}
_KEPT = {
    "array.rate_limit_mode": "scale",
    "law.as_published": False,
    "controller.kp": 0.005,
    "controller.k": 0.02,
}
SIGNS = {"all positive": (1, 1, 1, 1), "alternating": (1, -1, 1, -1)}
EVERY = 10  # samples to a row of the histories
_HORIZON = 700.0  # [s]


@dataclass(frozen=True)
class Variant:
    """A case on a plant, within limits, under a control."""

    case: str
    signs: str
    plant: str  # reduced, full
    drive: str  # rate, torque
    limited: bool = False
    kept: bool = False

    @property
    def setup(self) -> Setup:
        """What is run."""
        found = _built(self.case, self.limited, self.kept)
        terms = "published" if self.plant == "reduced" else "all"
        units = replace(found.units, drive=self.drive, terms=terms)  # type: ignore[type-var]
        return replace(found, units=units, delta=found.delta * np.array(SIGNS[self.signs]))


def _kernel(variant: Variant) -> tuple[bool, str, str]:
    """Return what runs of one batch share."""
    return (variant.kept, variant.plant, variant.drive)


def kernels(given: list[Variant]) -> int:
    """Return how many batches variants take."""
    return len({_kernel(variant) for variant in given})


@cache
def _built(case: str, limited: bool, kept: bool) -> Setup:
    values: dict[str, Any] = {"simulation.duration_s": _HORIZON}
    values |= _LIMITS if limited else {}
    return setup(case, **values | (_KEPT if kept else {}))


def variants() -> list[Variant]:
    """Return all of them."""
    plants = [("reduced", "rate"), ("full", "rate"), ("full", "torque")]
    both = [(case, signs) for case in CASES for signs in SIGNS]
    found = [Variant(*which, *plant) for plant in plants for which in both]
    for kept in (False, True):
        found += [Variant(*w, *plant, True, kept) for plant in plants[1:] for w in both]
    return found


def fly(given: list[Variant], done: Callable[[], None]) -> dict[Variant, Startup]:
    """Return startups in order; those of one kernel run together."""
    found: dict[Variant, Startup] = {}
    for _, group in groupby(sorted(given, key=_kernel), key=_kernel):
        found |= _batch(list(group))
        done()
    return {variant: found[variant] for variant in given}


def _batch(some: list[Variant]) -> dict[Variant, Startup]:
    setups = [variant.setup for variant in some]
    angles = np.array([s.delta for s in setups])
    result = run_batch(setups[0], setups=setups, delta=angles, history=EVERY)
    assert result.history is not None
    found = {}
    for i, (variant, flown) in enumerate(zip(some, setups, strict=True)):
        columns = Record(*(column[i] for column in result.history))
        run = Trajectory(
            setup=flown,
            **histories(flown, columns, flown.steps, EVERY),
            metrics={name: float(values[i]) for name, values in result.metrics.items()},
            stopped_at_s=None,
            stop_reason=result.stop_reason[i],
            status=[flag for flag, raised in result.status.items() if raised[i]],
        )
        found[variant] = Startup(run)
    return found


def row(variant: Variant, startup: Startup) -> dict[str, Any]:
    """Return a startup's numbers."""
    run, found = startup.run, startup.run.metrics
    H = run.inertial_momentum
    assert run.limited is not None and H is not None
    cut = (run.limited > 0) | startup.saturated
    drift = np.linalg.norm(H - H[0], axis=1) / run.setup.array.h0[0]
    return {
        "case": variant.case,
        "signs": variant.signs,
        "plant": variant.plant,
        "drive": variant.drive,
        "limits": "5 rad/s, 5 mN m" if variant.limited else "25 rad/s",
        "control": "direction kept" if variant.kept else "published",
        "settled": settled(startup),
        "momentum_settling_s": found["momentum_settling_s"],
        "wheel_settling_time_s": found["wheel_settling_s"],
        "attitude_settling_time_s": found["settling_time_s"],
        "peak_gimbal_rate_rad_s": found["max_peak_rate_rad_s"],
        "peak_wheel_torque_Nm": _wheel_torque(variant, startup),
        "limited_time_s": startup.time(cut),
        "last_limited_time_s": startup.last(cut),
        "momentum_drift": float(drift.max()),
        "final_momentum_drift": float(drift[-1]),
    }


def settled(startup: Startup) -> bool:
    """Return whether attitude and wheels are there at the end."""
    wheels = np.abs(startup.speed[-1] / startup.run.setup.array.design_speed - 1.0)
    return bool(startup.error[-1] < ATTITUDE and wheels.max() < 0.02)


def _wheel_torque(variant: Variant, startup: Startup) -> float:
    if variant.drive == "rate":
        return startup.run.metrics["max_wheel_torque_Nm"]
    motor = startup.run.wheel_motor_torque
    assert motor is not None
    return float(np.nanmax(np.abs(motor)))
