"""Why there is no path, in words."""

from __future__ import annotations

import math

import numpy as np

from nullmotion.rover.path_graph import StepGraph
from nullmotion.rover.path_search import Found


def unusable(graph: StepGraph, number: int, what: str) -> str:
    """Return what is wrong with a start or goal in a cell; number -1: off the ground."""
    if number < 0:
        return f"a {what} on known ground, a footprint away from its border"
    slope = math.degrees(-graph.pitch[number].min())
    return f"a {what} where the rover stays: here the ground falls by {slope:.0f} deg"


def apart(graph: StepGraph, found: Found, goal: tuple[float, float]) -> str:
    """Return how far a search got that did not find the goal."""
    reached = np.isfinite(found.costs)
    gap = np.linalg.norm(graph.lattice.middles(graph.cells[reached]) - goal, axis=1).min()
    return (
        f"a goal that feasible steps reach: from the start they lead to {reached.sum()} of "
        f"{len(reached)} footprints, the nearest {gap:.2f} m away"
    )
