"""The singularity atlas: surfaces of all sign patterns, types of states, self-motion sets."""

from __future__ import annotations

import time

import numpy as np
from common import Row, median_time

import nullmotion as nm
from nullmotion import atlas

POINTS = 1_000_000


def surfaces(quick: bool) -> list[Row]:
    """All sheets of six CMGs: angles, momenta, types, curvatures and triangles."""
    array, wanted = nm.layouts.pyramid(n=6), POINTS // 100 if quick else POINTS
    sheets = len(atlas.patterns(array))
    resolution = wanted // sheets
    made = atlas.surfaces(array, resolution)
    count = sum(len(s.u) for s in made)
    seconds = median_time(lambda: atlas.surfaces(array, resolution), 1 if quick else 3)
    worst = max(
        float(np.linalg.svd(array.unit_jacobian(s.delta[::97]), compute_uv=False)[:, -1].max())
        for s in made
    )
    return [
        Row(
            "surfaces of six CMGs, all 32 sign patterns",
            seconds,
            "s",
            at_most=5.0,
            note=f"{count} points, {sum(len(s.cells) for s in made)} triangles",
        ),
        Row("of them a sample: largest sigma_min", worst, "", at_most=1e-12),
    ]


def states(quick: bool) -> list[Row]:
    """What a state takes: its type, and all null motion of its momentum."""
    array = nm.layouts.pyramid()
    delta = atlas.surfaces(array, 200)[1].delta[: 50 if quick else 500]
    seconds = median_time(lambda: nm.singularity.classify(array, delta), 3) / len(delta)
    begin = time.perf_counter()
    found = atlas.self_motion(array, [0.3, 0.2, 0.1])
    return [
        Row("type of a singular state of four CMGs", 1e6 * seconds, "us"),
        Row(
            "all self-motion of a momentum, four CMGs",
            time.perf_counter() - begin,
            "s",
            note=f"{len(found)} closed curves",
        ),
    ]


def sizes(quick: bool) -> list[Row]:
    """What sizing asks: the largest ball, the volume, the torque that null motion can keep."""
    array, made = nm.layouts.pyramid(skew=np.arcsin(0.8)), []
    begin = time.perf_counter()
    ball = atlas.omnidirectional(array, 0.002 if quick else 2e-4)
    seconds = time.perf_counter() - begin
    note = f"{ball.lower:.5f} to {ball.upper:.5f} N m s, {ball.basis}"
    made.append(Row("omnidirectional momentum of a pyramid", seconds, "s", note=note))
    made.append(Row("its bounds, (upper - lower) / upper", ball.gap, "", at_most=0.005))
    for what, asked in (
        ("volume of its reachable momenta", lambda: atlas.volume(array, 0.3 if quick else 0.05)),
        ("nearest impassable singularity", lambda: atlas.nearest_impassable(array)),
        ("torque map", lambda: atlas.torque_map(array, resolution=21 if quick else 81)),
    ):
        begin = time.perf_counter()
        asked()
        made.append(Row(what, time.perf_counter() - begin, "s"))
    return made


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    return [*surfaces(quick), *states(quick), *sizes(quick)]


if __name__ == "__main__":
    for row in rows(quick=False):
        print(row.markdown())
