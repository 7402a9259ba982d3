"""How many Jacobi sweeps a 3 x n and a 2 x n matrix need: the numbers behind linalg._SWEEPS.

Run it: errors of the singular values against LAPACK and of the product, relative to sigma_1,
on random, graded, pyramid and nearly rank-deficient matrices. Three sweeps leave 4e-10 in the
singular values of some 3 x 4 matrices, four nothing above rounding. Two rows need one rotation.
"""

from __future__ import annotations

import numpy as np

import nullmotion as nm
from nullmotion import linalg
from nullmotion.compile import compile_function


def matrices(rng: np.random.Generator, m: int, count: int) -> np.ndarray:
    """Return random, graded, pyramid (m = 3) and nearly dependent m x 4 matrices."""
    a = rng.normal(size=(count, m, 4))
    part = count // 4
    a[:part] *= 10.0 ** rng.uniform(-8, 0, (part, 1, 4))
    a[part : 2 * part, -1] = (
        a[part : 2 * part, 0] + 10.0 ** rng.uniform(-12, 0, (part, 1)) * a[part : 2 * part, -1]
    )
    if m == 3:
        a[2 * part : 3 * part] = nm.layouts.pyramid().jacobian(
            rng.uniform(-np.pi, np.pi, (part, 4))
        )
    return a


def worst(m: int, sweeps: int, count: int = 400_000) -> tuple[float, float]:
    """Return the largest error of singular values and of the product."""
    linalg._SWEEPS[m] = sweeps
    kernel = compile_function(linalg.svd, np.zeros((m, 4)))
    a = matrices(np.random.default_rng(1), m, count)
    u, s, v, _ = kernel(a)
    truth = np.linalg.svd(a, compute_uv=False)
    values = np.abs(s - truth) / truth[:, :1]
    product = np.abs((u * s[:, None, :]) @ v.transpose(0, 2, 1) - a) / truth[:, :1, None]
    return float(values.max()), float(product.max())


if __name__ == "__main__":
    for m, tried in ((2, (1, 2)), (3, (2, 3, 4, 5))):
        for sweeps in tried:
            values, product = worst(m, sweeps)
            print(f"{m} x 4, {sweeps} sweeps: singular values {values:.1e}, product {product:.1e}")
