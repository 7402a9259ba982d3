"""How far our VSCMGs are from Basilisk's, and both from an integration of high order.

The numbers behind tests/against/test_vscmg_basilisk.py. Run it where Basilisk is installed (two
minutes): greatest differences of C_NB, body rate [rad/s], gimbal angles [rad] and rates and
wheel speeds, between the two and of each from SciPy's DOP853 on the bodies' own equations.

                                      attitude     omega     delta     rates     speed
    textbook, given torques, 60 s
      dt 0.01   ours - Basilisk        8.2e-12   4.0e-12   4.8e-10   3.3e-10   4.2e-12
      dt 0.01   ours                   1.1e-11   2.1e-11   5.2e-09   1.5e-09   1.7e-11
      dt 0.01   Basilisk               1.0e-11   2.3e-11   5.7e-09   1.8e-09   1.4e-11
      dt 0.001  ours - Basilisk        2.4e-13   1.6e-14   3.5e-12   1.9e-12   6.1e-13
      dt 0.001  ours                   3.0e-13   7.6e-14   1.0e-11   6.2e-12   5.2e-13
      dt 0.001  Basilisk               1.5e-13   9.2e-14   1.4e-11   8.1e-12   3.3e-13
    textbook, rate loops, 20 s
      dt 0.01   ours - Basilisk        1.9e-10   7.6e-12   6.9e-10   7.1e-11   2.9e-11
      dt 0.01   ours                   1.5e-10   6.1e-12   8.0e-10   8.3e-11   1.7e-11
      dt 0.01   Basilisk               1.1e-10   5.6e-12   5.9e-10   5.0e-11   2.7e-11
      dt 0.001  ours - Basilisk        1.9e-13   6.5e-15   1.3e-12   1.8e-13   2.3e-13
      dt 0.001  ours                   1.9e-13   6.2e-15   1.2e-12   1.7e-13   2.8e-13
      dt 0.001  Basilisk               6.0e-15   3.4e-16   5.8e-14   1.4e-14   9.4e-14
    100 N m s, rate loops, 10 s
      dt 0.01   ours - Basilisk        7.5e-07   2.3e-07   1.4e-06   3.6e-06   2.9e-07
      dt 0.01   ours                   2.9e-07   8.8e-08   5.4e-07   1.4e-06   1.1e-07
      dt 0.01   Basilisk               4.6e-07   1.4e-07   8.9e-07   2.2e-06   1.8e-07
      dt 0.001  ours - Basilisk        1.6e-11   4.6e-12   3.2e-11   7.4e-11   2.3e-11
      dt 0.001  ours                   4.9e-11   1.5e-11   9.2e-11   2.4e-10   2.8e-11
      dt 0.001  Basilisk               3.3e-11   1.0e-11   6.0e-11   1.6e-10   1.4e-11
    pico-satellite, rate loops, 10 s
      dt 0.01   ours - Basilisk        2.4e-08   7.1e-09   5.5e-08   4.1e-08   2.2e-08
      dt 0.01   ours                   2.4e-08   2.0e-08   1.8e-08   7.9e-08   1.9e-08
      dt 0.01   Basilisk               6.7e-09   1.3e-08   4.1e-08   6.5e-08   2.3e-08
      dt 0.001  ours - Basilisk        2.5e-12   8.1e-13   5.8e-12   4.5e-12   8.4e-12
      dt 0.001  ours                   2.6e-12   1.6e-12   2.2e-12   7.1e-12   7.2e-12
      dt 0.001  Basilisk               1.3e-12   8.0e-13   4.1e-12   6.1e-12   4.3e-12
    pico-satellite, given torques, 5 s
      dt 0.01   ours - Basilisk        2.4e-08   1.4e-07   8.7e-07   1.7e-06   1.3e-07
      dt 0.01   ours                   8.4e-07   7.7e-06   1.0e-05   5.1e-05   5.4e-06
      dt 0.01   Basilisk               8.6e-07   7.8e-06   1.1e-05   5.2e-05   5.5e-06
      dt 0.001  ours - Basilisk        3.0e-12   1.4e-11   1.0e-10   1.9e-10   1.3e-11
      dt 0.001  ours                   8.1e-11   7.2e-10   7.8e-10   5.2e-09   5.3e-10
      dt 0.001  Basilisk               8.3e-11   7.4e-10   8.8e-10   5.2e-09   5.4e-10

The two are as far from the truth as from each other, within a factor of a few, and both come to
it as dt^4 does. Gimbals free under stronger torques move chaotically, which is why the textbook's
craft is driven gently, or by rate loops: with five times the body rate and slower sines a change
of 1e-9 rad/s at the start, and the step of 0.01 s, grow like this:

    after   the change   ours - Basilisk
      3 s      1.3e-07           2.0e-10
     20 s      6.5e-05           1.4e-07
     60 s      9.9e+00           6.1e-01
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "against"))
import test_vscmg_basilisk as basilisk
import test_vscmg_equations as equations

STEPS = (0.01, 0.001)
FREE = basilisk.PICO._replace(gain=0.0, rate=0.0, torque=2e-3)
STRONG = basilisk.TEXTBOOK._replace(omega=5.0 * basilisk.TEXTBOOK.omega, pace=1.0)
FLIGHTS = {
    "textbook, given torques, 60 s": (basilisk.TEXTBOOK, 60.0),
    "textbook, rate loops, 20 s": (basilisk.SERVED, 20.0),
    "100 N m s, rate loops, 10 s": (basilisk.AGILE, 10.0),
    "pico-satellite, rate loops, 10 s": (basilisk.PICO, 10.0),
    "pico-satellite, given torques, 5 s": (FREE, 5.0),
}


def bodies(craft: basilisk.Craft) -> equations.Craft:
    """Return frames and round wheels with the same sums of inertias."""
    spin, across, about = np.add(craft.wheel, craft.gimbal)
    wheel, across_wheel = craft.wheel[0], 0.5 * min(across, about)
    frames = np.tile([spin - wheel, across - across_wheel, about - across_wheel], (4, 1))
    axes, each = (craft.array.gimbal_axes, craft.array.spin_axes), np.ones(4)
    return equations.Craft(craft.hub, *axes, frames, wheel * each, across_wheel * each)


def exact(craft: basilisk.Craft, seconds: float) -> basilisk.End:
    """Fly by each body's Newton-Euler equations and DOP853 to 1e-12."""
    machine, hold = bodies(craft), basilisk.HOLD
    attitude, speed = Rotation.from_mrp(basilisk.SIGMA).as_matrix().T, np.full(4, craft.speed)
    at = equations.Point(attitude, craft.omega, craft.delta, np.zeros(4), speed)
    for k in range(round(seconds / hold)):
        torque, rate, spin_up = craft.told(hold * k).reshape(3, 4)
        motors = np.concatenate([np.zeros(3), torque + craft.gain * (rate - at.rates), spin_up])

        def acceleration(t: float, at: equations.Point, motors: np.ndarray = motors) -> np.ndarray:
            mass, force = equations.system(machine, at, np.zeros(3))
            return np.linalg.solve(mass, force + motors)

        at = equations.held(at, (hold * k, hold * (k + 1)), acceleration)
    return basilisk.End(at.attitude.T, *at[1:])


