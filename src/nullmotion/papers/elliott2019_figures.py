"""The figures of Elliott 2019: Figures 4, 10 to 15, 20 to 28 and 37 to 41."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.papers import elliott2019_bands as bands
from nullmotion.papers import elliott2019_solids as solids
from nullmotion.papers.elliott2019_guarantees import Guarantees
from nullmotion.papers.elliott2019_planar import Curves
from nullmotion.papers.elliott2019_runs import Section44
from nullmotion.papers.elliott2019_sqp import Comparison
from nullmotion.plot import draw as drawing
from nullmotion.plot import palette, style
from nullmotion.plot.view import Curve, Mark, Panel

_WORDS = {4: "four", 5: "five", 6: "six", 7: "seven", 8: "eight", 9: "nine", 11: "eleven"}
_SQP = {5: 37, 7: 38, 9: 39, 11: 40}
_MOMENTUM = "Momentum H [h]"
_WIDE, _SQUARE = 2 * style.PANEL_WIDTH_IN, 3.75  # [in]
_BODIES = {22: (0.0, "constrained envelope"), 23: (0.5, "TC = 0.5"), 24: (1.0, "TC = 1")}
COUNT = 1 + 6 + 9 + 4 + 1

Drawing = Callable[[Any], None]


def draw(
    folder: Path,
    planar: Mapping[int, Curves],
    searched: Mapping[int, Comparison],
    promised: Guarantees,
    section: Section44,
) -> Iterator[Path]:
    """Draw all figures, one after another."""
    folder.mkdir(parents=True, exist_ok=True)
    yield drawing.save(
        [_norms(planar, "A) n even", 0), _norms(planar, "B) n odd", 1)],
        folder / "figure_04.png",
        title="Figure 4: greatest row norm of the pseudo-inverse",
    )
    for number, (n, curves) in enumerate(planar.items(), 10):
        title = f"Figure {number}: {_WORDS[n]} planar CMGs"
        yield drawing.save(_gain(curves), folder / f"figure_{number}.png", title=title)
    for number, (height, title, made) in _box90(promised, section).items():
        path = folder / f"figure_{number}.png"
        yield save(path, height, f"Figure {number}: {title}", made)
    for n, found in searched.items():
        path = folder / f"figure_{_SQP[n]}.png"
        title = f"Figure {_SQP[n]}: SQP less closed form, n = {n}"
        yield drawing.save([_search(found)], path, columns=1, title=title)


def _box90(promised: Guarantees, section: Section44) -> dict[int, tuple[float, str, Drawing]]:
    """Return height [in], title and drawing of the figures of Chapter 4 and Section 7.3."""
    band, cubic, spherical = promised.band, promised.cubic, promised.spherical
    cb, lg = section.constrained, section.gradients
    curved = partial(bands.guarantee, band=promised.spherical_band, capability=spherical.capability)
    return {
        20: (6.2, "torque capability, cubic constraint", partial(
            bands.guarantee, band=band, capability=cubic.capability)),
        21: (3.2, "producible torque, cubic constraint", partial(bands.zones, band=band)),
        **{number: (_SQUARE, f"{name}, in the restricted envelope (grey)", partial(
            _body, promised, level)) for number, (level, name) in _BODIES.items()},
        25: (_SQUARE, "50 trajectories of momentum, in the restricted envelope (grey)", partial(
            solids.draw_paths, courses=section.courses)),
        26: (3.2, "torque capability under the constraint (CB)", partial(
            bands.constrained, band=band, run=cb)),
        27: (7.2, "torque capability under the local gradient (LG), rate limit 1 rad/s", partial(
            bands.gradients, band=band, runs=lg, cb=cb)),
        28: (7.2, "distance from singularity", partial(
            bands.measures, band=promised.determinant, runs=lg, cb=cb)),
        41: (6.2, "torque capability, spherical constraint", curved),
    }  # fmt: skip


def _body(promised: Guarantees, level: float, figure: Any) -> None:
    solids.draw_body(figure, solids.body(promised.cubic, level))


def save(path: Path, height: float, title: str, made: Drawing) -> Path:
    """Write one figure as wide as a page, complete or not at all."""
    import matplotlib
    from matplotlib.figure import Figure

    part = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    with matplotlib.rc_context(style.rc()):
        figure = Figure(figsize=(_WIDE, height), layout="constrained")
        made(figure)
        figure.suptitle(title, fontsize=10, fontweight="bold", x=0.01, ha="left")
        try:
            figure.savefig(part)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    return path


def _norms(planar: Mapping[int, Curves], title: str, parity: int) -> Panel:
    chosen = [c for n, c in planar.items() if n % 2 == parity]
    curves = []
    for i, c in enumerate(chosen):
        norm, x = 1.0 / c.own, c.H / c.n
        curves.append(Curve(f"n = {c.n}", x, norm, palette.colour(i), palette.dash(i)))
    ends = np.array([c.critical / c.n for c in chosen])
    flat = np.array([2.0 / c.n for c in chosen])
    curves.append(Curve("$H_c$, 2/n", ends, flat, palette.INK, width=0.0, marker=True))
    label = r"$\|W_{MP}\|_\infty$ [-]"
    return Panel(title, title, label, tuple(curves), x_title="Momentum H / (n h) [-]")


def _gain(c: Curves) -> list[Panel]:
    own = Curve("closed form", c.H, c.own, palette.colour(0))
    backbone = Curve("circular backbone", c.H, c.backbone, palette.colour(1), "dash")
    gain = Curve("difference", c.H, c.gain_percent, palette.colour(0))
    common: dict[str, Any] = {"x_title": _MOMENTUM, "marks": (Mark(c.critical, "$H_c$", "left"),)}
    return [
        Panel("TC", "A) Torque capability", "TC [-]", (own, backbone), **common),
        Panel("gain", "B) What the backbone lacks", "Share of TC [%]", (gain,), **common),
    ]


def _search(found: Comparison) -> Panel:
    curve = Curve("", found.H, found.difference, palette.colour(0), width=0.0, marker=True)
    label = r"Difference of $\|W_{MP}\|_\infty$ [-]"
    return Panel("search", "", label, (curve,), x_title=_MOMENTUM)
