"""Torques from outside against point masses, potentials and a run of their own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullmotion import rotation
from nullmotion.compile import compile_function
from nullmotion.errors import InputError
from nullmotion.spacecraft import Desaturation, Disturbance, Orbit
from nullmotion.spacecraft.disturbance import EARTH_MU, EARTH_RADIUS

J = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
ORBIT = Orbit.at_altitude(500e3, inclination=0.9, ascending_node=-2.0, argument_of_latitude=0.4)


def attitude(rng: np.random.Generator) -> np.ndarray:
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def test_gravity_gradient_is_the_torque_of_gravity_on_point_masses(
    rng: np.random.Generator,
) -> None:
    """Newton's law on each mass; what is left is of the next order in size over distance."""
    radius, size = EARTH_RADIUS + 500e3, 5.0
    mass, place_B = rng.uniform(1, 9, 6), size * rng.uniform(-1, 1, (6, 3))
    place_B -= mass @ place_B / mass.sum()
    inertia = sum(
        m * ((r @ r) * np.eye(3) - np.outer(r, r)) for m, r in zip(mass, place_B, strict=True)
    )
    for t in (0.0, 700.0, 4000.0):
        q_BN = attitude(rng)
        turn = Rotation.from_quat(np.roll(q_BN, -1))  # from B to N
        centre = radius * np.asarray(ORBIT.position(t))
        place_N = turn.apply(place_B)
        # mu r / |r|^3, less its value at the centre, which gives no torque: keeps digits
        far = 2.0 * place_N @ centre + np.sum(place_N**2, axis=1)
        ratio = -np.expm1(-1.5 * np.log1p(far / radius**2))
        force = -EARTH_MU / radius**3 * (place_N - ratio[:, None] * (centre + place_N))
        torque_N = np.sum(np.cross(place_N, mass[:, None] * force), axis=0)
        found = Disturbance(orbit=ORBIT).torque(t, q_BN, inertia)
        scale = np.linalg.norm(torque_N)
        np.testing.assert_allclose(found, turn.inv().apply(torque_N), atol=1e-5 * scale)


def test_gravity_gradient_is_the_slope_of_its_potential(rng: np.random.Generator) -> None:
    """V = 3/2 w^2 o J o; a small turn a of the body about its own axes does the work -T a."""
    t, h = 1234.0, 1e-5
    for _ in range(5):
        q = attitude(rng)

        def potential(small: Any, q: Any = q) -> float:
            turned = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(small)
            o = turned.inv().apply(ORBIT.position(t))
            return 1.5 * ORBIT.rate**2 * float(o @ J @ o)

        slope = [(potential(h * e) - potential(-h * e)) / (2 * h) for e in np.eye(3)]
        found = Disturbance(orbit=ORBIT).torque(t, q, J)
        np.testing.assert_allclose(found, -np.array(slope), atol=1e-9 * ORBIT.rate**2 * 14)


def test_no_gravity_gradient_with_an_axis_to_the_earth(rng: np.random.Generator) -> None:
    position = np.asarray(ORBIT.position(0.0))
    moments, axes = np.linalg.eigh(J)
    turn, _ = Rotation.align_vectors([position], [axes[:, 1]])
    found = Disturbance(orbit=ORBIT).torque(0.0, np.roll(turn.as_quat(), 1), J)
    assert np.abs(found).max() < 1e-14 * moments[-1]


