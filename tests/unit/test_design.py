"""Designed biases: what is shipped, what the search keeps to, the command."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.optimize import linprog

from nullmotion import guarantee
from nullmotion.cli import app, guard
from nullmotion.errors import InputError
from nullmotion.guarantee import design as package
from nullmotion.guarantee.design import Goal, Reward, design, family_of, goal_of, outcome
from nullmotion.guarantee.design.climb import PENALTY
from nullmotion.guarantee.design.linear import _volume_slope
from nullmotion.guarantee.design.program import Program
from nullmotion.guarantee.design.samples import Samples
from nullmotion.guarantee.radius import guaranteed_radius, least_capabilities, volume
from nullmotion.guarantee.singular import nearest_singular

LAYOUTS = ("box90", "roof6", "roof5")
SHIPPED = {
    "box90-designed": {0.0: 1.9277, 0.5: 1.476, 1.0: 0.821},
    "roof6": {0.0: 2.9132, 0.5: 2.4715, 1.0: 1.8475, 1.5: 1.1242},
    "roof5": {0.0: 1.9412, 0.5: 1.474, 1.0: 0.862, 1.25: 0.500},
}


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty folder; return status, output and errors."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(outcome, "_POINTS", 2**12)

    def call(*arguments):
        status = guard.call(app, ("design", "constraint", *arguments))
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


@pytest.fixture
def small(monkeypatch):
    """Let the command take one step only."""
    monkeypatch.setattr(package, "design", partial(design, limit=1))


@pytest.mark.sampled(1)
@pytest.mark.parametrize("name", SHIPPED)
def test_what_is_shipped_holds(name):
    made = guarantee.create(name)
    for level, radius in SHIPPED[name].items():
        assert guaranteed_radius(made, level).value == pytest.approx(radius, abs=1e-3)
    point = nearest_singular(made)
    assert np.linalg.norm(point) >= guaranteed_radius(made, 0).value - 1e-9


def test_the_designed_box90_keeps_what_was_asked():
    made, cubic = guarantee.create("box90-designed"), guarantee.create("box90-cubic")
    assert guaranteed_radius(made, 0).value >= 1.90
    assert guaranteed_radius(made, 0.5).value >= 1.475
    home = made.torque_capability(np.zeros(3))
    assert least_capabilities(cubic, [0.1])[0] < home < 4 / 3
    for level in (0.0, 0.5, 1.0):  # in volume, too
        ours, other = (volume(c, level, points=2**16).value for c in (made, cubic))
        assert ours > 1.05 * other


@pytest.mark.parametrize("step", [0.1, pytest.param(0.01, marks=pytest.mark.slow)])
def test_the_designed_box90_is_above_both_published(step):
    made = guarantee.create("box90-designed")
    sizes = np.linspace(0.1, 1.8, round(1.7 / step) + 1)
    least = least_capabilities(made, sizes)
    for name, margin in (("box90-cubic", 0.02), ("box90-spherical", 0.004)):
        assert (least - least_capabilities(guarantee.create(name), sizes)).min() > margin
    for size, bound in outcome.BOUNDS["box90"].items():
        assert least_capabilities(made, [size])[0] < bound


@pytest.mark.parametrize("failed", range(6))
def test_the_roof_without_one(failed, rng):
    """Five CMGs hold the momentum; what they guarantee does not hang on which one failed."""
    made = guarantee.create("roof6").without(failed)
    h = rng.uniform(-1, 1, (50, 3))
    array = made.array()
    delta = made.gimbal_angles(h)
    assert array.n == 5 and np.abs(array.momentum(delta) - h).max() < 1e-12
    jacobians = np.array([made.gimbal_jacobian(x) for x in h])
    assert np.abs(array.jacobian(delta) @ jacobians - np.eye(3)).max() < 1e-12
    expected = 1 / np.linalg.norm(jacobians, axis=2).max(axis=1)
    assert made.torque_capability(h) == pytest.approx(expected, rel=1e-9)
    least = least_capabilities(made, [0.9])[0]
    assert least == pytest.approx(least_capabilities(guarantee.create("roof5"), [0.9])[0], rel=1e-6)


@pytest.mark.parametrize("failed", [-1, 6, True])
def test_there_is_no_seventh_cmg(failed):
    with pytest.raises(InputError, match="failed"):
        guarantee.create("roof6").without(failed)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_powers_are_those_of_the_constraint(layout, rng):
    """Psi and its gradient, and TC from them, are the constraint's own."""
    family = family_of(layout)
    c = family.start(3) + 0.1 * rng.normal(size=len(family.orbits(3)))
    made, h = family.make(3, c), rng.uniform(-1, 1, (20, 3))
    w = family.powers(3, h) @ c
    for row, x in zip(w, h, strict=True):
        psi, gradient = made.bias(x)
        assert row == pytest.approx([psi, *gradient], rel=1e-12, abs=1e-12)
    samples = Samples(family, 3, Goal("", None), 1.0)
    expected = made.torque_capability(h) ** 2
    assert samples.rows.squares(h, w) == pytest.approx(expected, rel=1e-9, abs=1e-12)
    q, slope = samples.slopes(h, c)
    assert np.nanmin(q, axis=1)[expected > 0] == pytest.approx(expected[expected > 0], rel=1e-9)
    step = 1e-6 * rng.normal(size=c.shape)
    change = samples.slopes(h, c + step)[0] - samples.slopes(h, c - step)[0]
    good = np.isfinite(change)
    assert change[good] == pytest.approx((2 * slope @ step)[good], rel=1e-4, abs=1e-9)


