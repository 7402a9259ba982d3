"""Torque capability maps and certificates, on one core."""

from __future__ import annotations

import time

import numpy as np
from common import Row, median_time

import nullmotion as nm
from nullmotion.guarantee import evaluate

# constraint, radius, torque capability to prove there
PROOFS = (
    ("box90-cubic", 1.38, 0.5),
    ("box90-cubic", 0.73, 1.0),
    ("box90-designed", 1.47, 0.5),
)


def momenta(count: int) -> np.ndarray:
    """Return momenta spread over the box-90's restricted envelope."""
    return np.random.default_rng(1).uniform(-2.0, 2.0, (count, 3))


def maps(count: int, rounds: int) -> list[Row]:
    """Measure maps over momenta and over gimbal angles, beside plain NumPy."""
    h, delta = momenta(count), np.pi * momenta(count)[:, [0, 1, 2, 0]]
    array, out = nm.layouts.box90(), []
    for name in ("box90-cubic", "box90-designed"):
        constraint = nm.guarantee.create(name)
        constraint.torque_capability(h)
        seconds = median_time(lambda c=constraint: c.torque_capability(h), rounds)
        out.append(Row(f"{name}: TC at {count:,} momenta", seconds, "s", at_most=2.0))
    for method in ("pseudo-inverse", "optimal"):
        nm.guarantee.torque_capability(array, delta, method)
        seconds = median_time(
            lambda m=method: nm.guarantee.torque_capability(array, delta, m), rounds
        )
        out.append(Row(f"box-90, {method}: TC at {count:,} states", seconds, "s", at_most=2.0))
    part = delta[: count // 10]
    mine = median_time(lambda: nm.guarantee.torque_capability(array, part), rounds)
    plain = median_time(lambda: 1 / np.linalg.norm(np.linalg.pinv(array.jacobian(part)), axis=-1)
                        .max(axis=-1), rounds)  # fmt: skip
    return [*out, Row("box-90, pseudo-inverse: NumPy's pinv / ours", plain / mine, "times")]


def proofs(quick: bool) -> list[Row]:
    """Measure certificates, compilation included, and their check."""
    out = []
    for name, radius, capability in PROOFS[: 1 if quick else None]:
        start = time.perf_counter()
        found = nm.guarantee.create(name).certificate(radius, capability)
        seconds = time.perf_counter() - start
        what = f"{name}: prove TC >= {capability:g} for |h| <= {radius:g}"
        note = found.statement if not found.proven else f"{found.boxes:,} boxes"
        good = seconds if found.proven else np.inf
        out.append(Row(what, good, "s", at_most=60.0, note=note))
        if not quick:
            start = time.perf_counter()
            holds = found.check()
            seconds = time.perf_counter() - start
            out.append(Row("its check, in 80-bit ball arithmetic", seconds, "s",
                           note="holds" if holds else "FAILS"))  # fmt: skip
    return out


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    evaluate.compiled.cache_clear()
    count, rounds = (100_000, 2) if quick else (1_000_000, 5)
    return [*maps(count, rounds), *proofs(quick)]


if __name__ == "__main__":
    import sys

    for each in rows("--quick" in sys.argv):
        print(each.markdown())
