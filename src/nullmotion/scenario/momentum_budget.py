"""The momentum that a spacecraft has from outside against what its array can hold."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion import rotation
from nullmotion.array import CmgArray
from nullmotion.scenario import attitude, start, vehicle, vscmg_units
from nullmotion.scenario.scenario import Scenario
from nullmotion.vscmg import Units, dynamics

_SAME = 1e-9  # half angle between two attitudes that count as one [rad]


class Budget(NamedTuple):
    """Momentum to be held at the end [N m s].

    Attributes:
        start: Total angular momentum at the start in N, body, units and wheels, (3,).
        outside: What a constant torque from outside adds until the end, in N, (3,).
        needed: Size of their sum.
        available: Upper bound of the array's momentum in their direction at the speeds
            that it was designed for.
    """

    start: np.ndarray
    outside: np.ndarray
    needed: float
    available: float


def budget(scenario: Scenario, array: CmgArray) -> Budget:
    """Return the momentum budget of a run with variable wheel speeds.

    The attitude is taken as the one asked for at the end, from the start on: a short turn
    to it changes little of what a constant torque of the body frame adds up to.

    Args:
        scenario: A run that turns a spacecraft, its sections checked each by itself.
        array: Its array that works.
    """
    begun, outside = momentum_at_start(scenario, array), _outside(scenario)
    total = begun + outside
    needed = float(np.linalg.norm(total))
    direction = rotation.matrix(end_attitude(scenario)) @ total
    return Budget(begun, outside, needed, held_at_most(array, direction))


def momentum_at_start(scenario: Scenario, array: CmgArray) -> np.ndarray:
    """Return the total angular momentum at the start in N [N m s], (3,)."""
    assert scenario.spacecraft is not None
    craft = vehicle.spacecraft(scenario.spacecraft)
    delta = start.angles(scenario.array, scenario.initial, array)
    made = Units(0.0, 0.0, 0.0)
    if scenario.vscmg is not None:
        made = vscmg_units.made(scenario.vscmg, scenario.array, array.n)
    units = made.for_n(array.n)
    rest = dynamics.rest_inertia(array, units, craft.inertia, delta)
    row = [delta, craft.omega_BN_B, np.zeros(array.n), vscmg_units.wheel_speed(scenario, array)]
    total = dynamics.total_momentum(array, units, rest, *(part[None] for part in row))[0]
    in_N: np.ndarray = rotation.matrix(craft.q_BN).T @ total
    return in_N


def end_attitude(scenario: Scenario) -> np.ndarray:
    """Return the attitude asked for at the end, q_RN."""
    target = attitude.target(scenario)
    if target is not None:
        return target
    assert scenario.spacecraft is not None
    craft = vehicle.spacecraft(scenario.spacecraft)
    times = np.array([scenario.simulation.duration_s])
    reference = attitude.reference(scenario, craft.q_BN, times)
    assert reference is not None
    last: np.ndarray = reference[-1, :4]
    return last


def held_at_most(array: CmgArray, direction: np.ndarray) -> float:
    """Return an upper bound of the array's momentum along a direction in B [N m s].

    Each rotor's largest projection, h0_i sin(angle between gimbal axis and direction): the
    array's envelope reaches as far where the other components cancel, else less far.
    """
    size = np.linalg.norm(direction)
    along = direction / size if size > 0 else direction
    across = np.sqrt(np.maximum(0.0, 1.0 - (array.gimbal_axes @ along) ** 2))
    return float(array.h0 @ across + array.momentum_bias @ along)


def _outside(scenario: Scenario) -> np.ndarray:
    """Return what the constant torque adds in N until the end [N m s], (3,)."""
    if scenario.disturbance is None:
        return np.zeros(3)
    given = np.array(scenario.disturbance.constant_Nm, float) * scenario.simulation.duration_s
    in_N: np.ndarray = rotation.matrix(end_attitude(scenario)).T @ given
    return in_N


def shortfall(scenario: Scenario, array: CmgArray) -> tuple[float, float] | None:
    """Return what has to be held and what can be held, where the array surely cannot; else None.

    Nothing is said of runs whose momentum can be taken off, or whose torque from outside is
    not known beforehand. A harmonic torque may take back at most |amplitude| / (pi frequency);
    a constant one while the attitude changes, all that it adds up to.
    """
    section = scenario.disturbance
    if scenario.desaturation is not None or (section and section.altitude_km is not None):
        return None
    found = budget(scenario, array)
    spread = 1.0 + scenario.mission.wheel_tolerance
    needed, held = found.needed, found.available
    if np.any(found.outside) and _turns(scenario):
        needed = float(np.linalg.norm(found.start) - np.linalg.norm(found.outside))
        held = float(np.sum(array.h0) + np.linalg.norm(array.momentum_bias))
    if section is not None and section.amplitude_Nm is not None and section.frequency_Hz:
        needed -= float(np.linalg.norm(section.amplitude_Nm)) / (np.pi * section.frequency_Hz)
    held = held * spread + _body_at_end(scenario)
    return (needed, held) if needed > held else None


def _turns(scenario: Scenario) -> bool:
    """Return whether the attitude asked for is another than that at the start."""
    assert scenario.spacecraft is not None
    if attitude.target(scenario) is None:
        return True
    q = vehicle.spacecraft(scenario.spacecraft).q_BN
    error = rotation.multiply(rotation.conjugate(end_attitude(scenario)), q)
    return bool(np.linalg.norm(error[1:]) > _SAME)


def _body_at_end(scenario: Scenario) -> float:
    """Return the most momentum of a body that follows a profile's rate at the end [N m s]."""
    if scenario.mission.profile is None or scenario.spacecraft is None:
        return 0.0
    craft = vehicle.spacecraft(scenario.spacecraft)
    times = np.array([scenario.simulation.duration_s])
    reference = attitude.reference(scenario, craft.q_BN, times)
    assert reference is not None
    largest = float(np.linalg.eigvalsh(craft.inertia)[-1])
    return largest * float(np.linalg.norm(reference[-1, 4:7]))
