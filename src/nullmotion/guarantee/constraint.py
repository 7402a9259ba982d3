"""What a constraint function is: one set of gimbal angles for every momentum.

An array with n CMGs and m torque dimensions has n - m angles to choose at a given momentum.
A constraint function chooses them once and for all, so that everything the array can do is a
function of its momentum alone: the torque capability can be mapped, and proven.

Momenta here are divided by one CMG's momentum, torques by one CMG's momentum and rate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from nullmotion.array import layouts
from nullmotion.array.model import CmgArray
from nullmotion.compile.tangent import jvp
from nullmotion.errors import InputError
from nullmotion.guarantee.evaluate import compiled
from nullmotion.guarantee.region import Ball, Region

if TYPE_CHECKING:
    from nullmotion.guarantee.certificate import Certificate

_BARELY = 0.01  # torque capability that shows an array regular


@dataclass(frozen=True)
class Constraint:
    """Base of constraint functions: one frozen dataclass in one file under ``constraints/``.

    An entry implements `angles`, `inside` and `squares` as source (`nullmotion.ops`, no
    decision by a value): it then runs on floats, in kernels and in intervals alike.

    Class attributes:
        name: Name in files and in `nullmotion.guarantee.create`.
        full_name: What it is called in the field.
        aliases: Other names it is found under.
        citation: Where it comes from.
        layout: Layout whose arrays it holds.
        method: Inverse whose torque capability it tells: ``pseudo-inverse`` (Eq 15) or
            ``augmented-jacobian`` (Eq 49).
    """

    name: ClassVar[str] = ""
    full_name: ClassVar[str] = ""
    aliases: ClassVar[tuple[str, ...]] = ()
    citation: ClassVar[str] = ""
    layout: ClassVar[str] = ""
    method: ClassVar[str] = "augmented-jacobian"

    @property
    def layout_parameters(self) -> dict[str, Any]:
        """Parameters of the layout beside its name."""
        return {}

    @property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Sets of CMGs with one gimbal axis, which may change places."""
        return ()

    @property
    def reach(self) -> float:
        """Momentum beyond which nothing is inside, in any direction."""
        raise NotImplementedError

    def angles(self, h: Any) -> Any:
        """Return the gimbal angles [rad], (n,), that hold a momentum inside; source."""
        raise NotImplementedError

    def inside(self, h: Any) -> Any:
        """Return whether a momentum (m,) is inside the constrained envelope; source."""
        raise NotImplementedError

    def squares(self, h: Any) -> Any:
        """Return the squared norms of the rows of the right inverse at a momentum; source.

        Their greatest is 1/TC^2. Equal rows may be given once.
        """
        raise NotImplementedError

    def edges(self, h: Any) -> list[Any]:
        """Return values that are <= 0 inside the envelope, where `squares` do not show it."""
        return []

    def parts(self, h: Any) -> list[Any]:
        """Return vectors (d,), of which none may vanish: the array is singular there; source."""
        return []

    def margins(self, h: Any, torque_capability: Any) -> Any:
        """Return values that are all <= 0 just where TC is at least what is given; source."""
        rows = [torque_capability**2 * s - 1.0 for s in self.squares(h)]
        return np.array([*rows, *self.edges(h)])

    def claim(self, radius: float, torque_capability: float) -> tuple[Callable[[Any], Any], Region]:
        """Return source and a region: TC holds in the ball if no value is above 0 there.

        An entry whose torque capability depends on less than the momentum may say so here.
        """
        return lambda h: self.margins(h, torque_capability), Ball(radius, self.m)

    def regular_claim(self, radius: float) -> tuple[Callable[[Any], Any], Region]:
        """Return source and a region: nothing but saturation is singular if no value is above 0."""
        return self.claim(radius, _BARELY)

    def momentum_of(self, point: Any) -> Any:
        """Return the momentum (m,) that a point of the claim's region stands for."""
        return point

    def gimbal_jacobian(self, h: Any) -> Any:
        """Return d angles / d h, (n, m): the augmented Jacobian's inverse on momenta; source."""
        axes = np.eye(len(h))
        return np.stack([jvp(self.angles, (h,), (axis,))[1] for axis in axes], axis=1)

    def array(self, **parameters: Any) -> CmgArray:
        """Return an array that it holds; parameters are h0, rate_limit and the like."""
        return layouts.create(self.layout, **self.layout_parameters, **parameters)

    def without(self, failed: int) -> Constraint:
        """Return the constraint for the array without one CMG.

        Raises:
            InputError: Where there is none.
        """
        raise InputError("failed CMG", failed, f"{self.name} has no constraint for fewer CMGs")

    def gimbal_angles(self, h: Any) -> np.ndarray:
        """Return the gimbal angles [rad], (..., n), that hold momenta (..., m).

        Raises:
            InputError: For a momentum outside the constrained envelope.
        """
        momenta, shape = self._checked(h)
        angles, inside = compiled(self).angles(momenta)
        if not inside.all():
            worst = momenta[np.argmin(inside)]
            raise InputError("h", worst.tolist(), f"a momentum inside the envelope of {self.name}")
        return angles.reshape(*shape, -1)

    def torque_capability(self, h: Any) -> Any:
        """Return the torque capability at momenta (..., m), a float or (...); 0.0 outside."""
        momenta, shape = self._checked(h)
        return compiled(self).capability(momenta).reshape(shape)[()]

    def certificate(
        self,
        radius: float,
        torque_capability: float | None = None,
        *,
        progress: Callable[[float], None] | None = None,
    ) -> Certificate:
        """Prove that TC is at least what is given wherever |h| <= radius.

        Without a torque capability: that inside the envelope nothing but saturation is
        singular there. By branch and bound over boxes, each bounded by interval arithmetic
        through this constraint's own source; a false claim comes back with a momentum that
        refutes it.

        Raises:
            InputError: For a radius or torque capability that is not a finite number above 0.
        """
        from nullmotion.guarantee.certificate import certify

        return certify(self, radius, torque_capability, progress)

    def _checked(self, h: Any) -> tuple[np.ndarray, tuple[int, ...]]:
        momenta = np.asarray(h, float)
        m = self.m
        if momenta.ndim == 0 or momenta.shape[-1] != m:
            raise InputError("h", momenta.tolist(), f"{m} components of momentum on the last axis")
        if not np.isfinite(momenta).all():
            raise InputError("h", "not finite", "finite momenta, in units of one CMG's")
        return momenta.reshape(-1, m), momenta.shape[:-1]

    @property
    def m(self) -> int:
        """Number of torque dimensions."""
        return self.array().m
