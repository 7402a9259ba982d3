"""What VSCMGs must keep: momentum, energy, and the motion of CMGs at constant wheel speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion import tree
from nullmotion.array.wheels import Wheels
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage
from nullmotion.spacecraft import Spacecraft
from nullmotion.spacecraft import dynamics as cmg
from nullmotion.spacecraft.motion import ideal
from nullmotion.vscmg import Units, dynamics

DT, SECONDS, EVERY = 0.01, 600.0, 50  # s, s, steps between two samples
WHEEL, SPEED = 6.95e-4, 200.0  # kg m^2, rad/s: Kim et al. (2014), Table 1
SPIN, ACROSS, ABOUT = 3.15e-3, 2.8e-3, 2.8e-3  # kg m^2
LARGEST = WHEEL * SPEED  # N m s
CRAFT = np.diag([6.10e-2, 6.10e-2, 7.64e-2])  # kg m^2, units included
ANGLES = np.array([0.5498, 0.2333, 0.5498, 0.2333])
ATTITUDE = np.array([0.1, 0.3, 0.8, 0.4]) / np.sqrt(0.9)
OMEGA = np.array([0.05, -0.1, 0.08])


class Given(NamedTuple):
    """What a flight starts from."""

    plant: dynamics.Plant
    state: dynamics.State


def given(units: Units) -> Given:
    plain = nm.layouts.pyramid(skew=np.radians(54.74), h0=LARGEST)
    array, units = replace(plain, wheels=Wheels(np.array(WHEEL))), units.for_n(4)
    plant = dynamics.Plant(array, units, dynamics.rest_inertia(array, units, CRAFT, ANGLES))
    return Given(plant, dynamics.State(ATTITUDE, OMEGA, ANGLES, np.zeros(4), np.zeros(4), 0.0))


def pico(**how: Any) -> Given:
    spin, across, about = (np.array(x) for x in (SPIN, ACROSS, ABOUT))
    return given(Units(spin, across, about, **how))


def nothing(since: Any, q: Any) -> Any:
    return np.zeros(3)


def told(t: np.ndarray) -> np.ndarray:
    """Return gimbal rates and wheel accelerations: up to 200 rad/s in 500 s, then coasting."""
    pace, phase = np.array([0.9, 1.1, 1.3, 1.5]), np.array([0.0, 1.0, 2.0, 3.0])
    rates = 0.5 * np.sin(pace * t[:, None] + phase)
    spin_up = np.where(t < 500.0, SPEED / 500.0, 0.0)[:, None]
    return np.hstack([rates, np.repeat(spin_up, 4, axis=1)])


def by_motors(k: Any, row: Any, s: Any, p: Given) -> Any:
    """Gimbal rate loops at 20 rad/s, wheel motors with the torque for the acceleration."""
    loops = 20.0 * ABOUT * (row[:4] - s.rates)
    return dynamics.torque_driven(p.plant, s, loops, WHEEL * row[4:], nothing, DT)


def by_servos(k: Any, row: Any, s: Any, p: Given) -> Any:
    return dynamics.rate_driven(p.plant, s, row[:4], row[4:], nothing, DT)


def fly(start: Given, step: Callable[..., Any]) -> dynamics.State:
    """Return the samples of a flight, one row for each."""
    steps = round(SECONDS / DT)
    loop = Loop(
        start=lambda p: p.state,
        stages=(Stage(step),),
        outputs=lambda s, p: s.work,
        parameters=start,
        varying=(False,) * len(tree.flatten(start)),
        row=8,
        record=lambda s: s,
    )
    kernel = LoopKernel(loop, recording=True, width=1)
    carried, out = (np.zeros((n, 1)) for n in (kernel.carried, kernel.outputs + len(kernel.flags)))
    history, rows = np.empty((steps // EVERY, kernel.records, 1)), told(DT * np.arange(steps))
    kernel.run(carried, np.zeros((0, 1)), rows, history, out, 0, 1, 0, steps, True, EVERY)
    ends = np.cumsum([len(tree.flatten(part)) for part in start.state])
    return dynamics.State(*np.split(history[:, :, 0], ends[:-1], axis=1))


class Parts(NamedTuple):
    """Axes of hub and units in N at each sample, and the inertia without the units."""

    hub: np.ndarray  # (k, 3, 3)
    units: np.ndarray  # (k, n, 3, 3): s, t, g
    omega: np.ndarray  # in N
    rest: np.ndarray


def parts(s: dynamics.State, array: nm.CmgArray, rest: np.ndarray) -> Parts:
    to_N = Rotation.from_quat(np.roll(s.q, -1, axis=1)).as_matrix()
    spin = [
        Rotation.from_rotvec(s.delta[:, [i]] * g).apply(array.spin_axes[i])
        for i, g in enumerate(array.gimbal_axes)
    ]
    s_axes = np.stack(spin, axis=1)
    g_axes = np.broadcast_to(array.gimbal_axes, s_axes.shape)
    in_B = np.stack([s_axes, np.cross(g_axes, s_axes), g_axes], axis=2)
    units = np.einsum("kij,knaj->knai", to_N, in_B)
    return Parts(to_N, units, np.einsum("kij,kj->ki", to_N, s.omega), rest)


def without_units(array: nm.CmgArray) -> np.ndarray:
    """Return the hub's inertia; the satellite's is told with the units at the start."""
    at = parts(
        dynamics.State(np.eye(4)[:1], OMEGA[None], ANGLES[None], *np.zeros((3, 1, 4))),
        array,
        np.zeros((3, 3)),
    )
    inertia: np.ndarray = CRAFT - np.einsum(
        "nai,a,naj->ij", at.units[0], [SPIN, ACROSS, ABOUT], at.units[0]
    )
    return inertia


def turning(s: dynamics.State, at: Parts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the hub's rate in B, the frames' rates and the wheels' on the units' axes."""
    frames = np.einsum("knai,ki->kna", at.units, at.omega)
    frames[:, :, 2] += s.rates
    return s.omega, frames, frames[:, :, 0] + s.speed


