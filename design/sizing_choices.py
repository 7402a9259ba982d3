"""Why `nullmotion size` tries what it tries: laws, start angles, coasts and skew angles flown.

Each line is the least h0^2 x rate over the gimbal rates at which every one of about a hundred
slews settles (N m s, rad/s), for the 100 kg case. Run it with a requirement's name for another.
"""

from __future__ import annotations

import sys

import numpy as np

from nullmotion.sizing import load_requirement
from nullmotion.sizing.curve import Curve, rates
from nullmotion.sizing.geometry import Geometry, Start
from nullmotion.sizing.slews import searched
from nullmotion.sizing.trial import Fleet, Trial

LAWS = ("sr", "gsr", "local-gradient", "constraint", "nd", "dsea", "vcbsae")


def worth(fleet: Fleet, geometry: Geometry, law: str, coast: float) -> str:
    r = fleet.requirement
    trial = Trial(fleet, geometry, law, coast)
    curve = Curve(trial, searched(r, geometry, 3), rates(r.gimbal_rates, 8), 0.02)
    knee = curve.knee
    return f"{curve.best:9.3f}  h0 {knee.h0:7.3f}  rate {np.degrees(knee.rate):6.1f} deg/s"


def main() -> None:
    fleet = Fleet(load_requirement(sys.argv[1] if len(sys.argv) > 1 else "agile-100kg"))
    angles = {"box90": None, "roof": np.pi / 4, "roof6": None, "pyramid": np.radians(54.73)}
    starts: tuple[Start, ...] = ("home", "constraint")
    print("laws and start angles, coast 0.4")
    for layout, skew in angles.items():
        for start in starts:
            geometry = Geometry(layout, skew, False, start)
            for law in LAWS if geometry.held or start == "home" else ():
                if not Trial(fleet, geometry, law, 0.4).unsupported:
                    print(f"{layout:8} {start:11} {law:15}", worth(fleet, geometry, law, 0.4))
    print("coasts")
    for layout, skew in angles.items():
        for coast in (0.0, 0.2, 0.4, 0.6):
            print(f"{layout:8} {coast}", worth(fleet, Geometry(layout, skew, False), "sr", coast))
    print("angles")
    for layout in ("roof", "pyramid"):
        for skew in np.radians(np.arange(15.0, 75.0, 5.0)):
            made = worth(fleet, Geometry(layout, float(skew), False), "sr", 0.4)
            print(f"{layout:8} {np.degrees(skew):4.0f} deg", made)


if __name__ == "__main__":
    main()
