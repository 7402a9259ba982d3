"""Regions of momentum that a proof covers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Ball:
    """All momenta of m components with |h| at most the radius."""

    radius: float
    m: int = 3


@dataclass(frozen=True)
class Box:
    """All momenta between two corners, (m,) each."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]


Region = Ball | Box
