"""The singularity atlas: singular surfaces and their types, self-motion, momentum envelope."""

from __future__ import annotations

from nullmotion.atlas.curvature import gaussian_curvature
from nullmotion.atlas.kind import KINDS
from nullmotion.atlas.manifold import Component, component, escapable, self_motion
from nullmotion.atlas.passable import passable
from nullmotion.atlas.signs import patterns
from nullmotion.atlas.surfaces import SingularPoints, Surface, singular_points, surfaces

__all__ = [
    "KINDS",
    "Component",
    "SingularPoints",
    "Surface",
    "component",
    "escapable",
    "gaussian_curvature",
    "passable",
    "patterns",
    "self_motion",
    "singular_points",
    "surfaces",
]
