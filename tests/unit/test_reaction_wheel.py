"""A reaction wheel beside a planar array, rows that hold, and the command that laws foresee."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.law import Law
from nullmotion.scenario import build
from nullmotion.sim import Setup, run
from nullmotion.spacecraft import ReactionWheel, Spacecraft, controllers
from nullmotion.spacecraft.reference import held


@dataclass(frozen=True)
class Seer(Law):
    """A host law that keeps what it was shown."""

    name = "seer"
    information = ("preview",)
    traceable = False
    count: int = 4

    @property
    def preview_samples(self):
        return self.count

    def init(self, array, delta):
        return ()

    def step(self, array, obs, state):
        rates = np.linalg.pinv(array.jacobian(obs.delta)) @ obs.hdot
        return rates, (*state, obs.preview)


def slew(law=None, **fields):
    """Return a small turn about all axes on a triangle with a wheel."""
    values = {
        "array": nm.layouts.create("triangle", h0=1.0),
        "law": law or nm.laws.create("pseudo-inverse"),
        "delta": np.array([0.1, -0.2, 0.05]),
        "hdot": np.zeros(2),
        "dt": 0.02,
        "steps": 400,
        "period_steps": 5,
        "spacecraft": Spacecraft(np.array([24.0, 20.0, 16.0])),
        "controller": controllers.create("quaternion-feedback", natural_frequency_rad_s=0.4),
        "target": np.array([0.995, 0.03, -0.04, 0.06]),
        "reaction_wheel": ReactionWheel([0.0, 0.0, 2.0], 0.3, 1.0),
    }
    return Setup(**(values | fields))


def test_wheel_in_kernel_equals_python_and_momentum_stays():
    setup = slew()
    fast, plain = run(setup), run(setup, backend="python")
    assert fast.backend == "kernel"
    for name in ("wheel_momentum", "wheel_torque", "q_BN", "delta", "inertial_momentum"):
        np.testing.assert_allclose(getattr(fast, name), getattr(plain, name), atol=1e-10)
    drift = np.abs(fast.inertial_momentum - fast.inertial_momentum[0]).max()
    assert drift < 1e-7 and np.abs(fast.wheel_momentum).max() > 0.1
    assert np.isnan(fast.wheel_torque[-1])
    assert fast.pointing_error[-1] < 0.3 * fast.pointing_error[0]


def test_limits_of_torque_and_speed_hold():
    found = run(slew(reaction_wheel=ReactionWheel([0, 0, -1.0], 0.05, 0.12, 0.1)))
    assert np.nanmax(np.abs(found.wheel_torque)) == pytest.approx(0.05)
    assert np.abs(found.wheel_momentum).max() <= 0.12 + 1e-12
    assert np.abs(found.inertial_momentum - found.inertial_momentum[0]).max() < 1e-7


def test_a_run_without_a_wheel_has_none():
    array = nm.layouts.create("pyramid")
    found = run(slew(array=array, delta=np.zeros(4), hdot=np.zeros(3), reaction_wheel=None))
    assert found.wheel_momentum is None and found.wheel_torque is None


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"reaction_wheel": None}, "or a reaction wheel"),
        ({"reaction_wheel": ReactionWheel([0.0, 0.1, 1.0])}, "normal"),
        ({"spacecraft": None}, "only on a spacecraft"),
    ],
)
def test_what_does_not_give_three_dimensions_is_refused(change, says):
    with pytest.raises(nm.InputError, match=says):
        slew(**change)
    with pytest.raises(nm.InputError, match="momentum"):
        ReactionWheel([0, 0, 1.0], momentum_limit=1.0, momentum=2.0)


def test_what_is_foreseen_is_what_comes():
    seer = Seer()
    setup = slew(seer, dt=0.1, steps=40, period_steps=1)
    found = run(setup)
    shown = []

    def step(self, array, obs, state):
        shown.append(obs.preview)
        return np.linalg.pinv(array.jacobian(obs.delta)) @ obs.hdot, ()

    seen = type("Watcher", (Seer,), {"step": step})()
    run(replace(setup, law=seen))
    for k in range(10, 30):
        np.testing.assert_allclose(shown[k][0], found.hdot[k], atol=1e-12)
        np.testing.assert_allclose(shown[k][1:], found.hdot[k + 1 : k + 4], atol=2e-3)
    assert np.abs(found.hdot[10:30]).max() > 0.05


def test_a_schedule_is_foreseen_to_its_end():
    shown = []

    def step(self, array, obs, state):
        shown.append(obs.preview)
        return np.zeros(3), ()

    law = type("Watcher", (Seer,), {"step": step})()
    rows = np.arange(12.0).reshape(6, 2)
    array = nm.layouts.create("triangle")
    run(Setup(array, law, np.zeros(3), rows, dt=0.1, steps=6))
    np.testing.assert_allclose(shown[1], rows[1:5])
    np.testing.assert_allclose(shown[4], rows[[4, 5, 5, 5]])
    shown.clear()
    target = Setup(array, law, np.zeros(3), np.zeros(2), dt=0.1, steps=2, momentum_target=[1, 0])
    run(target)
    assert np.abs(shown[0][0]).max() > 1 and (shown[0][1:] == 0).all()


def test_rows_hold_until_the_next():
    q = np.array([[1.0, 0, 0, 0], [0, 2.0, 0, 0]])
    found = held(np.array([1.0, 30.0]), q, 0.1 * np.arange(400))
    assert (found[:300, 0] == 1).all() and (found[300:, 1] == 1).all()
    assert (found[:, 4:] == 0).all()


def test_scenario_sections():
    setup = build.setup(nm.load_scenario("pereira-eq45"))
    assert setup.reaction_wheel.torque_limit == 0.2
    np.testing.assert_allclose(setup.reaction_wheel.axis, [0, 0, 1])
    reference = setup.reference
    roll = nm.rotation.euler_321(reference[450, :4])
    np.testing.assert_allclose(np.degrees(roll), [0, 20, -25], atol=1e-9)
    assert (reference[299, :4] == [1, 0, 0, 0]).all() and reference[300, 0] < 0.99
    speed = {"wheel_inertia_kg_m2": 0.01, "speed_limit_rpm": 60.0}
    other = nm.load_scenario("pereira-eq45").with_values({"reaction_wheel": speed})
    assert build.setup(other).reaction_wheel.momentum_limit == pytest.approx(0.02 * np.pi)


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("reaction_wheel.axis", [0.0, 1.0, 1.0], "normal"),
        ("reaction_wheel.speed_limit_rpm", 5.0, "wheel_inertia_kg_m2"),
        ("reaction_wheel.momentum_Nms", 2.0, "at most the limit"),
        ("array.layout", "pyramid", "two torque dimensions"),
    ],
)
def test_wrong_keys_are_told(key, value, says):
    with pytest.raises(nm.InputError, match=says) as told:
        nm.load_scenario("pereira-eq45", {key: value})
    assert "reaction_wheel" in str(told.value)
