"""Call steering laws by hand: gimbal rates from measured angles and a wanted hdot."""

import numpy as np

import nullmotion as nm

array = nm.layouts.pyramid(h0=1.0, rate_limit=np.pi)
delta = np.radians([-85.0, 0.0, 85.0, 0.0])  # close to the internal elliptic singularity
hdot = np.array([1.0, 0.0, 0.0])  # N m, along the direction that is getting lost

print("rates in deg/s, after the rate limit, and the torque error across and along the command:")
for name in nm.laws.names():
    law = nm.laws.create(name)
    if reason := law.supports(array):
        print(f"  {name:16s} {reason}")
        continue
    state = law.init(array, delta)
    sample = nm.Observation(delta=delta, hdot=hdot, t=0.0, period=0.01)
    rates, state = law.step(array, sample, state)
    rates = array.limited(rates)
    error = array.jacobian(delta) @ rates - hdot
    print(
        f"  {name:16s} {np.degrees(rates).round(1)!s:36s}"
        f" across {np.hypot(error[1], error[2]):.3f} N m, along {error[0]:+.3f} N m"
    )

# The same law as machine code for this array: a call takes about a microsecond.
law = nm.laws.create("vcbsae")
compiled = nm.prepare(law, array, period=0.01)
plain, _ = law.step(array, nm.Observation(delta=delta, hdot=hdot), law.init(array, delta))
print("\nvcbsae, compiled - plain [rad/s]:", compiled(delta, hdot) - array.limited(plain))
