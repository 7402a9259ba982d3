"""Every registered law on every registered layout, held to what it claims.

A law is evaluated on many states at once as a kernel, its parameters and its array
being inputs; that the kernel says what the plain source says is tested first. A law that
turns wheels gets flywheels and is evaluated at all kinds of wheel speeds.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pytest

from nullmotion import Claim, CmgArray, Observation, laws, layouts, prepare, tree
from nullmotion.array.wheels import Wheels
from nullmotion.compile import compile_function
from nullmotion.errors import UnsupportedArrayError

LARGEST_RATE = 2e4  # times |hdot| / mean momentum: what a bounded law may ask for
RATE_LIMIT = np.pi
SPEED = 200.0  # of wheels whose speed may change, by design [rad/s]
FASTEST = 300.0


@cache
def array_of(layout: str, turning: bool = False, h0: float = 1.0) -> CmgArray:
    """Return a layout's array, with flywheels whose speed may change if asked for."""
    array = layouts.create(layout, h0=h0, rate_limit=RATE_LIMIT)
    return with_wheels(array, h0) if turning else array


def with_wheels(array: CmgArray, h0: float = 1.0, **limits: float) -> CmgArray:
    wheels = Wheels(np.array(h0 / SPEED), **{key: np.array(v) for key, v in limits.items()})
    return array.altered(wheels=wheels.for_n(array.n))


def array_for(law: Any, layout: str, h0: float = 1.0) -> CmgArray:
    """Return a layout's array as a law needs it."""
    return array_of(layout, law.turns_wheels, h0)


def spins(law: Any, n: int, count: int) -> np.ndarray:
    """Return wheel speeds (count, n): for a law that turns wheels of all kinds, in turn.

    At rest, as designed, backwards, mixed, some at rest, hardly turning, and fast.
    """
    if not law.turns_wheels:
        return np.zeros((count, n))
    mixed = np.random.default_rng(8).uniform(-1.2, 1.2, n)
    some = np.arange(n) % 3 > 0
    kinds = [np.zeros(n), np.ones(n), -np.ones(n), mixed, mixed * some, 1e-9 * mixed]
    kinds.append(np.sign(mixed) * FASTEST / SPEED)
    return SPEED * np.array(kinds)[np.arange(count) % len(kinds)]


def steered(claim: Claim | None = None) -> Any:
    """Parametrise over the laws that make a claim and the layouts that they support."""
    return pytest.mark.parametrize(
        ("law", "layout"),
        [
            (law, layout)
            for law in laws.names()
            for layout in layouts.names()
            if claim is None or claim in laws.get(law).claims
            if not laws.create(law).supports(array_for(laws.get(law), layout))
        ],
    )


def step(
    law: Any, array: CmgArray, delta: Any, hdot: Any, t: Any, period: Any, spin: Any, state: Any
) -> Any:
    """Return a law's rates, wheel accelerations behind them if it turns wheels, and its state."""
    observation = Observation(
        delta,
        hdot,
        t,
        period,
        delta_dot=np.zeros(array.n),
        omega_BN_B=np.zeros(3),
        wheel_speed=spin,
    )
    asked, after = law.step(array, observation, state)
    return (np.concatenate(asked) if law.turns_wheels else asked), after


AXES = ("gimbal_axes", "spin_axes", "torque_axes")


@cache
def compiled(name: str, n: int, m: int, axes: tuple[bytes, ...] = ()) -> Any:
    """Return a law as a kernel whose parameters and array are inputs, but for known axes."""
    shapes = ((n, 3), (n, 3), (m, 3))
    known = {
        key: np.frombuffer(raw).reshape(shape)
        for key, raw, shape in zip(AXES, axes, shapes, strict=bool(axes))
    }
    law = laws.create(name)
    arrays = (array_for(law, layout) for layout in layouts.names())
    array = next(a for a in arrays if (a.n, a.m) == (n, m))

    def rates(d: Any, h: Any, t: Any, span: Any, spin: Any, state: Any, law: Any, own: Any) -> Any:
        return step(law, own.altered(**known), d, h, t, span, spin, state)

    start, still = law.init(array, np.zeros(n)), np.zeros(n)
    return compile_function(rates, still, np.zeros(m), 0.0, 0.01, still, start, law, array)


def kernel_of(law: Any, array: CmgArray) -> Any:
    axes = tuple(getattr(array, key).tobytes() for key in AXES) if law.knows_axes else ()
    return compiled(law.name, array.n, array.m, axes)


def an_array(law: Any) -> CmgArray:
    """Return the pyramid, or another array that the law steers."""
    arrays = [array_for(law, layout) for layout in ("pyramid", *layouts.names())]
    return next(array for array in arrays if not law.supports(array))


