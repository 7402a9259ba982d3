"""How small the motors of a startup may be: who settles, under pairs of limits.

The satellite of the scenario `vscmg-startup`, 24 random attitudes and gimbal angles for each pair.
Prints the share that settles and the median time from which the attitude stays within 1.1 deg.
"""

from __future__ import annotations

import numpy as np

import nullmotion as nm

WHEELS, GIMBALS, RUNS = (5.0, 2.0, 1.0, 0.5, 0.2), (5.0, 1.0, 0.3, 0.1, 0.03), 24


def settled(wheel_mNm: float, gimbal_rad_s: float, rng: np.random.Generator) -> str:
    scenario = nm.load_scenario(
        "vscmg-startup",
        values={
            "array.wheel_torque_limit_Nm": 1e-3 * wheel_mNm,
            "array.rate_limit_deg_s": float(np.degrees(gimbal_rad_s)),
            "mission.settle_tolerance_deg": 1.1459,
            "simulation.duration_s": 700.0,
        },
    )
    q = rng.normal(size=(RUNS, 4))
    angles = rng.uniform(-180.0, 180.0, (RUNS, 4))
    found = nm.simulate_batch(
        scenario,
        q_BN=q / np.linalg.norm(q, axis=1, keepdims=True),
        gimbal_deg=angles,
        target_q_BN=np.tile([1.0, 0.0, 0.0, 0.0], (RUNS, 1)),
    )
    good = np.isfinite(found["settling_time_s"]) & np.isfinite(found["wheel_settling_s"])
    return f"{good.sum():2d}/{RUNS} {np.nanmedian(found['settling_time_s']):6.1f} s"


def main() -> None:
    rng = np.random.default_rng(1)
    print("wheels      " + "".join(f"{g:>8g} rad/s  " for g in GIMBALS))
    for wheel in WHEELS:
        cells = [settled(wheel, gimbal, rng) for gimbal in GIMBALS]
        print(f"{wheel:4g} mN m   " + "  ".join(cells))


if __name__ == "__main__":
    main()
