"""The page of a mission: the rover rolls over uneven ground from a start to a goal."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.report import page
from nullmotion.report.charts import Charts, grid
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.rover_mission_panels import mission_panels
from nullmotion.report.rover_mission_scene import distances, scene
from nullmotion.report.rover_stage import legend, scripts, stage
from nullmotion.report.tables import table
from nullmotion.report.tiles import Tile, row
from nullmotion.report.wording import number

_SPEEDS = (0.5, 1.0, 2.0, 4.0)
_LOOKS = {"oblique": "Oblique", "above": "Above", "follow": "Follow the rover"}


def write_mission_report(
    path: str | Path, travel: Any, field: Any, rover: Any = None, title: str = ""
) -> Path:
    """Write a mission as an HTML page that needs no network.

    Args:
        path: File to write.
        travel: A `nullmotion.rover.path_travel.Travel`.
        field: The ground, a `HeightField`.
        rover: The rover; its gimbal axis is drawn.
        title: Title of the page.

    Returns:
        The path.
    """
    head = title or f"{rover.name if rover else 'Rover'}: a mission"
    shown, charts = scene(travel, field, rover), Charts()
    acted = stage(shown, _seen(travel), _legend(field, shown, rover), (), _SPEEDS, _LOOKS, True)
    drawn: Markup | str = ""
    if travel.steps:
        panels = [charts.add(panel, group="way") for panel in mission_panels(travel)]
        drawn = page.section("Over the distance", grid(panels), id="charts-section")
    parts = [
        _header(travel, field, rover, head),
        page.section("Key numbers", row(_tiles(travel)), id="numbers"),
        page.section("The mission", acted, id="mission"),
        *([drawn] if isinstance(drawn, Markup) else []),
        page.section("Numbers", _numbers(travel), page.details("Each step", _steps(travel)),
                     id="table"),
        scripts(shown, "mission"),
    ]  # fmt: skip
    return page.write(path, page.document(head, parts, charts, page.versions()))


def _header(travel: Any, field: Any, rover: Any, title: str) -> Markup:
    steps = f"{travel.steps} step{'' if travel.steps == 1 else 's'}"
    words = f"{steps}, {number(travel.distance, 3)} m, {number(travel.miss, 3)} m from the goal"
    goal = ", ".join(number(float(v)) for v in travel.goal)
    start = ", ".join(number(float(v), 3) for v in travel.middles[0, :2])
    wide, deep = (number(v) for v in field.size)
    name = rover.name if rover is not None else f"A rover of {number(travel.mass)} kg"
    made = f" ({field.source})" if field.source else ""
    ground = f"{wide} x {deep} m of ground{made}"
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", words, class_="verdict done"),
        tag("p", f"{name} from ({start}) to ({goal}) m over {ground}", class_="subject"),
    )


def _tiles(travel: Any) -> list[Tile]:
    care = travel.upkeep
    hours = f"{number(travel.duration / 3600, 3)} h with pauses of {number(care.pause)} s"
    return [
        Tile("Cost of the steps", number(travel.step_cost, 3), "J/(kg m)", "motors alone"),
        Tile(
            "Cost of travel", number(travel.cost_of_travel, 4), "J/(kg m)", "spin-up, drag, steps"
        ),
        Tile("Energy of the steps", number(travel.step_energy / 1e3, 3), "kJ"),
        Tile("Time on the way", number(travel.duration / 60, 3), "min", hours),
        Tile("Least margin", number(_least(travel.margin), 3), "N m", "before a spike lifts off"),
        Tile("Steepest climb", number(np.degrees(travel.pitch.max(initial=0.0)), 3), "deg"),
    ]


def _least(values: np.ndarray) -> float:
    return float(values.min()) if len(values) else float("nan")


def _seen(travel: Any) -> str:
    return (
        f"Animation: the rover rolls over shaded ground in {travel.steps} steps, leaving its "
        "footprints; charts below show energy and slopes over the distance."
    )


def _legend(field: Any, shown: Any, rover: Any) -> Markup:
    heights = np.asarray(field.heights)
    low, high = number(np.nanmin(heights), 3), number(np.nanmax(heights), 3)
    words = f"height {low} to {high} m, a contour every {number(shown['ground']['contour'])} m"
    entries = [
        ("trail", "way of the footprints"),
        ("planned", "path as planned at the start"),
        ("heights", words),
    ]
    if rover is not None:
        entries.insert(2, ("gimbal-axis", "gimbal axis"))
    return legend(entries)


def _numbers(travel: Any) -> Markup:
    care = travel.upkeep
    rows = [
        ("Steps", str(travel.steps), "–"),
        ("Distance", number(travel.distance), "m"),
        ("As the crow flies", number(travel.straight), "m"),
        ("From the goal", number(travel.miss), "m"),
        ("Time on the way", number(travel.duration), "s"),
        ("Energy of the steps", number(travel.step_energy), "J"),
        (f"Drag, {number(care.power)} W", number(travel.drag_energy), "J"),
        ("Spin-up of the rotor", number(care.spin_up_energy), "J"),
        ("Cost of travel", number(travel.cost_of_travel), "J/(kg m)"),
        ("Cost of the steps", number(travel.step_cost), "J/(kg m)"),
        ("Least margin", number(_least(travel.margin)), "N m"),
        ("Farthest of a spike from the lattice", number(travel.drift), "m"),
        ("Searches of the path", str(travel.searches), "–"),
    ]
    shown = [(name, value, tag("span", unit, class_="unit")) for name, value, unit in rows]
    return table(("Quantity", "Value", "Unit"), shown, "The mission in numbers", (1,))


def _steps(travel: Any) -> Markup:
    head = ("Step", "At [m]", "Edge", "Slope [deg]", "Across [deg]", "Time [s]", "Energy [J]",
            "Margin [N m]")  # fmt: skip
    way = distances(travel)
    rows = [
        (
            str(k + 1),
            number(way[k], 3),
            join(*(str(int(i)) for i in travel.edges[k]), between="–"),
            number(np.degrees(travel.pitch[k]), 3),
            number(np.degrees(travel.cross[k]), 3),
            number(travel.time[k], 3),
            number(travel.energy[k], 4),
            number(travel.margin[k], 3),
        )
        for k in range(travel.steps)
    ]
    return table(head, rows, "Each step; an edge by the spikes at its ends", range(1, 8))