def test_position_goes_round_the_orbit() -> None:
    period = 2.0 * np.pi / ORBIT.rate
    t = np.linspace(0.0, period, 50)
    places = np.array([ORBIT.position(s) for s in t])
    np.testing.assert_allclose(np.linalg.norm(places, axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(ORBIT.position(0.3 + 3 * period), ORBIT.position(0.3), atol=1e-12)
    # 3-1-3 turns of the x axis: node, inclination, argument of latitude
    expected = [
        Rotation.from_euler("ZXZ", [-2.0, 0.9, 0.4 + ORBIT.rate * s]).apply([1.0, 0, 0]) for s in t
    ]
    np.testing.assert_allclose(places, expected, atol=1e-14)


@pytest.mark.parametrize(
    ("altitude", "period"), [(35_786e3, 86_164.1), (20_200e3, 43_200.0 * 0.99727), (0.1, 5069.3)]
)
def test_periods_of_known_orbits(altitude: float, period: float) -> None:
    assert 2.0 * np.pi / Orbit.at_altitude(altitude).rate == pytest.approx(period, rel=2e-3)


def test_constant_and_sinusoid(rng: np.random.Generator) -> None:
    given = Disturbance([1e-3, 0, -2e-3], [0.0, 4e-3, 1e-3], frequency=0.25, phase=0.5)
    t = np.arange(0.0, 40.0, 0.01)
    torque = np.array([given.torque(s, attitude(rng), J) for s in t])
    np.testing.assert_allclose(torque.mean(axis=0), given.constant, atol=1e-9)
    spectrum = 2.0 * np.fft.rfft(torque, axis=0) / len(t)
    lines = np.zeros_like(spectrum)
    lines[10] = given.amplitude * np.exp(1j * (0.5 - 0.5 * np.pi))
    np.testing.assert_allclose(spectrum[1:], lines[1:], atol=1e-12)
    np.testing.assert_array_equal(Disturbance().torque(3.0, attitude(rng), J), np.zeros(3))


def test_compiled_code_agrees_with_floats(rng: np.random.Generator) -> None:
    given = Disturbance([1e-3, 0, 0], [0, 1e-3, 0], 0.1, 0.2, ORBIT)
    leaver = Desaturation(0.3, 0.1, 1.0)

    def both(t: Any, q: Any, h: Any, d: Any, e: Any) -> Any:
        return d.torque(t, q, J), e.torque(h)

    run = compile_function(both, 0.0, np.zeros(4), np.zeros(3), given, leaver)
    t, q = rng.uniform(0, 6000, 100), np.array([attitude(rng) for _ in range(100)])
    h = rng.normal(size=(100, 3)) * 10.0 ** rng.uniform(-2, 2, (100, 1))
    h[0] = 0.0
    constant = [given.constant, given.amplitude, [0.1, 0.2, ORBIT.rate, 0.9, -2.0, 0.4]]
    leaves = np.tile(np.concatenate(constant), (100, 1))
    found = run(t, q, h, leaves, np.tile([0.3, 0.1, 1.0], (100, 1)))
    for i in range(100):
        expected = both(t[i], q[i], h[i], given, leaver)
        np.testing.assert_allclose(found[0][i], expected[0], rtol=1e-11, atol=1e-15)
        np.testing.assert_allclose(found[1][i], expected[1], rtol=1e-12, atol=1e-15)


def test_desaturation_pulls_momentum_down_to_its_threshold(rng: np.random.Generator) -> None:
    leaver, dt = Desaturation(torque_limit=0.5, gain=0.2, threshold=1.0), 0.02
    h = 10.0 * np.array([2.0, -1.0, 2.0]) / 3.0
    direction, sizes = h / 10.0, []
    for _ in range(3000):
        torque = np.asarray(leaver.torque(h))
        assert np.linalg.norm(torque) <= 0.5 * (1 + 1e-12)
        assert np.abs(np.cross(torque, direction)).max() < 1e-12
        h = h + dt * torque
        sizes.append(float(h @ direction))
    t = dt * np.arange(1, 3001)
    # at the limit down to 2.5 N m s, then exponentially, then nothing
    limited = t < 15.0
    np.testing.assert_allclose(np.array(sizes)[limited], 10.0 - 0.5 * t[limited], atol=1e-9)
    later = (t > 15.1) & (t < 19.5)
    decay = 2.5 * np.exp(-0.2 * (t[later] - 15.0))
    np.testing.assert_allclose(np.array(sizes)[later], decay, rtol=5e-3)
    assert sizes[-1] == pytest.approx(1.0, abs=0.2 * 0.02)
    np.testing.assert_array_equal(leaver.torque(np.array([0.0, 0.6, 0.0])), np.zeros(3))
    np.testing.assert_array_equal(Desaturation(np.inf).torque(np.zeros(3)), np.zeros(3))
    np.testing.assert_allclose(Desaturation(np.inf, 2.0).torque(h), -2.0 * h)


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: Disturbance(constant=[1.0, 2.0]), "disturbance.constant"),
        (lambda: Disturbance(amplitude=[1.0, 2.0, np.nan]), "disturbance.amplitude"),
        (lambda: Disturbance(frequency=-1.0), "disturbance.frequency"),
        (lambda: Disturbance(phase=np.inf), "disturbance.phase"),
        (lambda: Orbit(np.nan), "orbit.rate"),
        (lambda: Orbit(1e-3, inclination=np.inf), "orbit.inclination"),
        (lambda: Orbit.at_altitude(-1.0), "altitude"),
        (lambda: Orbit.at_altitude(500e3, ascending_node=np.nan), "orbit.ascending_node"),
        (lambda: Desaturation(0.0), "desaturation.torque_limit"),
        (lambda: Desaturation(np.nan), "desaturation.torque_limit"),
        (lambda: Desaturation(1.0, gain=0.0), "desaturation.gain"),
        (lambda: Desaturation(1.0, gain=np.inf), "desaturation.gain"),
        (lambda: Desaturation(1.0, threshold=-1.0), "desaturation.threshold"),
    ],
)
def test_values_that_are_refused(make: Any, key: str) -> None:
    with pytest.raises(InputError) as refused:
        make()
    assert refused.value.key == key


def test_frames_of_the_gravity_gradient() -> None:
    """A pencil along x, the Earth in the x-y plane of B: the torque turns x towards the Earth."""
    orbit = Orbit(1.0)
    q = rotation.from_euler_321((-0.3, 0.0, 0.0))
    torque = Disturbance(orbit=orbit).torque(0.0, q, np.diag([0.1, 5.0, 5.0]))
    assert torque[2] > 0 and torque[2] == pytest.approx(1.5 * 4.9 * np.sin(0.6))
