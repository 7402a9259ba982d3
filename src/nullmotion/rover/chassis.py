"""A chassis: a convex polyhedron that stands on spikes at its corners and rolls over its edges.

    N_j = r . I r + M d_j^2            inertia about edge j, d_j away from the mass centre
    g   = argmin over |g| = 1 of max_j |e_j . g|                         (Elliott 2019, Eq 68)

Body axes of a named solid: the first face is down, b3 up, its first edge along +b1. Edges count
from 1, as in the paper: those of the first face counter-clockwise from above, then the others from
the lowest, counter-clockwise from +b2, so that e4, e5, e6 of the tetrahedron lie opposite to
e1, e2, e3. Faces and corners count from 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover import polyhedron, polyhedron_order
from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.gimbal_axis import best_axis
from nullmotion.spacecraft.body import checked_inertia


@dataclass(frozen=True, eq=False)
class Chassis:
    """A rigid convex body; spikes are at its corners.

    Args:
        vertices: Spike tips about the mass centre, in body axes [m], (V, 3).
        mass: Mass of the whole rover [kg].
        inertia: Inertia about the mass centre [kg m^2], (3, 3).
        name: What to call it.

    Raises:
        InputError: For points that are not the corners of a convex body around the mass centre,
            a mass that is not above 0, or an inertia that no body has.
    """

    vertices: np.ndarray
    mass: float
    inertia: np.ndarray
    name: str = "polyhedron"

    def __post_init__(self) -> None:
        """Check what can be checked."""
        put = object.__setattr__
        put(self, "vertices", polyhedron.checked_points(self.vertices))
        put(self, "mass", positive("mass", self.mass))
        put(self, "inertia", checked_inertia("inertia", self.inertia))
        if min(-self.vertices[face[0]] @ self.up(i) for i, face in enumerate(self.faces)) <= 0:
            allowed = "corners around the mass centre (0, 0, 0)"
            raise InputError("vertices", self.vertices.tolist(), allowed)

    @classmethod
    def named(cls, name: str, edge_length: float = 1.0, mass: float = 1.0) -> Chassis:
        """Return a platonic solid of uniform density.

        Args:
            name: ``tetrahedron``, ``cube``, ``octahedron``, ``dodecahedron`` or ``icosahedron``.
            edge_length: L [m].
            mass: M [kg].

        Raises:
            InputError: For an unknown name (with the nearest), or a length or mass not above 0.
        """
        points = positive("edge_length", edge_length) * polyhedron.platonic(name)
        return cls.uniform(points, mass, name)

    @classmethod
    def uniform(cls, points: Any, mass: float, name: str = "polyhedron") -> Chassis:
        """Return the convex body of uniform density with these corners [m], (V, 3).

        Raises:
            InputError: As for the class.
        """
        corners = polyhedron.checked_points(points)
        body = polyhedron.solid(corners, polyhedron.faces_of(corners))
        return cls(corners - body.centre, mass, positive("mass", mass) * body.inertia, name)

    @cached_property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """Corners of each face, counter-clockwise seen from inside; the lowest face first."""
        return polyhedron_order.sorted_faces(self.vertices)

    @cached_property
    def edges(self) -> np.ndarray:
        """Corners (from, to) of each edge, (E, 2): row j - 1 is edge j."""
        return polyhedron_order.sorted_edges(self.vertices, self.faces)

    def up(self, face: int) -> np.ndarray:
        """Return the unit normal of a face that points up when the face is on the ground."""
        a, b, c = self.vertices[list(self.faces[face][:3])]
        normal = np.cross(b - a, c - b)
        return normal / np.linalg.norm(normal)

    def faces_at(self, edge: int) -> tuple[int, int]:
        """Return the two faces at an edge, the lower number first.

        Raises:
            InputError: For an edge that the chassis does not have.
        """
        if not (isinstance(edge, int | np.integer) and 1 <= edge <= len(self.edges)):
            raise InputError("edge", edge, f"an edge of the {self.name}: 1 to {len(self.edges)}")
        pair = set(self.edges[edge - 1])
        low, high = (i for i, face in enumerate(self.faces) if pair <= set(face))
        return low, high

    def edge_frame(self, edge: int, face: int | None = None) -> EdgeFrame:
        """Return the frame of a step over an edge.

        Args:
            edge: Edge, from 1.
            face: Face on the ground before the step; the lower number of the two by default.

        Raises:
            InputError: For an edge or a face that it cannot start from.
        """
        around = self.faces_at(edge)
        start = around[0] if face is None else face
        if start not in around:
            raise InputError("face", face, f"a face at edge {edge}: {around[0]} or {around[1]}")
        end = around[1] if start == around[0] else around[0]
        pair = [int(i) for i in self.edges[edge - 1]]
        loop = self.faces[start]
        if loop[(loop.index(pair[0]) + 1) % len(loop)] != pair[1]:
            pair.reverse()
        a, b = self.vertices[pair]
        return EdgeFrame.between(
            edge, (start, end), (pair[0], pair[1]), a, b, self._ups(start, end)
        )

    def _ups(self, start: int, end: int) -> tuple[np.ndarray, np.ndarray]:
        return self.up(start), self.up(end)

    def inertia_about_edge(self, edge: int) -> float:
        """Return N, the inertia about an edge [kg m^2]."""
        frame = self.edge_frame(edge)
        return float(frame.r @ self.inertia @ frame.r + self.mass * frame.com_distance**2)

    def com_to_edge(self, edge: int) -> float:
        """Return d, the distance of the mass centre from an edge [m]."""
        return self.edge_frame(edge).com_distance

    def step_angle(self, edge: int) -> float:
        """Return the angle by which the chassis turns in a step over an edge [rad]."""
        return self.edge_frame(edge).turn

    def gimbal_axis(self) -> np.ndarray:
        """Return the gimbal axis whose greatest projection on an edge is least (Eq 68), (3,)."""
        ends = self.vertices[self.edges]
        return best_axis(ends[:, 1] - ends[:, 0])


def positive(key: str, value: Any) -> float:
    """Return a finite number above 0, or refuse it."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not 0 < number < np.inf:
        raise InputError(key, value, "a finite number above 0")
    return number
