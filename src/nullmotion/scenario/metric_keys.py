"""Keys made from metrics: what a run may stop at, and what may be required of it."""

from __future__ import annotations

from functools import cache
from typing import Any

from pydantic import create_model

from nullmotion import metrics
from nullmotion.metrics.base import PLAIN, Metric
from nullmotion.scenario import schema

SIDES = ("below", "above")
_OF_ALL_RUNS = ("duration_s", "stopped_at_s")


def split(key: str) -> tuple[str, str]:
    """Return the name and the side of ``<name>_below`` or ``<name>_above``."""
    name, _, side = key.rpartition("_")
    return name, side


def metric(key: str) -> type[Metric]:
    """Return the metric of a stop condition's key."""
    return metrics.get(split(key)[0])


def limits(section: schema.Section) -> dict[str, float]:
    """Return what a section of limits gives, by key."""
    given = section.model_dump(exclude_unset=True)
    return {key: value for key, value in given.items() if value is not None}


def summary_names() -> dict[str, type[Metric] | None]:
    """Return the numbers of a run's summary by name, each with its metric if it has one."""
    found: dict[str, type[Metric] | None] = dict.fromkeys(_OF_ALL_RUNS)
    for cls in map(metrics.get, metrics.names()):
        for reduction in cls.reductions:
            found[cls.name if reduction in PLAIN else f"{reduction}_{cls.name}"] = cls
    return found


def stop_model() -> type[schema.StopSection]:
    """Return the model of ``[simulation.stop]``: a threshold for each metric of a state."""
    return _model(
        schema.StopSection,
        tuple(n for n in metrics.names() if not metrics.get(n).needs_rates),
    )


def requirements_model() -> type[schema.RequirementsSection]:
    """Return the model of ``[requirements]``: limits of each number of a summary."""
    return _model(schema.RequirementsSection, tuple(summary_names()))


@cache
def _model(base: type[Any], names: tuple[str, ...]) -> type[Any]:
    keys = [f"{name}_{side}" for name in names for side in SIDES]
    fields: Any = dict.fromkeys(keys, (float | None, None))
    return create_model(base.__name__, __base__=base, **fields)