def momentum(s: dynamics.State, array: nm.CmgArray) -> np.ndarray:
    """Return the sum of what hub, frames and wheels hold, in N, (k, 3)."""
    at = parts(s, array, without_units(array))
    hub, frames, wheels = turning(s, at)
    held = frames * [SPIN - WHEEL, ACROSS, ABOUT]
    held[:, :, 0] += WHEEL * wheels
    total: np.ndarray = np.einsum("kij,jl,kl->ki", at.hub, at.rest, hub)
    return total + np.einsum("kna,knai->ki", held, at.units)


def energy(s: dynamics.State, array: nm.CmgArray) -> np.ndarray:
    """Return the sum of the kinetic energies, (k,)."""
    at = parts(s, array, without_units(array))
    hub, frames, wheels = turning(s, at)
    total: np.ndarray = np.einsum("ki,ij,kj->k", hub, at.rest, hub)
    total = total + frames**2 @ [SPIN - WHEEL, ACROSS, ABOUT] @ np.ones(4)
    return 0.5 * (total + WHEEL * (wheels**2).sum(axis=1))


def drift(s: dynamics.State, array: nm.CmgArray) -> float:
    """Return the greatest change of momentum over the largest of a wheel."""
    held = momentum(s, array)
    return float(np.linalg.norm(held - held[0], axis=1).max() / LARGEST)


@pytest.fixture(scope="module")
def driven() -> tuple[Given, dynamics.State]:
    """Ten minutes of motors: the wheels start from rest while the gimbals swing."""
    start = pico(drive="torque")
    return start, fly(start, by_motors)


def test_motors_leave_the_momentum(driven: tuple[Given, dynamics.State]) -> None:
    start, flown = driven
    assert flown.speed.max() > 0.99 * SPEED and np.ptp(flown.delta, axis=0).min() > 0.5
    assert np.linalg.norm(flown.omega, axis=1).max() > 0.5
    found = drift(flown, start.plant.array)
    print(f"drift {found:.1e}")
    assert found < 1e-8


def test_energy_is_what_the_motors_gave(driven: tuple[Given, dynamics.State]) -> None:
    start, flown = driven
    stored = energy(flown, start.plant.array)
    missing = np.abs(stored - stored[0] - flown.work[:, 0]).max()
    print(f"missing {missing:.1e} of {np.ptp(stored):.1e}")
    assert np.ptp(stored) > 50.0 and missing < 1e-6 * np.ptp(stored)


