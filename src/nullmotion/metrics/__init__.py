"""Metrics of a run, one file each."""

from __future__ import annotations

from nullmotion.metrics.base import Metric, Sample
from nullmotion.registry import Registry

registry = Registry("metric", "nullmotion.metrics", "nullmotion.metrics.base.Metric")
names = registry.names
get = registry.get


def applicable(body: bool, wheels: bool = False) -> list[str]:
    """Return the names of the metrics that a run has.

    Args:
        body: Whether it has a spacecraft.
        wheels: Whether its wheel speeds change.
    """
    found = ((name, get(name)) for name in names())
    return [
        name
        for name, metric in found
        if (body or not metric.needs_body) and (wheels or not metric.needs_wheels)
    ]


__all__ = ["Metric", "Sample", "applicable", "get", "names", "registry"]
