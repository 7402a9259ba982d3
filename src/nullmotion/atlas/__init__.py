"""The singularity atlas: surfaces and their types, self-motion, envelope, torque maps."""

from __future__ import annotations

from nullmotion.atlas.analysis import Analysis, analyse
from nullmotion.atlas.bounds import Bounds
from nullmotion.atlas.curvature import gaussian_curvature
from nullmotion.atlas.envelope import max_momentum, omnidirectional, reach, volume
from nullmotion.atlas.internal import Impassable, nearest_impassable
from nullmotion.atlas.kind import KINDS
from nullmotion.atlas.manifold import Component, component, escapable, self_motion
from nullmotion.atlas.outer import outer_surface
from nullmotion.atlas.passable import passable
from nullmotion.atlas.signs import patterns
from nullmotion.atlas.sizes import Radii, failures, radii
from nullmotion.atlas.state import State, inspect
from nullmotion.atlas.surfaces import SingularPoints, Surface, singular_points, surfaces
from nullmotion.atlas.torque import TorqueMap, surface_torque, torque_map

__all__ = [
    "KINDS",
    "Analysis",
    "Bounds",
    "Component",
    "Impassable",
    "Radii",
    "SingularPoints",
    "State",
    "Surface",
    "TorqueMap",
    "analyse",
    "component",
    "escapable",
    "failures",
    "gaussian_curvature",
    "inspect",
    "max_momentum",
    "nearest_impassable",
    "omnidirectional",
    "outer_surface",
    "passable",
    "patterns",
    "radii",
    "reach",
    "self_motion",
    "singular_points",
    "surface_torque",
    "surfaces",
    "torque_map",
    "volume",
]
