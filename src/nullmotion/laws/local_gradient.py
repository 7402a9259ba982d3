"""Local gradient: null motion up the slope of det(A A^T)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation, check_parameters, command_size

_FLOOR = 1e-4


@dataclass(frozen=True)
class LocalGradient(Law):
    """Pseudo-inverse rates and null motion towards a larger det(A A^T).

        delta_dot = A^+ hdot + k (I - A^+ A) d,   d_i = d det(A A^T) / d delta_i
        d_i       = -2 h_i^T adj(A A^T) a_i       (a_i: column of A, d a_i / d delta_i = -h_i)

    A, h_i and hdot are divided by the mean momentum, which Eq 59 as printed leaves out.
    A^+ has the singular values' floor of `pseudo-inverse`.

    Args:
        k: Gain of the null motion [rad/s]; None scales with the command,
            k = |hdot| / mean momentum. Elliott varies it from 0.2 to 1.
    """

    name: ClassVar[str] = "local-gradient"
    full_name: ClassVar[str] = "Local gradient"
    aliases: ClassVar[tuple[str, ...]] = ("lg", "gradient")
    citation: ClassVar[str] = "Elliott, dissertation (2019), Eqs 59, 143"
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim)

    k: float | None = None

    def __post_init__(self) -> None:
        """Check the gain."""
        check_parameters(self, not_negative=("k",))

    def exact_above(self, array: CmgArray) -> float:
        """Return the floor of the singular values."""
        return _FLOOR

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return least rates and the projected gradient."""
        A = array.unit_jacobian(obs.delta)
        rows = linalg.rows(A, obs.hdot / array.mean_momentum)
        squares = ops.maximum(rows.squares, _FLOOR * _FLOOR)
        momenta = array.rotor_momenta(obs.delta) / array.mean_momentum
        slope = linalg.adjugate(A @ A.T) @ A
        gradient = -2.0 * np.array([momenta[i] @ slope[:, i] for i in range(array.n)])
        gain = command_size(array, obs) if self.k is None else self.k
        rates = rows.solve(squares)
        return rates + gain * rows.project_out(gradient, squares), state
