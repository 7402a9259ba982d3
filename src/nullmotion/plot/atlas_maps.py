"""Maps of torque capability: planes of momentum space, as pictures want them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from nullmotion.plot.atlas_flat import strokes
from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_pieces import Pieces, cut
from nullmotion.plot.atlas_torque import SCALE, UNREACHABLE
from nullmotion.plot.atlas_view import Scene

if TYPE_CHECKING:
    from nullmotion.atlas.torque import TorqueMap

_HATCH = "#b9c0c8"
_LINE = 0.3  # width in points of a line that is 1 px wide on screen
_HALO = 0.7


class Plane(NamedTuple):
    """A map as it is drawn: h = foot + x basis[0] + y basis[1].

    Attributes:
        basis: Its two directions along the torque axes, (2, m).
        foot: Its point closest to no momentum [N m s], (m,).
        x: Momentum along the first direction [N m s], (kx,).
        y: Momentum along the second direction [N m s], (ky,).
        capability: Torque capability [N m], (ky, kx); not finite where there is none.
        delta: Gimbal angles that give it [rad], (ky, kx, n).
    """

    basis: np.ndarray
    foot: np.ndarray
    x: np.ndarray
    y: np.ndarray
    capability: np.ndarray
    delta: np.ndarray


def plane_of(shown: TorqueMap) -> Plane:
    """Return a map with components of momentum as coordinates, x before y before z."""
    basis, origin = np.asarray(shown.basis, float), np.asarray(shown.origin, float)
    along = basis @ origin
    x, y = np.asarray(shown.x, float) + along[0], np.asarray(shown.y, float) + along[1]
    found = Plane(basis, origin - along @ basis, x, y, shown.capability, shown.delta)
    if np.abs(basis[0]).argmax() <= np.abs(basis[1]).argmax():
        return found
    turned = found.capability.T, np.swapaxes(found.delta, 0, 1)
    return Plane(basis[::-1], found.foot, y, x, *turned)


def map_title(scene: Scene, shown: TorqueMap) -> str:
    """Return which plane a map shows."""
    where = plane_of(shown)
    if scene.array.m == 2:
        return "All momenta"
    normal = np.cross(*where.basis)
    normal = normal * np.sign(normal[np.abs(normal).argmax()])
    name = axis_name(scene, normal)
    return f"{name} = {float(normal @ where.foot) + 0.0:.4g} N m s".replace("-", "−")


def axis_name(scene: Scene, row: np.ndarray) -> str:
    """Return the name of a momentum's component along a direction given along the torque axes."""
    body = row @ np.asarray(scene.array.torque_axes, float)
    for name, axis in zip("xyz", np.eye(3), strict=True):
        if np.allclose(body, axis, atol=1e-9):
            return f"h{name}"
    return f"h along ({', '.join(f'{v:.2g}' for v in body)})"


def most_capability(scene: Scene) -> float:
    """Return the largest torque capability of all maps [N m]; 0 if none is finite."""
    found = [shown.capability[np.isfinite(shown.capability)] for shown in scene.maps]
    return float(max((np.max(values) for values in found if values.size), default=0.0))


def map_panel(axes: Any, scene: Scene, shown: TorqueMap, made: Pieces | None) -> Any:
    """Draw a map with the singular lines of its plane; return what a colour bar is made of.

    Args:
        axes: Matplotlib axes.
        scene: What the map belongs to.
        shown: The map.
        made: Triangles of the singular surfaces; None for two torque dimensions.
    """
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    where, most = plane_of(shown), most_capability(scene)
    axes.grid(False)
    axes.set_facecolor(UNREACHABLE)
    axes.patch.set(hatch="/////", edgecolor=_HATCH, linewidth=0)
    drawn = axes.pcolormesh(
        where.x,
        where.y,
        np.ma.masked_invalid(where.capability),
        cmap=LinearSegmentedColormap.from_list("torque", list(SCALE)),
        norm=Normalize(0.0, most or 1.0),
        rasterized=True,
        shading="nearest",
    )
    _lines(axes, scene, where, made)
    half = [0.5 * float(np.ptp(v)) / max(len(v) - 1, 1) for v in (where.x, where.y)]
    axes.set(
        xlim=(where.x[0] - half[0], where.x[-1] + half[0]),
        ylim=(where.y[0] - half[1], where.y[-1] + half[1]),
        aspect="equal", title=map_title(scene, shown),
        xlabel=f"{axis_name(scene, where.basis[0])} [N m s]",
        ylabel=f"{axis_name(scene, where.basis[1])} [N m s]",
    )  # fmt: skip
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)
    return drawn


def _lines(axes: Any, scene: Scene, where: Plane, made: Pieces | None) -> None:
    ends, kind = _ends(scene, where, made)
    for k, look in enumerate(LOOKS):
        own = ends[kind == k] @ where.basis.T
        for colour, wider, alpha in (("#ffffff", _HALO, 0.75), (look.colour, 0.0, 1.0)):
            width = _LINE * look.width + wider
            strokes(axes, own, colour, width, alpha=alpha, rasterized=True)


def _ends(scene: Scene, where: Plane, made: Pieces | None) -> tuple[np.ndarray, np.ndarray]:
    """Return the singular lines of a plane as pieces (k, 2, m), and their types."""
    if made is not None:
        normal = np.cross(*where.basis)
        found = cut(made, normal, float(normal @ where.foot))
        return found.ends, found.kind
    ends = [sheet.momentum[sheet.cells] for sheet in scene.sheets]
    kinds = [sheet.kind[sheet.cells[:, 0]] for sheet in scene.sheets]
    return np.concatenate(ends), np.concatenate(kinds)
