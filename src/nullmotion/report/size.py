"""The page of `nullmotion size`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Panel
from nullmotion.report import page
from nullmotion.report.charts import Charts, grid
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.tables import table
from nullmotion.report.wording import number

HEAD = (
    "Layout",
    "CMGs",
    "Basis",
    "Law",
    "h0 [N m s]",
    "Rate [deg/s]",
    "Angle [deg]",
    "Torque [N m]",
    "Binds",
    "Flown",
    "5 % smaller",
)
NUMERIC = (1, 4, 5, 6, 7)
_SHORT = {"momentum": "h0", "gimbal rate": "rate"}
_SAMPLED = (
    "Sampled: the least that flies every slew that was looked at. Certified: torque in every "
    "direction at every momentum of the slews, proven by interval arithmetic; the flights of the "
    "closed loop beside it are samples."
)


def size_report(sizing: Any, path: str | Path) -> Path:
    """Write what sizing found as an HTML page that needs no network.

    Args:
        sizing: What `nullmotion.sizing.size` returns.
        path: File to write.

    Returns:
        The path.
    """
    charts = Charts()
    rows = sizing.rows
    parts = [
        _header(sizing),
        page.section(
            "Arrays",
            table(HEAD, cells(rows), "The smallest array of each layout", NUMERIC, wide=True),
            tag("p", _SAMPLED, class_="note"),
            *(tag("p", f"{r.layout}: {r.reason}.", class_="note") for r in rows if r.reason),
            id="arrays",
        ),
    ]
    if any(row.curve for row in rows):
        drawn = [charts.add(_panel(rows))]
        parts.append(page.section("Momentum and gimbal rate", grid(drawn), id="trade"))
    parts += [_proofs(rows), _tried(rows), page.scenario(sizing.requirement.source.text)]
    return page.write(path, page.document(sizing.requirement.title, parts, charts, page.versions()))


def cells(rows: Sequence[Any]) -> list[tuple[str, ...]]:
    """Return the cells of a table with `HEAD`: a row for each design and each certified array."""
    made = []
    for row in rows:
        if row.status != "sized":
            made.append((row.layout, str(row.cmgs), "cannot", *["–"] * 8))
            continue
        smaller = [k.replace("_", " ") for k, flies in row.smaller_by_5_percent.items() if flies]
        made.append(
            (
                row.layout,
                str(row.cmgs),
                row.basis,
                row.law,
                *map(number, (row.h0_Nms, row.gimbal_rate_deg_s, row.skew_deg, row.torque_Nm)),
                " + ".join(_SHORT[name] for name in row.binds) or "–",
                f"{'yes' if row.flown else 'no'}, {row.axes:,} axes",
                f"flies: {', '.join(smaller)}" if smaller else "no",
            )
        )
        if row.certified is not None:
            made.append(_certified(row))
    return made


def _certified(row: Any) -> tuple[str, ...]:
    proof = row.certified
    numbers = (proof.h0_Nms, proof.gimbal_rate_deg_s, proof.skew_deg, proof.torque_Nm)
    return (
        row.layout,
        str(row.cmgs),
        proof.basis if proof.proven else "not proven",
        proof.law,
        *map(number, numbers),
        f"TC {number(proof.torque_capability, 3)} to {number(proof.radius, 3)} h0",
        f"{'yes' if proof.flown else 'no'}, {proof.flights:,} slews",
        "–",
    )


def _header(sizing: Any) -> Markup:
    r = sizing.requirement
    cone = "any axis"
    if r.slew.cone_half_angle_deg < 180:
        cone = f"axes up to {r.slew.cone_half_angle_deg:g} deg from {list(r.slew.axis)}"
    said = f"{r.slew.angle_deg:g} deg, settled within {r.time:g} s, about {cone}"
    sized = [row for row in sizing.rows if row.status == "sized"]
    words = f"{len(sized)} of {len(sizing.rows)} layouts meet the requirement"
    words += "" if sizing.complete else "; interrupted before the others"
    tone = "done" if len(sized) == len(sizing.rows) and sizing.complete else "stopped"
    return tag(
        "header",
        tag("p", r.title, class_="title"),
        tag("h1", words, class_=f"verdict {tone}"),
        tag("p", said, class_="subject"),
    )


def _panel(rows: Sequence[Any]) -> Panel:
    curves = []
    for i, row in enumerate(row for row in rows if row.curve):
        x, y = (np.array(row.curve[key], float) for key in ("gimbal_rate_deg_s", "h0_Nms"))
        y[~np.isfinite(y)] = np.nan
        colour, dash = palette.colour(i), palette.dash(i)
        curves.append(Curve(row.layout, x, y, colour, dash, marker=True))
    return Panel(
        "trade",
        "The least momentum that flies at each gimbal rate",
        "Momentum of each CMG [N m s]",
        tuple(curves),
        x_title="Largest gimbal rate [deg/s]",
        note="The design is where h0 to the power of momentum_weight times the rate is least.",
        log=True,
    )


def _proofs(rows: Sequence[Any]) -> Markup:
    head = ("Layout", "Constraint", "Claim", "Boxes", "Time [s]")
    made = [
        (
            row.layout,
            row.certified.constraint,
            c["statement"],
            f"{c['boxes']:,}",
            number(c["seconds"]),
        )
        for row in rows
        if row.certified is not None
        for c in row.certified.certificates
    ]
    why = [
        tag("p", f"{row.layout}: {row.certified_reason}.", class_="note")
        for row in rows
        if row.certified_reason
    ]
    shown = table(head, made, "Certificates", (3, 4)) if made else ""
    return page.section("Certificates", shown, join(*why), id="certificates")


def _tried(rows: Sequence[Any]) -> Markup:
    head = ("Layout", "Law", "Coast", "Angle [deg]", "h0 [N m s]", "Gimbal rate [deg/s]")
    keys = ("coast_fraction", "skew_deg", "h0_Nms", "gimbal_rate_deg_s")
    made = [
        (row.layout, one["law"], *(number(one[key], 3) for key in keys))
        for row in rows
        for one in row.tried
    ]
    shown = table(head, made, "Candidates at their knee, coarse", range(2, 6))
    return page.section("What was tried", page.details("Candidates", shown), id="tried")
