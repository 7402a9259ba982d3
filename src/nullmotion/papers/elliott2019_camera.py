"""Bodies in momentum space seen from afar: rays that stop where a function becomes positive."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops
from nullmotion.compile import compile_function, llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage

WIDTH = 2.85  # half the side of a picture [h]
_SIDE = 2.001  # half the side of the cube that holds every body [h]
_PIXELS, _BLOCK = 500, 4096  # along a side, and of them at once
_STEPS, _HALVINGS = 320, 12  # along a ray through the cube
_SLOPE = 1e-3  # step of the differences that a normal is made of
_BEHIND = 0.03  # depth from which on a point is behind a surface [h]


@dataclass(frozen=True)
class Camera:
    """A direction to look from: orthographic, z up.

    Args:
        elevation: Above the x-y plane [rad].
        azimuth: About z from x [rad].
    """

    elevation: float
    azimuth: float

    @property
    def axes(self) -> np.ndarray:
        """Unit vectors to the right, upwards and towards the viewer, (3, 3)."""
        e, a = self.elevation, self.azimuth
        towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.stack([right, np.cross(towards, right), towards])


class View(NamedTuple):
    """What a camera sees of a body, rows from the bottom, not a number where it sees past it.

    Attributes:
        camera: Where from.
        depth: Distance from the origin's plane towards the viewer [h], (pixels, pixels).
        normal: Outward unit normals in the camera's axes, (pixels, pixels, 3).
    """

    camera: Camera
    depth: np.ndarray
    normal: np.ndarray

    def hidden(self, points: np.ndarray) -> np.ndarray:
        """Return which points (k, 3) are behind the body."""
        x, y, z = self.camera.axes @ points.T
        rows, columns = (np.floor((c / WIDTH + 1.0) * (0.5 * _PIXELS)).astype(int) for c in (y, x))
        inner = np.clip(rows, 0, _PIXELS - 1), np.clip(columns, 0, _PIXELS - 1)
        return np.asarray(np.nan_to_num(self.depth[inner], nan=-np.inf) > z + _BEHIND)


class _Ray(NamedTuple):
    plane: Any
    towards: Any
    start: Any
    step: Any


class _Place(NamedTuple):
    z: Any
    step: Any
    hit: Any


class Body:
    """Where a function of the momentum is positive, inside the cube |h_i| <= 2."""

    def __init__(self, source: Callable[[Any], Any]) -> None:
        """Compile the function and the walk along a ray."""
        self.function = compile_function(source, np.zeros(3))

        def walk(k: Any, row: Any, s: _Place, p: _Ray) -> _Place:
            inside = ops.less(0.0, source(p.plane + s.z * p.towards))
            hit = ops.maximum(s.hit, ops.where(inside, 1.0, 0.0))
            step = ops.where(ops.less(0.0, hit), 0.5 * s.step, s.step)
            return _Place(s.z + ops.where(inside, step, -step), step, hit)

        example = _Ray(np.zeros(3), np.ones(3), 0.0, 0.1)
        loop = Loop(
            start=lambda p: _Place(p.start, p.step, 0.0),
            stages=(Stage(walk),),
            outputs=lambda s, p: (s.z, s.hit),
            parameters=example,
            varying=(True,) * 8,
        )
        self._kernel = LoopKernel(loop, width=llvm.host().lanes)

    def seen(self, camera: Camera) -> View:
        """Return a camera's view."""
        edge = ((np.arange(_PIXELS) + 0.5) / _PIXELS * 2.0 - 1.0) * WIDTH
        places = np.stack(np.meshgrid(edge, edge), axis=-1).reshape(-1, 2)
        plane, towards = places @ camera.axes[:2], camera.axes[2]
        ends = np.sort((np.array([-_SIDE, _SIDE])[:, None, None] - plane) / towards, axis=0)
        front, back = ends[1].min(axis=1), ends[0].max(axis=1)
        met = front > back
        depth, normal = np.full(len(plane), np.nan), np.full((len(plane), 3), np.nan)
        depth[met] = self._walked(plane[met], towards, front[met], back[met])
        seen = np.isfinite(depth)
        normal[seen] = self._normals(plane[seen] + depth[seen, None] * towards) @ camera.axes.T
        size = (_PIXELS, _PIXELS)
        return View(camera, depth.reshape(size), normal.reshape(*size, 3))

    def _walked(
        self, plane: np.ndarray, towards: np.ndarray, front: np.ndarray, back: np.ndarray
    ) -> np.ndarray:
        kernel, step = self._kernel, (front - back) / _STEPS
        total = -(-len(plane) // _BLOCK) * _BLOCK
        along = np.broadcast_to(towards, plane.shape)
        rows = np.column_stack([plane, along, front - 0.5 * step, step])
        values = np.ascontiguousarray(np.pad(rows, ((0, total - len(plane)), (0, 0)), "edge").T)
        out, nothing = np.zeros((kernel.outputs + len(kernel.flags), total)), np.zeros((1, 1))

        def block(first: int) -> None:
            state, last = np.zeros((kernel.carried, _BLOCK)), _STEPS + _HALVINGS
            kernel.run(state, values, nothing, nothing, out, first, _BLOCK, 0, last, True)

        with ThreadPoolExecutor() as pool:
            list(pool.map(block, range(0, total, _BLOCK)))
        z, hit = out[:2, : len(plane)]
        return np.where((hit > 0) & (z > back - step), z, np.nan)

    def _normals(self, points: np.ndarray) -> np.ndarray:
        steps = _SLOPE * np.eye(3)
        f = self.function
        slope = np.stack([f(points - s) - f(points + s) for s in steps], axis=1)
        size = np.linalg.norm(slope, axis=1, keepdims=True)
        return np.asarray(slope / np.where(size > 0, size, 1.0))
