"""Attitude controllers, one file each; `create` makes one by name."""

from __future__ import annotations

from typing import Any

from nullmotion.registry import Registry
from nullmotion.spacecraft.controller import Controller

registry = Registry(
    "controller",
    "nullmotion.spacecraft.controllers",
    "nullmotion.spacecraft.controller.Controller",
)
names = registry.names
get = registry.get


def create(name: str, **parameters: Any) -> Controller:
    """Return a controller by name, with its fields as parameters."""
    made: Controller = registry.create(name, **parameters)
    return made
