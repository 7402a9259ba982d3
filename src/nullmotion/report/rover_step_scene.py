"""What the animation of a step draws: the body over time in world axes, z up.

World axes: x the horizontal part of the step's direction, y along the ground's level, z up.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.report.rover_stage import numbers

FRAMES = 360


def scene(plan: Any, run: Any, landing: Any) -> dict[str, Any]:
    """Return the scene of a step: the plan, and its result where there is one."""
    frame, chassis, cmg = plan.frame, plan.rover.chassis, plan.rover.cmg
    W, end = world(plan.site), last(plan, run, landing)
    t = np.linspace(0.0, end, FRAMES)
    s, g, o = cmg.axes(0.0)
    made: dict[str, Any] = {
        "from": 0.0,
        "to": end,
        "clock": "Time",
        "length": frame.length,
        "turn": frame.turn,
        "incline": plan.site.incline,
        "ground": W.T.tolist(),
        "vertices": chassis.vertices.tolist(),
        "faces": [list(face) for face in chassis.faces],
        "edges": [[int(i) for i in pair] for pair in chassis.edges],
        "axis": list(frame.spikes),
        "start": list(chassis.faces[frame.start_face]),
        "end": list(chassis.faces[frame.end_face]),
        "cmg": {"s": s.tolist(), "g": g.tolist(), "o": o.tolist()},
        "frames": FRAMES,
        "plan": _turned(plan, t, plan, W),
        "result": None,
    }
    if landing is not None:
        made["result"] = _landed(landing, t, W)
    elif run is not None:
        made["result"] = _turned(plan, t, run, W)
    return made


def world(site: Any) -> np.ndarray:
    """Return what turns f, r, p of a step into world axes, (3, 3)."""
    up = -site.vector / np.linalg.norm(site.vector)
    ahead = np.array([1.0, 0.0, 0.0]) - up[0] * up
    ahead /= np.linalg.norm(ahead)
    return np.array([ahead, np.cross(up, ahead), up])


def last(plan: Any, run: Any, landing: Any) -> float:
    """Return when the last of plan, run and landing ends [s]."""
    return max(float(one.t[-1]) for one in (plan, run, landing) if one is not None)


def _turned(plan: Any, t: np.ndarray, source: Any, W: np.ndarray) -> dict[str, Any]:
    """Return the body of a plan or run, which turns about the edge."""
    theta, delta = (np.interp(t, source.t, values) for values in (source.theta, source.delta))
    turns = np.array([W @ plan.frame.rotation(angle) for angle in theta])
    return _track(turns @ -plan.frame.point, turns, theta, delta)


def _landed(landing: Any, t: np.ndarray, W: np.ndarray) -> dict[str, Any]:
    """Return the body of a step on the ground, free in all directions, and the ground's forces."""
    x = _sampled(t, landing.t, landing.state)
    q = x[:, 3:7] / np.linalg.norm(x[:, 3:7], axis=1, keepdims=True)
    turns = W @ np.moveaxis(rotation.matrix(q.T), -1, 0).transpose(0, 2, 1)
    theta = _sampled(t, landing.t, landing.signals.theta[:, None])[:, 0]
    force = np.asarray(landing.signals.force)
    weight = landing.plan.rover.mass * landing.plan.site.gravity
    pushed = _sampled(t, landing.t, force.reshape(len(force), -1)).reshape(len(t), -1, 3)
    track = _track(x[:, :3] @ W.T, turns, theta, x[:, 13])
    return track | {"force": numbers(pushed @ W.T / weight)}


def _track(
    centre: np.ndarray, turns: np.ndarray, theta: np.ndarray, delta: np.ndarray
) -> dict[str, Any]:
    """Return mass centres, attitudes (body to world, by rows) and angles as text."""
    return {
        "centre": numbers(centre),
        "turn": numbers(turns),
        "theta": numbers(theta),
        "delta": numbers(delta),
    }


def _sampled(t: np.ndarray, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return columns (k, m) at other times, (n, m)."""
    return np.column_stack([np.interp(t, known, column) for column in values.T])
