"""The frame of a step over one edge.

    f, r, p     forward on the ground, along the edge (the step turns positively about it), up;
                f x r = p, all in body axes as they lie before the step
    cm/o        from the edge's middle o to the mass centre: (-d sin alpha, y, d cos alpha)
    turn        angle until the next face is on the ground (2 alpha for a regular solid)

Elliott 2019, Section 5.3 and Fig 31; N of the paper is f here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class EdgeFrame:
    """Geometry of a step over an edge; vectors in body axes, about the mass centre.

    Attributes:
        edge: Edge, from 1.
        start_face: Face on the ground before the step.
        end_face: Face on the ground after it.
        spikes: Corners (a, b) at the ends of the edge, a -> b along r.
        r: Unit vector along the edge, (3,).
        forward: Unit vector on the ground in the direction of the step, (3,).
        up: Unit normal of the ground, (3,).
        point: Middle of the edge [m], (3,).
        length: Length of the edge [m].
        turn: Angle of the whole step [rad].
    """

    edge: int
    start_face: int
    end_face: int
    spikes: tuple[int, int]
    r: np.ndarray
    forward: np.ndarray
    up: np.ndarray
    point: np.ndarray
    length: float
    turn: float

    @classmethod
    def between(
        cls,
        edge: int,
        faces: tuple[int, int],
        spikes: tuple[int, int],
        a: np.ndarray,
        b: np.ndarray,
        ups: tuple[np.ndarray, np.ndarray],
    ) -> EdgeFrame:
        """Return the frame of the edge from a to b between faces with these normals."""
        length = float(np.linalg.norm(b - a))
        r = (b - a) / length
        cosine, sine = ups[0] @ ups[1], np.cross(ups[1], ups[0]) @ r
        turn = float(np.arctan2(sine, cosine))
        return cls(edge, *faces, spikes, r, np.cross(r, ups[0]), ups[0], (a + b) / 2, length, turn)

    @property
    def axes(self) -> np.ndarray:
        """Rows f, r, p: turns body axes into the frame, (3, 3)."""
        return np.array([self.forward, self.r, self.up])

    @property
    def com(self) -> np.ndarray:
        """cm/o: the mass centre from the edge's middle, in f, r, p before the step [m], (3,)."""
        return -self.axes @ self.point

    @property
    def com_distance(self) -> float:
        """Distance of the mass centre from the edge, d [m]."""
        x, _, z = self.com
        return float(np.hypot(x, z))

    @property
    def alpha(self) -> float:
        """Angle between the plane of edge and mass centre and the ground's normal [rad].

        It is also the steepest slope on which the chassis does not fall over this edge.
        """
        x, _, z = self.com
        return float(np.arctan2(-x, z))

    @property
    def distance(self) -> float:
        """How far the mass centre gets along the ground in a step [m]."""
        return float(self.com_distance * (np.sin(self.alpha) + np.sin(self.turn - self.alpha)))

    def rotation(self, theta: float) -> np.ndarray:
        """Return what turns body axes into f, r, p after turning by theta, (3, 3)."""
        c, s = np.cos(theta), np.sin(theta)
        about_r = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        turned: np.ndarray = about_r @ self.axes
        return turned

    def spike_positions(self, vertices: np.ndarray, theta: float) -> np.ndarray:
        """Return corners from o in f, r, p after turning by theta [m], (V, 3)."""
        moved: np.ndarray = (vertices - self.point) @ self.rotation(theta).T
        return moved
