"""The singularity atlas: surfaces and their types, self-motion, envelope, torque maps.

Surfaces are at hand at once, since every report draws them; the rest is imported when first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from nullmotion.atlas.curvature import gaussian_curvature
from nullmotion.atlas.kind import KINDS
from nullmotion.atlas.passable import passable
from nullmotion.atlas.signs import patterns
from nullmotion.atlas.surfaces import SingularPoints, Surface, singular_points, surfaces

if TYPE_CHECKING:
    from nullmotion.atlas.analysis import Analysis, analyse
    from nullmotion.atlas.bounds import Bounds
    from nullmotion.atlas.envelope import max_momentum, omnidirectional, reach, volume
    from nullmotion.atlas.internal import Impassable, nearest_impassable
    from nullmotion.atlas.manifold import Component, component, escapable, self_motion
    from nullmotion.atlas.outer import outer_surface
    from nullmotion.atlas.sizes import Radii, failures, radii
    from nullmotion.atlas.state import State, inspect
    from nullmotion.atlas.torque import TorqueMap, surface_torque, torque_map

_WHERE = {
    **dict.fromkeys(("Analysis", "analyse"), "analysis"),
    "Bounds": "bounds",
    **dict.fromkeys(("max_momentum", "omnidirectional", "reach", "volume"), "envelope"),
    **dict.fromkeys(("Impassable", "nearest_impassable"), "internal"),
    **dict.fromkeys(("Component", "component", "escapable", "self_motion"), "manifold"),
    "outer_surface": "outer",
    **dict.fromkeys(("Radii", "failures", "radii"), "sizes"),
    **dict.fromkeys(("State", "inspect"), "state"),
    **dict.fromkeys(("TorqueMap", "surface_torque", "torque_map"), "torque"),
}

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


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'nullmotion.atlas' has no attribute {name!r}")
    return getattr(import_module(f"nullmotion.atlas.{_WHERE[name]}"), name)