def test_samples_measure_what_search_finds():
    """Radius and volume of a start on rays; the slope of the volume by differences."""
    family = family_of("box90")
    goal = Goal("", None, (Reward(0.5, 1.0),), (Reward(0.5, 1.0),))
    samples = Samples(family, 2, goal, 1.8)
    c = family.start(2)
    now, made = samples.measure(c, PENALTY), family.make(2, c)
    assert now.radii[0] == pytest.approx(guaranteed_radius(made, 0.5).value, abs=5e-3)
    assert now.volumes[0] == pytest.approx(volume(made, 0.5, points=2**16).value, rel=0.03)
    step = np.zeros(len(c))
    step[0] = 1e-2
    high, low = (samples.measure(c + s * step, PENALTY).volumes[0] for s in (1, -1))
    expected = 2 * _volume_slope(samples, c, now, 0.5) @ step
    assert high - low == pytest.approx(expected, rel=0.15)  # where rays only touch, there is none


def test_a_program_with_few_active_rows_is_the_whole_program(rng):
    slopes, values = rng.normal(size=(3000, 6)), rng.uniform(0.0, 3.0, 3000)
    gain = rng.normal(size=6)
    program = Program(6, 0)
    program.need(values, slopes)
    found = program.solve(gain, np.empty(0), 1.0, 0.5, np.empty(0))
    whole = linprog(-gain, -slopes, values, bounds=[(-0.5, 0.5)] * 6)
    assert found is not None and gain @ found.change == pytest.approx(-whole.fun, rel=1e-9)


@pytest.mark.slow
def test_a_few_steps_improve_the_start_and_keep_the_envelope():
    family = family_of("box90")
    goal = goal_of(family, "radius", (0.5,), envelope=1.7)
    told = []
    found = design(family, goal, starts=1, limit=2, progress=told.append)
    start = guaranteed_radius(family.make(2, family.start(2)), 0.5).value
    assert guaranteed_radius(found.constraint, 0.5).value > start + 0.05
    assert guaranteed_radius(found.constraint, 0).value >= 1.7
    assert told == sorted(told) and told[-1] == 1.0
    assert found.steps <= 6 and not found.interrupted and found.missed < 1e-6


def test_the_best_so_far_is_kept():
    family = family_of("box90")

    def stop(share):
        raise KeyboardInterrupt

    found = design(family, goal_of(family, "radius", envelope=1.7), limit=1, progress=stop)
    assert found.interrupted
    assert guaranteed_radius(found.constraint, 0).value >= 1.7


@pytest.mark.slow
def test_the_greatest_envelope():
    family = replace(family_of("box90"), axial=2)
    found = design(family, goal_of(family, "envelope"), starts=1, limit=10)
    assert guaranteed_radius(found.constraint, 0).value > 1.95


@pytest.mark.slow
def test_the_search_comes_back_with_what_is_shipped():
    """Or as good: the last digits hang on the linear algebra of the machine."""
    family = family_of("box90")
    found = design(family, goal_of(family), starts=1)
    for level, least in {0.0: 1.905, 0.5: 1.475, 1.0: 0.80}.items():
        assert guaranteed_radius(found.constraint, level).value > least


@pytest.mark.slow
def test_the_command_writes_a_constraint(cli, small, tmp_path):
    options = ("--layout", "roof6", "--objective", "volume", "--torque-capability", "1")
    status, out, err = cli(*options, "--starts", "1", "--axial-degree", "2", "--out", "r")
    assert (status, err) == (0, "")
    assert "TC >= 1.5, radius" in out and "0 1 1" in out and "roof6, volume" in out
    written = json.loads((tmp_path / "r" / "constraint.json").read_text())
    assert written["constraint"] == "roof6" and len(written["parameters"]["terms"]) == 10
    made = guarantee.create(written["constraint"], **written["parameters"])
    told = written["outcomes"][0]["radii"][1]
    found = guaranteed_radius(made, told["torque_capability"]).value
    assert found == pytest.approx(told["radius"], rel=1e-9)
    assert f"{found:.4f}" in out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--layout", "pyramid"), "box90 or roof6"),
        (("--objective", "speed"), "balanced, envelope, radius, volume"),
        (("--degree", "1"), "degree = 1: a whole number from 2"),
        (("--degree", "7"), "degree = 7"),
        (("--axial-degree", "-1"), "axial degree = -1"),
        (("--starts", "0"), "starts = 0"),
        (("--seed", "-1"), "seed = -1"),
        (("--envelope-radius", "2"), "above 0 and below 2"),
        pytest.param(
            ("--envelope-radius", "1.999"),
            "envelope = 1.999: at most 1.9",
            marks=pytest.mark.slow,
        ),
        (("--torque-capability", "0.5"), "none with this objective"),
        (("--objective", "radius", "--torque-capability", "-1"), "above 0"),
        (("--objective", "radius", "--torque-capability", "nan"), "above 0"),
        (("--objective", "radius", "--weight", "2"), "one for each of 0"),
    ],
)
def test_bad_input_is_told_in_one_line(cli, options, said):
    status, out, err = cli(*options)
    assert status == guard.BAD_INPUT
    assert out == "" and err.startswith("error: ") and err.count("\n") == 1 and said in err
