"""The quadratic program of a plan: null motion at each knot, two slacks, no equation.

With delta_k = p_k + N_k lambda_k (`knots.Knot`: p_k has the knot's momentum, N_k is null motion),
moves x_k = delta_k - delta_(k-1), distances d_k in momentum and times T_k:

    minimise   sum_k  w/2 |x_k|^2 / d_k  +  rho/2 d_k s_k^2  +  kappa d_k q_k
    with       sigma_k + slope_k lambda_k + s_k >= sigma_ref,          s_k >= 0
               |x_k| <= rmax T_k (1 + q_k),                            q_k >= 0
               |lambda_k| <= trust

s_k is what sigma_min lacks. q_k is what a step takes longer than it may: the torque of a step
beyond the rate limits is 1/(1 + q_k) of what is asked, in its direction. So every program can be
met, and a factor of time and torque together changes nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple

LATE = 50.0  # kappa: the price of torque that is not given, before all else
_STEADY = 1e-3  # keeps the Hessian definite


class Node(NamedTuple):
    """What a knot adds to the program (compiled, for many at once).

    Attributes:
        diagonal: Of the Hessian, for each lambda.
        cross: Hessian between lambda_(k-1) and lambda_k, (n - m, n - m).
        gradient: To lambda_k, (n - m,).
        price: rho d_k.
        late: kappa d_k.
        slope: Of sigma_min along lambda_k, (n - m,).
        lacking: sigma_ref - sigma_k.
        null: d x_k / d lambda_k, (n, n - m).
        back: d x_k / d lambda_(k-1), (n, n - m).
        stretch: rmax T_k, (n,); and with the other sign.
        upper: rmax T_k - x_k at lambda = 0, (n,).
        lower: -rmax T_k - x_k at lambda = 0, (n,).
    """

    diagonal: Any
    cross: Any
    gradient: Any
    price: Any
    late: Any
    slope: Any
    lacking: Any
    null: Any
    back: Any
    stretch: tuple[Any, Any]
    upper: Any
    lower: Any


class Links(NamedTuple):
    """What a node is made from: its knot, the knots beside it, its step.

    Attributes:
        point: Configuration at the knot's momentum, (n,), with those before and after it.
        null: Null motion as orthogonal columns of one length, (n, n - m), and that of the knot
            before (zero for the first).
        slope: See `Node`.
        ahead: sigma_min expected at ``point``.
        weight: w/d_k of the steps to and from the knot (the last: 0).
        step: d_k.
        limit: rmax T_k [rad], (n,).
        price: rho.
        reference: sigma_ref.
    """

    point: tuple[Any, Any, Any]
    null: tuple[Any, Any]
    slope: Any
    ahead: Any
    weight: tuple[Any, Any]
    step: Any
    limit: Any
    price: Any
    reference: Any


def node(links: Links) -> Node:
    """Return a knot's share of the program."""
    point, before, after = links.point
    null, null_before = links.null
    w, w_after = links.weight
    move, limit = point - before, links.limit
    return Node(
        (w + w_after) * (null[:, 0] @ null[:, 0]) + _STEADY,
        -w * (null_before.T @ null),
        null.T @ (w * move - w_after * (after - point)),
        links.price * links.step,
        LATE * links.step,
        links.slope,
        links.reference - links.ahead,
        null,
        -null_before,
        (limit, -limit),
        limit - move,
        -limit - move,
    )
