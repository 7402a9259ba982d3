"""Accuracy on many inputs: the singular value decomposition, and kernels against plain Python."""

from __future__ import annotations

import numpy as np
from common import LAWS, Row

import nullmotion as nm
from nullmotion import linalg
from nullmotion.compile import compile_function


def matrices(rng: np.random.Generator, count: int) -> np.ndarray:
    """3 x 4 matrices: random, graded, pyramids at any angle, of rank 0, 1 and 2."""
    a = rng.normal(size=(count, 3, 4))
    part = count // 8
    a[:part] *= 10.0 ** rng.uniform(-8, 0, (part, 1, 4))
    a[part : 3 * part] = nm.layouts.pyramid().jacobian(rng.uniform(-np.pi, np.pi, (2 * part, 4)))
    a[3 * part : 4 * part] = nm.layouts.pyramid().jacobian(
        rng.integers(0, 4, (part, 4)) * np.pi / 2
    )
    a[4 * part : 5 * part, 2] = a[4 * part : 5 * part, 0] - 2 * a[4 * part : 5 * part, 1]
    a[5 * part : 6 * part] = rng.normal(size=(part, 3, 1)) * rng.normal(size=(part, 1, 4))
    a[6 * part] = 0.0
    return a


def svd_error(count: int) -> float:
    """Largest error of singular values, product and orthogonality, relative to sigma_1."""
    rng = np.random.default_rng(7)
    kernel = compile_function(linalg.svd, np.zeros((3, 4)))
    worst = 0.0
    for _ in range(max(1, count // 100_000)):
        a = matrices(rng, min(count, 100_000))
        u, s, v, null = kernel(a)
        scale = np.maximum(np.linalg.svd(a, compute_uv=False)[:, :1], 1e-300)
        worst = max(worst, float(np.max(np.abs(s - np.linalg.svd(a, compute_uv=False)) / scale)))
        product = (u * s[:, None, :]) @ v.transpose(0, 2, 1)
        worst = max(worst, float(np.max(np.abs(product - a) / scale[:, :, None])))
        q = np.concatenate([v, null], axis=2)
        worst = max(worst, float(np.abs(q.transpose(0, 2, 1) @ q - np.eye(4)).max()))
        worst = max(worst, float(np.abs(u.transpose(0, 2, 1) @ u - np.eye(3)).max()))
    return worst


def law_difference(name: str, count: int) -> float:
    """Largest difference between kernel and plain Python, over rates and the state's condition."""
    rng = np.random.default_rng(11)
    array, law = nm.layouts.pyramid(rate_limit=np.pi), nm.laws.create(name)
    delta, hdot, t = (
        rng.uniform(-np.pi, np.pi, (count, 4)),
        rng.normal(size=(count, 3)),
        rng.uniform(0, 10, count),
    )
    state = law.init(array, np.zeros(4))

    def step(d: np.ndarray, h: np.ndarray, clock: float) -> np.ndarray:
        return law.step(array, nm.Observation(d, h, clock, 0.01), state)[0]

    ours = compile_function(step, np.zeros(4), np.zeros(3), 0.0)(delta, hdot, t)
    with np.errstate(all="ignore"):
        plain = np.array([step(*x) for x in zip(delta, hdot, t, strict=True)])
    s = np.linalg.svd(array.unit_jacobian(delta), compute_uv=False)
    size = np.maximum(np.abs(plain).max(axis=1), 1e-300)
    return float((np.abs(ours - plain).max(axis=1) / size / (s[:, 0] / s[:, 2])).max())


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    count = 100_000 if quick else 1_000_000
    out = [
        Row(
            f"SVD against LAPACK, {count} 3x4 matrices",
            svd_error(count),
            "x sigma_1",
            at_most=5e-15,
        )
    ]
    states = 200 if quick else 10_000
    for law in LAWS:
        note = "largest difference / rates / condition number"
        out.append(
            Row(
                f"{law}: kernel against plain Python, {states} states",
                law_difference(law, states),
                "",
                at_most=1e-13,
                note=note,
            )
        )
    return out
