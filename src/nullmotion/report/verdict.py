"""How a run went, in words."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from nullmotion.plot.quantities import (
    final_error_deg,
    of_attitude,
    saturated,
    stuck_since,
    tolerance_deg,
)
from nullmotion.plot.view import Run
from nullmotion.report.wheels import at_speed, incomplete
from nullmotion.report.wording import number, plain

Tone = Literal["done", "stopped", "trouble"]


class Verdict(NamedTuple):
    """A headline and how serious it is."""

    words: str
    tone: Tone

    @property
    def useful(self) -> bool:
        """Whether the run's numbers may be compared with others'."""
        return self.tone != "trouble"


def verdict(run: Run) -> Verdict:
    """Return how a run ended."""
    broken = _broken_at(run)
    if broken is not None:
        return Verdict(f"Failed: not a number from {number(broken)} s on", "trouble")
    if of_attitude(run):
        return _of_attitude(run)
    stuck = stuck_since(run)
    if stuck is not None and saturated(run):
        return Verdict(
            f"Saturated: momentum used up, no torque from {number(stuck)} s on", "stopped"
        )
    if stuck is not None:
        return Verdict(f"Stuck: delivers no torque from {number(stuck)} s on", "trouble")
    if run.stopped_at_s is not None:
        reason = plain(run.stop_reason or "a stop condition")
        return Verdict(f"Stopped at {number(run.stopped_at_s)} s: {reason}", "stopped")
    return Verdict(f"Ran to the end ({number(run.t[-1])} s)", "done")


def _of_attitude(run: Run) -> Verdict:
    """Return whether the attitude settled; by metrics, as the history may be thinned."""
    left = f"{number(final_error_deg(run))} deg left at the end"
    stopped = run.stopped_at_s is not None
    ended = f"Stopped at {number(run.stopped_at_s)} s: {plain(run.stop_reason)}" if stopped else ""
    allowed, settled = tolerance_deg(run), run.metrics.get("settling_time_s")
    if allowed is None or settled is None:
        tone: Tone = "stopped" if stopped else "done"
        return Verdict(f"{ended or f'Ran to the end ({number(run.t[-1])} s)'}; {left}", tone)
    within, missed = f"within {number(allowed)} deg", incomplete(run)
    if missed:
        words = f"{missed}, {left}"
        return Verdict("; ".join(filter(None, [words, ended.lower()])), "trouble")
    if not np.isfinite(settled):
        words = f"ot settled {within}: {left}"
        return Verdict(f"{ended}; n{words}" if stopped else f"N{words}", "trouble")
    words = f"Settled {within} in {number(settled)} s" if settled > 0 else f"Always {within}"
    return Verdict("; ".join(filter(None, [words, at_speed(run), ended.lower()])), "done")


def _broken_at(run: Run) -> float | None:
    good = np.isfinite(run.delta).all(axis=1)
    if of_attitude(run):
        good &= np.isfinite(run.q_BN).all(axis=1)
    return None if good.all() else float(run.t[np.flatnonzero(~good)[0]])


def status_words(run: Run) -> list[str]:
    """Return the run's status flags as words, without the one that says all is well."""
    return [plain(str(flag)) for flag in run.status if str(flag).lower() not in ("", "ok", "done")]
