"""``nullmotion run``: one scenario, one law."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options, screen, wheel_rows

if TYPE_CHECKING:
    from nullmotion.scenario import Scenario
    from nullmotion.sim import Trajectory


def run(
    scenario: options.ScenarioArgument,
    out: options.Out = None,
    settings: options.Settings = None,
    law_file: options.LawFile = None,
    csv: Annotated[bool, typer.Option("--csv", help="Write trajectory.csv too.")] = False,
    seed: options.Seed = None,
    backend: Annotated[str, typer.Option(help="auto, kernel (compiled) or python.")] = "auto",
) -> None:
    """Fly one scenario and store the run."""
    names, text = options.load_law_file(law_file)
    loaded = options.load(scenario, options.values(settings, seed), names)
    target = options.writable(out or Path("out") / loaded.name)
    trajectory = fly(loaded, backend)
    write(trajectory, loaded, target, csv, text)
    show(trajectory, loaded)
    typer.echo(f"Results in {target} (open report.html); again with: nullmotion rerun {target}")


def fly(scenario: Scenario, backend: str = "auto") -> Trajectory:
    """Return the trajectory, with a progress bar if it takes long."""
    from nullmotion.scenario.simulate import simulate

    with screen.progress(f"Flying {scenario.name}") as progress:
        return simulate(scenario, backend, progress=progress)  # type: ignore[arg-type]


def write(
    trajectory: Trajectory, scenario: Scenario, target: Path, csv: bool, law_file: str
) -> None:
    """Write all files of the run, the report included."""
    from nullmotion.report.run import run_report
    from nullmotion.scenario import requirements, store, vscmg_summary

    def report(path: Path) -> Any:
        text = scenario.source.effective_text()
        kept = requirements.evaluate(scenario, trajectory.summary())
        wheels = vscmg_summary.summary(trajectory, scenario)
        return run_report(trajectory, path, scenario.title, text, kept, wheels)  # type: ignore[arg-type]

    store.write(trajectory, scenario, target, csv=csv, law_file=law_file, report=report)


def show(trajectory: Trajectory, scenario: Scenario) -> None:
    """Print the run's key numbers."""
    found, stopped = trajectory.summary(), trajectory.stopped_at_s
    of_its_kind = _momentum if trajectory.q_BN is None else _attitude
    rows = [
        ("Law", scenario.law.name),
        ("Stopped at", "-" if stopped is None else f"{stopped:.6g} s"),
        ("Stop reason", trajectory.stop_reason),
        *of_its_kind(found),
        *(wheel_rows.rows(trajectory, scenario) if trajectory.wheel_speed is not None else []),
        *_requirements(scenario, found),
        ("Status", ", ".join(found["status"])),
        ("Backend", " ".join(filter(None, (trajectory.backend, trajectory.instruction_set)))),
    ]
    screen.console().print(screen.table(scenario.title, ("Quantity", "Value"), rows))


def _momentum(found: Mapping[str, Any]) -> list[tuple[str, str]]:
    number = screen.number
    return [
        ("Final momentum", screen.vector(found["final_momentum"]) + " N m s"),
        ("Least sigma_min", number(found.get("min_sigma_min"))),
        ("Off-axis torque, peak", screen.percent(found.get("max_off_axis_torque_fraction")) + " %"),
        ("Largest rate step", number(found.get("max_rate_step_rad_s")) + " rad/s"),
    ]


def _attitude(found: Mapping[str, Any]) -> list[tuple[str, str]]:
    number = screen.number
    settled = screen.settling(found.get("settling_time_s"))
    return [
        ("Settling time", settled if settled == screen.NOT_SETTLED else f"{settled} s"),
        ("Final pointing error", number(found.get("final_pointing_error_deg")) + " deg"),
        ("Peak body rate", number(found.get("max_body_rate_deg_s")) + " deg/s"),
        ("Peak motor torque", number(found.get("max_motor_torque_Nm")) + " N m"),
        ("Rate-saturated", number(found.get("rate_saturated_s")) + " s"),
        ("Least sigma_min", number(found.get("min_sigma_min"))),
        ("Gimbal travel", number(found.get("gimbal_travel_rad")) + " rad"),
    ]


def _requirements(scenario: Scenario, found: Mapping[str, Any]) -> list[tuple[str, str]]:
    from nullmotion.scenario import requirements

    results = requirements.evaluate(scenario, found)
    if not results:
        return []
    failed = [result["name"] for result in results if not result["passed"]]
    words = f"{len(results) - len(failed)}/{len(results)} passed"
    return [("Requirements", words + (f", failed: {', '.join(failed)}" if failed else ""))]
