"""Charts of a mission over the distance that the rover has come."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Level, Panel
from nullmotion.report.rover_mission_scene import distances

_WAY = "Distance [m]"


def mission_panels(travel: Any) -> list[Panel]:
    """Return the charts of a mission."""
    way = distances(travel)
    middle = (way[1:] + way[:-1]) / 2
    blue, orange, ink = palette.colour(0), palette.colour(1), palette.INK
    steps = np.concatenate([[0.0], np.cumsum(travel.energy)])
    drag = travel.upkeep.power * np.concatenate(
        [[0.0], np.cumsum(travel.time + travel.upkeep.pause)]
    )
    total = steps + drag + travel.upkeep.spin_up_energy
    pitch, cross = np.degrees(travel.pitch), np.degrees(travel.cross)
    height = travel.middles[:, 2]

    def each(label: str, values: np.ndarray, colour: str, dash: str = "solid") -> Curve:
        return Curve(label, middle, values, colour, dash, width=1.0, marker=True)

    def cost(energy: np.ndarray) -> np.ndarray:
        return energy[1:] / (travel.mass * way[1:])

    return [
        Panel(
            "energy",
            "Energy of the steps",
            "Energy [J]",
            (Curve("steps", way, steps, blue),),
            x_title=_WAY,
            note="Of gimbal and rotor motor, from the start.",
        ),
        Panel(
            "step-energy",
            "Energy of each step",
            "Energy [J]",
            (each("step", travel.energy, blue),),
            x_title=_WAY,
        ),
        Panel(
            "cost",
            "Cost of travel so far",
            "Cost [J/(kg m)]",
            (
                Curve("all, with the spin-up", way[1:], cost(total), ink),
                Curve("steps and drag", way[1:], cost(steps + drag), orange, "dash"),
                Curve("steps alone", way[1:], cost(steps), blue, "dot"),
            ),
            x_title=_WAY,
            log=True,
        ),
        Panel(
            "slope",
            "Slope under the rover",
            "Slope [deg]",
            (
                each("in the direction of the step", pitch, blue),
                each("along the edge", cross, orange, "dash"),
            ),
            x_title=_WAY,
            note="Uphill is above 0.",
        ),
        Panel(
            "margin",
            "Torque to spare in each step",
            "Margin [N m]",
            (each("step", travel.margin, blue),),
            (Level(0.0, "a spike lifts off"),),
            x_title=_WAY,
        ),
        Panel(
            "height",
            "Height of the footprints",
            "Height [m]",
            (Curve("middle", way, height, blue),),
            x_title=_WAY,
        ),
    ]
