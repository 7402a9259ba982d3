"""What has to be flown: slew axes, which CMG has failed, what momentum the array holds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.sizing.axes import frames
from nullmotion.sizing.requirement import Requirement

NONE_FAILED = -1


class Cases(NamedTuple):
    """Slews to fly.

    Attributes:
        axis: Unit vectors in B, (k, 3).
        failed: Number of the CMG that has failed, -1 if none has, (k,).
        bias: Momentum of the array before the slew [N m s], (k, 3).
    """

    axis: np.ndarray
    failed: np.ndarray
    bias: np.ndarray

    def __len__(self) -> int:
        """Return the number of slews."""
        return len(self.axis)

    def picked(self, which: np.ndarray) -> Cases:
        """Return some of the slews, by index or mask."""
        return Cases(self.axis[which], self.failed[which], self.bias[which])

    def joined(self, other: Cases) -> Cases:
        """Return these slews and others."""
        pairs = zip(self.fields, other.fields, strict=True)
        return Cases(*(np.concatenate(pair) for pair in pairs))

    @property
    def fields(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The three arrays."""
        return self.axis, self.failed, self.bias


def multiplicity(requirement: Requirement, n: int) -> int:
    """Return how many slews there are for each axis: CMGs that fail, directions of the bias."""
    return len(_failures(requirement, n)) * len(biases(requirement, np.eye(3)[:1])[0])


def cases(requirement: Requirement, n: int, axes: np.ndarray) -> Cases:
    """Return all slews about axes (k, 3) for an array of n CMGs."""
    held = biases(requirement, axes)
    failed = np.array(_failures(requirement, n))
    count, ways = len(failed), held.shape[1]
    return Cases(
        np.repeat(axes, count * ways, axis=0),
        np.tile(np.repeat(failed, ways), len(axes)),
        np.repeat(held, count, axis=0).reshape(-1, 3) if ways == 1 else _spread(held, count),
    )


def biases(requirement: Requirement, axes: np.ndarray) -> np.ndarray:
    """Return the momenta that the array may hold before a slew about axes, (k, ways, 3).

    Of a momentum in any direction: along the slew's own momentum J e, against it, and across.
    """
    given = requirement.disturbance.momentum_Nms
    if isinstance(given, tuple):
        return np.tile(np.array(given, float), (len(axes), 1, 1))
    if given == 0:
        return np.zeros((len(axes), 1, 3))
    along = axes @ requirement.inertia
    C = frames(along / np.linalg.norm(along, axis=1, keepdims=True))
    return given * np.concatenate([C, -C], axis=1)


def _failures(requirement: Requirement, n: int) -> list[int]:
    return [NONE_FAILED, *range(n)] if requirement.failures else [NONE_FAILED]


def _spread(held: np.ndarray, count: int) -> np.ndarray:
    return np.repeat(held[:, None], count, axis=1).reshape(-1, 3)
