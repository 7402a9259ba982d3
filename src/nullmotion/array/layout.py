"""What a layout is: parameters in, axes out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray


@dataclass(frozen=True)
class Layout:
    """Base of named geometries: one frozen dataclass in one file under ``layouts/``.

    Fields are the parameters; an angle (metadata ``{"unit": "deg"}``) is in rad here
    and carries ``_deg`` in files.

    Class attributes:
        name: Name in files and in ``nullmotion.layouts``.
        full_name: What it is called in the field.
        aliases: Other names it is found under.
        citation: Where it is described.
    """

    name: ClassVar[str] = ""
    full_name: ClassVar[str] = ""
    aliases: ClassVar[tuple[str, ...]] = ()
    citation: ClassVar[str] = ""

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes, each (n, 3)."""
        raise NotImplementedError

    def home(self) -> Any:
        """Return gimbal angles [rad] with no momentum and a regular Jacobian, to start from."""
        gimbal_axes, _ = self.axes()
        return np.zeros(len(gimbal_axes))

    def array(self, **parameters: Any) -> CmgArray:
        """Return the array; parameters are those of `CmgArray` beside the axes."""
        gimbal, spin = (np.asarray(a, float) for a in self.axes())
        # cos(pi/2) is meant as 0
        gimbal, spin = (np.where(np.abs(a) < 1e-15, 0.0, a) for a in (gimbal, spin))
        return CmgArray(gimbal, spin, **parameters, label=self.name)
