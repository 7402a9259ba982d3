"""Metrics of a run, one file each."""

from __future__ import annotations

from nullmotion.metrics.base import Metric, Sample
from nullmotion.registry import Registry

registry = Registry("metric", "nullmotion.metrics", "nullmotion.metrics.base.Metric")
names = registry.names
get = registry.get


def applicable(body: bool) -> list[str]:
    """Return the names of the metrics that a run has, with or without a spacecraft."""
    return [name for name in names() if body or not get(name).needs_body]


__all__ = ["Metric", "Sample", "applicable", "get", "names", "registry"]
