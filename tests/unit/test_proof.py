"""Proofs by branch and bound, what refutes them, and the checker that trusts none."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from nullmotion import ops
from nullmotion.errors import InputError, TraceError
from nullmotion.guarantee import search
from nullmotion.guarantee.check import check
from nullmotion.guarantee.proof import Proof, prove
from nullmotion.guarantee.region import Ball, Box

THIRD = (0.2, -0.3, 0.1)


def hill(h: Any) -> Any:
    """Return a smooth function with its maximum 1 at THIRD, multiplied out."""
    a = THIRD[: len(h)]
    square = sum(h[j] * h[j] - 2.0 * (a[j] * h[j]) + a[j] * a[j] for j in range(len(h)))
    return ops.cos(square) / (1.0 + 0.5 * square)


HOLDS = {
    "radius 1-D": (lambda h: h[0] * h[0] - 1.0001, Ball(1.0, 1)),
    "radius 2-D": (lambda h: h @ h - 1.001, Ball(1.0, 2)),
    "radius 3-D": (lambda h: h @ h - 1.01, Ball(1.0, 3)),
    "hill 1-D": (lambda h: hill(h) - 1.0001, Box((-1.0,), (2.0,))),
    "hill 2-D": (lambda h: [hill(h) - 1.001, h[0] - 2.0], Box((-1.0, -2.0), (1.0, 1.0))),
    "hill 3-D": (lambda h: hill(h) - 1.01, Ball(1.3, 3)),
    "norm at its kink": (lambda h: [ops.sqrt(h @ h) - 1.01, -0.01 - ops.sqrt(h @ h)], Ball(1.0, 2)),
    "limits": (
        lambda h: ops.maximum(ops.absolute(h[0]), ops.clip(h[1], -0.5, 2.0)) - 1.001,
        Ball(1.0, 2),
    ),
    "angle": (
        lambda h: ops.cos(ops.atan2(h[1], h[0])) - h[0] / ops.sqrt(h @ h) - 1e-3,
        Box((0.5, -1.0), (1.0, 1.0)),
    ),
    "arc cosine": (lambda h: ops.acos(ops.clip(h[0], -1.0, 1.0)) - 3.2, Box((-1.0,), (1.0,))),
    "root from its end": (lambda h: ops.sqrt(h[0]) - 1.001, Box((0.0,), (1.0,))),
    "jump": (lambda h: ops.where(h[0] < 0.3, -1.0, h[0] - 1.001), Box((0.0,), (1.0,))),
    "constant": (lambda h: [0.0 * h[0] - 1.0, -2.0], Ball(1.0, 2)),
}


@pytest.mark.parametrize("name", HOLDS)
def test_what_holds_is_proven_and_the_proof_is_confirmed(name):
    function, region = HOLDS[name]
    seen: list[float] = []
    proof = prove(function, region, progress=seen.append)
    assert proof.proven and proof.reason == "" and proof.counterexample is None
    assert proof.tree.count("p") + proof.tree.count("o") == proof.boxes
    assert seen == sorted(seen) and seen[-1] == proof.decided == 1.0
    parts: list[float] = []
    found = check(function, region, proof.tree, progress=parts.append)
    assert found.ok and found.boxes == proof.boxes and found.failed is None
    assert parts == sorted(parts)


FAILS = {
    "hill 1-D": (lambda h: hill(h) - 0.9999, Box((-1.0,), (1.0,))),
    "hill 2-D": (lambda h: [-1.0 + 0.0 * h[0], hill(h) - 0.9999], Ball(1.0, 2)),
    "hill 3-D": (lambda h: hill(h) - 0.9999, Ball(1.3, 3)),
    "at the edge": (lambda h: h @ h - 0.999, Ball(1.0, 3)),
    "jump": (lambda h: ops.where(h[0] < 0.3, -1.0, 0.7 - h[0]), Box((0.0,), (1.0,))),
}


@pytest.mark.parametrize("name", FAILS)
def test_what_fails_is_refuted_by_a_point_inside(name):
    function, region = FAILS[name]
    proof = prove(function, region)
    assert not proof.proven and proof.reason == "counterexample" and proof.tree == ""
    point, component, value = proof.counterexample
    assert region.holds(np.array([point])).all() and value > 0.0
    there = np.atleast_1d(function(np.array(point)))[component]
    assert there == pytest.approx(value, abs=1e-12)
    if name.startswith("hill"):
        assert np.abs(np.array(point) - THIRD[: region.m]).max() < 0.05


def quick() -> tuple[Any, Ball, Proof]:
    def function(h: Any) -> Any:
        return [h @ h - 1.05, hill(h) - 1.05]

    return function, Ball(1.0, 2), prove(function, Ball(1.0, 2))


def subtree(tree: str, at: int) -> str:
    """Return the subtree that begins at a letter."""
    missing, end = 1, at
    while missing:
        missing += 1 if tree[end] in "012" else -1
        end += 1
    return tree[at:end]


def test_a_tree_that_was_tampered_with_is_refused():
    function, region, proof = quick()
    tree = proof.tree
    assert check(function, region, tree).ok
    for at, letter in enumerate(tree):
        if letter == "p":
            found = check(function, region, f"{tree[:at]}o{tree[at + 1 :]}")
            assert not found.ok and found.failed is not None and "outside" in found.reason
    for at in [i for i, letter in enumerate(tree) if letter in "01"][1::3]:
        part = subtree(tree, at)
        assert not check(function, region, tree[:at] + tree[at + len(part) :]).ok
    assert not check(function, region, tree[:-1]).ok
    assert not check(function, region, tree + "p").ok
    assert not check(function, region, "").ok
    assert "letter" in check(function, region, "x").reason
    assert "letter" in check(function, region, tree.replace("0", "2", 1)).reason


def test_another_claim_is_refused():
    function, region, proof = quick()
    for other in (Ball(1.03, 2), Box((-1.0, -1.0), (1.0, 1.0))):
        found = check(function, other, proof.tree)
        assert not found.ok and len(found.failed[0]) == 2
    for claim in (lambda h: h @ h - 0.99, lambda h: [h @ h - 1.05, 1e-9 + 0.0 * h[0]]):
        found = check(claim, region, proof.tree)
        assert not found.ok and "not confirmed" in found.reason


def test_a_box_too_wide_for_the_checker_is_cut_further():
    assert check(lambda h: h[0] * h[0] - h[1] - 1.2, Ball(1.0, 2), "p").ok is False
    assert check(lambda h: h @ h - 1.4, Ball(1.0, 2), "p").ok


def test_what_is_undefined_in_the_region_is_not_proven():
    for function in (lambda h: -1.0 / (h[0] * h[0]), lambda h: ops.sqrt(h[0]) - 9.0):
        proof = prove(function, Box((-1.0,), (1.1,)), limit_boxes=60)
        assert not proof.proven and proof.reason == "box limit"
        assert proof.counterexample is None and 0.0 < proof.decided < 1.0
    assert not check(lambda h: ops.sqrt(h[0]) - 9.0, Box((-1.0,), (1.1,)), "p").ok


@pytest.mark.parametrize("least", [1e-3, 1e-7, 1e-13])
def test_what_a_ball_touches_is_not_left_out(least, rng):
    u = rng.normal(size=3)
    u /= np.linalg.norm(u)

    def function(h: Any) -> Any:
        return [h @ u - 1.38 * (1.0 - least), -1.0 + h[0] * h[0] * 0.1]

    proof = prove(function, Ball(1.38, 3), limit_boxes=3000)
    assert not proof.proven and proof.reason in ("counterexample", "box limit")
    assert not check(function, Ball(1.38, 3), "p").ok
    outward = prove(lambda h: h @ u - 1.38 * (1.0 + least), Ball(1.38, 3), limit_boxes=3000)
    assert outward.proven == (least > 1e-10)


def test_time_is_limited():
    assert prove(lambda h: h @ h, Ball(1.0, 2), limit_seconds=0.0).reason == "time limit"


def test_an_interrupt_leaves_an_honest_result():
    def stop(part: float) -> None:
        if part > 0.3:
            raise KeyboardInterrupt

    proof = prove(lambda h: h @ h - 1.001, Ball(1.0, 2), progress=stop)
    assert not proof.proven and proof.reason == "interrupted"
    assert proof.tree == "" and 0.3 < proof.decided < 1.0 and proof.boxes > 0


def test_a_kernel_takes_over_and_finds_the_same_tree(monkeypatch):
    function, region, proof = quick()
    monkeypatch.setattr(search, "_COMPILE_AFTER", 20)
    assert prove(function, region).tree == proof.tree


def test_source_that_decides_is_refused():
    with pytest.raises(TraceError):
        prove(lambda h: h[0] if h[0] > 0 else -h[0], Ball(1.0, 1))


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_ball_tells_certainly_outside_and_inside(m, rng):
    radius = 1.38
    ball = Ball(radius, m)
    d = rng.normal(size=(300, m))
    points = radius * d / np.linalg.norm(d, axis=1, keepdims=True)
    points = np.concatenate([points, points * (1 + 1e-13), points * (1 - 1e-13), d])
    size = [sum(Fraction(v) ** 2 for v in p) for p in points.tolist()]
    limit = Fraction(radius) ** 2
    outside = ball.outside(np.stack([points, points], axis=1))
    inside = ball.holds(points)
    for s, a, b in zip(size, outside.tolist(), inside.tolist(), strict=True):
        assert not (a and s <= limit) and not (b and s > limit)
    assert outside[300:600].all() and inside[600:900].all()
    wide = np.stack([points - 0.1, points + 0.1], axis=1)
    nearest = np.clip(0.0, wide[:, 0], wide[:, 1])
    assert not ball.outside(wide)[np.linalg.norm(nearest, axis=1) < radius].any()


def test_halves_cover_their_box(rng):
    boxes = np.sort(rng.normal(size=(20, 2, 3)), axis=1)
    axes = rng.integers(3, size=20)
    halves = search.halved(boxes, axes).reshape(20, 2, 2, 3)
    for box, axis, (low, high) in zip(boxes, axes, halves, strict=True):
        assert low[1, axis] == high[0, axis] == 0.5 * box[0, axis] + 0.5 * box[1, axis]
        low[1, axis], high[0, axis] = box[1, axis], box[0, axis]
        np.testing.assert_array_equal(low, box)
        np.testing.assert_array_equal(high, box)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Ball(0.0), lambda: Ball(np.inf), lambda: Ball(1.0, 4), lambda: Box((0.0,), (0.0,)),
        lambda: Box((0.0,), (1.0, 2.0)), lambda: Box((0.0,) * 4, (1.0,) * 4),
        lambda: Box((0.0,), (np.nan,)),
    ],
)  # fmt: skip
def test_what_is_no_region_is_refused(make):
    with pytest.raises(InputError, match="region"):
        make()


def test_the_checker_never_confirms_what_a_point_refutes(rng):
    """Random claims that are false at one point of the box, by less than the box's spread."""
    functions = [f for f, region in HOLDS.values() if region.m == 2]
    for function, _ in itertools.product(functions, range(6)):
        centre, width = rng.uniform(0.3, 0.7, 2), 10.0 ** rng.uniform(-6, -1)
        box = Box(tuple(centre - width), tuple(centre + width))
        point = centre + rng.uniform(-width, width, 2)
        least = float(np.max(np.atleast_1d(function(point)))) - 1e-12

        def claim(h: Any, f: Any = function, least: float = least) -> Any:
            return [v - least for v in np.atleast_1d(f(h))]

        assert not check(claim, box, "p").ok
