"""What the trajectories of Section 4.4 of Elliott 2019 leave: torque capability and measures."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from nullmotion import laws, linalg, ops
from nullmotion.array import layouts
from nullmotion.array.capability import torque_capability
from nullmotion.array.model import CmgArray
from nullmotion.compile import CompiledFunction, compile_function
from nullmotion.guarantee._two_planes import TwoPlanes
from nullmotion.guarantee.constraints.box90_cubic import Box90Cubic
from nullmotion.law import Law
from nullmotion.papers.elliott2019_courses import courses
from nullmotion.papers.elliott2019_flight import Flown, Flyer

GAINS = (0.2, 0.4, 0.6, 0.8, 1.0)  # rad/s
TRAJECTORIES = 50
SEED = 2019
SINGULAR = 0.01  # det(J J^T) below which an end counts as singular; without, it is near 2.4


@dataclass(frozen=True)
class Run:
    """All steps of all trajectories under one law, one after another.

    Attributes:
        label: Name in figures.
        edges: First step of each trajectory, and the number of all, (trajectories + 1,).
        sizes: |h| [h], (steps,).
        capability: TC, (steps,).
        measure: det(J J^T), or |det J_t| for the constraint, (steps,).
        arrived: Number of trajectories that are back at no momentum.
    """

    label: str
    edges: np.ndarray
    sizes: np.ndarray
    capability: np.ndarray
    measure: np.ndarray
    arrived: int

    def __len__(self) -> int:
        """Return the number of steps."""
        return len(self.sizes)

    @property
    def ends(self) -> np.ndarray:
        """The measure at the end of each trajectory, (trajectories,)."""
        return self.measure[self.edges[1:] - 1]

    @property
    def singular_ends(self) -> int:
        """Number of trajectories that end singular."""
        return int((self.ends < SINGULAR).sum())


class Section44:
    """The trajectories of one seed under the constraint and the local gradient."""

    def __init__(self, seed: int = SEED, count: int = TRAJECTORIES) -> None:
        """Draw the trajectories."""
        self.seed = seed
        self.constraint = Box90Cubic()
        self.array = layouts.create("box90", h0=1.0, rate_limit=1.0)
        extent = self.constraint.extent
        self.courses = courses(self.constraint.torque_capability, extent, count, seed)

    @cached_property
    def constrained(self) -> Run:
        """The runs under the constraint, TC by Eq 49."""
        law = laws.create("constraint", constraint="box90-cubic", trim=0.0)
        return self._run("CB", [law])[0]

    @cached_property
    def gradients(self) -> dict[float, Run]:
        """The runs under the local gradient by gain, TC by Eq 143 with 1 rad/s."""
        found = self._run("LG", [laws.create("local-gradient", k=k) for k in GAINS])
        return dict(zip(GAINS, found, strict=True))

    def _run(self, label: str, variants: Sequence[Law]) -> list[Run]:
        flyer = Flyer(self.array, variants, start())
        with ThreadPoolExecutor() as pool:
            flown = list(pool.map(flyer.fly, self.courses))
        return [
            self._measured(label, law, [each[i] for each in flown])
            for i, law in enumerate(variants)
        ]

    def _measured(self, label: str, law: Law, flown: Sequence[Flown]) -> Run:
        delta = np.concatenate([each.delta for each in flown])
        k = getattr(law, "k", None)
        if k is None:
            sizes, capability, measure = self._augmented(delta)
        else:
            sizes, measure = self._plain(delta)
            capability = torque_capability(self.array, delta, "local-gradient", k=k)
            label = f"{label}, k = {k:g}"
        edges = np.cumsum([0, *(len(each.delta) for each in flown)])
        return Run(label, edges, sizes, capability, measure, sum(each.arrived for each in flown))

    @cached_property
    def _augmented(self) -> CompiledFunction:
        source = partial(augmented, self.array, self.constraint)
        return compile_function(source, np.zeros(4))

    @cached_property
    def _plain(self) -> CompiledFunction:
        def source(delta: Any) -> tuple[Any, Any]:
            A = self.array.jacobian(delta)
            return linalg.norm(self.array.momentum(delta)), linalg.det(A @ A.T)

        return compile_function(source, np.zeros(4))


def start() -> np.ndarray:
    """Return the gimbal angles of Eqs 63 to 66 [rad], (4,)."""
    b = 4 * np.sqrt(6.0) / 3
    first, third = np.arccos(-b / 4), np.arccos(b / 4)
    return np.array([first, -first, third, -third])


def augmented(array: CmgArray, constraint: TwoPlanes, delta: Any) -> tuple[Any, Any, Any]:
    """Return |h|, TC by Eq 49 and |det J_t| at gimbal angles on the constraint or off it; source.

    J_t is A with the row c below, the gradient of H_x1 - (H_x - Psi)/2 (Eqs 12 and 50). With
    the minors z of A, A z = 0: det J_t = -+ c . z, and the columns of J_t^-1 that torque
    takes are A^+ - z (c A^+)/(c . z).
    """
    A, h = array.jacobian(delta), array.momentum(delta)
    slope = constraint.bias(h)[1]
    c = np.array([A[0, 0], A[0, 1], 0.0, 0.0]) - 0.5 * (np.eye(3)[0] - slope) @ A
    z, inverse = linalg.minors_null_vector(A), A.T @ linalg.adjugate(A @ A.T)
    det, square = c @ z, linalg.det(A @ A.T)
    rates = (inverse - np.outer(z, (c @ inverse) / det)) / square
    rows = np.sqrt(np.array([row @ row for row in rates]))
    return linalg.norm(h), 1.0 / ops.amax(rows), ops.absolute(det)
