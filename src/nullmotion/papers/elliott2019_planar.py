"""Chapter 3 of Elliott 2019: planar arrays, beside the circular backbone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from nullmotion.guarantee.constraints.backbone import Backbone
from nullmotion.guarantee.constraints.planar import Planar
from nullmotion.papers.base import Cell

SIZES = (4, 5, 6, 7, 8, 9)  # CMGs, Figures 10 to 15
_SAMPLES = 400
_CLOSE = "n = {} at H = {:.2f} n; the dissertation says 'as much as approximately'"


@dataclass(frozen=True)
class Curves:
    """Torque capability of the two constraints over the momentum.

    Attributes:
        n: Number of CMGs.
        critical: H_c.
        H: Momenta from 0 to 0.99 n, (k,).
        own: TC of the closed forms, (k,).
        backbone: TC of the circular backbone, (k,).
    """

    n: int
    critical: float
    H: np.ndarray
    own: np.ndarray
    backbone: np.ndarray

    @property
    def gain_percent(self) -> np.ndarray:
        """What the backbone lacks, in percent of the closed forms' TC, (k,)."""
        return 100.0 * (1.0 - self.backbone / self.own)

    def best(self, declining: bool) -> tuple[float, float]:
        """Return the largest gain in a region and the momentum it is at."""
        there = self.critical <= self.H if declining else self.critical > self.H
        i = int(np.argmax(np.where(there, self.gain_percent, -np.inf)))
        return float(self.gain_percent[i]), float(self.H[i])


def curves(n: int) -> Curves:
    """Return both constraints' torque capability for n CMGs."""
    own, backbone = Planar(n), Backbone(n)
    H = np.sort(np.append(np.linspace(0.0, 0.99 * n, _SAMPLES), own.critical_momentum))
    h = along(H)
    return Curves(
        n, own.critical_momentum, H, own.torque_capability(h), backbone.torque_capability(h)
    )


def along(H: np.ndarray) -> np.ndarray:
    """Return momenta (H, 0), (k, 2)."""
    return np.stack([H, np.zeros_like(H)], axis=1)


def cells(found: Mapping[int, Curves]) -> Iterator[Cell]:
    """Return what the text says of Figures 10 to 15."""
    for what, value, tolerance in (("static", 25.0, 0.5), ("declining", 35.0, 1.0)):
        best, H, n = max((*c.best(what == "declining"), c.n) for c in found.values())
        note = _CLOSE.format(n, H / n)
        yield Cell("text", f"{what} region", "gain_percent", value, best, tolerance, note=note)
    least = min(float((c.own - c.backbone).min()) for c in found.values())
    never = "yes" if least > -1e-9 else "no"
    yield Cell("text", "TC at least the backbone's, n = 4 to 9", "everywhere", "yes", never)
