"""Every registered law on every registered layout, held to what it claims.

A law is evaluated on many states at once by tracing it and running its tape with
NumPy; that the tape says what the plain source says is tested first.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from nullmotion import CmgArray, Claim, Observation, laws, layouts, tree
from nullmotion.compile import compile_function
from nullmotion.compile.program import interpret, trace

LARGEST_RATE = 2e4  # times |hdot| / mean momentum: what a bounded law may ask for
RATE_LIMIT = np.pi

PAIRS = [(law, layout) for law in laws.names() for layout in layouts.names()]


@cache
def array_of(layout: str) -> CmgArray:
    return layouts.create(layout, h0=1.0, rate_limit=RATE_LIMIT)


def supported(law: str, layout: str) -> tuple[Any, CmgArray]:
    steering, array = laws.create(law), array_of(layout)
    if reason := steering.supports(array):
        pytest.skip(reason)
    return steering, array


def claimed(law: str, layout: str, claim: Claim) -> tuple[Any, CmgArray]:
    if claim not in laws.get(law).claims:
        pytest.skip(f"{law} does not claim: {claim}")
    return supported(law, layout)


def step(law: Any, array: CmgArray, delta: Any, hdot: Any, t: Any, period: Any, state: Any) -> Any:
    observation = Observation(
        delta,
        hdot,
        t,
        period,
        delta_dot=np.zeros(array.n),
        omega_BN_B=np.zeros(3),
        wheel_speed=np.zeros(array.n),
    )
    return law.step(array, observation, state)


def many(
    law: Any,
    array: CmgArray,
    delta: Any,
    hdot: Any,
    t: float = 0.0,
    period: float = 0.01,
    state: Any = None,
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return rates (N, n) at N states and the leaves of the law's next states."""
    start = law.init(array, delta[0])
    leaves = tree.flatten(start) if state is None else state
    if not law.traceable:
        runs = [step(law, array, d, h, t, period, start) for d, h in zip(delta, hdot, strict=True)]
        return np.array([r for r, _ in runs]), []

    def rates(d: Any, h: Any, clock: Any, span: Any, s: Any) -> Any:
        return step(law, array, d, h, clock, span, s)

    program, _ = trace(rates, delta[0], hdot[0], t, period, start, fuse=False)
    out = interpret(program, [*delta.T, *hdot.T, t, period, *leaves])
    out = [np.broadcast_to(o, len(delta)) for o in out]
    return np.stack(out[: array.n], axis=1), out[array.n :]


def commands(array: CmgArray, count: int, rng: np.random.Generator) -> np.ndarray:
    directions = rng.normal(size=(count, array.m))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return directions * 10.0 ** rng.uniform(-2, 0.5, (count, 1))


def measure(array: CmgArray, delta: np.ndarray) -> np.ndarray:
    return np.linalg.svd(array.unit_jacobian(delta), compute_uv=False)[:, array.m - 1 :].sum(axis=1)


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


def turned(array: CmgArray, rng: np.random.Generator) -> tuple[CmgArray, np.ndarray]:
    """Return the array with its body axes turned, and the turn of the torque space."""
    R, Q = _rotation(rng, 3), _rotation(rng, array.m)
    basis = Q @ array.torque_axes @ R.T
    axes = array.gimbal_axes @ R.T, array.spin_axes @ R.T
    return CmgArray(*axes, array.h0, array.rate_limit, torque_axes=basis), Q


