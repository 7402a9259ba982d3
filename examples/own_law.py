"""A steering law in one file: the transpose of the Jacobian, scaled to the command.

It flies below. The command line takes the same file:

    nullmotion compare elliptic-singularity --laws sr --law-file examples/own_law.py
"""

from dataclasses import dataclass

import numpy as np

import nullmotion as nm
from nullmotion import ops


@dataclass(frozen=True)
class Transpose(nm.Law):
    """delta_dot = c A^T hdot with the c for which A delta_dot is nearest to hdot.

    Args:
        least: Floor of |A A^T hdot|^2 / |hdot|^2, where the singular direction is commanded.
    """

    name = "transpose"
    full_name = "Jacobian transpose"
    citation = "an example"
    claims = frozenset({nm.Claim.FINITE, nm.Claim.STATELESS, nm.Claim.TIMELESS})

    least: float = 1e-3

    def step(self, array, obs, state):
        """Return rates along the steepest descent of the torque error."""
        A, b = array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum
        rates = A.T @ b
        torque = A @ rates
        return rates * (b @ torque) / ops.maximum(torque @ torque, self.least * (b @ b)), state


def main() -> None:
    """Fly the law and one of the package's through the same manoeuvre."""
    nm.laws.load_file(__file__)
    for name in ("transpose", "sr"):
        scenario = nm.load_scenario("elliptic-singularity", {"law.name": name})
        run = nm.simulate(scenario)
        found = run.summary()
        print(f"{name}, {run.backend}: {run.stop_reason} at {found['duration_s']:.2f} s")
        print(f"  momentum {np.round(found['final_momentum'], 3)} N m s")
        print(f"  least sigma_min {found['min_sigma_min']:.4f}")
        print(f"  off-axis torque, peak {found['max_off_axis_torque_fraction']:.3f} of the command")


if __name__ == "__main__":
    main()
