"""Which steps of a tetrahedral rover are alike.

A step depends on the gimbal axis g = (g_f, g_r, g_p) in the frame of its edge (forward, along the
edge, up). Two steps cost the same if their axes agree up to

- the sign of g: the gimbal then turns the other way;
- the sign of g_r beside that of both others: reflection in the plane across the edge, under which
  angular momentum along the edge stays and across it changes sign.

So g counts as (|g_r|, g_f, g_p) with g_f, g_p up to a common sign. PETER has two kinds: e1, e3,
e4, e6 and e2, e5, from either face (Elliott 2019, Section 5.5.2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import Chassis
from nullmotion.rover.rover import Rover

_ALIKE = 1e-6


@dataclass(frozen=True, eq=False)
class StepKinds:
    """The kinds of steps of a rover.

    Attributes:
        of: Kind of the step about the edge from spike a to b (turning positively about a -> b),
            (V, V); -1 for a = b.
        examples: One step of each kind: edge, from 1, and the face it starts from.
    """

    of: np.ndarray
    examples: tuple[tuple[int, int], ...]

    def name(self, kind: int) -> str:
        """Return the edge of the kind's example as the paper writes it."""
        return f"e{self.examples[kind][0]}"


def kinds(rover: Rover) -> StepKinds:
    """Return the kinds of steps of a rover.

    Raises:
        InputError: For a chassis that is not a regular tetrahedron with its mass centre in the
            middle: others do not keep to a triangular lattice.
    """
    check_tetrahedron(rover.chassis)
    of = np.full((4, 4), -1)
    found: list[np.ndarray] = []
    examples = []
    for edge in range(1, 7):
        for face in rover.chassis.faces_at(edge):
            frame = rover.chassis.edge_frame(edge, face)
            form = _form(frame.axes @ rover.cmg.gimbal_axis)
            like = [k for k, known in enumerate(found) if np.abs(form - known).max() < _ALIKE]
            if not like:
                found.append(form)
                examples.append((edge, face))
            of[frame.spikes] = like[0] if like else len(found) - 1
    return StepKinds(of, tuple(examples))


def check_tetrahedron(chassis: Chassis) -> float:
    """Return the edge length [m] of a regular tetrahedron, or refuse another chassis."""
    points = chassis.vertices
    allowed = "a regular tetrahedron about its mass centre, which keeps to a triangular lattice"
    if len(points) != 4:
        raise InputError("rover.chassis", chassis.name, allowed)
    gaps = np.linalg.norm(points[:, None] - points, axis=2)[np.triu_indices(4, 1)]
    size = float(gaps.mean())
    if np.ptp(gaps) > 1e-6 * size or np.linalg.norm(points.mean(axis=0)) > 1e-6 * size:
        raise InputError("rover.chassis", chassis.name, allowed)
    # a step has the same inertia about every edge only if the mass is spread alike
    moments = np.linalg.eigvalsh(chassis.inertia)
    if np.ptp(moments) > 1e-6 * moments[-1]:
        raise InputError("rover.inertia", moments.tolist(), "equal principal moments")
    return size


def _form(axis: np.ndarray) -> np.ndarray:
    """Return (|g_r|, g_f, g_p), the larger of the last two positive."""
    forward, along, up = axis
    across = np.array([forward, up])
    largest = across[np.argmax(np.abs(across) > np.abs(across).max() - _ALIKE)]
    return np.array([abs(along), *(across * (1.0 if largest >= 0 else -1.0))])