def plainly(law: Any, array: CmgArray, delta: Any, hdot: Any, t: float = 0.0) -> np.ndarray:
    """Return rates (N, n), or rates and accelerations (N, 2n), at N states by the plain source."""
    start = law.init(array, delta[0])
    states = zip(delta, hdot, spins(law, array.n, len(delta)), strict=True)
    return np.array([step(law, array, d, h, t, 0.01, w, start)[0] for d, h, w in states])


def many(
    law: Any,
    array: CmgArray,
    delta: Any,
    hdot: Any,
    t: float = 0.0,
    state: list[np.ndarray] | None = None,
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return what `plainly` does, by a kernel, and the leaves of the law's next states."""
    if not law.traceable:
        return plainly(law, array, delta, hdot, t), []
    start = law.init(array, delta[0])

    def tiled(record: Any) -> np.ndarray:
        return np.tile(np.array(tree.flatten(record), float), (len(delta), 1))

    clock = np.full(len(delta), t), np.full(len(delta), 0.01)
    memory = (
        tiled(start) if state is None else np.stack([*state, np.zeros(len(delta))], axis=1)[:, :-1]
    )
    seen = (delta, hdot, *clock, spins(law, array.n, len(delta)))
    rates, after = kernel_of(law, array)(*seen, memory, tiled(law), tiled(array))
    return rates, _leaves(after)


def _leaves(state: Any) -> list[np.ndarray]:
    if isinstance(state, tuple):
        return [leaf for part in state for leaf in _leaves(part)]
    return list(np.reshape(state, (len(state), -1)).T)


def torque_matrices(law: Any, array: CmgArray, delta: np.ndarray) -> np.ndarray:
    """Return what makes torque of a law's commands at N states: A, or beside it that of wheels."""
    if not law.turns_wheels:
        return array.jacobian(delta)
    inertia, speed = array.flywheels.inertia, spins(law, array.n, len(delta))
    gimbals = array.transverse_directions(delta) * (inertia * speed)[:, None, :]
    return np.concatenate([gimbals, array.wheel_axes(delta) * inertia], axis=2)


def conditions(law: Any, array: CmgArray, delta: np.ndarray) -> np.ndarray:
    """Return the condition number of these matrices."""
    s = np.linalg.svd(torque_matrices(law, array, delta), compute_uv=False)
    return s[:, 0] / np.maximum(s[:, array.m - 1 :].sum(axis=1), 1e-300)


def commands(array: CmgArray, count: int, rng: np.random.Generator) -> np.ndarray:
    directions = rng.normal(size=(count, array.m))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return directions * 10.0 ** rng.uniform(-2, 0.5, (count, 1))


def measure(array: CmgArray, delta: np.ndarray) -> np.ndarray:
    return np.linalg.svd(array.unit_jacobian(delta), compute_uv=False)[:, array.m - 1 :].sum(axis=1)


@cache
def regular_states(array: CmgArray, above: float, count: int = 300) -> tuple[Any, Any]:
    """Return random states with sigma_min above a margin, some of them close to it."""
    rng = np.random.default_rng(3)
    delta = rng.uniform(-np.pi, np.pi, (20 * count, array.n))
    near = singular_states(array)[0]
    near = near[rng.integers(0, len(near), 10 * count)]
    near = near + rng.normal(size=near.shape) * 10.0 ** rng.uniform(-3, 0, (len(near), 1))
    delta = rng.permutation(np.concatenate([delta, near]))
    delta = delta[measure(array, delta) > above][:count]
    return delta, commands(array, len(delta), rng)


@cache
def singular_states(array: CmgArray) -> tuple[Any, Any]:
    """Return singular states: quarter turns and every rotor along or against a direction."""
    rng = np.random.default_rng(5)
    n, basis = array.n, array.torque_axes
    quarters = rng.integers(0, 4, (200, n)) * (0.5 * np.pi)
    quarters[0] = 0.0
    quarters[1] = np.resize(np.radians([-90.0, 0.0, 90.0, 0.0]), n)
    directions = rng.normal(size=(100, array.m)) @ basis
    directions[: array.n] = array.gimbal_axes  # a rotor that cannot reach its direction
    directions[array.n : array.n + array.m] = basis
    signs = rng.choice([-1.0, 1.0], (100, n))
    aligned = np.arctan2(
        signs * (directions @ array.transverse_axes.T), signs * (directions @ array.spin_axes.T)
    )
    delta = np.concatenate([quarters, aligned])
    delta = np.tile(delta, (3, 1))
    hdot = commands(array, len(delta), rng)
    axes = np.eye(array.m)[rng.integers(0, array.m, 300)] * rng.choice([-1.0, 1.0], (300, 1))
    hdot[:300] = axes
    singular = np.concatenate([quarters, aligned])
    u = np.linalg.svd(array.unit_jacobian(singular))[0][:, :, -1]
    hdot[300:600] = u * rng.choice([-1.0, 1.0], (300, 1))
    hdot[600:610] = 0.0
    return delta, hdot


def few(law: Any, states: tuple[Any, Any]) -> tuple[Any, Any]:
    """Return states; some of them for a host law, which takes milliseconds for each."""
    return states if law.traceable else (states[0][::19], states[1][::19])


def turned(array: CmgArray, rng: np.random.Generator) -> tuple[CmgArray, np.ndarray]:
    """Return the array with its body axes turned, and the turn of the torque space."""
    R, Q = _rotation(rng, 3), _rotation(rng, array.m)
    basis = Q @ array.torque_axes @ R.T
    axes = array.gimbal_axes @ R.T, array.spin_axes @ R.T
    other = CmgArray(*axes, array.h0, array.rate_limit, torque_axes=basis, wheels=array.wheels)
    return other, Q


def _rotation(rng: np.random.Generator, size: int) -> np.ndarray:
    q, r = np.linalg.qr(rng.normal(size=(size, size)))
    q = q * np.sign(np.diag(r))
    return (
        q * np.linalg.det(q) if size % 2 else q @ np.diag([1.0] * (size - 1) + [np.linalg.det(q)])
    )


def close(a: Any, b: Any, tolerance: float = 1e-9) -> None:
    a, b = np.asarray(a), np.asarray(b)
    scale = 1.0 + np.abs(b).max(axis=-1, keepdims=True)
    worst = np.abs(a - b) / scale
    assert np.nanmax(worst) <= tolerance and np.isfinite(worst).all(), np.nanmax(worst)


@pytest.mark.parametrize("law", laws.names())
def test_a_law_says_what_it_is(law: str) -> None:
    entry = laws.get(law)
    assert entry.name == law
    assert entry.full_name and entry.citation and entry.__doc__
    assert all(isinstance(claim, Claim) for claim in entry.claims)
    known = ("delta_dot", "omega_BN_B", "wheel_speed", "preview", "torque_matrix")
    assert set(entry.information) <= set(known)


@steered()
@pytest.mark.sampled(18)
def test_kernel_equals_plain(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    if not steering.traceable:
        pytest.skip("a host law")
    delta, hdot = (
        np.concatenate(x)
        for x in zip(
            [a[:3] for a in regular_states(array, 0.05)],
            [a[::190] for a in singular_states(array)],
            strict=True,
        )
    )
    rates, _ = many(steering, array, delta, hdot, t=0.3)
    plain = plainly(steering, array, delta, hdot, t=0.3)
    if steering.turns_wheels:  # where gimbals and wheels together lose rank, rounding decides
        decided = conditions(steering, array, delta) < 1e6
        assert np.isfinite(rates).all() and decided.sum() > 3
        rates, plain = rates[decided], plain[decided]
    close(rates, plain, 1e-8)


@pytest.mark.parametrize("law", laws.names())
@pytest.mark.sampled(4)
def test_kernel_equals_plain_up_to_rounding(law: str) -> None:
    """300 random states of one array, to 1e-13 times the state's condition number."""
    steering = laws.create(law)
    array = an_array(steering)
    if not steering.traceable:
        pytest.skip("a host law")
    rng = np.random.default_rng(17)
    delta, hdot = rng.uniform(-np.pi, np.pi, (300, array.n)), rng.normal(size=(300, array.m))
    kernel, _ = many(steering, array, delta, hdot, t=1.7)
    plain = plainly(steering, array, delta, hdot, t=1.7)
    difference = np.abs(kernel - plain).max(axis=1) / np.abs(plain).max(axis=1)
    assert (difference <= 1e-13 * conditions(steering, array, delta)).all()


@pytest.mark.parametrize("law", laws.names())
def test_plain_python_is_finite_too(law: str) -> None:
    steering = laws.create(law)
    array = an_array(steering)
    if Claim.FINITE not in steering.claims:
        pytest.skip("not claimed")
    states = [a[::30] for a in singular_states(array)]
    assert np.isfinite(plainly(steering, array, *states)).all()


@steered(Claim.EXACT_TORQUE)
@pytest.mark.sampled(15)
def test_exact_torque(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    margin = steering.exact_above(array)
    delta, hdot = regular_states(array, max(1.001 * margin, 1e-3))
    assert len(delta) > 20, f"no states with sigma_min above {margin}"
    delta, hdot = few(steering, (delta, hdot))
    rates, _ = many(steering, array, delta, hdot)
    torque = np.einsum("kmn,kn->km", torque_matrices(steering, array, delta), rates)
    close(torque, hdot)


@steered(Claim.FINITE)
@pytest.mark.sampled(9)
def test_finite(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    arrays = [array]
    if steering.turns_wheels:
        limits = {"torque_limit": 0.4, "power_limit": 50.0, "speed_limit": FASTEST}
        arrays += [with_wheels(array, **limits), with_wheels(array, torque_limit=0.0)]
    for one in arrays:
        rates, state = many(steering, one, *few(steering, singular_states(array)))
        assert np.isfinite(rates).all()
        assert all(np.isfinite(leaf).all() for leaf in state)


@steered(Claim.BOUNDED)
@pytest.mark.sampled(16)
def test_bounded(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    for states in (singular_states(array), regular_states(array, 0.0)):
        delta, hdot = few(steering, states)
        rates, _ = many(steering, array, delta, hdot)
        bound = LARGEST_RATE * np.linalg.norm(hdot, axis=1) / array.mean_momentum
        assert (np.abs(rates).max(axis=1) <= bound).all()


@steered(Claim.ROTATION)
@pytest.mark.sampled(16)
def test_rotation(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    delta, hdot = few(steering, regular_states(array, 0.05))
    other, turn = turned(array, np.random.default_rng(7))
    close(many(steering, other, delta, hdot @ turn.T)[0], many(steering, array, delta, hdot)[0])


@steered(Claim.SCALING)
@pytest.mark.sampled(15)
def test_scaling(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    delta, hdot = few(steering, regular_states(array, 0.05))
    large = array_for(steering, layout, h0=73.0)
    close(many(steering, large, delta, 73.0 * hdot)[0], many(steering, array, delta, hdot)[0])


@steered(Claim.HOMOGENEOUS)
def test_homogeneous(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    for states in (singular_states(array), regular_states(array, 0.05)):
        delta, hdot = few(steering, states)
        rates, _ = many(steering, array, delta, hdot)
        close(many(steering, array, delta, 0.37 * hdot)[0], 0.37 * rates)


@steered(Claim.STATELESS)
def test_stateless(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    delta, hdot = few(steering, regular_states(array, 0.05))
    rates, state = many(steering, array, delta, hdot)
    close(many(steering, array, delta, hdot, state=[leaf[::-1] for leaf in state])[0], rates, 0.0)


@steered(Claim.TIMELESS)
def test_timeless(law: str, layout: str) -> None:
    steering = laws.create(law)
    array = array_for(steering, layout)
    delta, hdot = few(steering, regular_states(array, 0.05))
    late = many(steering, array, delta, hdot, t=12.3)[0]
    close(late, many(steering, array, delta, hdot)[0], 0.0)


def _flat(n: int) -> CmgArray:
    return CmgArray(np.tile([0.0, 0.0, 1.0], (n, 1)), np.tile([1.0, 0.0, 0.0], (n, 1)))


ODD_ARRAYS = {
    "two parallel": _flat(2),
    "two crossed": CmgArray([[0, 0, 1.0], [0, 1.0, 0]], [[1.0, 0, 0], [1.0, 0, 0]]),
    "three": layouts.create("pyramid", n=3),
    "five parallel": _flat(5),
    "twelve": layouts.create("pyramid", n=12),
    "unequal": layouts.create("pyramid", h0=np.array([0.5, 1.0, 2.0, 4.0])),
    "one wheel stopped": layouts.create("pyramid", h0=np.array([0.0, 1.0, 1.0, 1.0])),
}


@pytest.mark.parametrize("law", laws.names())
@pytest.mark.parametrize(
    "kind", [pytest.param(k, marks=pytest.mark.slow) if k == "twelve" else k for k in ODD_ARRAYS]
)
def test_odd_arrays_are_steered_or_refused_with_a_reason(law: str, kind: str) -> None:
    steering, array = laws.create(law), ODD_ARRAYS[kind]
    array = with_wheels(array) if steering.turns_wheels else array
    reason = steering.supports(array)
    assert isinstance(reason, str)
    if reason:
        with pytest.raises(UnsupportedArrayError, match=re.escape(reason)):
            prepare(steering, array, period=0.01)
    else:
        start = steering.init(array, np.zeros(array.n))
        delta, hdot = singular_states(array)
        spin = spins(steering, array.n, len(delta))
        for k in range(0, len(delta), 100):
            rates, _ = step(steering, array, delta[k], hdot[k], 0.0, 0.01, spin[k], start)
            assert np.isfinite(rates).all()


@pytest.mark.parametrize("law", [law for law in laws.names() if laws.get(law).turns_wheels])
def test_a_law_that_turns_wheels_asks_for_them(law: str) -> None:
    steering = laws.create(law)
    reason = steering.supports(array_of("pyramid"))
    assert "wheels" in reason
    with pytest.raises(UnsupportedArrayError, match=re.escape(reason)):
        prepare(steering, array_of("pyramid"), period=0.01)
