"""How often each law carries a pyramid to 1.8 h0: 200 random starts and directions.

    python design/lookahead_success.py [--runs 200] [--laws receding-horizon,sr] [--period 0.01]

Starts have zero momentum and random gimbal angles, directions are uniform; both come from one
seed. hdot = 0.5 h0 per second along the direction until h = 1.8 h0, rate limit 1.5 rad/s. A run
succeeds if the error of the torque, taken over each sample (change of momentum / period - hdot,
as a fraction of |hdot|), stays below 2 %.

`disturbed`: somewhere between 30 and 70 % of the run the torque turns to another random
direction or (every second run) reverses, without notice; rates act 20 ms late; the array's momenta
are off by up to 1 % each and its gimbal axes by 0.57 deg (1 %). The torque is then compared
with the command of 20 ms before, and the error that counts is its RMS over the run: the
plant alone makes up to 2 % at single instants. Laws that allow for a delay are told of it.
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from nullmotion import laws, layouts, tree
from nullmotion.array.model import CmgArray
from nullmotion.compile import compile_function
from nullmotion.law import Observation
from nullmotion.scenario.plant import real_array
from nullmotion.scenario.schema import PlantSection
from nullmotion.sim import Setup, run_batch
from nullmotion.sim.workers import run_each

SEED, SPEED, REACH, RATE, DELAY = 2022, 0.5, 1.8, 1.5, 0.02
PASSED = 0.02


def cases(array: CmgArray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return gimbal angles with zero momentum (count, n) and unit directions (count, m)."""
    generator = np.random.default_rng(SEED)
    starts, directions = [], []
    while len(starts) < count:
        delta = generator.uniform(-np.pi, np.pi, array.n)
        direction = generator.normal(size=array.m)
        for _ in range(50):
            step = np.linalg.pinv(array.jacobian(delta), rcond=1e-3) @ array.momentum(delta)
            delta = delta - step * min(1.0, 0.5 / max(np.linalg.norm(step), 1e-300))
        if np.linalg.norm(array.momentum(delta)) < 1e-12:
            starts.append(delta)
            directions.append(direction / np.linalg.norm(direction))
    return np.array(starts), np.array(directions)


def setups(
    name: str, starts: np.ndarray, directions: np.ndarray, period: float, disturbed: bool
) -> list[Setup]:
    """Return a law's runs."""
    array = layouts.pyramid(skew=np.radians(54.73), h0=1.0, rate_limit=RATE)
    law = laws.create(name)
    if disturbed and hasattr(law, "lead_s"):
        law = dataclasses.replace(law, lead_s=DELAY)
    steps = round(REACH / SPEED / period)
    found = []
    for i, (start, direction) in enumerate(zip(starts, directions, strict=True)):
        generator = np.random.default_rng([SEED, i])
        hdot = np.tile(SPEED * direction, (steps, 1))
        extra: dict[str, object] = {}
        if disturbed:
            at = round(generator.uniform(0.3, 0.7) * steps)
            other = generator.normal(size=array.m)
            other = -direction if i % 2 else other / np.linalg.norm(other)
            hdot[at:] = SPEED * other
            errors = PlantSection(gimbal_axis_error_deg=np.degrees(0.01), h0_error=0.01)
            extra["plant"] = real_array(array, errors, generator)
            extra["delay_steps"] = round(DELAY / period)
        command = hdot if disturbed else hdot[0]
        found.append(Setup(array, law, start, command, dt=period, steps=steps, **extra))
    return found


def errors(setup: Setup, impulse: np.ndarray) -> np.ndarray:
    """Return the torque's error over each sample as a fraction of the command."""
    table = setup.hdot if setup.scheduled else np.tile(setup.hdot, (setup.steps, 1))
    late = setup.delay_steps
    achieved = np.diff(impulse, axis=0)[late:] / setup.dt
    return np.linalg.norm(achieved - table[: setup.steps - late], axis=1) / SPEED


def fly(runs: Sequence[Setup]) -> list[np.ndarray]:
    """Return the impulse of each run (steps + 1, m)."""
    if not runs[0].law.traceable:
        return [found.impulse for found in run_each(runs)]
    if runs[0].scheduled:
        return list(fly_together(runs))
    history = run_batch(runs[0], setups=runs, history=1).history
    assert history is not None
    return list(history.impulse)


