"""Vector-control based singularity avoidance and escape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.array.momentum_state import (
    command_direction,
    eram,
    rotor_directions,
    working,
)
from nullmotion.law import Claim, Law, Observation, check_parameters, command_size

_FLOOR = 1e-4
_STILL = 1e-9  # a rotor within this sine of the anti-parallel state stands on it
_ALIGNED = 1e-6  # a gimbal axis within this angle of the command gives it nothing


@dataclass(frozen=True)
class VectorControl(Law):
    """Null motion that turns the gimbal rates towards a wanted direction G.

    With e = hdot/|hdot|, theta_i the angle from rotor i to e, and o_i the component of
    column a_i along the projection of e on the rotor's plane (the paper's h_i . o_i^s):

        f_i = clip(o_i / d, -1, 1);  0.01 where the rotor stands anti-parallel (o_i = 0)
        n_i = f_i exp(xi eram_i),   G = n / |n|                                       (30)
        s_i = clip((theta_i - pi/2) / d, 0, 1)                                        (37)
        lambda z = max_i s_i |r| / max(varsigma, |G . r/|r||) (I - A^+ A) G           (38)

    where r are the pseudo-inverse rates. Off singular states (sigma_m >= sigma_c), and
    where the momentum is used up (sse < epsilon1), delta_dot = r + lambda z; else, with
    q = (sigma_m / sigma_c)^2 and 1/sigma_m replaced by q/sigma_c in r,

        delta_dot = r + q lambda z + (1 - q) escape_rate G                            (39)

    A and hdot are divided by the mean momentum. With one degree of null motion
    (I - A^+ A) G is the paper's (G . z) z. The desaturation branch of Eq 39 is blank in
    the paper; the avoidance law goes on there with sigma_m floored at 1e-4. The rate
    test in f (delta_dot_i = 0) is left out: a rotor that passes the anti-parallel state
    does not stop on it. G is a direction of gimbal rates in rad/s, which the paper
    adds as it stands.

    Args:
        xi: Stretch of the effective residual momentum, above 1.
        d: Half width of the transitions of f and s.
        varsigma: Bound on the null motion, between 0 and 1.
        sigma_c: Singular value below which the array counts as singular.
        epsilon: sse below which momentum counts as exhausted. No rates depend on it;
            it is where the paper's runs stop.
        epsilon1: sse below which a singular state is not escaped.
        escape_rate: Rate along G at a singular state [rad/s]; None scales with the
            command, |hdot| / mean momentum.
        as_published: The reading under which Mao's tables come back: d = 0.13 in f and
            0.1 in s, 0.01 in place of o_i before the division by d, and
            G_i = f_i E_i / |E|, E_i = exp(xi eram_i).
    """

    name: ClassVar[str] = "vcbsae"
    full_name: ClassVar[str] = "Vector-control based singularity avoidance and escape"
    aliases: ClassVar[tuple[str, ...]] = ("vector-control",)
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Eqs 28-39"
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim)

    xi: float = 10.0
    d: float = 0.1
    varsigma: float = 0.1
    sigma_c: float = 0.1
    epsilon: float = 0.2
    epsilon1: float = 0.8
    escape_rate: float | None = None
    as_published: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_parameters(
            self,
            positive=("xi", "d", "varsigma", "sigma_c"),
            not_negative=("epsilon", "epsilon1", "escape_rate"),
        )

    def exact_above(self, array: CmgArray) -> float:
        """Return sigma_c: above it the torque error is rounding."""
        return self.sigma_c

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the pseudo-inverse rates turned towards G, or the escape rates."""
        rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
        squares = ops.maximum(rows.squares, _FLOOR * _FLOOR)
        residual = eram(array, obs.delta, obs.hdot)
        limit = self.sigma_c * self.sigma_c
        left = sum(residual) + ops.sqrt(rows.squares[-1])
        escape = ops.logical_and(
            ops.less(rows.squares[-1], limit), ops.less_equal(self.epsilon1, left)
        )
        q = ops.where(escape, rows.squares[-1] / limit, 1.0)
        r = rows.solve(self._damped(squares, escape))
        G = self._direction(array, obs, residual)
        null = self._null_motion(array, obs, r, G, rows.project_out(G, squares))
        rate = command_size(array, obs) if self.escape_rate is None else self.escape_rate
        return r + q * null + ((1.0 - q) * rate) * G, state

    def _damped(self, squares: Any, escape: Any) -> Any:
        """Return squares whose last makes v_m sigma_m / square = v_m q / sigma_c on escape."""
        least = ops.sqrt(squares[-1])
        cubic = (self.sigma_c * self.sigma_c * self.sigma_c) / least
        last = np.eye(len(squares))[-1]
        return squares + last * ops.where(escape, cubic - squares[-1], 0.0)

    def _direction(self, array: CmgArray, obs: Observation, residual: Any) -> Any:
        """Return G (Eq 30), (n,)."""
        e = command_direction(array, obs.hdot)
        axes = array.gimbal_axes
        in_plane = e - (axes @ e)[:, None] * axes
        reach = ops.sqrt((in_plane * in_plane).sum(axis=1))
        rotors = rotor_directions(array, obs.delta)
        columns = np.stack([linalg.cross(g, h) for g, h in zip(axes, rotors, strict=True)])
        sine = (columns * in_plane).sum(axis=1) / ops.maximum(reach, _ALIGNED)
        against = ops.less((rotors * in_plane).sum(axis=1), -_ALIGNED * _ALIGNED)
        stuck = ops.logical_and(ops.less(ops.absolute(sine), _STILL), against)
        width = 0.13 if self.as_published else self.d
        start = 0.01 / width if self.as_published else 0.01
        f = ops.where(stuck, start, ops.clip(sine / width, -1.0, 1.0)) * working(array)
        amplitude = ops.exp(self.xi * residual)
        n = f * amplitude
        length = linalg.norm(amplitude if self.as_published else n)
        return n / ops.where(ops.less(0.0, length), length, 1.0)

    def _null_motion(
        self, array: CmgArray, obs: Observation, r: Any, G: Any, projected: Any
    ) -> Any:
        """Return lambda z (Eqs 37, 38), (n,)."""
        cosine = rotor_directions(array, obs.delta) @ command_direction(array, obs.hdot)
        behind = 0.5 * np.pi - ops.acos(ops.clip(-cosine, -1.0, 1.0))
        switch = ops.amax(ops.clip(behind / self.d, 0.0, 1.0) * working(array))
        size = linalg.norm(r)
        along = ops.absolute(G @ r) / ops.where(ops.less(0.0, size), size, 1.0)
        return (switch * size / ops.maximum(self.varsigma, along)) * projected
