"""A certificate: something proven over a ball of momentum, to be checked again.

Two things are claimed: a torque capability, and that nothing but saturation is singular.
"""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.region import Region

_FORMAT = "nullmotion certificate 1"
Kind = Literal["torque capability", "no internal singularity"]
_METHOD = "interval arithmetic in IEEE doubles, every operation rounded outward; branch and bound"


@dataclass(frozen=True)
class Certificate:
    """What was claimed, whether it holds, and the boxes that show it.

    Attributes:
        kind: What is claimed.
        constraint: Name of the constraint function.
        parameters: Its fields.
        radius: Radius of the ball |h| <= radius, in units of one CMG's momentum.
        torque_capability: Claimed lower bound of TC inside; 0 where none is claimed.
        proven: Whether every box of a partition of the ball was proven.
        boxes: Number of boxes of the partition.
        depth: Halvings from the first box to the smallest.
        tree: The partition, for `check`: see `nullmotion.guarantee.proof`.
        seconds: Time it took, compilation included [s].
        reason: Why it was not proven; empty if it was.
        counterexample: A momentum inside at which the claim is false, if one was found.
        counterexample_capability: TC there.
    """

    kind: Kind
    constraint: str
    parameters: dict[str, Any]
    radius: float
    torque_capability: float
    proven: bool
    boxes: int
    depth: int
    tree: str
    seconds: float
    reason: str = ""
    counterexample: tuple[float, ...] | None = None
    counterexample_capability: float | None = None

    @property
    def statement(self) -> str:
        """The claim and what became of it, in a sentence."""
        what = f"TC >= {self.torque_capability:g}"
        if self.kind == "no internal singularity":
            what = "no singularity but saturation"
        claim = f"{what} for every |h| <= {self.radius:g}"
        if self.proven:
            return f"{claim}: proven with {self.boxes:,} boxes"
        if self.counterexample is None:
            return f"{claim}: not proven ({self.reason}, {self.boxes:,} boxes)"
        where = ", ".join(f"{v:.6g}" for v in self.counterexample)
        return f"{claim}: false, TC = {self.counterexample_capability:.6g} at h = ({where})"

    def __bool__(self) -> bool:
        """Whether the claim is proven."""
        return self.proven

    def save(self, path: str | Path) -> None:
        """Write it as JSON, to a temporary name first."""
        file = Path(path)
        record = {"format": _FORMAT, "method": _METHOD, "statement": self.statement}
        record |= {"region": f"|h| <= {self.radius!r} h0", "units": "h0, h0 rate_limit"}
        text = json.dumps(record | dataclasses.asdict(self), indent=1)
        part = file.with_name(f".{file.name}.part")
        part.write_text(text + "\n", encoding="utf-8")
        os.replace(part, file)

    def check(self, progress: Callable[[float], None] | None = None) -> bool:
        """Return whether the boxes do show the claim, in ball arithmetic of 80 bits.

        Every box is rebuilt from the tree and evaluated again, by python-flint; nothing of
        the arithmetic that found the proof is used.
        """
        from nullmotion.guarantee import check, create

        constraint = create(self.constraint, **self.parameters)
        function, region = _claim(constraint, self.kind, self.radius, self.torque_capability)
        return self.proven and check.check(function, region, self.tree, progress=progress).ok


def _claim(
    constraint: Constraint, kind: Kind, radius: float, torque_capability: float
) -> tuple[Callable[[Any], Any], Region]:
    if kind == "torque capability":
        return constraint.claim(radius, torque_capability)
    return constraint.regular_claim(radius)


def load(path: str | Path) -> Certificate:
    """Return a certificate from its file.

    Raises:
        InputError: For a file that is not one.
    """
    file = Path(path)
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
        if record.get("format") != _FORMAT:
            raise ValueError("not a certificate")
        return Certificate(**{f.name: record[f.name] for f in dataclasses.fields(Certificate)})
    except (OSError, ValueError, KeyError, AttributeError) as error:
        raise InputError("certificate", str(path), f"a file that --out wrote ({error})") from None


def certify(
    constraint: Constraint,
    radius: float,
    torque_capability: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Certificate:
    """Prove that TC is at least ``torque_capability`` wherever |h| <= ``radius``.

    Without a torque capability: that nothing but saturation is singular there.

    Raises:
        InputError: For a radius or torque capability that is not a finite number above 0.
    """
    from nullmotion.guarantee.proof import prove

    for key, value in (("radius", radius), ("torque_capability", torque_capability)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise InputError(key, value, "a finite number above 0")
    kind: Kind = "torque capability" if torque_capability else "no internal singularity"
    size, least = float(radius), float(torque_capability or 0.0)
    function, region = _claim(constraint, kind, size, least)
    found = prove(function, region, progress=progress)
    return Certificate(
        kind=kind,
        constraint=constraint.name,
        parameters=dataclasses.asdict(constraint),
        radius=size,
        torque_capability=least,
        proven=found.proven,
        boxes=found.boxes,
        depth=found.depth,
        tree=found.tree if found.proven else "",
        seconds=found.seconds,
        reason="" if found.proven else found.reason,
        **_refutation(constraint, found.counterexample),
    )


def _refutation(constraint: Constraint, counterexample: Any) -> dict[str, Any]:
    if counterexample is None:
        return {}
    momentum = constraint.momentum_of(np.asarray(counterexample[0], float))
    return {
        "counterexample": tuple(float(v) for v in momentum),
        "counterexample_capability": float(constraint.torque_capability(momentum)),
    }