def test_momentum_and_energy_are_sums_over_the_bodies(
    driven: tuple[Given, dynamics.State],
) -> None:
    start, flown = driven
    held, stored = (f(flown, start.plant.array) for f in (momentum, energy))
    for k in (0, 300, -1):
        s = dynamics.State(*(part[k] for part in flown))
        a, moving = dynamics.axes(start.plant.array, s.delta), (s.omega, s.rates, s.speed)
        in_N = dynamics.in_N(s.q, start.plant.momentum(a, *moving))
        np.testing.assert_allclose(in_N, held[k], rtol=0, atol=1e-14)
        assert start.plant.energy(a, *moving) == pytest.approx(stored[k], rel=1e-13)
    columns = (flown.delta, flown.omega, flown.rates, flown.speed)
    total = dynamics.total_momentum(*start.plant, *columns)
    turned_back = [dynamics.in_N(q, h) for q, h in zip(flown.q, total, strict=True)]
    np.testing.assert_allclose(turned_back, held, rtol=0, atol=1e-14)


def test_servos_leave_the_momentum_but_for_what_is_published_without() -> None:
    """Kim et al., Eq 7, lose what the gimbals hold whenever their rates change."""
    drifts = {}
    for terms in ("all", "published"):
        start = pico(terms=terms)
        drifts[terms] = drift(fly(start, by_servos), start.plant.array)
    print("drift", drifts)
    assert drifts["all"] < 1e-8 and drifts["published"] > 1e-3


def turned(start: Given, rates: np.ndarray, dt: float) -> np.ndarray:
    """Return by how much the body rate changes when gimbals at rest turn at once."""
    running = start.state._replace(speed=np.full(4, SPEED))
    after = dynamics.rate_driven(start.plant, running, rates, np.zeros(4), nothing, dt)
    ends = dynamics.State(*(np.stack([a, b]) for a, b in zip(running, after, strict=True)))
    if start.plant.units.terms == "all":
        assert drift(ends, start.plant.array) < 1e-12
    change: np.ndarray = after.omega - running.omega
    return change


def test_a_jump_of_gimbal_rates_turns_the_body() -> None:
    """As much as keeps the momentum: by -J^-1 sum J_g delta_dot g at once."""
    rates, dt = np.array([3.0, -1.0, 2.0, 0.5]), 1e-9
    start = pico()
    expected = -np.linalg.solve(CRAFT, ABOUT * rates @ start.plant.array.gimbal_axes)
    assert np.linalg.norm(expected) > 0.1
    np.testing.assert_allclose(turned(start, rates, dt), expected, rtol=0, atol=1e-7)
    turned(start, rates, 0.01)
    np.testing.assert_allclose(turned(pico(terms="published"), rates, dt), 0.0, atol=1e-7)


@pytest.mark.parametrize("terms", ["all", "published"])
def test_light_units_at_constant_speed_are_cmgs(terms: Any, rng: np.random.Generator) -> None:
    """Only the wheels' momentum is left: the project's plant of CMGs, where rates jump."""
    light, dt, torque = 1e-11, 0.005, np.array([0.02, -0.03, 0.01])
    array = nm.layouts.pyramid(h0=LARGEST)
    vscmgs = replace(array, wheels=Wheels(np.array(light)))
    units = Units(*(np.array(light),) * 3, terms=terms).for_n(4)
    plant = dynamics.Plant(vscmgs, units, CRAFT)
    speed = np.full(4, LARGEST / light)
    ours = dynamics.State(ATTITUDE, OMEGA, ANGLES, np.zeros(4), speed, 0.0)
    craft, disturbance = Spacecraft(CRAFT), nm.spacecraft.Disturbance(constant=torque)
    body, delta = cmg.Body(ATTITUDE, OMEGA, np.zeros(3)), ANGLES
    for k in range(400):
        if k % 20 == 0:
            rates = rng.uniform(-1.0, 1.0, 4)
        ours = dynamics.rate_driven(plant, ours, rates, np.zeros(4), lambda since, q: torque, dt)
        vehicle = cmg.Vehicle(craft, array, None, (), disturbance, None, k * dt)
        motion = ideal(array, (), delta, rates, rates, k * dt, dt)
        body, delta = cmg.rk4(vehicle, body, delta, motion, k * dt, dt), delta + dt * rates
    assert np.linalg.norm(ours.omega - OMEGA) > 0.5
    np.testing.assert_allclose(ours.delta, delta, rtol=0, atol=1e-12)
    np.testing.assert_allclose(ours.omega, body.omega, rtol=0, atol=1e-8)
    np.testing.assert_allclose(ours.q, body.q / np.linalg.norm(body.q), rtol=0, atol=1e-8)
