"""Plan a step of the CMG rover uphill, follow it in closed loop, land it on rock and on sand."""

import math

from nullmotion.rover import PlanError, Site, initialise, peter, plan_step, track
from nullmotion.rover.impulsive import impulsive_step
from nullmotion.rover.landing import land
from nullmotion.rover.wheels import hedgehog


def main() -> None:
    """Step over both kinds of edges on 15 deg, then try what cannot be done."""
    rover, site = peter(), Site(incline=math.radians(15))
    for edge in (1, 2):
        plan = plan_step(rover, edge, site)
        print(
            f"edge {edge}: {plan.duration:.2f} s, {plan.least_margin:.1f} N m to spare, "
            f"{plan.cost_of_travel:.1f} J/kg/m"
        )
        way = initialise(plan, delta=0.0)
        print(f"  the gimbal gets to its start in {way.duration:.1f} s without moving the rover")
        run = track(plan)
        print(f"  closed loop: {run.outcome}, at most {run.max_angle_error:.3f} rad off")
        for ground in ("rock", "sand"):
            landing = land(plan, ground)
            print(f"  on {ground}: {landing.outcome}, slip {1e3 * landing.slip:.1f} mm")

    wheels = impulsive_step(hedgehog(), site=site)
    print(f"Hedgehog, impulsive: {wheels.cost_of_travel:.0f} J/kg/m")

    try:
        plan_step(rover, site=Site(incline=math.radians(80)))
    except PlanError as error:
        print(error)


if __name__ == "__main__":
    main()
