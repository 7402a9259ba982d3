"""``nullmotion rover``: steps and trips of a rover that one CMG rolls over its edges."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options, rover_mission, rover_options, rover_screen, screen

if TYPE_CHECKING:
    from nullmotion.rover.files import StepFile
    from nullmotion.rover.rover_run_store import Report

app = typer.Typer(no_args_is_help=True)

RoverArgument = Annotated[
    str,
    typer.Argument(metavar="ROVER", help="TOML file, or a name from `nullmotion list rovers`."),
]
Edge = Annotated[int | None, typer.Option("--edge", help="Edge to step over, from 1.")]
Incline = Annotated[
    float | None, typer.Option("--incline-deg", help="Slope of the ground, uphill above 0.")
]


@app.callback()
def _rover() -> None:
    """Roll a rover over its edges with one CMG: plan a step, land it, make a trip."""


@app.command("plan")
def plan(
    rover: RoverArgument = "peter",
    edge: Edge = None,
    incline_deg: Incline = None,
    settings: rover_options.Settings = None,
    out: options.Out = None,
) -> None:
    """Plan a step over an edge on a slope; with reaction wheels: what it takes."""
    from nullmotion.rover import files, rover_run, rover_run_store

    asked = rover_options.values(settings, {"step.edge": edge, "site.incline_deg": incline_deg})
    file = files.load_step(rover, asked, rover_options.ORIGIN)
    target = options.writable(out or Path("out") / f"{file.name}-plan")
    with (
        rover_options.explained(),
        screen.progress(f"Planning a step of {file.rover.name}") as progress,
    ):
        found, verdict = rover_run.plan_file(file, progress)
    page = None if isinstance(found, rover_run.WheelPlan) else _step_page(file, found)
    rover_run_store.write_plan(file, found, verdict, target, page)
    rover_screen.show_plan(file, found, verdict)
    rover_options.tell(target, page)


@app.command("run")
def run(
    rover: RoverArgument = "peter",
    edge: Edge = None,
    incline_deg: Incline = None,
    ground: Annotated[
        str | None,
        typer.Option("--ground", help="TOML file, or a name: rock, gravel, regolith, sand, ice."),
    ] = None,
    initial_gimbal_deg: Annotated[
        float | None,
        typer.Option(
            "--initial-gimbal-deg",
            help="Bring the gimbal from this angle to the step's start first.",
        ),
    ] = None,
    settings: rover_options.Settings = None,
    csv: Annotated[bool, typer.Option("--csv", help="Write the histories as CSV too.")] = False,
    out: options.Out = None,
) -> None:
    """Plan a step, follow it in closed loop, land it in the contact simulation."""
    from nullmotion.rover import files, rover_run, rover_run_store

    flags = {
        "step.edge": edge,
        "site.incline_deg": incline_deg,
        "ground": None if ground is None else {"file": _here(ground)},
        "initial.gimbal_deg": initial_gimbal_deg,
    }
    file = files.load_step(rover, rover_options.values(settings, flags), rover_options.ORIGIN)
    target = options.writable(out or Path("out") / file.name)
    with rover_options.explained(), screen.progress(f"Rolling {file.rover.name}") as progress:
        result = rover_run.run_file(file, progress)
    page = _step_page(file, result.plan, result.run, result.landing)
    rover_run_store.write_run(result, target, csv, page)
    rover_screen.show_run(result)
    rover_options.tell(target, page)


app.command("mission")(rover_mission.mission)


def _here(ground: str) -> str:
    """Return a path from the current folder, not the rover file's; a name as it is."""
    return str(Path(ground).absolute()) if Path(ground).is_file() else ground


def _step_page(file: StepFile, plan: Any, run: Any = None, landing: Any = None) -> Report:
    """Return what writes the page of a step."""

    def write(path: Path) -> Any:
        from nullmotion.report.rover import write_step_report

        return write_step_report(path, plan, run, landing, file.title)

    return write
