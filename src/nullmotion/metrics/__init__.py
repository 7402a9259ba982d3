"""Metrics of a run, one file each."""

from __future__ import annotations

from nullmotion.metrics.base import Metric, Sample
from nullmotion.registry import Registry

registry = Registry("metric", "nullmotion.metrics", "nullmotion.metrics.base.Metric")
names = registry.names
get = registry.get

__all__ = ["Metric", "Sample", "get", "names", "registry"]
