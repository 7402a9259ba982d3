"""``nullmotion plan``: the best null motion over a whole manoeuvre."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options, screen

if TYPE_CHECKING:
    from nullmotion.plan import PlanResult
    from nullmotion.scenario import Scenario

PLAN, FLOWN = "plan.json", "plan.toml"


def plan(
    scenario: options.ScenarioArgument,
    method: Annotated[
        str,
        typer.Option(
            help="exact (proven), skip (the paper's heuristic), enumerate, continuous (knots of "
            "any value) or preferred (the best start angles instead)."
        ),
    ] = "exact",
    depth: Annotated[
        int | None, typer.Option(help="Number of knots; plan.depth or 10 by default.")
    ] = None,
    levels: Annotated[
        int | None, typer.Option(help="Values of a knot, odd; plan.levels or 3 by default.")
    ] = None,
    lag: Annotated[
        bool | None,
        typer.Option("--lag/--no-lag", help="Take the null vector of the sample before."),
    ] = None,
    out: options.Out = None,
    settings: options.Settings = None,
    law_file: options.LawFile = None,
    seed: options.Seed = None,
) -> None:
    """Find the null motion that serves a whole manoeuvre best, with proof."""
    names, _ = options.load_law_file(law_file)
    loaded = options.load(scenario, options.values(settings, seed), names)
    target = options.writable(out or Path("out") / f"{loaded.name}-plan")
    wanted = {"depth": depth, "levels": levels, "lag": lag}
    result = search(loaded, method, {k: v for k, v in wanted.items() if v is not None})
    write(result, loaded, target)
    show(result, loaded)
    typer.echo(f"Results in {target}; fly it with: nullmotion run {target / FLOWN}")


def search(scenario: Scenario, method: str, options: dict[str, Any]) -> PlanResult:
    """Return the plan of a scenario, with a progress bar if it takes long."""
    from nullmotion import plan

    with screen.progress(f"Planning {scenario.name}") as progress:
        return plan.search(scenario, method, progress=progress, **options)


def write(result: PlanResult, scenario: Scenario, target: Path) -> None:
    """Write the plan and the scenario that flies it, both or none."""
    from nullmotion.plan.from_scenario import follower
    from nullmotion.scenario.files import replacing

    flown, files = follower(result, scenario)
    owned = (PLAN, FLOWN) if (target / PLAN).is_file() else ()
    with replacing(target, owned) as new:
        (new / PLAN).write_text(result.to_json(), encoding="utf-8")
        (new / FLOWN).write_text(flown, encoding="utf-8")
        for name, text in files.items():
            (new / name).write_text(text, encoding="utf-8")


def show(result: PlanResult, scenario: Scenario) -> None:
    """Print the plan beside no null motion."""
    console = screen.console()
    before, after = result.baseline_parts, result.parts
    rows = [(result.cost, result.baseline_value, result.value)]
    rows += [(key.replace("_", " "), before[key], after[key]) for key in after]
    cells = [(what, screen.number(a), screen.number(b), _change(a, b)) for what, a, b in rows]
    columns = ("Quantity", "No null motion", "Plan", "Change [%]")
    console.print(screen.table(scenario.title, columns, cells, (1, 2, 3)))
    facts = [
        ("Knots / k_max", " ".join(f"{k:.4g}" for k in result.knots)),
        ("Proven best", _proof(result)),
        ("Rollouts", f"{result.rollouts:.6g}"),
        ("Time", f"{result.seconds:.3g} s, and {result.compile_seconds:.2g} s to compile"),
    ]
    if result.delta is not None:
        facts[0] = ("Start angles [deg]", screen.vector(result.to_dict()["gimbal_deg"]))
    console.print(screen.table("", ("Search", result.method), facts))
    for remark in result.remarks:
        typer.echo(f"Note: {remark}")


def _change(before: float, after: float) -> str:
    return f"{100 * (after - before) / abs(before):+.2f}" if before else "-"


def _proof(result: PlanResult) -> str:
    if not result.proven:
        return "no"
    many = "" if result.ties_complete else "at least "
    others = f"; {many}{len(result.ties)} more as good" if result.ties else ""
    return f"yes, of {result.certificate['sequences']:,} courses{others}"
