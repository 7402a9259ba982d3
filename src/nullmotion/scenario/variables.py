"""What a run holds, as named variables with units, whatever file they go to."""

from __future__ import annotations

import numpy as np

from nullmotion import rotation
from nullmotion.scenario import variables_vscmg
from nullmotion.scenario.variable import Row, Variable
from nullmotion.sim.trajectory import Trajectory

CONVENTIONS = (
    "SI units and radians; vectors in body frame B along torque_axes. CMG i (counted from 0) "
    "has gimbal axis g_i, spin axis s_i at delta_i = 0, t_i = g_i x s_i, momentum "
    "h_i = h0_i (s_i cos delta_i + t_i sin delta_i); A = dh/d(delta). hdot is the commanded rate "
    "of the array's momentum, torque the achieved A delta_dot; the vehicle gets "
    "-A delta_dot - omega x h. Rates act from their row's time to the next row's; the last row "
    "has none. Singularity measures are those of A over the mean momentum of the working CMGs."
)
WITH_BODY = (
    " Quaternions are scalar first, q_BN turns N into B: v_B = C(q_BN) v_N, "
    "q_dot = 1/2 q * [0, omega]; omega_BN_B is the rate of B against N in B. pointing_error is the "
    "angle of reference^-1 * q_BN. euler_321 are yaw, pitch and roll, turned in this order about "
    "z, y and x. inertial_momentum is that of spacecraft and array in N."
)
_CMG, _AXIS, _QUATERNION = ("time", "cmg"), ("time", "torque_axis"), ("time", "quaternion")
_HISTORY: tuple[Row, ...] = (
    ("delta", _CMG, "rad", "gimbal angle (true)"),
    ("rates", _CMG, "rad s-1", "gimbal rate applied"),
    ("rates_asked", _CMG, "rad s-1", "gimbal rate asked by the law, before the rate limit"),
    ("hdot", _AXIS, "N m", "commanded rate of momentum"),
    ("torque", _AXIS, "N m", "achieved rate of momentum A delta_dot"),
    ("momentum", _AXIS, "N m s", "momentum of the array"),
    ("momentum_wanted", _AXIS, "N m s", "start momentum and integral of the command"),
    ("impulse", _AXIS, "N m s", "integral of the achieved torque"),
    (
        "eram",
        _CMG,
        "1",
        "effective residual angular momentum over the mean momentum (Mao 2019, Eq 28)",
    ),
)
_BODY: tuple[Row, ...] = (
    ("q_BN", _QUATERNION, "1", "attitude of B against N, scalar first"),
    ("omega_BN_B", ("time", "body_axis"), "rad s-1", "body rate in B"),
    ("reference", _QUATERNION, "1", "attitude asked for, q_RN, scalar first"),
    ("pointing_error", ("time",), "rad", "angle between the attitude and the one asked for"),
    (
        "inertial_momentum",
        ("time", "inertial_axis"),
        "N m s",
        "angular momentum of spacecraft and array in N",
    ),
)
_SERVO: tuple[Row, ...] = (
    ("speed", _CMG, "rad s-1", "gimbal rate at this instant; rates are its means over steps"),
)
_WHEEL: tuple[Row, ...] = (
    ("wheel_momentum", ("time",), "N m s", "momentum of the reaction wheel along its axis"),
    ("wheel_torque", ("time",), "N m", "rate of the reaction wheel's momentum"),
)
_MOTOR: tuple[Row, ...] = (("motor_torque", _CMG, "N m", "torque of the gimbal motor on its axis"),)
_MEASURES = {
    "sigma_min": "least singular value of A over the mean momentum",
    "sqrt_det_AAT": "manipulability sqrt(det(A A^T)) of A over the mean momentum",
    "condition_number": "ratio of the extreme singular values of A",
    "residual_momentum": "sum of the effective residual momenta over the mean momentum",
    "momentum_state": "singularity state estimation sse (Mao 2019)",
}
# what places along a dimension are called in a table, where they are no counts
LABELS = {
    "body_axis": ("x", "y", "z"),
    "inertial_axis": ("x", "y", "z"),
    "angle": ("yaw", "pitch", "roll"),
}
# what a column's name ends in for each unit
UNITS = {
    "1": "",
    "s": "_s",
    "rad": "_rad",
    "rad s-1": "_rad_s",
    "rad s-2": "_rad_s2",
    "N m": "_Nm",
    "N m s": "_Nms",
    "J": "_J",
    "kg m2": "_kg_m2",
}


def variables(trajectory: Trajectory) -> list[Variable]:
    """Return everything that a run holds over time, and its geometry."""
    found = [Variable("time", ("time",), trajectory.t, "s", "time since the start")]
    for name, dims, units, text in (*_HISTORY, *_surroundings(trajectory)):
        found.append(Variable(name, dims, np.asarray(getattr(trajectory, name)), units, text))
    if trajectory.q_BN is not None:
        angles = np.asarray(rotation.euler_321(trajectory.q_BN.T)).T
        text = "yaw, pitch and roll of B against N, turned about z, y, x"
        found.append(Variable("euler_321", ("time", "angle"), angles, "rad", text))
    for name, values in trajectory.measures.items():
        text = _MEASURES.get(name, name.replace("_", " "))
        found.append(Variable(name, ("time",), np.asarray(values), "1", text))
    found += variables_vscmg.learned(trajectory)
    return [*found, *_geometry(trajectory)]


def _surroundings(trajectory: Trajectory) -> tuple[Row, ...]:
    """Return what a run holds of its spacecraft and servo, where it has them."""
    setup = trajectory.setup
    body, servo = setup.spacecraft is not None, setup.servo is not None
    driven = setup.units is not None and setup.units.drive == "torque"
    return (
        (_WHEEL if setup.reaction_wheel is not None else ())
        + (_BODY if body else ())
        + (_SERVO if servo or driven else ())
        + (_MOTOR if body or servo else ())
        + (variables_vscmg.WHEELS if setup.variable_speed else ())
        + (variables_vscmg.DRIVEN if driven else ())
    )


def _geometry(trajectory: Trajectory) -> list[Variable]:
    array, real = trajectory.setup.array, trajectory.setup.true_array
    axes, one, torque = ("cmg", "body_axis"), ("cmg",), ("torque_axis", "body_axis")
    rows: tuple[tuple[str, tuple[str, ...], object, str, str], ...] = (
        ("torque_axes", torque, array.torque_axes, "1", "directions of torque in B"),
        ("gimbal_axes", axes, array.gimbal_axes, "1", "gimbal axes in B as the law knows them"),
        (
            "spin_axes",
            axes,
            array.spin_axes,
            "1",
            "spin axes in B at delta = 0 as the law knows them",
        ),
        ("h0", one, array.h0, "N m s", "spin momentum as the law knows it"),
        ("rate_limit", one, array.rate_limit, "rad s-1", "largest gimbal rate"),
        ("true_gimbal_axes", axes, real.gimbal_axes, "1", "gimbal axes in B as they are"),
        ("true_spin_axes", axes, real.spin_axes, "1", "spin axes in B at delta = 0 as they are"),
        ("true_h0", one, real.h0, "N m s", "spin momentum as it is"),
    )
    found = [Variable(n, dims, np.asarray(v), units, text) for n, dims, v, units, text in rows]
    craft = trajectory.setup.spacecraft
    if craft is not None:
        text = "inertia of the spacecraft in B, as its file has it"
        dims = ("body_axis", "body_axis_2")
        found.append(Variable("inertia", dims, craft.inertia, "kg m2", text))
    return found + (
        variables_vscmg.flywheels(trajectory) if trajectory.setup.variable_speed else []
    )
