"""The weighted VSCMG law against its equations, written densely with LAPACK's inverses."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nullmotion import InputError, Observation, laws, layouts
from nullmotion.array.wheels import Wheels

I_W, OMEGA_D = 6.95e-4, 200.0
KINDS = {
    "pyramid": ("pyramid", {}),
    "box90": ("box90", {}),
    "roof": ("roof", {}),
    "roof6": ("roof6", {}),
    "pyramid of five": ("pyramid", {"n": 5}),
}
every = pytest.mark.parametrize("kind", KINDS)


def array_of(kind: str, rate_limit: float = np.inf, **wheels: Any) -> Any:
    name, parameters = KINDS[kind]
    turning = Wheels(np.array(I_W), **{key: np.array(v) for key, v in wheels.items()})
    layout = layouts.get(name)(**parameters)
    return layout.array(h0=I_W * OMEGA_D, rate_limit=rate_limit, wheels=turning)


def law_of(**parameters: Any) -> Any:
    return laws.create("vscmg-weighted", **{"k_m": 10.0} | parameters)


class State(NamedTuple):
    delta: np.ndarray
    speed: np.ndarray
    hdot: np.ndarray


def steer(law: Any, array: Any, state: State, period: float = 0.01) -> tuple[Any, Any]:
    """Return wheel accelerations and gimbal rates."""
    seen = Observation(state.delta, state.hdot, 0.0, period, wheel_speed=state.speed)
    (rates, accelerations), _ = law.step(array, seen, law.init(array, state.delta))
    return np.asarray(accelerations, float), np.asarray(rates, float)


def directions(array: Any, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return C_W and C_T, (3, n), by turning the spin axes about the gimbal axes."""
    c_w = np.array(
        [
            np.cos(d) * s + np.sin(d) * np.cross(g, s)
            for d, s, g in zip(delta, array.spin_axes, array.gimbal_axes, strict=True)
        ]
    )
    return c_w.T, np.cross(array.gimbal_axes, c_w).T


def Q_of(array: Any, state: State) -> np.ndarray:
    c_w, c_t = directions(array, state.delta)
    return np.hstack([c_w * I_W, c_t * I_W * state.speed])


def det_of(array: Any, delta: np.ndarray) -> float:
    c_t = directions(array, delta)[1]
    return np.linalg.det(c_t @ c_t.T)


def gamma_of(law: Any, array: Any, delta: np.ndarray) -> float:
    return law.gamma0 * np.exp(-law.lambda2 * det_of(array, delta))


def slope_of_gamma(law: Any, array: Any, delta: np.ndarray) -> np.ndarray:
    steps = 1e-6 * np.eye(len(delta))
    return np.array(
        [gamma_of(law, array, delta + h) - gamma_of(law, array, delta - h) for h in steps]
    ) / (2e-6)


def published(law: Any, array: Any, state: State) -> tuple[np.ndarray, np.ndarray]:
    """Return Eq 27 with sigma of Eq 31 from Eqs 42-43, gamma descended, cross terms kept."""
    n, Q = array.n, Q_of(array, state)
    f = -det_of(array, state.delta)
    W = np.diag([law.W_Omega0 * np.exp(law.lambda1 * f)] * n + [law.W_delta] * n)
    inverse = W @ Q.T @ np.linalg.inv(Q @ W @ Q.T)
    N = np.eye(2 * n) - inverse @ Q
    s_w = 1.0 / np.cosh(1.0 / (-law.k_d * f + law.epsilon))
    s_g = 1.0 / np.cosh(-law.k_g * f)
    S = np.diag([s_w] * n + [s_g] * n)
    R = inverse @ state.hdot
    sigma = np.zeros(2 * n)
    sigma[n:] = -law.k_gamma * slope_of_gamma(law, array, state.delta)
    mu = I_W * (OMEGA_D - state.speed)
    missing = law.k_m * mu - R[:n] - (N @ S @ sigma)[:n]
    sigma[:n] = np.linalg.inv((N @ S)[:n, :n]) @ missing
    both = R + N @ S @ sigma
    return both[:n], both[n:]


