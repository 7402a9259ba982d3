"""What gradient and evolution contribute to knots of any value: behind plan/continuous.py.

Run it (three minutes on one core): gains over the ternary optimum of ten knots on the paper's
manoeuvres, mean and least of five seeds, and seconds. Evolution of 150,000 runs alone finds
the best course known for 20 knots; where there are more, it needs the gradient:

    knots  manoeuvre    gradient        evolution       both
       20  roll         +25.8  +24.0    +26.3  +26.3    +26.3  +26.3
           three-axis   +57.0  +57.0    +58.3  +58.3    +58.3  +58.3
           kinematic    +17.1  +17.1    +18.9  +18.9    +18.9  +18.9
       70  roll         +26.2  +26.2    +22.3  +20.8    +26.8  +26.8
           three-axis   +59.4  +59.3    +60.1  +59.9    +60.2  +60.2
           kinematic    +19.6  +19.5    +10.9   +7.3    +20.5  +20.5

Twelve starts do as well as 32 for the gradient. scipy.optimize's L-BFGS-B from 16 starts, one
after the other at four widths, came to the same courses in ten times the time of the batch.
"""

from __future__ import annotations

import time

import numpy as np

from nullmotion import plan
from nullmotion.plan import continuous, exact
from nullmotion.plan.from_scenario import setup_of

MANOEUVRES = ("roll", "three-axis", "kinematic")
SEEDS = range(5)


def without_gradient(hunt: continuous._Hunt, *_: object) -> None:
    """Leave the climb out."""


def gains(rollouts: plan.Rollouts, length: int, evaluations: int, climbs: bool) -> str:
    """Return mean and least gain in percent, and seconds for one search."""
    best, begin = exact.search(rollouts), time.perf_counter()
    climb = continuous._Hunt.climb
    continuous._Hunt.climb = climb if climbs else without_gradient  # type: ignore[assignment]
    options = {"evaluations": evaluations, "seconds": 600.0}
    found = [
        continuous.search(rollouts, np.array(best.knots), length, seed=seed, **options).value
        for seed in SEEDS
    ]
    continuous._Hunt.climb = climb  # type: ignore[method-assign]
    gain = 100.0 * (np.array(found) / best.value - 1.0)
    seconds = (time.perf_counter() - begin) / len(SEEDS)
    return f"{gain.mean():+6.1f} {gain.min():+6.1f} {seconds:5.1f} s"


def main() -> None:
    """Print the table."""
    print("knots  manoeuvre    gradient               evolution              both")
    for length in (20, 40, 70):
        for name in MANOEUVRES:
            setup, wanted = setup_of(f"papakonstantinou-{name}")
            wanted.pop("levels")
            rollouts = plan.prepared(setup, **wanted)
            modes = ((0, True), (continuous.EVALUATIONS, False), (continuous.EVALUATIONS, True))
            row = "   ".join(gains(rollouts, length, *mode) for mode in modes)
            print(f"{length:5d}  {name:12s} {row}", flush=True)


if __name__ == "__main__":
    main()
