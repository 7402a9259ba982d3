"""How an array is the one that a constraint function holds, seen from another frame.

An array fits when one rotation R of the body axes lays its gimbal axes on those of the
constraint's layout, up to their signs. Where gimbal angles are counted from, and which way, is
then a shift and a sign for each CMG:

    angle_p = sign_p delta_i + zero_p,    place p of the layout, CMG i of the array
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import TraceError
from nullmotion.guarantee._axes import CLOSE, places, rotations
from nullmotion.guarantee.constraint import Constraint

_EXACT = 1e-12  # what is this near a whole number is meant as one


@dataclass(frozen=True, eq=False)
class Fit:
    """An array in the frame and the angles of a layout.

    Attributes:
        cmgs: CMG of the array at each place of the layout.
        signs: +1, or -1 where the gimbal axis points the other way, by place, (n,).
        zeros: Angle of each place at delta = 0 [rad], (n,).
        turn: Momentum in the array's torque axes to momentum in the layout's, (m, m).
        likeness: Sum of the cosines between the array's gimbal and spin axes and the layout's;
            2 n where only the body axes are turned.
    """

    cmgs: tuple[int, ...]
    signs: np.ndarray
    zeros: np.ndarray
    turn: np.ndarray
    likeness: float

    def angles(self, delta: Any) -> Any:
        """Return the layout's gimbal angles [rad], by place; source."""
        return self.signs * delta[list(self.cmgs)] + self.zeros

    def changes(self, changes: Any) -> Any:
        """Return differences or rates of the array's CMGs for those of the places; source."""
        return (self.signs * changes)[np.argsort(self.cmgs)]


def fit(constraint: Constraint, array: CmgArray) -> Fit | str:
    """Return how an array is the one that a constraint holds, or why it is not.

    Momenta are not compared: see `nullmotion.guarantee.tracking`.

    Raises:
        TraceError: When the axes are symbols: they differ between the runs of a batch.
    """
    axes = (array.gimbal_axes, array.spin_axes, array.torque_axes)
    if ops.is_symbolic(*axes):
        raise TraceError("a constraint must know the gimbal axes: run by run where they differ")
    key = tuple((a.shape, a.tobytes()) for a in map(np.ascontiguousarray, axes))
    return _fit(constraint, key)


@lru_cache(maxsize=256)
def _fit(constraint: Constraint, axes: tuple[tuple[tuple[int, ...], bytes], ...]) -> Fit | str:
    model, name = constraint.array(), constraint.name
    gimbal, spin, torque = (np.frombuffer(raw).reshape(shape) for shape, raw in axes)
    if len(gimbal) != model.n:
        return f"{name} holds {model.n} CMGs, not {len(gimbal)}"
    if len(torque) != model.m:
        return f"{name} holds an array of {model.m} torque dimensions, not {len(torque)}"
    best: tuple[float, np.ndarray, list[int]] | None = None
    for R in rotations(gimbal, spin, model):
        at = places(gimbal @ R.T, model.gimbal_axes)
        if at is not None:
            likeness = np.sum((gimbal @ R.T) * model.gimbal_axes[at])
            likeness += np.sum((spin @ R.T) * model.spin_axes[at])
            if best is None or likeness > best[0] + CLOSE:
                best = likeness, R, at
    if best is None:
        return (
            f"its gimbal axes are not those of {constraint.layout} ({name}), however it is turned"
        )
    likeness, R, at = best
    turned = gimbal @ R.T, spin @ R.T, torque @ R.T
    return _made(*turned, np.argsort(at), model, float(likeness))


def _made(
    gimbal: np.ndarray,
    spin: np.ndarray,
    torque: np.ndarray,
    cmgs: np.ndarray,
    model: CmgArray,
    likeness: float,
) -> Fit:
    """Return the fit of axes that are turned already."""
    signs = np.sign(np.sum(gimbal[cmgs] * model.gimbal_axes, axis=1))
    along = np.sum(spin[cmgs] * model.spin_axes, axis=1)
    across = np.sum(spin[cmgs] * model.transverse_axes, axis=1)
    zeros = np.arctan2(_plain(across), _plain(along))
    basis = model.torque_axes
    assert basis is not None
    return Fit(tuple(cmgs.tolist()), signs, zeros, _plain(basis @ torque.T), likeness)


def _plain(values: np.ndarray) -> np.ndarray:
    """Return values with those that are meant as whole numbers made so."""
    whole = np.rint(values)
    return np.where(np.abs(values - whole) < _EXACT, whole + 0.0, values)
