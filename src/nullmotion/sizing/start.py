"""Gimbal angles before a slew: those of a momentum, as far from singular as they are found."""

from __future__ import annotations

import numpy as np

from nullmotion.array.model import CmgArray

_TRIES, _STEPS, _ROUNDS, _POLISH = 200, 24, 2, 12
_SEED = 1
_HELD = 1e-8  # error of the momentum, over h0, that counts as none
_DAMPING = 1e-3
_LEAST = 0.05  # sigma_min / h0 below which an array counts as singular at rest


def rest(array: CmgArray) -> np.ndarray | None:
    """Return angles without momentum and with a large least singular value, (n,); None if none.

    Args:
        array: An array with h0 = 1; after a failure its layout's home is no start.
    """
    generator = np.random.default_rng(_SEED)
    delta = generator.uniform(-np.pi, np.pi, (_TRIES, array.n))
    delta = _towards(array, delta, np.zeros((_TRIES, 3)), _POLISH * 4)
    held = np.linalg.norm(array.momentum(delta), axis=1) < _HELD
    sigma = np.where(held, np.linalg.svd(array.jacobian(delta), compute_uv=False)[:, -1], 0.0)
    best = int(np.argmax(np.round(sigma, 6)))
    return delta[best] if sigma[best] > _LEAST else None


def holding(
    array: CmgArray, home: np.ndarray, momentum: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles (k, n) that hold momenta (k, 3) over h0, and where they do, (k,).

    The way leads from home along the momentum, so that small momenta stay near home.
    """
    delta = np.tile(home, (len(momentum), 1))
    if not momentum.any():
        return delta, np.ones(len(momentum), bool)
    for step in range(1, _STEPS + 1):
        delta = _towards(array, delta, momentum * (step / _STEPS), _ROUNDS)
    delta = _towards(array, delta, momentum, _POLISH)
    off = np.linalg.norm(array.momentum(delta) - momentum, axis=1)
    return delta, off < _HELD


def _towards(array: CmgArray, delta: np.ndarray, wanted: np.ndarray, rounds: int) -> np.ndarray:
    """Return angles after damped Gauss-Newton steps towards momenta."""
    for _ in range(rounds):
        A, e = array.jacobian(delta), wanted - array.momentum(delta)
        damping = np.minimum(_DAMPING, np.einsum("km,km->k", e, e)) + 1e-14
        AAT = A @ A.transpose(0, 2, 1) + damping[:, None, None] * np.eye(3)
        step = np.einsum("kmn,km->kn", A, np.linalg.solve(AAT, e[:, :, None])[:, :, 0])
        delta = delta + step / np.maximum(1.0, np.linalg.norm(step, axis=1, keepdims=True))
    return delta
