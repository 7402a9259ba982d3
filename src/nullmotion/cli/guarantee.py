"""``nullmotion guarantee``: the torque that an array can always give, proven."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import guarantee_files, options, screen

if TYPE_CHECKING:
    from nullmotion.guarantee.constraint import Constraint
    from nullmotion.guarantee.table import Guarantee


def guarantee(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="A name from `nullmotion list constraints`.")
    ] = "",
    radius: Annotated[
        float | None, typer.Option(help="Momentum up to which it is to hold, in units of h0.")
    ] = None,
    torque_capability: Annotated[
        float | None, typer.Option(help="Torque in every direction, in units of h0 x rate limit.")
    ] = None,
    h0: Annotated[
        float | None, typer.Option("--h0-Nms", help="One CMG's momentum, to show N m s and N m.")
    ] = None,
    rate_limit: Annotated[
        float | None, typer.Option("--rate-limit-deg-s", help="Gimbal rate limit, beside --h0-Nms.")
    ] = None,
    settings: Annotated[
        list[str] | None, typer.Option("--set", help="A parameter: n=5, b=3.2; may be repeated.")
    ] = None,
    check: Annotated[
        Path | None, typer.Option(help="Check a certificate's file instead, box by box.")
    ] = None,
    out: options.Out = None,
) -> None:
    """Prove what torque an array can give in every direction, at every momentum up to a radius.

    With neither --radius nor --torque-capability: a table of both. With one of them: the best
    of the other. With both: whether it holds.
    """
    if check is not None:
        _check(check)
        return
    made = constraint(name, settings or [])
    scale = units(h0, rate_limit)
    target = None if out is None else options.writable(out)
    with screen.progress(f"Proving {made.name}") as progress:
        rows = _rows(made, radius, torque_capability, progress)
    _show(made, rows, scale)
    if target is not None:
        guarantee_files.write(made, rows, target)
        typer.echo(f"Results in {target}")
    if any(row.certificate is not None and not row.certificate for row in rows):
        raise typer.Exit(1)


def constraint(name: str, settings: list[str]) -> Constraint:
    """Return a constraint with parameters from ``key=value``.

    Raises:
        InputError: For what is not one.
    """
    from nullmotion import guarantee as package
    from nullmotion.errors import InputError

    parameters: dict[str, Any] = {}
    for text in settings:
        key, equals, value = text.partition("=")
        try:
            parameters[key.strip()] = json.loads(value)
        except json.JSONDecodeError:
            allowed = "KEY=VALUE, the value a number or a list of numbers: b=3.2, n=5"
            raise InputError("--set", text, allowed) from None
        if not equals:
            raise InputError("--set", text, "KEY=VALUE")
    return package.create(name, **parameters)


def units(h0: float | None, rate_limit_deg_s: float | None) -> tuple[float, float] | None:
    """Return h0 [N m s] and h0 times the rate limit [N m], if both are given.

    Raises:
        InputError: For one without the other, or a number that is not above 0.
    """
    from nullmotion.errors import InputError

    given = {"--h0-Nms": h0, "--rate-limit-deg-s": rate_limit_deg_s}
    if h0 is None and rate_limit_deg_s is None:
        return None
    for key, value in given.items():
        if value is None or not 0 < value < float("inf"):
            raise InputError(key, value, "a number above 0, both options together")
    assert h0 is not None and rate_limit_deg_s is not None
    return h0, h0 * rate_limit_deg_s * 3.141592653589793 / 180


def _rows(
    made: Constraint, radius: float | None, torque_capability: float | None, progress: Any
) -> list[Guarantee]:
    from nullmotion.guarantee import radius as search
    from nullmotion.guarantee import table

    if radius is None and torque_capability is None:
        return table.table(made, progress=progress)
    if radius is not None:
        proof = (
            table.prove_capability(made, radius, progress)
            if torque_capability is None
            else made.certificate(radius, torque_capability, progress=progress)
        )
    else:
        assert torque_capability is not None
        found = table.largest_radius(made, torque_capability)
        proof = table.prove_radius(made, torque_capability, found.value, progress)
    found = search.guaranteed_radius(made, proof.torque_capability)
    momentum = tuple(map(float, found.momentum))
    return [table.Guarantee(proof.torque_capability, found.value, momentum, proof)]


def _show(made: Constraint, rows: list[Guarantee], scale: tuple[float, float] | None) -> None:
    heads = ["TC", "Radius by search", "Proven radius", "Boxes", "Time [s]"]
    if scale:
        heads[1:1] = ["Torque [N m]"]
        heads += ["Proven momentum [N m s]"]
    cells = [_cells(row, scale) for row in rows]
    title = f"{made.full_name}: TC in h0 x rate limit, radius |h| in h0"
    numeric = tuple(range(len(heads)))
    screen.console().print(screen.table(title, tuple(heads), cells, numeric))
    for row in rows:
        if row.certificate is not None and (len(rows) == 1 or not row.certificate):
            typer.echo(row.certificate.statement)


def _cells(row: Guarantee, scale: tuple[float, float] | None) -> list[str]:
    proof = row.certificate
    good = proof is not None and proof.proven
    cells = [
        f"{row.torque_capability:g}" if row.torque_capability else "envelope",
        f"{row.radius:.4f}",
        f"{proof.radius:.4f}" if proof is not None and good else "-",
        f"{proof.boxes:,}" if proof is not None else "-",
        f"{proof.seconds:.2f}" if proof is not None else "-",
    ]
    if scale:
        cells[1:1] = [f"{scale[1] * row.torque_capability:.4g}"]
        cells += [f"{scale[0] * proof.radius:.4g}" if proof is not None and good else "-"]
    return cells


def _check(file: Path) -> None:
    from nullmotion.guarantee import certificate

    loaded = certificate.load(file)
    with screen.progress(f"Checking {loaded.boxes:,} boxes") as progress:
        good = loaded.check(progress)
    typer.echo(loaded.statement)
    typer.echo("Checked: every box holds." if good else "NOT confirmed: the boxes do not show it.")
    if not good:
        raise typer.Exit(1)
