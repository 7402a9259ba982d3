"""Spin variable-speed CMGs up from rest while the attitude is held, motors limited."""

import numpy as np

import nullmotion as nm


def main() -> None:
    """Fly one startup, then a hundred with inertias that the controller does not know."""
    found = nm.simulate("vscmg-startup")
    assert found.wheel_speed is not None
    print("t [s]   wheel speeds [rad/s]               pointing error [deg]")
    for k in np.searchsorted(found.t, (0.0, 10.0, 50.0, 100.0, found.t[-1])):
        speeds = "  ".join(f"{speed:7.2f}" for speed in found.wheel_speed[k])
        print(f"{found.t[k]:5.0f}   {speeds}   {np.degrees(found.pointing_error[k]):12.4f}")

    rng = np.random.default_rng(0)
    known = np.diag(nm.load_scenario("vscmg-startup").spacecraft.inertia_kg_m2)
    inertias = np.diag(known)[None] * rng.uniform(0.8, 1.2, (100, 3))
    batch = nm.simulate_batch("vscmg-startup", inertia_kg_m2=inertias)
    settled = np.isfinite(batch["settling_time_s"]) & np.isfinite(batch["wheel_settling_s"])
    print(f"{settled.sum()} of {len(batch)} spacecraft with inertias 20 % off start up;")
    print(f"the slowest wheel takes {np.nanmax(batch['wheel_settling_s']):.0f} s")


if __name__ == "__main__":
    main()
