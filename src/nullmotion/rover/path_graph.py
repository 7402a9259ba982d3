"""All steps that a rover can make on a ground: the graph in which a path is searched.

Each cell of the lattice gives a footprint: three points on the ground, a plane through them, and
three steps. A step is charged for the plane that it leaves and for the one that it lands on: it
takes the mean energy and time of both and the lesser margin. It is refused where the rover could
not stay on either, where the `StepCost` refuses it on either, and where the ground is unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.rover.path_cost import StepCost, StepCosts
from nullmotion.rover.path_lattice import Lattice
from nullmotion.rover.terrain import HeightField


@dataclass(frozen=True, eq=False)
class StepGraph:
    """Cells and the steps between them.

    Attributes:
        lattice: Where the cells are.
        cells: Cells, (n, 3).
        following: Number of the cell behind each corner, (n, 3); -1 for none.
        steps: Energies [J], times [s], margins [N m], (n, 3) each; energy inf where refused.
        pitch: Slope of each cell towards the edge opposite to each corner [rad], (n, 3).
        stays: Whether the rover stays on a cell without its actuator, (n,).
    """

    lattice: Lattice
    cells: np.ndarray
    following: np.ndarray
    steps: StepCosts
    pitch: np.ndarray
    stays: np.ndarray

    def number(self, cell: np.ndarray) -> int:
        """Return the number of a cell; -1 if it is not on the ground."""
        found = np.flatnonzero((self.cells == cell).all(axis=1))
        return int(found[0]) if len(found) else -1

    def step_near(self, before: np.ndarray, after: np.ndarray) -> tuple[int, int]:
        """Return the cell, and the corner that it leaves, of the step nearest to one on the map."""
        gap = np.linalg.norm(self.lattice.middles(self.cells) - before, axis=1)
        cell = int(np.argmin(gap))
        beyond = self.lattice.middles(self.lattice.behind(self.cells[cell]))
        return cell, int(np.argmin(np.linalg.norm(beyond - after, axis=1)))


def step_graph(field: HeightField, lattice: Lattice, cost: StepCost, steepest: float) -> StepGraph:
    """Return all steps on a ground.

    Args:
        field: The ground.
        lattice: Where the spikes can come to stand.
        cost: What a step costs.
        steepest: Slope towards an edge beyond which the rover falls over it [rad].
    """
    cells = lattice.cells_on(field)
    feet = lattice.feet(cells)
    a, b = np.roll(feet, -1, axis=1), np.roll(feet, -2, axis=1)
    pitch, cross = slopes(field.points(lattice.corners(cells)))
    following = _numbered(cells, lattice.behind(cells))
    stays = pitch.min(axis=1, initial=np.inf) > -steepest
    leaving = cost(a, b, pitch, cross)
    back = np.argmax(
        following[following] == np.arange(len(cells))[:, None, None], axis=2
    )  # the corner through which the step would be undone
    beyond = np.take_along_axis(pitch[following], back[..., None], axis=2)[..., 0]
    tilt = np.take_along_axis(cross[following], back[..., None], axis=2)[..., 0]
    landing = cost(a, b, -beyond, -tilt)
    energy = 0.5 * (leaving.energy + landing.energy)
    made = (following >= 0) & stays[:, None] & stays[following] & np.isfinite(energy)
    steps = StepCosts(
        np.where(made, energy, np.inf),
        0.5 * (leaving.time + landing.time),
        np.minimum(leaving.margin, landing.margin),
    )
    return StepGraph(lattice, cells, following, steps, pitch, stays)


def slopes(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return pitch and cross slope for leaving each corner of footprints [rad], (..., 3).

    With e along the edge opposite to a corner (counter-clockwise), n the normal of the footprint
    and f = e x n outwards: pitch = atan2(f_z, n_z), the slope that gravity across the edge sees,
    and cross = asin(e_z).

    Args:
        corners: Corners of footprints, counter-clockwise from above [m], (..., 3, 3).
    """
    along = np.roll(corners, -2, axis=-2) - np.roll(corners, -1, axis=-2)
    normal = np.cross(along[..., 0, :], along[..., 1, :])[..., None, :]
    e, n = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (along, normal))
    outward = np.cross(e, n)
    return np.arctan2(outward[..., 2], n[..., 2]), np.arcsin(e[..., 2])


def _numbered(cells: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the rows in `cells` (n, 3) of neighbours of them (..., 3); -1 where none is."""
    first = cells.min(axis=0, initial=0) - 1
    span = cells.max(axis=0, initial=0) - first + 2
    rows = np.full(span, -1)
    rows[tuple((cells - first).T)] = np.arange(len(cells))
    found: np.ndarray = rows[tuple(np.moveaxis(wanted - first, -1, 0))]
    return found
