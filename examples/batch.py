"""A thousand random starts at once: how much off-axis torque does a law cause?"""

import time
from itertools import pairwise

import numpy as np

import nullmotion as nm

RUNS = 1000

random = np.random.default_rng(1)
starts = random.uniform(-60.0, 60.0, (RUNS, 4))  # gimbal angles, deg
directions = random.normal(size=(RUNS, 3))
directions /= np.linalg.norm(directions, axis=1, keepdims=True)  # 1 N m each

for name in ("sr", "vcbsae"):
    scenario = nm.load_scenario("elliptic-singularity", {"law.name": name})
    began = time.perf_counter()
    batch = nm.simulate_batch(scenario, gimbal_deg=starts, hdot_Nm=directions)
    seconds = time.perf_counter() - began
    print(f"{name}: {len(batch)} runs in {seconds:.2f} s, compilation included")

    peak = batch["max_off_axis_torque_fraction"]
    counts, edges = np.histogram(peak, bins=np.linspace(0.0, 1.0, 11))
    for count, (low, high) in zip(counts, pairwise(edges), strict=True):
        print(f"  {low:.1f} to {high:.1f}{count:6d} {'#' * -(-60 * count // RUNS)}")
    print(f"  median {np.median(peak):.3f}, above 1.0: {np.sum(peak > 1.0)}\n")
