"""The charts of which the figures of Kim et al. 2012 are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion.papers.kim2014_cases import ATTITUDE, Startup
from nullmotion.plot import palette
from nullmotion.plot.parts import bundle, limited
from nullmotion.plot.view import Curve, Level, Panel
from nullmotion.vscmg.lyapunov import LyapunovMonitor

AT_ONCE, EARLY = 0.2, 25.0  # [s]: the first samples, the transient
_MOST = 6000  # points of a curve
_CMGS = tuple(f"CMG {i + 1}" for i in range(4))


def quaternion_error(run: Startup) -> Panel:
    """The four elements of the error quaternion."""
    assert run.run.q_BR is not None
    curves = bundle(run.run.t, run.run.q_BR, ("e₀", "e₁", "e₂", "e₃"))
    return Panel("error", "Quaternion error", "e [-]", curves)


def error_size(run: Startup) -> Panel:
    """|e_v| on a logarithmic axis."""
    curve = Curve("|e_v|", run.run.t, run.error, palette.colour(0))
    curves = curve, _threshold(run, ATTITUDE, f"settled: {ATTITUDE:g}")
    return Panel("error_size", "Size of the error", "|e_v| [-]", curves, log=True)


def gimbal_rates(run: Startup) -> Panel:
    """Gimbal rates as they are."""
    curves = bundle(run.run.t, run.run.rates, _CMGS)
    return Panel("rates", "Gimbal rates", "Rate [rad/s]", curves)


def wheel_accelerations(run: Startup) -> Panel:
    """Wheel accelerations."""
    assert run.run.wheel_acceleration is not None
    curves = bundle(run.run.t, run.run.wheel_acceleration, _CMGS)
    return Panel("accelerations", "Wheel accelerations", "Acceleration [rad/s²]", curves)


def wheel_speeds(run: Startup) -> Panel:
    """Wheel speeds and the speed that they go to."""
    aim = float(run.run.setup.array.design_speed[0])
    curves = bundle(run.run.t, run.speed, _CMGS)
    return Panel("speeds", "Wheel speeds", "Ω [rad/s]", curves, (Level(aim, "desired"),))


def objective(run: Startup) -> Panel:
    """The measure f of Eq 29."""
    return Panel(
        "f", "Singularity measure", "f [-]", (Curve("f", run.run.t, -run.det, palette.colour(0)),)
    )


def null_weights(run: Startup) -> Panel:
    """The weights of null motion of Eq 33."""
    return Panel(
        "S", "Null-motion weights", "S [-]", bundle(run.run.t, run.weights, ("s_w", "s_g"))
    )


def null_motion(run: Startup) -> Panel:
    """What null motion asks of the gimbals."""
    curves = bundle(run.run.t, run.null_motion, _CMGS)
    return Panel("null", "Null motion asked of gimbals", "Rate [rad/s]", curves)


def momentum_error(run: Startup) -> Panel:
    """The momentum error of each wheel."""
    return Panel("mu", "Momentum tracking error", "µ [N m s]", bundle(run.run.t, run.mu, _CMGS))


def momentum_decay(run: Startup) -> Panel:
    """|mu| beside the exponential of Eq 46."""
    t = run.run.t
    found = Curve("|µ| / |µ(0)|", t, run.share, palette.colour(0))
    bound = Curve("exp(-I_W k_m t)", t, np.exp(-run.gain * t), palette.colour(1), "dash")
    curves = found, bound, _threshold(run, 0.02, "2 %")
    return Panel("decay", "Its size, beside Eq 46", "Share [-]", curves, log=True)


def _threshold(run: Startup, value: float, label: str) -> Curve:
    ends = run.run.t[[0, -2]]
    return Curve(label, ends, np.full(2, value), palette.QUIET, "longdash", 1.2)


def estimates(run: Startup, key: str, title: str, which: slice, names: Sequence[str]) -> Panel:
    """Some of the controller's estimates."""
    assert run.run.estimates is not None
    curves = bundle(run.run.t, 1e3 * run.run.estimates[:, which], names)
    return Panel(key, title, "Estimate [g m²]", curves)


def lyapunov(name: str, found: LyapunovMonitor) -> Panel:
    """V, its bound and its part from tracking errors."""
    lines = (("V", found.V), ("bound", found.bound), ("tracking errors", found.tracking))
    curves = tuple(
        Curve(label, found.t, values, palette.colour(i), palette.dash(i))
        for i, (label, values) in enumerate(lines)
    )
    return Panel(f"V_{name}", name, "V [N m]", curves)


def between(panel: Panel, first: float, last: float) -> Panel:
    """Return a chart from one time to another, with no more points than can be seen.

    The last row is left out: what acts, and the reference, are those of the sample before.
    """
    return replace(panel, curves=tuple(_cut(curve, first, last) for curve in panel.curves))


def _cut(curve: Curve, first: float, last: float) -> Curve:
    if len(curve.x) == 2:  # a threshold
        return replace(curve, x=np.clip(curve.x, first, last))
    rows: Any = np.flatnonzero((curve.x[:-1] >= first) & (curve.x[:-1] <= last))
    rows = rows[:: 1 + len(rows) // _MOST]
    return replace(curve, x=curve.x[rows], y=curve.y[rows])


def at_once(panel: Panel) -> Panel:
    """Return the first samples of a chart, each held until the next."""
    title = f"{panel.title}: first {AT_ONCE:g} s"
    cut = between(replace(panel, title=title), 0.0, AT_ONCE)
    held = (replace(c, x=np.repeat(c.x, 2)[1:], y=np.repeat(c.y, 2)[:-1]) for c in cut.curves)
    return replace(cut, curves=tuple(held))


def within_limit(panel: Panel, run: Startup) -> Panel:
    """Return a chart of gimbal rates with their limit."""
    return limited(panel, [float(run.run.setup.array.rate_limit[0])], "rad/s")


def early(panel: Panel) -> Panel:
    """Return the transient of a chart."""
    return between(replace(panel, title=f"{panel.title}: first {EARLY:g} s"), 0.0, EARLY)


def later(panel: Panel) -> Panel:
    """Return what follows the transient."""
    return between(replace(panel, title=f"{panel.title}: later"), EARLY, np.inf)


def whole(panel: Panel) -> Panel:
    """Return all of a chart."""
    return between(panel, 0.0, np.inf)
