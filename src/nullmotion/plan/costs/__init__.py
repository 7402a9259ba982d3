"""Costs of plans, one file each; `create` makes one by name."""

from __future__ import annotations

from typing import Any

from nullmotion.plan.cost import Cost
from nullmotion.registry import Registry

registry = Registry("cost", "nullmotion.plan.costs", "nullmotion.plan.cost.Cost")
names = registry.names
get = registry.get


def create(name: str, **parameters: Any) -> Cost:
    """Return a cost by name, with its fields as parameters."""
    made: Cost = registry.create(name, **parameters)
    return made
