"""What trips cost, and what a chassis's shape does."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.rover.chassis import Chassis
from nullmotion.rover.chassis_table import chassis_row, platonic_rows
from nullmotion.rover.mission_cost import CmgMission, Upkeep
from nullmotion.rover.polyhedron import NAMES
from nullmotion.rover.rover import peter
from nullmotion.rover.wheels import stays

GIVEN = Upkeep(power=37.0, pause=45.0, spin_up_time=7200.0, rotor_energy=5000.0)


def test_a_trip_adds_up_step_by_step():
    rover, time, cost = peter(), 4.2, 11.0
    trips = CmgMission.of(rover, cost, time, GIVEN)
    energy = 5000.0 + 37.0 * 7200.0
    length = rover.edge_frame(1).distance
    for _ in range(120):
        energy += 37.0 * (45.0 + time) + cost * 47.0 * length
    assert trips.cost_of_travel(120 * length) == pytest.approx(energy / (47.0 * 120 * length))
    assert trips.cost_of_travel(1e12) == pytest.approx(trips.running_cost)
    assert GIVEN.between(9.0, 3) == pytest.approx(37.0 * (135.0 + 9.0))


def test_the_rotor_of_peter():
    care = Upkeep.of(peter())
    assert care.rotor_energy == pytest.approx(0.5 * 0.14 * 800**2)
    assert (care.power, care.pause, care.spin_up_time) == (50.0, 60.0, 86_400.0)


@pytest.mark.parametrize("other", [150.0, 900.0, 2306.0])
def test_where_two_rovers_cost_the_same(other):
    trips = CmgMission(30.0, 8.0, 110.0, GIVEN)
    found = brentq(lambda D: trips.cost_of_travel(D) - other, 1e-3, 1e7, xtol=1e-9)
    assert trips.break_even(other) == pytest.approx(found, rel=1e-6)
    assert trips.break_even(trips.running_cost - 1) == np.inf


def test_no_upkeep_leaves_the_steps():
    trips = CmgMission(30.0, 8.0, 110.0, Upkeep(0.0, 0.0, 0.0, 0.0))
    assert trips.cost_of_travel(0.5) == 8.0


def test_refusals():
    trips = CmgMission(30.0, 8.0, 110.0, GIVEN)
    for distance in (0.0, -3.0, np.nan, np.inf):
        with pytest.raises(InputError, match="distance_m"):
            trips.cost_of_travel(distance)
    with pytest.raises(InputError, match="upkeep.power"):
        Upkeep(power=-1.0)
    with pytest.raises(InputError, match="upkeep.spin_up_time"):
        Upkeep(spin_up_time=np.nan)
    with pytest.raises(InputError, match="pace_s_m"):
        CmgMission(30.0, 8.0, 0.0, GIVEN)
    with pytest.raises(InputError, match="step_cost"):
        CmgMission(30.0, -8.0, 1.0, GIVEN)
    with pytest.raises(UnknownNameError, match="tetrahedron"):
        platonic_rows(["tetrahedrn"])
    with pytest.raises(InputError, match="gravity"):
        chassis_row(Chassis.named("cube"), -1.0)


@pytest.mark.parametrize("name", NAMES)
def test_the_slope_of_a_chassis_is_where_it_falls(name):
    """Tilt the ground in every direction until it does not stay."""
    chassis = Chassis.named(name, 0.4, 12.0)
    slope, up = chassis_row(chassis).slope, chassis.up(0)
    side = chassis.edge_frame(1, 0).forward
    for tilt, held in ((slope - 1e-4, [True]), (slope + 1e-4, [True, False])):
        found = set()
        for azimuth in np.radians(np.arange(0.0, 360.0, 1.0)):
            down = Rotation.from_rotvec(azimuth * up).apply(side)
            found.add(stays(chassis, 0, -np.cos(tilt) * up + np.sin(tilt) * down))
        assert found == set(held)


@pytest.mark.parametrize("name", NAMES)
def test_torques_from_the_spikes_own_loads(name):
    """Statics with the mass centre level with the edge: torque to step, load on each spike."""
    mass, gravity, chassis = 7.0, 1.9, Chassis.named(name, 0.3, 7.0)
    row, frame = chassis_row(chassis, gravity), chassis.edge_frame(2)
    a, b = chassis.vertices[list(frame.spikes)]
    middle = (a + b) / 2
    weight = mass * gravity * np.cross((b - a) / 0.3, -middle) / np.linalg.norm(middle)
    assert row.step_torque == pytest.approx(abs(np.cross(-middle, weight) @ (b - a)) / 0.3)
    across = np.cross((b - a) / 0.3, weight / np.linalg.norm(weight))
    moment = min(abs(np.cross(end, weight) @ across) for end in (a, b))
    assert row.disturbance_torque == pytest.approx(moment)
    assert row.ratio == pytest.approx(row.step_torque / row.disturbance_torque)


def test_shape_does_not_depend_on_size_mass_or_gravity():
    small, large = platonic_rows(), platonic_rows(NAMES, 3.0, 200.0, 9.81)
    for one, two in zip(small, large, strict=True):
        assert (one.slope, one.ratio) == pytest.approx((two.slope, two.ratio))
        assert two.distance == pytest.approx(3.0 * one.distance)
        assert two.step_torque == pytest.approx(600.0 * 9.81 / 3.711 * one.step_torque)


def test_a_chassis_of_ones_own():
    """A long box: worst is the step over its long side's short edge, best slope the flat side's."""
    box = np.array([[x, y, z] for x in (-1, 1) for y in (-0.3, 0.3) for z in (-0.1, 0.1)], float)
    row = chassis_row(Chassis.uniform(box, 5.0, "box"))
    assert row.slope == pytest.approx(np.arctan(0.1 / 1.0))
    assert row.ratio == pytest.approx(np.hypot(1.0, 0.3) / 0.1)
    assert row.distance == pytest.approx(0.1 + 0.3)
