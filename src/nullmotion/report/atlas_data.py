"""The data block of a page's atlas."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.atlas_looks import LOOKS, Look
from nullmotion.plot.atlas_pieces import own_places
from nullmotion.plot.atlas_signs import minus, sign_name
from nullmotion.plot.atlas_torque import SCALE, span, torque_left
from nullmotion.plot.atlas_view import FEW_SHEETS, Ball, Motion, Scene
from nullmotion.plot.quantities import basis_names
from nullmotion.report.atlas_coded import Coded, angles
from nullmotion.report.atlas_map_data import map_data

_FULL = 32767  # of a 16-bit number
_MARGIN = 127
MOST_BYTES = 450_000  # of all motions, before base64
MOST_SAMPLES, LEAST_SAMPLES = 2000, 100  # of one motion


def block(scene: Scene, begin_at_end: bool = False) -> dict[str, Any]:
    """Return what the page's script draws.

    Momentum is in body axes for three torque dimensions, along the torque axes for two.

    Args:
        scene: What is shown.
        begin_at_end: Whether a run is first shown as it ended.
    """
    coded = Coded()
    largest = max(float(np.abs(_drawn(scene, s.momentum)).max()) for s in scene.every) or 1.0
    quantum = largest / _FULL
    return {
        "array": _array(scene),
        "axis_names": basis_names(scene.array.torque_axes),
        "radius": scene.radius,
        "quantum": quantum,
        "kinds": [_look(scene, look) for look in LOOKS],
        "colours": list(palette.COLOURS),
        "scale": list(SCALE),
        "meshes": _meshes(scene, coded),
        "sheets": [_sheet(scene, index, quantum, coded) for index in range(len(scene.every))],
        "spheres": [_ball(scene, k, ball) for k, ball in enumerate(scene.balls)],
        "motions": [_motion(scene, motion, coded) for motion in scene.motions],
        "begin_at_end": begin_at_end,
        "maps": map_data(scene, coded),
        "arrays": coded.texts,
    }


def _look(scene: Scene, look: Look) -> dict[str, Any]:
    """Return a type's look; what may lie behind much else is the thinner, the more there is."""
    thinner = min(1.0, (8 / len(scene.sheets)) ** 0.5)
    alpha = look.alpha if look.stripes else look.alpha * thinner
    return asdict(look) | {"shown": True, "alpha": alpha, "rim": look.rim * thinner}


def _ball(scene: Scene, place: int, ball: Ball) -> dict[str, Any]:
    """Return a radius about the array's bias; names stand all around."""
    centre = np.zeros(3)
    centre[: scene.array.m] = _drawn(scene, scene.middle)
    return asdict(ball) | {"angle": 150 + 55 * place, "centre": centre.tolist()}


def _drawn(scene: Scene, vectors: np.ndarray) -> np.ndarray:
    """Return vectors along the torque axes as they are drawn: in B where there are three."""
    basis = scene.array.torque_axes
    assert basis is not None
    return vectors @ basis if scene.array.m == 3 else vectors


def _array(scene: Scene) -> dict[str, Any]:
    array = scene.array
    assert array.torque_axes is not None
    return {
        "label": array.label,
        "names": [str(i + 1) for i in range(array.n)],
        "gimbal_axes": array.gimbal_axes.tolist(),
        "spin_axes": array.spin_axes.tolist(),
        "transverse_axes": array.transverse_axes.tolist(),
        "h0": np.asarray(array.h0, float).tolist(),
        "mean": float(array.mean_momentum),
        "bias": np.asarray(array.momentum_bias, float).tolist(),
        "torque_axes": array.torque_axes.tolist(),
        "home": scene.home.tolist(),
    }


def _meshes(scene: Scene, coded: Coded) -> list[dict[str, int]]:
    """Return directions and triangles: those of all sheets, then of each flat piece."""
    different = (scene.sheets[0], *scene.flats)
    left = torque_left(scene)
    low, high = span(left) if left else (0.0, 1.0)
    made = []
    for place, one in enumerate(different):
        small = np.uint16 if len(one.u) < 65536 else np.uint32
        u = np.rint(_drawn(scene, one.u) * _FULL).astype(np.int16)
        mesh = {"u": coded.add(u), "triangles": coded.add(one.cells.astype(small))}
        if left:
            steps = np.rint(255 * (left[place] - low) / (high - low))
            mesh["left"] = coded.add(steps.astype(np.uint8))
        made.append(mesh)
    return made


def _sheet(scene: Scene, index: int, quantum: float, coded: Coded) -> dict[str, Any]:
    sheet, flat = scene.every[index], index - len(scene.sheets) + 1
    own = own_places(sheet)
    h = np.rint(_drawn(scene, sheet.momentum) / quantum).astype(np.int16)
    made = {
        "signs": sheet.signs.astype(int).tolist(),
        "name": sign_name(sheet.signs),
        "mesh": max(flat, 0),
        "shown": len(scene.sheets) <= FEW_SHEETS or minus(sheet.signs) <= 1,
        "h": coded.add(h),
        "kind": coded.add(sheet.kind[own].astype(np.uint8)),
    }
    if flat > 0:
        made["delta"] = coded.add(angles(sheet.delta))
    elif scene.array.m == 3:
        made["margin"] = coded.add(_margin(sheet.curvature[own]))
    return made


def _margin(curvature: np.ndarray) -> np.ndarray:
    """Return 1/K, which passes through zero where types part, squeezed into 8 bits."""
    with np.errstate(divide="ignore"):
        value = np.where(curvature == 0, np.inf, 1.0 / curvature)
    usual = np.median(np.abs(value[np.isfinite(value)])) if np.isfinite(value).any() else 1.0
    with np.errstate(invalid="ignore"):
        squeezed = np.where(np.isfinite(value), value / (np.abs(value) + (usual or 1.0)), 1.0)
    return np.rint(_MARGIN * squeezed).astype(np.int8)


def _motion(scene: Scene, motion: Motion, coded: Coded) -> dict[str, Any]:
    h = _drawn(scene, np.asarray(motion.momentum, float))
    padded = np.zeros((len(h), 3))
    padded[:, : h.shape[1]] = h
    fits = MOST_BYTES // (4 * (5 + scene.array.n) * len(scene.motions))
    most = min(len(h), int(np.clip(fits, LEAST_SAMPLES, MOST_SAMPLES)))
    keep = np.unique(np.rint(np.linspace(0, len(h) - 1, most)).astype(int))
    columns = {"t": motion.t, "delta": motion.delta, "h": padded, "sigma": motion.sigma}
    made = {
        key: coded.add(np.asarray(values, np.float32)[keep])
        for key, values in columns.items()
        if values is not None
    }
    return {"label": motion.label, "colour": motion.colour, "dash": motion.dash, **made}
