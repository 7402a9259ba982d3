"""What a run holds of wheels whose speed changes, as named variables with units."""

from __future__ import annotations

import numpy as np

from nullmotion.scenario import estimates
from nullmotion.scenario.variable import Row, Variable
from nullmotion.sim.trajectory import Trajectory

WITH_WHEELS = (
    " Wheel speeds change: h_i = I_i wheel_speed_i (...), torque is A delta_dot + C_W I wheel "
    "acceleration, with C_W the spin axes; h0 and the singularity measures are those at the speeds "
    "that the array was designed for. Estimates are the controller's, from zero."
)
_CMG = ("time", "cmg")
WHEELS: tuple[Row, ...] = (
    ("wheel_speed", _CMG, "rad s-1", "wheel speed against the gimbal frame"),
    ("wheel_acceleration", _CMG, "rad s-2", "its mean derivative over the step"),
    ("wheel_motor_torque", _CMG, "N m", "torque of the wheel motor"),
    ("limited", ("time",), "1", "1 where a limit cut the torque that was asked for, else 0"),
)
DRIVEN: tuple[Row, ...] = (("motor_work", ("time",), "J", "work of all motors, less friction"),)


def labels(trajectory: Trajectory) -> dict[str, tuple[str, ...]]:
    """Return the names of places along dimensions that are told by names in files."""
    found = estimates.estimates(trajectory)
    return {f"{kind}_part": tuple(names) for kind, (names, _, _) in found.items()}


def learned(trajectory: Trajectory) -> list[Variable]:
    """Return what the controller has learned."""
    found = []
    for kind, (_, units, values) in estimates.estimates(trajectory).items():
        text = f"what the controller has learned: {kind.replace('_', ' ')}"
        dims = ("time", f"{kind}_part")
        found.append(Variable(f"estimated_{kind}", dims, values, units, text))
    return found


def flywheels(trajectory: Trajectory) -> list[Variable]:
    """Return what does not change of wheels and units."""
    setup, one = trajectory.setup, ("cmg",)
    known, real, units = setup.array.flywheels, setup.true_array.flywheels, setup.units
    rows: list[tuple[str, object, str, str]] = [
        ("design_wheel_speed", setup.array.design_speed, "rad s-1", "wheel speed that gives h0"),
        ("wheel_inertia", known.inertia, "kg m2", "spin inertia of the wheel as the law knows it"),
        ("true_wheel_inertia", real.inertia, "kg m2", "spin inertia of the wheel as it is"),
        ("wheel_torque_limit", known.torque_limit, "N m", "largest torque of the wheel motor"),
        ("wheel_speed_limit", known.speed_limit, "rad s-1", "largest wheel speed"),
        ("wheel_power_limit", known.power_limit, "W", "largest power of the wheel motor"),
    ]
    if units is not None:
        for axis in ("spin", "transverse", "gimbal"):
            text = f"inertia of the unit, wheel included, about its {axis} axis"
            value = getattr(units, f"{axis}_inertia")
            rows.append((f"unit_{axis}_inertia", value, "kg m2", text))
    return [Variable(name, one, np.asarray(v, float), unit, text) for name, v, unit, text in rows]
