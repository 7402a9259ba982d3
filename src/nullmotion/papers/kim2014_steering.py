"""What the steering law of Kim et al. 2012 does inside, along a run.

The law's command is the weighted inverse Q_W^+ hdot with null motion on top (Eq 27). Its first
part is computed again here, from the run's states and estimates.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.compile import compile_function
from nullmotion.sim import Setup, Trajectory
from nullmotion.spacecraft.controller import AttitudeObservation


def determinant(array: CmgArray, delta: np.ndarray) -> np.ndarray:
    """Return det(C_T C_T^T) = -f at gimbal angles (k, n), (k,)."""
    across = array.transverse_directions(delta)
    found: np.ndarray = np.linalg.det(across @ across.transpose(0, 2, 1))
    return found


def weights(law: Any, det: np.ndarray) -> np.ndarray:
    """Return s_w = sech(1 / (k_d det + epsilon)) and s_g = sech(k_g det), (k, 2)."""
    return 1.0 / np.cosh(np.stack([1.0 / (law.k_d * det + law.epsilon), law.k_g * det], axis=1))


def ranged(run: Trajectory, det: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return Q_W^+ hdot: wheel accelerations [rad/s^2] and gimbal rates [rad/s], (k, n) each.

    Args:
        run: A startup under the law as published; every row a sample of it.
        det: From `determinant`, (k,).
    """
    law: Any = run.setup.law
    n, Q = run.setup.array.n, torque_matrices(run)
    weight = np.empty((len(Q), 2 * n))
    weight[:, :n] = (law.W_Omega0 * np.exp(-law.lambda1 * det))[:, None]
    weight[:, n:] = law.W_delta
    weighted = Q * weight[:, None, :]
    y = np.linalg.solve(weighted @ Q.transpose(0, 2, 1), run.hdot[..., None])
    command = np.einsum("kij,ki->kj", weighted, y[..., 0])
    return command[:, :n], command[:, n:]


def torque_matrices(run: Trajectory) -> np.ndarray:
    """Return Q as the controller estimates it, (k, 3, 2n)."""
    setup: Setup = run.setup
    controller: Any = setup.controller
    assert setup.reference is not None and run.estimates is not None
    array, blank = setup.array, controller.init(setup.array)

    def source(q: Any, omega: Any, row: Any, delta: Any, speed: Any, theta2: Any) -> Any:
        spun = array.altered(h0=array.flywheels.inertia * speed)
        reference = row[:4], row[4:7], row[7:10]
        obs = AttitudeObservation(q, omega, *reference, None, None, 0.0, setup.period, spun, delta)
        return controller.torque_matrix(obs, blank._replace(theta2=theta2))

    rows = np.minimum(np.arange(len(run.t)), len(setup.reference) - 1)
    first = len(blank.theta1)
    theta2 = run.estimates[:, first : first + len(blank.theta2)]
    state = run.q_BN, run.omega_BN_B, setup.reference[rows], run.delta, run.wheel_speed, theta2
    given = tuple(np.ascontiguousarray(part) for part in state)
    found: np.ndarray = compile_function(source, *(part[0] for part in given))(*given)
    return found
