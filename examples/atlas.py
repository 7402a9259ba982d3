"""Size by what an array can hold in every direction, and ask what null motion can do."""

import numpy as np

import nullmotion as nm
from nullmotion import atlas


def main() -> None:
    """Compare skews by their omnidirectional momentum; look at one elliptic state."""
    print("skew [deg]   outer surface   every direction   best direction [N m s]")
    for skew in (40.0, 54.73, 70.0):
        array = nm.layouts.pyramid(skew=np.radians(skew))
        ball, most = atlas.omnidirectional(array), atlas.max_momentum(array)
        outer = atlas.outer_surface(array)
        print(f"{skew:10.2f} {outer.radius:15.3f} {ball.lower:17.3f} {most.upper:16.3f}")

    array = nm.layouts.pyramid(skew=np.radians(54.73))
    state = atlas.inspect(array, np.radians([-90.0, 0.0, 90.0, 0.0]))
    size = np.linalg.norm(state.momentum)
    leave = "can" if state.escapable else "cannot"
    print(f"[-90, 0, 90, 0] deg: {state.kind}, |h| = {size:.4f} N m s; null motion {leave} leave")
    near = atlas.nearest_impassable(array)
    if near is not None:
        print(f"nearest impassable singularity: |h| = {near.radius:.4f} N m s")


if __name__ == "__main__":
    main()
