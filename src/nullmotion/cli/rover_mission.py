"""``nullmotion rover mission``: a trip over uneven ground."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options, rover_options, rover_screen, screen

if TYPE_CHECKING:
    from nullmotion.rover.mission_run import MissionResult
    from nullmotion.rover.rover_run_store import Report


def mission(
    mission: Annotated[
        str,
        typer.Argument(
            metavar="MISSION", help="TOML file, or a name from `nullmotion list rovers`."
        ),
    ] = "mission-20m",
    settings: rover_options.Settings = None,
    csv: Annotated[bool, typer.Option("--csv", help="Write steps.csv too.")] = False,
    out: options.Out = None,
) -> None:
    """Roll from a start to a goal over uneven ground, and tell what the trip costs.

    Steps that were planned are kept: the next trip of the same rover is faster.
    """
    from nullmotion.rover import files_mission, mission_run, mission_run_store

    file = files_mission.load_mission(
        mission, rover_options.values(settings, {}), rover_options.ORIGIN
    )
    target = options.writable(out or Path("out") / file.name)
    with rover_options.explained(), screen.progress(f"Rolling {file.rover.name}") as progress:
        result = mission_run.run_mission(file, progress)
    page = _page(result)
    mission_run_store.write_mission(result, target, csv, page)
    rover_screen.show_mission(result)
    rover_options.tell(target, page)


def _page(result: MissionResult) -> Report:
    """Return what writes the page of a mission."""

    def write(path: Path) -> Any:
        from nullmotion.report.rover import write_mission_report

        file = result.file
        return write_mission_report(path, result.travel, file.terrain, file.rover, file.title)

    return write
