"""Mao et al. 2019, what its tables do not hold: in a plain Euler loop of a few lines.

Table 7 is here to the last digit, so that the loop of the reproduction is held to another one.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from nullmotion import Observation, laws, layouts
from nullmotion.array import momentum_state

ARRAY = layouts.create("pyramid", skew=np.radians(54.73), h0=1.0, rate_limit=np.pi)
COMMANDS = {1: -np.ones(3), 2: -np.array([0.5, 0.4, 0.1]), 3: np.array([1.0, 0.0, 0.0])}
ELLIPTIC = np.radians([-90.0, 0.0, 90.0, 0.0])
DT, STEPS = 0.01, 1000
LAWS = {
    "PI": laws.create("pseudo-inverse"),
    "GSR": laws.create("gsr", as_published=True),
    "ODSR1": laws.create("odsr", as_published=True),
    "ODSR2": laws.create("odsr", w=(1.0, 0.01, 1.0, 1.0), as_published=True),
    "DSEA": laws.create("dsea", as_published=True),
    "VCBSAE": laws.create("vcbsae", as_published=True),
}


def run(law: Any, hdot: np.ndarray, start: np.ndarray) -> dict[str, Any]:
    """Return time, reserve, deviation and flags of one run."""
    delta, state, previous = start.astype(float), law.init(ARRAY, start), None
    e = hdot / np.linalg.norm(hdot)
    impulse, off, jump, least = np.zeros(3), 0.0, 0.0, np.inf
    for k in range(STEPS + 1):
        jacobian = ARRAY.jacobian(delta)
        sigma = np.linalg.svd(jacobian, compute_uv=False)[-1]
        least = min(least, sigma)
        if k == STEPS or momentum_state.sse(ARRAY, delta, hdot, sigma) < 0.2:
            break
        rates, state = law.step(ARRAY, Observation(delta, hdot, k * DT, DT), state)
        rates = ARRAY.limited(rates)
        torque = jacobian @ rates
        off = max(off, np.linalg.norm(torque - (torque @ e) * e) / np.linalg.norm(hdot))
        jump = jump if previous is None else max(jump, np.abs(rates - previous).max())
        delta, previous, impulse = delta + DT * rates, rates, impulse - DT * torque
    saturated = e - (ARRAY.gimbal_axes @ e)[:, None] * ARRAY.gimbal_axes
    saturated = saturated / np.linalg.norm(saturated, axis=1, keepdims=True)
    return {
        "time": k * DT,
        "reserve": np.linalg.norm(saturated.sum(axis=0)) - np.linalg.norm(ARRAY.momentum(delta)),
        "impulse": impulse,
        "off": off,
        "least": least,
        "flags": "".join("NY"[bool(b)] for b in (off > 0.02, jump > 0.5, least < 0.02)),
    }


ESCAPE = [
    ("GSR", 2.59, 0.03779, 0.1243, 0.1299),
    ("DSEA", 2.72, 0.0441, -0.2005, 0.2053),
    ("VCBSAE", 2.64, 0.09281, -0.1479, 0.1746),
]


@pytest.mark.parametrize(("law", "time", "y", "z", "total"), ESCAPE)
def test_escape(law: str, time: float, y: float, z: float, total: float) -> None:
    result = run(LAWS[law], COMMANDS[3], ELLIPTIC)
    assert result["time"] == pytest.approx(time, abs=0.005)
    assert result["impulse"][1:] == pytest.approx([y, z], abs=1e-4)
    assert np.linalg.norm(result["impulse"][1:]) == pytest.approx(total, abs=1e-4)


def test_vcbsae_with_equation_30_as_printed() -> None:
    result = run(laws.create("vcbsae"), COMMANDS[3], np.zeros(4))
    assert result["time"] == pytest.approx(3.30, abs=0.005)
    assert result["reserve"] == pytest.approx(0.00666, abs=1e-4)
    assert result["off"] < 1e-6 and result["least"] > 0.09
    escape = run(laws.create("vcbsae"), COMMANDS[3], ELLIPTIC)
    assert escape["time"] == pytest.approx(2.19, abs=0.005)
    assert np.linalg.norm(escape["impulse"][1:]) == pytest.approx(0.1758, abs=2e-4)


def test_the_deadlock_of_the_pseudo_inverse_does_not_hang_on_rounding() -> None:
    start = np.random.default_rng(0).normal(size=4) * 1e-12
    assert run(LAWS["PI"], COMMANDS[3], start)["reserve"] == pytest.approx(2.0, abs=0.002)
