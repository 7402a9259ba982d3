"""Section 4.4.2 of Elliott 2019: what the text says of Figures 26 to 28."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from nullmotion.papers.base import Cell
from nullmotion.papers.elliott2019_runs import SINGULAR, Run, Section44
from nullmotion.papers.elliott2019_spheres import Band

MARGIN = 0.02  # by which the predicted band is widened
MANY = 5  # of 50 trajectories
NOTE = (
    "Section 4.4 with three seeds of the random numbers, which the dissertation does not print. "
    f"A trajectory ends singular where det(J J^T) is below {SINGULAR:g}; det J_t for CB. "
    "The last columns are shares of the steps: TC outside of what the constraint can have at that "
    "|H|, widened by 0.02, and above it."
)

_STEPS = "of {} steps, the band widened by 0.02"
_LEAST = "det J_t is {:.3g} at least"
_ENDS = "{} of {} trajectories; det(J J^T) is {:.1e} at most there and {:.2g} at least elsewhere"
_NEGATIVE = "least TC {:.3g}, rate limit 1 rad/s"
_ZERO = "least TC of all gains {:.3g}; negative at k = {}"
_SHARE = "at {:.0f} to {:.0f} % of the steps"


def cells(section: Section44, band: Band) -> Iterator[Cell]:
    """Return the statements of Section 4.4.2."""
    for row, column, published, computed, note in _lines(section, band):
        yield Cell("text", row, column, published, computed, 0.0, "inferred", note)


def _lines(section: Section44, band: Band) -> Iterator[tuple[Any, ...]]:
    cb, lg = section.constrained, section.gradients
    out, row = float(outside(cb, band)), "CB, 50 trajectories"
    yield row, "steps_outside_predicted_band", 0.0, out, _STEPS.format(len(cb))
    least = float(cb.measure.min())
    yield row, "non-singular", "yes", _yes(least > SINGULAR), _LEAST.format(least)
    for run in lg.values():
        ends = np.sort(run.ends)
        split, count = run.singular_ends, len(ends)
        limits = ends[max(split - 1, 0)], ends[min(split, count - 1)]
        note = _ENDS.format(split, count, *limits)
        yield run.label, "many_end_singular_at_0", "yes", _yes(split >= MANY), note
    lowest = {k: float(run.capability.min()) for k, run in lg.items()}
    last, below = max(lg), [k for k, tc in lowest.items() if tc < 0]
    note = _NEGATIVE.format(lowest[last])
    yield lg[last].label, "TC_negative_somewhere", "yes", _yes(lowest[last] < 0), note
    note = _ZERO.format(min(lowest.values()), ", ".join(f"{k:g}" for k in below))
    yield "LG", "TC_near_zero_or_negative", "yes", _yes(min(lowest.values()) < MARGIN), note
    shares = [above(run, band) for run in lg.values()]
    note = _SHARE.format(100 * min(shares), 100 * max(shares))
    yield "LG", "TC_above_CB_somewhere", "yes", _yes(max(shares) > 0), note


def _yes(holds: Any) -> str:
    return "yes" if holds else "no"


def outside(run: Run, band: Band) -> int:
    """Return the number of steps with a TC outside the widened band."""
    return int(band.outside(run.sizes, run.capability, MARGIN).sum())


def above(run: Run, band: Band) -> float:
    """Return the share of steps with a TC above the widened band."""
    high = np.interp(run.sizes, band.sizes, band.high)
    return float((run.capability > high + MARGIN).mean())


def beyond(section: Section44, band: Band) -> Iterator[dict[str, Any]]:
    """Return one row for each law."""
    for run in (section.constrained, *section.gradients.values()):
        yield {
            "law": run.label,
            "seed": section.seed,
            "arrived": run.arrived,
            "end singular": run.singular_ends,
            "least TC": float(run.capability.min()),
            "greatest TC": float(run.capability.max()),
            "outside CB's band": outside(run, band) / len(run),
            "above CB's band": above(run, band),
        }