def compared(craft: basilisk.Craft, seconds: float) -> None:
    """Print the differences of a flight."""
    truth = exact(craft, seconds)
    for dt in STEPS:
        ours, theirs = (fly(craft, seconds, dt) for fly in (basilisk.ours, basilisk.theirs))
        pairs = {"ours - Basilisk": ours.off(theirs)}
        pairs |= {"ours": ours.off(truth), "Basilisk": theirs.off(truth)}
        for pair, off in pairs.items():
            line = f"  dt {dt:<6} {pair:<15}"
            print(f"{line:32}" + "".join(f"{value:10.1e}" for value in off))


def main() -> None:
    """Print both tables."""
    print(f"{'':32}" + "".join(f"{name:>10}" for name in basilisk.End._fields))
    for name, (craft, seconds) in FLIGHTS.items():
        print(name)
        compared(craft, seconds)
    shaken = STRONG._replace(omega=STRONG.omega + 1e-9)
    print("\nafter   the change   ours - Basilisk")
    for seconds in (3.0, 20.0, 60.0):
        ours, other = (basilisk.ours(craft, seconds) for craft in (STRONG, shaken))
        theirs = basilisk.theirs(STRONG, seconds)
        print(f"{seconds:3.0f} s {ours.off(other).max():12.1e} {ours.off(theirs).max():17.1e}")


if __name__ == "__main__":
    main()
