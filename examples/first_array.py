"""Define an array, look at its momentum and Jacobian, and see how near it is to singular."""

import numpy as np

import nullmotion as nm

array = nm.layouts.pyramid(skew=np.radians(54.73), h0=1.0, rate_limit=np.pi)

start = np.zeros(4)
print("momentum at zero angles [N m s]:", array.momentum(start))
print("Jacobian A = dh/d(delta) [N m s/rad]:")
print(array.jacobian(start).round(4))

# Measures are those of A over the mean momentum; leading axes of delta are a batch.
singular = np.radians([-90.0, 0.0, 90.0, 0.0])
path = np.linspace(0.0, 1.0, 5)[:, None] * singular + 0.0
print("\nfrom zero angles to the internal elliptic singularity:")
measures = nm.singularity.measures(array, path)
for i, angles in enumerate(np.degrees(path)):
    print(
        f"  delta = {angles} deg:",
        ", ".join(f"{name} = {values[i]:.3g}" for name, values in measures.items()),
    )

near = nm.singularity.nearest(array, start)
print("\nnearest singular configuration to zero angles:")
print(f"  delta_s = {np.degrees(near.delta_s).round(1)} deg, {near.distance:.3f} rad away")
print(f"  no torque along u = {near.u.round(3)} there")

frozen = array.without(2, frozen_at=np.radians(30.0))
held = frozen.momentum(np.zeros(3))
print("\nwith CMG 2 (counted from 0) stuck at 30 deg, its wheel spinning:")
print(f"  {frozen.n} CMGs steer, momentum at their zero angles {held.round(3)} N m s")
