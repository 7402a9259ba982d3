"""Fly a slew with a gimbal that sticks, from Python, and see who settles."""

import numpy as np

import nullmotion as nm
from nullmotion.metrics import applicable, get
from nullmotion.sim import Setup, run
from nullmotion.spacecraft import Event, Servo, Spacecraft, controllers


def slew(cmgs: int, law: str) -> Setup:
    """Return a 40 deg slew in which CMG 1 (counted from 0) sticks after 2 s."""
    array = nm.layouts.pyramid(n=cmgs, h0=1.0, rate_limit=np.radians(60.0))
    half = np.radians(20.0)
    axis = np.array([1.0, 2.0, 1.0]) / np.sqrt(6.0)
    return Setup(
        array,
        nm.laws.create(law),
        np.zeros(cmgs),
        np.zeros(3),
        dt=0.01,
        steps=2500,
        spacecraft=Spacecraft(np.array([10.0, 12.0, 8.0])),
        controller=controllers.create("quaternion-feedback", natural_frequency_rad_s=0.5),
        target=np.concatenate([[np.cos(half)], np.sin(half) * axis]),
        servo=Servo(time_constant=0.02),
        events=(Event("stuck", cmg=1, at=2.0, detected_after=0.5),),
        metrics=tuple(get(name)() for name in applicable(True)),
    )


def main() -> None:
    """Print a line for each array and law."""
    print("CMGs  law             settled [s]  error [deg]  motor [N m]  saturated [s]")
    for cmgs in (4, 5, 6):
        for law in ("pseudo-inverse", "sr", "vcbsae"):
            m = run(slew(cmgs, law)).metrics
            settled = m["settling_time_s"]
            text = "never" if np.isnan(settled) else f"{settled:.2f}"
            print(
                f"{cmgs:4d}  {law:14s}  {text:>11s}  {m['final_pointing_error_deg']:11.4f}"
                f"  {m['max_motor_torque_Nm']:11.3f}  {m['rate_saturated_s']:13.2f}"
            )


if __name__ == "__main__":
    main()
