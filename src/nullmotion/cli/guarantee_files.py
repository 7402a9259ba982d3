"""What ``nullmotion guarantee`` writes."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from nullmotion.guarantee.certificate import Certificate
    from nullmotion.guarantee.constraint import Constraint
    from nullmotion.guarantee.table import Guarantee

RESULT, FIGURE = "guarantee.json", "guarantee.png"


def write(made: Constraint, rows: list[Guarantee], target: Path) -> None:
    """Write table, certificates and figure, all or none."""
    from nullmotion.plot.guarantee import guarantee_figure
    from nullmotion.scenario.files import replacing

    record = {
        "constraint": made.name,
        "parameters": dataclasses.asdict(made),
        "units": {"torque_capability": "h0 x rate limit", "radius": "h0"},
        "guarantees": [_record(row) for row in rows],
    }
    proven = [row.certificate for row in rows if row.certificate]
    with replacing(target, (RESULT, FIGURE)) as new:
        (new / RESULT).write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
        for proof in proven:
            proof.save(new / file_of(proof))
        guarantee_figure(
            new / FIGURE,
            made,
            [(row.radius, row.torque_capability) for row in rows],
            [(proof.radius, proof.torque_capability) for proof in proven],
        )


def file_of(proof: Certificate) -> str:
    """Return the name of a certificate's file."""
    return f"certificate-{proof.torque_capability:g}.json"


def _record(row: Guarantee) -> dict[str, Any]:
    proof = row.certificate
    return {
        "torque_capability": row.torque_capability,
        "radius": row.radius,
        "momentum": list(row.momentum),
        "marked": "certified" if proof else "sampled",
        "proven_radius": proof.radius if proof else None,
        "boxes": proof.boxes if proof is not None else None,
        "seconds": proof.seconds if proof is not None else None,
        "certificate": file_of(proof) if proof else None,
    }