def _rotation(rng: np.random.Generator, size: int) -> np.ndarray:
    q, r = np.linalg.qr(rng.normal(size=(size, size)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q) if size % 2 else q @ np.diag([1.0] * (size - 1) + [np.linalg.det(q)])


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
    known = ("delta_dot", "omega_BN_B", "wheel_speed", "preview")
    assert set(entry.information) <= set(known)


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_traced_equals_plain(law: str, layout: str) -> None:
    steering, array = supported(law, layout)
    if not steering.traceable:
        pytest.skip("a host law")
    delta, hdot = (np.concatenate(x) for x in zip(
        [a[:6] for a in regular_states(array, 0.05)], [a[::150] for a in singular_states(array)],
        strict=True,
    ))
    rates, _ = many(steering, array, delta, hdot, t=0.3)
    start = steering.init(array, delta[0])
    plain = [step(steering, array, d, h, 0.3, 0.01, start)[0] for d, h in zip(delta, hdot, strict=True)]
    close(rates, plain, 1e-8)


@pytest.mark.parametrize("law", laws.names())
def test_compiled_equals_plain(law: str) -> None:
    steering, array = supported(law, "pyramid")
    if not steering.traceable:
        pytest.skip("a host law")
    start = steering.init(array, np.zeros(4))

    def rates(delta: Any, hdot: Any, t: Any, state: Any, parameters: Any, given: Any) -> Any:
        return step(parameters, given, delta, hdot, t, 0.01, state)

    example = (np.zeros(4), np.zeros(3), 0.0, start, steering, array)
    compiled = compile_function(rates, *example)
    delta, hdot = (np.concatenate(x) for x in zip(
        [a[:8] for a in regular_states(array, 0.05)], [a[::90] for a in singular_states(array)],
        strict=True,
    ))
    rows = [np.tile(np.array(tree.flatten(x), float), (len(delta), 1)) for x in example[3:]]
    got = compiled(delta, hdot, np.full(len(delta), 0.3), *rows)[0]
    plain = [step(steering, array, d, h, 0.3, 0.01, start)[0] for d, h in zip(delta, hdot, strict=True)]
    close(got, plain, 1e-8)


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_exact_torque(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.EXACT_TORQUE)
    margin = steering.exact_above(array)
    delta, hdot = regular_states(array, max(1.001 * margin, 1e-3))
    assert len(delta) > 20, f"no states with sigma_min above {margin}"
    rates, _ = many(steering, array, delta, hdot)
    torque = np.einsum("kmn,kn->km", array.jacobian(delta), rates)
    close(torque, hdot)


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_finite(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.FINITE)
    rates, state = many(steering, array, *singular_states(array))
    assert np.isfinite(rates).all()
    assert all(np.isfinite(leaf).all() for leaf in state)


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_bounded(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.BOUNDED)
    for delta, hdot in (singular_states(array), regular_states(array, 0.0)):
        rates, _ = many(steering, array, delta, hdot)
        bound = LARGEST_RATE * np.linalg.norm(hdot, axis=1) / array.mean_momentum
        assert (np.abs(rates).max(axis=1) <= bound).all()


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_rotation(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.ROTATION)
    delta, hdot = regular_states(array, 0.05)
    other, turn = turned(array, np.random.default_rng(7))
    close(many(steering, other, delta, hdot @ turn.T)[0], many(steering, array, delta, hdot)[0])


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_scaling(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.SCALING)
    delta, hdot = regular_states(array, 0.05)
    large = layouts.create(layout, h0=73.0, rate_limit=RATE_LIMIT)
    close(many(steering, large, delta, 73.0 * hdot)[0], many(steering, array, delta, hdot)[0])


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_homogeneous(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.HOMOGENEOUS)
    for delta, hdot in (singular_states(array), regular_states(array, 0.05)):
        rates, _ = many(steering, array, delta, hdot)
        close(many(steering, array, delta, 0.37 * hdot)[0], 0.37 * rates)


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_stateless(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.STATELESS)
    delta, hdot = regular_states(array, 0.05)
    rates, state = many(steering, array, delta, hdot)
    close(many(steering, array, delta, hdot, state=[leaf[::-1] for leaf in state])[0], rates, 0.0)


@pytest.mark.parametrize(("law", "layout"), PAIRS)
def test_timeless(law: str, layout: str) -> None:
    steering, array = claimed(law, layout, Claim.TIMELESS)
    delta, hdot = regular_states(array, 0.05)
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
@pytest.mark.parametrize("kind", ODD_ARRAYS)
def test_odd_arrays_are_steered_or_refused_with_a_reason(law: str, kind: str) -> None:
    steering, array = laws.create(law), ODD_ARRAYS[kind]
    reason = steering.supports(array)
    assert isinstance(reason, str)
    if not reason:
        assert np.isfinite(many(steering, array, *singular_states(array))[0]).all()
