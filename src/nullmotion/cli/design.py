"""``nullmotion design``: functions that are the best for a purpose."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options, screen

if TYPE_CHECKING:
    from nullmotion.guarantee.design import Design
    from nullmotion.guarantee.design.outcome import Outcome

FILE = "constraint.json"
app = typer.Typer(no_args_is_help=True)


@app.callback()
def _design() -> None:
    """Design what steers an array."""


@app.command("constraint")
def constraint(
    layout: Annotated[
        str, typer.Option(help="box90, roof6, or roof5: roof6 without one CMG.")
    ] = "box90",
    objective: Annotated[
        str,
        typer.Option(
            help="balanced (what is shipped), envelope (greatest), radius or volume (greatest "
            "for each --torque-capability)."
        ),
    ] = "balanced",
    torque_capability: Annotated[
        list[float] | None,
        typer.Option(help="Torque in every direction, in h0 x rate limit; may be repeated."),
    ] = None,
    weight: Annotated[
        list[float] | None,
        typer.Option(help="What each torque capability counts, in the same order; 1 by default."),
    ] = None,
    envelope_radius: Annotated[
        float | None, typer.Option(help="Momentum up to which nothing may be singular, in h0.")
    ] = None,
    degree: Annotated[int, typer.Option(help="Degree of Psi in the squares of momentum.")] = 2,
    axial_degree: Annotated[
        int, typer.Option(help="The same for the powers of the momentum along x alone.")
    ] = 4,
    starts: Annotated[int, typer.Option(help="Starts of the search.")] = 3,
    seed: Annotated[int, typer.Option(help="Seed of the starts.")] = 0,
    out: options.Out = None,
) -> None:
    """Find the bias Psi between two planes of CMGs that guarantees most.

    Ctrl-C ends the search; the best found so far is kept.
    """
    from dataclasses import replace

    from nullmotion.guarantee import design

    family = replace(design.family_of(layout), axial=axial_degree)
    goal = design.goal_of(
        family, objective, tuple(torque_capability or ()), tuple(weight or ()), envelope_radius
    )
    target = options.writable(out or Path("out") / f"{layout}-{objective}")
    with screen.progress(f"Designing for {layout}") as progress:
        found = design.design(family, goal, degree, starts=starts, seed=seed, progress=progress)
    outcomes = _write(found, target)
    _show(found, outcomes)
    typer.echo(f"Results in {target / FILE}")


def _write(found: Design, target: Path) -> list[Outcome]:
    from nullmotion.guarantee.design import outcome
    from nullmotion.scenario.files import replacing

    outcomes = outcome.compare(found)
    record = outcome.record(found, outcomes)
    with replacing(target, (FILE,) if (target / FILE).is_file() else ()) as new:
        (new / FILE).write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return outcomes


def _show(found: Design, outcomes: list[Outcome]) -> None:
    from nullmotion.guarantee.design.outcome import BOUNDS, rounded

    console = screen.console()
    names = [outcome.name for outcome in outcomes]
    numeric = tuple(range(1, len(names) + 2))
    rows = [(_level(t, "radius"), *(f"{o.radii[t]:.4f}" for o in outcomes))
            for t in outcomes[0].radii]  # fmt: skip
    rows += [("plane without momentum, |h|", *(_size(o.singular) for o in outcomes))]
    rows += [(_level(t, "volume"), *(_volume(o.volumes[t]) for o in outcomes))
             for t in outcomes[0].volumes]  # fmt: skip
    console.print(screen.table(f"{found.family.layout}, {found.goal.name}: momentum in h0",
                               ("Quantity", *names), rows, numeric))  # fmt: skip
    bound = BOUNDS.get(found.family.layout, {})
    heads = ("|h|", *names, *(["bound"] if bound else []))
    rows = [(f"{h:g}", *(f"{o.least[h]:.4f}" for o in outcomes), *_bound(bound, h))
            for h in outcomes[0].least]  # fmt: skip
    title = "Least TC over directions of momentum, in h0 x rate limit"
    console.print(screen.table(title, heads, rows, numeric))
    cells = [(" ".join(map(str, p)), f"{c:.8g}") for *p, c in _terms(rounded(found))]
    console.print(screen.table("Psi", ("Powers", "Coefficient"), cells, (1,)))
    _remarks(found)


def _remarks(found: Design) -> None:
    if found.interrupted:
        typer.echo("Interrupted: the best found so far.")
    if found.missed > 1e-3:
        typer.echo(f"Not met: TC is up to {found.missed:.4f} below what the objective asks for.")


def _terms(made: Any) -> Any:
    return made.terms


def _level(level: float, what: str) -> str:
    return f"TC >= {level:g}, {what}" if level else f"envelope, {what}"


def _size(size: float | None) -> str:
    return "-" if size is None else f"{size:.4f}"


def _volume(found: Any) -> str:
    return f"{found.value:.2f} +- {found.standard_error:.2f}"


def _bound(bounds: dict[float, float], h: float) -> list[str]:
    return [f"{bounds[h]:.3f}"] if bounds else []