def regular(array: Any, count: int, seed: int) -> list[State]:
    """Return random states with gimbals that give torque every way, wheels turning both ways."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        delta = rng.uniform(-np.pi, np.pi, array.n)
        speed = rng.uniform(60.0, 300.0, array.n) * rng.choice([-1.0, 1.0], array.n)
        jacobian = directions(array, delta)[1] * speed / OMEGA_D
        if np.linalg.svd(jacobian, compute_uv=False)[-1] > 0.25:
            found.append(State(delta, speed, rng.normal(size=3) * 0.03))
    return found


SETS = {
    "defaults": {},
    "case 1": {"W_Omega0": 2.0, "lambda1": 3.0, "k_m": 10.0},
    "case 2": {"W_Omega0": 1000.0, "lambda1": 0.0, "k_m": 30.0},
    "others": {"k_gamma": 0.7, "lambda2": 0.4, "gamma0": 2.0, "k_g": 0.3, "W_delta": 4.0},
}


@every
@pytest.mark.parametrize("parameters", SETS.values(), ids=SETS)
def test_the_law_is_the_papers(kind: str, parameters: dict[str, float]) -> None:
    array = array_of(kind)
    law = law_of(**parameters, damping=1e-12, as_published=True)
    for state in regular(array, 12, 3):
        wheel, gimbal = steer(law, array, state)
        expected = published(law, array, state)
        np.testing.assert_allclose(wheel, expected[0], rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(gimbal, expected[1], rtol=1e-6, atol=1e-7)


@every
@pytest.mark.parametrize("goal", ["momentum", "equalise", "power", "none"])
def test_the_torque_is_the_one_asked_for(kind: str, goal: str) -> None:
    array = array_of(kind)
    for as_published in (True, False):
        law = law_of(goal=goal, power_W=0.3, as_published=as_published)
        for state in regular(array, 12, 4):
            torque = Q_of(array, state) @ np.concatenate(steer(law, array, state))
            np.testing.assert_allclose(torque, state.hdot, rtol=0, atol=1e-9 * 0.03)


@every
def test_the_wheels_follow_the_momentum_goal_as_damping_vanishes(kind: str) -> None:
    array = array_of(kind)
    for state in regular(array, 6, 5):
        wanted = 10.0 * I_W * (OMEGA_D - state.speed)
        off = [
            np.abs(steer(law_of(damping=d, lambda1=0.0), array, state)[0] - wanted).max()
            for d in (1e-2, 1e-3, 1e-4)
        ]
        assert off[2] < 1e-2
        np.testing.assert_allclose([off[0] / off[1], off[1] / off[2]], 10.0, rtol=0.1)
        aim = law_of(damping=1e-9, wheel_speed_rad_s=140.0)
        expected = 10.0 * I_W * (140.0 - state.speed)
        np.testing.assert_allclose(steer(aim, array, state)[0], expected, atol=1e-6)


@every
def test_null_motion_of_the_gimbals_descends_gamma(kind: str) -> None:
    array, fell = array_of(kind), 0
    for state in regular(array, 30, 6):
        for damping in (1e-9, 1.0):
            alike = {"damping": damping, "nudge": 0.0, "k_g": 0.0, "lambda2": 0.3}
            on, off = (law_of(k_gamma=k, **alike) for k in (0.1, 0.0))
            turned = steer(on, array, state)[1] - steer(off, array, state)[1]
            slope = slope_of_gamma(on, array, state.delta) @ turned
            assert slope < 1e-9
            fell += slope < -1e-6
    assert fell > 40  # some states have one null direction, and gamma may be level along it


@every
def test_equalise_keeps_the_mean_speed_and_closes_the_spread(kind: str) -> None:
    array, law = array_of(kind), law_of(goal="equalise", damping=1e-9)
    for state in regular(array, 8, 7):
        wheel = steer(law, array, state)[0]
        assert abs(np.sum(wheel)) < 1e-6
        spread = state.speed - state.speed.mean()
        np.testing.assert_allclose(wheel, -10.0 * I_W * spread, atol=1e-6)


@every
@pytest.mark.parametrize("watts", [0.5, -0.5])
def test_power_goes_into_the_wheels(kind: str, watts: float) -> None:
    array, law = array_of(kind), law_of(goal="power", power_W=watts, damping=1e-9)
    for state in regular(array, 8, 8):
        wheel = steer(law, array, state)[0]
        np.testing.assert_allclose(I_W * state.speed @ wheel, watts, rtol=1e-7)


def test_equalise_keeps_the_mean_speed_of_unequal_wheels() -> None:
    array = array_of("pyramid")
    unequal = Wheels(I_W * np.array([0.5, 1.0, 1.0, 2.0]))
    array = array.altered(wheels=unequal, h0=unequal.inertia * OMEGA_D)
    for state in regular(array, 5, 13):
        seen = Observation(state.delta, state.hdot, wheel_speed=state.speed)
        law = law_of(goal="equalise", damping=1e-9)
        (_, wheel), _ = law.step(array, seen, law.init(array, state.delta))
        assert abs(np.sum(wheel)) < 1e-6
        assert (state.speed - state.speed.mean()) @ wheel < 0.0


def test_goals_are_met_by_the_wheels_that_work() -> None:
    array = array_of("pyramid", torque_limit=[np.inf, 0.0, np.inf, np.inf])
    for state in regular(array, 5, 14):
        wheel = steer(law_of(goal="power", power_W=0.4, damping=1e-9), array, state)[0]
        np.testing.assert_allclose(I_W * state.speed @ wheel, 0.4, rtol=1e-7)
        wheel = steer(law_of(goal="equalise", damping=1e-9), array, state)[0]
        assert abs(np.sum(wheel)) < 1e-6 and wheel[1] == 0.0


@every
def test_wheels_without_torque_get_none(kind: str) -> None:
    """Also where the gimbals alone cannot give the torque."""
    limits = np.full(KINDS[kind][1].get("n", 6 if kind == "roof6" else 4), np.inf)
    limits[[0, 2]] = 0.0
    array = array_of(kind, torque_limit=limits)
    for as_published in (False, True):
        law = law_of(as_published=as_published)
        for state in regular(array, 6, 9):
            for speed in (state.speed, 0.0 * state.speed):
                wheel = steer(law, array, state._replace(speed=speed))[0]
                assert np.all(wheel[[0, 2]] == 0.0)
            torque = Q_of(array, state) @ np.concatenate(steer(law, array, state))
            np.testing.assert_allclose(torque, state.hdot, rtol=0, atol=1e-9 * 0.03)


@st.composite
def limited_states(draw: Any) -> tuple[Any, State, float]:
    """Draw an array with limits, and a state of any kind within its speed limit."""
    kind = draw(st.sampled_from(sorted(KINDS)))
    n = 6 if kind == "roof6" else KINDS[kind][1].get("n", 4)

    def numbers(low: float, high: float, count: int = n) -> np.ndarray:
        drawn = draw(st.lists(st.floats(low, high), min_size=count, max_size=count))
        return np.round(drawn, 6)

    dead = st.lists(st.sampled_from([0.0, 1.0, 1.0]), min_size=n, max_size=n)
    array = array_of(
        kind,
        rate_limit=numbers(0.01, 10.0),
        torque_limit=numbers(1e-4, 0.02) * np.array(draw(dead)),
        power_limit=numbers(1e-3, 3.0),
        speed_limit=numbers(210.0, 400.0),
    )
    delta = numbers(-3.2, 3.2)
    if draw(st.booleans()):
        delta = np.round(delta / (0.5 * np.pi)) * (0.5 * np.pi)
    speed = numbers(-1.0, 1.0) * array.wheels.speed_limit
    hdot = numbers(-1.0, 1.0, 3) * 10.0 ** draw(st.integers(-4, 1))
    return array, State(delta, speed, hdot), draw(st.sampled_from([1e-3, 0.01, 0.5]))


@settings(max_examples=80, deadline=None)
@given(limited_states())
def test_limits_are_kept_and_the_torque_keeps_its_direction(
    drawn: tuple[Any, State, float],
) -> None:
    array, state, period = drawn
    wheel, gimbal = steer(law_of(), array, state, period)
    wheels = array.wheels
    slack = 1.0 + 1e-9
    assert np.all(np.abs(gimbal) <= array.rate_limit * slack)
    assert np.all(np.abs(I_W * wheel) <= wheels.torque_limit * slack)
    assert np.all(np.abs(I_W * wheel * state.speed) <= wheels.power_limit * slack)
    assert np.all(np.abs(state.speed + period * wheel) <= wheels.speed_limit * slack)
    assert np.all(wheel[wheels.torque_limit == 0.0] == 0.0)
    both, Q = np.concatenate([wheel, gimbal]), Q_of(array, state)
    torque, size = Q @ both, np.linalg.norm(state.hdot)
    weight = law_of().W_Omega0 * np.exp(-det_of(array, state.delta))
    W = np.concatenate([weight * (wheels.torque_limit > 0.0), np.ones(array.n)])
    M = (Q * W) @ Q.T
    if np.linalg.cond(M) > 1e6 or size == 0.0:
        return  # not every torque can be given
    share = torque @ state.hdot / size**2
    # what is added to M to keep its inverse finite, and what that does to null motion; 1e-6 of
    # a command is what a run takes for cut
    rounding = 3e-12 * np.linalg.cond(M) * (size + np.sum(np.abs(Q) @ np.abs(both)))
    rounding += 1e-6 * size
    assert -rounding <= share * size <= size + rounding
    assert np.linalg.norm(torque - share * state.hdot) <= rounding


@settings(max_examples=60, deadline=None)
@given(limited_states())
def test_torque_that_needs_no_cut_comes_whole(drawn: tuple[Any, State, float]) -> None:
    array, state, period = drawn
    Q, size = Q_of(array, state), np.linalg.norm(state.hdot)
    weight = law_of().W_Omega0 * np.exp(-det_of(array, state.delta))
    W = np.concatenate([weight * (array.wheels.torque_limit > 0.0), np.ones(array.n)])
    M = (Q * W) @ Q.T
    if np.linalg.cond(M) > 1e6 or size == 0.0:
        return
    R = W * (Q.T @ np.linalg.solve(M, state.hdot))
    low, high = array.wheels.bounds(state.speed, period)
    room = np.concatenate([np.where(R[: array.n] < 0, -low, high), array.rate_limit])
    used = np.abs(R) > 1e-12 * np.abs(R).max()
    share = min(1.0, float(np.min(0.999 * room[used] / np.abs(R[used]))))
    smaller = state._replace(hdot=share * state.hdot)
    both = np.concatenate(steer(law_of(), array, smaller, period))
    rounding = 3e-12 * np.linalg.cond(M) * (size + np.sum(np.abs(Q) @ np.abs(both)))  # as above
    np.testing.assert_allclose(Q @ both, smaller.hdot, rtol=0, atol=rounding + 1e-6 * size)


def singular(array: Any) -> list[np.ndarray]:
    """Return gimbal angles with every rotor along, against or across some direction."""
    rng, found = np.random.default_rng(2), [np.zeros(array.n)]
    found += list(rng.integers(0, 4, (8, array.n)) * 0.5 * np.pi)
    ways = [*np.eye(3), *array.gimbal_axes, *rng.normal(size=(2, 3))]
    for u in ways:
        signs = rng.choice([-1.0, 1.0], array.n)
        t = np.cross(array.gimbal_axes, array.spin_axes)
        found.append(np.arctan2(signs * (t @ u), signs * (array.spin_axes @ u)))
    return found


@every
@pytest.mark.parametrize("goal", ["momentum", "equalise", "power", "none"])
def test_finite_where_nothing_turns_and_nothing_can(kind: str, goal: str) -> None:
    arrays = [array_of(kind), array_of(kind, 5.0, torque_limit=5e-3, power_limit=1.0)]
    arrays.append(array_of(kind, 5.0, torque_limit=0.0, speed_limit=200.0))
    speeds = [np.zeros(arrays[0].n), np.full(arrays[0].n, OMEGA_D)]
    speeds.append(np.resize([0.0, 200.0, -200.0, 1e-9], arrays[0].n))
    for array in arrays:
        for delta in singular(array):
            for k, speed in enumerate(speeds):
                for as_published in (False, True):
                    law = law_of(goal=goal, power_W=1.0, as_published=as_published)
                    hdot = np.eye(3)[k] * 0.02
                    assert np.isfinite(steer(law, array, State(delta, speed, hdot))).all()


def test_a_sharp_switch_is_finite_at_a_singular_state() -> None:
    """s_w = sech(1 / epsilon) there: its square is no number above 0 when epsilon is small."""
    array = array_of("pyramid")
    elliptic = np.radians([90.0, 0.0, -90.0, 0.0])
    state = State(elliptic, np.full(4, OMEGA_D), np.array([0.01, 0.02, 0.03]))
    for epsilon in (0.1, 0.01, 1e-3, 1e-6):
        assert np.isfinite(steer(law_of(epsilon=epsilon), array, state)).all()


@pytest.mark.parametrize("kind", ["pyramid", "roof", "roof6"])
def test_a_wheel_at_its_speed_limit_does_not_take_the_others_torque(kind: str) -> None:
    """Gimbals give what it cannot."""
    array = array_of(kind, rate_limit=5.0, speed_limit=300.0)
    for state in regular(array, 10, 11):
        speed = state.speed.copy()
        speed[1] = 300.0 * np.sign(speed[1])
        at_limit = state._replace(speed=speed)
        both = np.concatenate(steer(law_of(), array, at_limit))
        torque = Q_of(array, at_limit) @ both
        np.testing.assert_allclose(torque, state.hdot, rtol=0, atol=1e-6 * 0.03)


def test_in_a_gimbals_singular_direction_the_wheels_give_the_torque() -> None:
    """At the elliptic state no gimbal rate gives torque along x, and none at all at rest."""
    array = array_of("pyramid")
    elliptic = np.radians([-90.0, 0.0, 90.0, 0.0])
    for speed in (np.full(4, OMEGA_D), np.zeros(4)):
        state = State(elliptic, speed, np.array([0.02, 0.0, 0.0]))
        wheel, gimbal = steer(law_of(), array, state)
        c_w = directions(array, elliptic)[0]
        np.testing.assert_allclose(c_w[0] @ (I_W * wheel), 0.02, rtol=1e-6)
        torque = Q_of(array, state) @ np.concatenate([wheel, gimbal])
        np.testing.assert_allclose(torque, state.hdot, atol=1e-9)


def test_aligned_rotors_are_left() -> None:
    """Where det has no slope, gimbals turn nevertheless, and not all alike; the paper's stand."""
    array = array_of("pyramid")
    state = State(np.zeros(4), np.zeros(4), np.zeros(3))
    flat = np.radians([90.0, 0.0, -90.0, 0.0])
    assert np.abs(slope_of_gamma(law_of(), array, flat)).max() < 1e-6
    turned = steer(law_of(), array, state._replace(delta=flat))[1]
    assert np.ptp(turned) > 0.1
    still = steer(law_of(as_published=True), array, state._replace(delta=flat))[1]
    np.testing.assert_allclose(still, 0.0, atol=1e-6)


def test_what_a_controller_knows_of_the_torque_matrix_is_used() -> None:
    array = array_of("pyramid")
    (state,) = regular(array, 1, 12)
    rng = np.random.default_rng(1)
    Q = Q_of(array, state) * (1.0 + 0.2 * rng.normal(size=(3, 8)))
    law = law_of()
    seen = Observation(state.delta, state.hdot, wheel_speed=state.speed, torque_matrix=Q)
    (rates, accelerations), _ = law.step(array, seen, law.init(array, state.delta))
    torque = Q @ np.concatenate([accelerations, rates])
    np.testing.assert_allclose(torque, state.hdot, atol=1e-9)


def test_refusals() -> None:
    plain = layouts.create("pyramid")
    assert "variable-speed" in law_of().supports(plain)
    assert law_of().supports(array_of("pyramid")) == ""
    for key in ("W_Omega0", "W_delta", "k_d", "epsilon", "damping"):
        with pytest.raises(InputError, match=f"law.{key}"):
            law_of(**{key: 0.0})
    with pytest.raises(InputError, match="law.goal"):
        law_of(goal="rest")
    with pytest.raises(InputError, match=r"law\.k_m"):
        law_of(k_m=-1.0)
