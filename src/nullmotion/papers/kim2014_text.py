"""What Kim et al. 2012 print: Tables 1 and 2, and what the text says of the two cases."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from nullmotion.papers.base import Cell, Value
from nullmotion.papers.kim2014_cases import ATTITUDE, Startup

Line = tuple[str, Value, Value, float, str]  # column, published, computed, tolerance, note

RW_MODE = 0.5  # s_w below which wheels serve the torque: "s_w = 0 ... RW mode"
_SETTLING = {"case1": 600.0, "case2": 200.0}  # [s]
_NO_SHARE = "printed without the share that counts as settled: within a tenth of it"
_NO_GAINS = "gains are not printed"
_NEAR = 0.05  # det(C_T C_T^T)


def cells(flights: Mapping[str, Startup]) -> list[Cell]:
    """Return every printed value and word with ours."""
    run = flights["case1"]
    found = [Cell("1", "satellite", *line) for line in _table1(run)]
    found += [Cell("2", "start", *line) for line in _table2(run)]
    found += [Cell("text", "simulation", *line) for line in _simulation(run)]
    for name, startup in flights.items():
        other = flights["case2" if name == "case1" else "case1"]
        for lines in (_settling(name, startup), _limits(name, startup, other), _theorem(startup)):
            found += [
                Cell("text", name, column, printed, ours, tolerance, "fitted", note or _NO_GAINS)
                for column, printed, ours, tolerance, note in lines
            ]
    return found


def _table1(run: Startup) -> Iterable[tuple[Any, ...]]:
    setup = run.run.setup
    assert setup.spacecraft is not None and setup.units is not None
    for i, printed in enumerate((6.10e-2, 6.10e-2, 7.64e-2)):
        axis = "xyz"[i]
        yield f"J_{axis}{axis}_kg_m2", printed, float(setup.spacecraft.inertia[i, i]), 1e-12
    yield "I_G_kg_m2", 2.80e-3, float(setup.units.gimbal_inertia[0]), 1e-12
    yield "I_W_kg_m2", 6.95e-4, run.inertia, 1e-12
    cosine = float(setup.array.gimbal_axes[0, 2])  # gimbal axes lean by the skew angle
    yield "skew_angle_deg", 54.74, float(np.degrees(np.arccos(cosine))), 1e-6


def _table2(run: Startup) -> Iterable[tuple[Any, ...]]:
    start = run.run
    assert start.q_BN is not None and start.omega_BN_B is not None
    length = "its length is 0.949; flown at length 1, the scalar part first"
    yield "q", "[0.1, 0.3, 0.8, 0.4]", _words(start.q_BN[0]), 0.0, "printed", length
    yield "omega_rad_s", 0.0, float(np.abs(start.omega_BN_B[0]).max())
    blank: Any = start.setup.controller.init(start.setup.array)  # type: ignore[union-attr]
    yield "theta_1", 0.0, float(np.abs(blank.theta1).max())
    yield "theta_2", 0.0, float(np.abs(blank.theta2).max())
    signs = "signs are lost in the scan: all positive here, alternating in beyond.json"
    printed = "[0.5498, 0.2333, 0.5498, 0.2333]"
    yield "delta_rad", printed, _words(start.delta[0]), 0.0, "printed", signs
    yield "Omega_rad_s", 0.0, float(np.abs(run.speed[0]).max())
    yield "elements_of_theta_1", 10.0, float(len(blank.theta1))
    reading = "J_g and J_s - J_t of each unit; which seven the paper has is not said"
    yield "elements_of_theta_2", 7.0, float(len(blank.theta2)), 0.0, "inferred", reading


def _simulation(run: Startup) -> Iterable[tuple[Any, ...]]:
    setup = run.run.setup
    assert setup.reference is not None
    rate = setup.reference[:, 4]
    yield "gimbal_rate_limit_rad_s", 25.0, float(setup.array.rate_limit[0]), 1e-9
    yield "Omega_d_rad_s", 200.0, float(setup.array.design_speed[0]), 1e-9
    rpm = float(setup.array.design_speed[0] * 30.0 / np.pi)
    yield "Omega_d_rpm", 2000.0, rpm, 100.0, "printed", "about"
    yield "omega_d_amplitude_rad_s", 0.004, float(np.abs(rate).max()), 1e-6
    first = float(run.run.t[int(np.argmax(rate))])
    yield "omega_d_quarter_time_s", 500.0, first, 1.0, "printed", "a quarter of 2000 s"


def _settling(name: str, run: Startup) -> Iterable[Line]:
    found, printed = run.run.metrics, _SETTLING[name]
    for column in ("momentum_settling_s", "wheel_settling_s"):
        label = column if column.startswith("momentum") else "wheel_settling_time_s"
        yield label, printed, float(found[column]), 0.1 * printed, _NO_SHARE
    given = f"size of e_v below {ATTITUDE:g} for good"
    yield "attitude_settling_time_s", None, float(found["settling_time_s"]), 0.0, given
    rate, off = run.decay
    note = f"I_W k_m with the fitted k_m; between 1/e and 1 % within {100 * off:.2g} % of it"
    yield "momentum_decay_rate_1_s", run.gain, rate, 0.01 * run.gain, note
    final = run.speed[-1]
    for i, speed in enumerate(final):
        end = f"at {run.run.t[-1]:g} s"
        yield f"final_wheel_speed_{i + 1}_rad_s", 200.0, float(speed), 4.0, end


def _limits(name: str, run: Startup, other: Startup) -> Iterable[Line]:
    found, slow = run.run.metrics, name == "case1"
    ours = bool(run.saturated.any())
    last = run.last(run.saturated)
    note = f"for {run.time(run.saturated):.3g} s, the last at {last:.3g} s" if last else ""
    yield "gimbal_rate_saturated", "Y" if slow else "N", _flag(ours), 0.0, note
    peak = float(found["max_peak_rate_rad_s"])
    yield "peak_gimbal_rate_rad_s", 25.0 if slow else None, peak, 1e-9, ""
    asked, note = float(found["max_wheel_torque_Nm"]), "no limit is printed"
    yield "peak_wheel_torque_Nm", None, asked, 0.0, note
    yield "peak_wheel_acceleration_rad_s2", None, asked / run.inertia, 0.0, note
    yield from _singularities(slow, run, other)


def _singularities(slow: bool, run: Startup, other: Startup) -> Iterable[Line]:
    """What the text says of Figs 5, 6, 12: singularities, RW mode, the course of f."""
    near = run.last(run.det < _NEAR) or 0.0
    note = f"det(C_T C_T^T) is last below {_NEAR:g} at {near:.3g} s"
    yield "leaves_singularities", "Y", _flag(near < 0.1 * run.run.t[-1]), 0.0, note
    here, there = (s.time(s.weights[:, 0] < RW_MODE) for s in (run, other))
    yield "rw_mode_time_s", None, here, 0.0, f"s_w below {RW_MODE:g}"
    travel = float(np.abs(np.diff(run.det)).sum())
    yield (
        "variation_of_f",
        None,
        travel,
        0.0,
        "sum of the sizes of its changes from sample to sample",
    )
    if not slow:
        yield "less_rw_mode_than_case_1", "Y", _flag(here < there), 0.0, f"s_w below {RW_MODE:g}"
        moderate = travel < 0.5 * float(np.abs(np.diff(other.det)).sum())
        yield "moderate_variation_of_f", "Y", _flag(moderate), 0.0, "half of case 1 or less"


def _theorem(run: Startup) -> Iterable[Line]:
    """Theorem 1 on the run: Eqs 45, 46 and 50."""
    end = float(run.error[-2])  # the last row has no sample of the reference
    yield (
        "attitude_error_vanishes",
        "Y",
        _flag(end < 1e-4),
        0.0,
        f"the size of e_v ends at {end:.2g}",
    )
    bound = np.exp(-run.gain * run.run.t)
    late = float(run.run.metrics["momentum_settling_s"]) - np.log(50.0) / run.gain
    note = f"while wheels are slow Eq 43 has no solution: the size of mu is {late:.2g} s late"
    held = bool(np.all(run.share <= bound * (1 + 1e-6)))
    yield "bound_of_Eq_46_holds", "Y", _flag(held), 0.0, note
    found = run.lyapunov
    yield "bound_of_Eq_50_holds", "Y", _flag(len(found.above) == 0), 0.0, found.words()


def _flag(value: Any) -> str:
    return "Y" if value else "N"


def _words(values: np.ndarray) -> str:
    return f"[{', '.join(f'{value:.4g}' for value in values)}]"