def fly_together(runs: Sequence[Setup]) -> np.ndarray:
    """Return the impulses (runs, steps + 1, m) of runs with commands of their own.

    A batch of the simulator shares one schedule; here the law is compiled alone and the gimbals
    turn at constant rates from sample to sample, which is what the simulator does too.
    """
    first = runs[0]
    array, law, count = first.array, first.law, len(runs)
    state = law.init(array, first.delta)

    def step(delta: Any, hdot: Any, t: Any, state: Any) -> Any:
        rates, after = law.step(array, Observation(delta, hdot, t, first.dt), state)
        return array.limited(rates), after

    kernel = compile_function(step, np.zeros(array.n), np.zeros(array.m), 0.0, state)
    delta = np.array([one.delta for one in runs])
    carried = np.array([tree.flatten(law.init(array, one.delta)) for one in runs], float)
    table, queue = np.array([one.hdot for one in runs]), []
    momenta = [[one.true_array.momentum(d) for one, d in zip(runs, delta, strict=True)]]
    for k in range(first.steps):
        rates, after = kernel(delta, table[:, k], np.full(count, k * first.dt), carried)
        carried = np.array([*_leaves(after)]).T.reshape(count, -1)
        queue.append(rates)
        if k >= first.delay_steps:
            delta = delta + first.dt * queue[k - first.delay_steps]
        momenta.append([one.true_array.momentum(d) for one, d in zip(runs, delta, strict=True)])
    return np.array(momenta).transpose(1, 0, 2)


def _leaves(state: Any) -> list[np.ndarray]:
    """Return the values of a record of arrays over runs, each (runs,)."""
    if isinstance(state, tuple):
        return [leaf for part in state for leaf in _leaves(part)]
    return list(np.reshape(state, (len(state), -1)).T)


def interval(passed: int, count: int) -> tuple[float, float]:
    """Return Wilson's 95 % confidence interval of a share."""
    z, p = 1.959964, passed / count
    middle = (p + z * z / (2 * count)) / (1 + z * z / count)
    half = z * np.sqrt(p * (1 - p) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return middle - half, middle + half


def row(name: str, count: int, period: float, disturbed: bool) -> dict[str, object]:
    """Return what one law makes of the cases."""
    starts, directions = cases(layouts.pyramid(skew=np.radians(54.73)), count)
    runs = setups(name, starts, directions, period, disturbed)
    found = [errors(s, impulse) for s, impulse in zip(runs, fly(runs), strict=True)]
    peak = np.array([e.max() for e in found])
    rms = np.array([np.sqrt((e * e).mean()) for e in found])
    passed = int(((rms if disturbed else peak) < PASSED).sum())
    low, high = interval(passed, count)
    reads = [*laws.create(name).information_used]
    if disturbed and hasattr(laws.get(name), "lead_s"):
        reads.append("delay")
    return {
        "law": name, "passed": passed, "of": count, "low": low, "high": high,
        "median_peak": float(np.median(peak)), "median_rms": float(np.median(rms)),
        "information": ", ".join(reads) or "angles and command",
    }  # fmt: skip


def main(arguments: Sequence[str]) -> None:
    """Print a row for each law."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--period", type=float, default=0.01)
    parser.add_argument("--laws", default="")
    parser.add_argument("--kinds", default="nominal,disturbed")
    given = parser.parse_args(arguments)
    array = layouts.pyramid()
    names = given.laws.split(",") if given.laws else laws.names()
    print("| runs | law | passed | 95 % interval | median peak | median RMS | information |")
    print("|---|---|---|---|---|---|---|")
    for kind in given.kinds.split(","):
        for name in names:
            if laws.create(name).supports(array):
                continue
            r = row(name, given.runs, given.period, kind == "disturbed")
            print(
                f"| {kind} | {name} | {r['passed']} of {r['of']} | {r['low']:.1%} to "
                f"{r['high']:.1%} | {r['median_peak']:.2%} | {r['median_rms']:.2%} | "
                f"{r['information']} |",
                flush=True,
            )


if __name__ == "__main__":
    main(sys.argv[1:])
