"""One state of an array in words: on screen and on the page."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from nullmotion.atlas.manifold import SINGULAR
from nullmotion.atlas.state import State
from nullmotion.report import page
from nullmotion.report.markup import Markup, tag
from nullmotion.report.tables import table
from nullmotion.report.wording import number

_MEANINGS = {
    "regular": "regular: torque in every direction",
    "saturation": "saturation: no more momentum along u",
    "elliptic": "elliptic: no null motion, so that it cannot be left by null motion",
    "hyperbolic": "hyperbolic: null motion leaves it",
    "degenerate-hyperbolic": "degenerate hyperbolic: null motion there stays singular",
}
_MOST = 6  # pieces of the self-motion set that are told one by one
_HEAD = ("Piece", "Best sigma_min", "at gimbal angles [deg]", "Best sqrt(det A Aᵀ)", "Here")


def state_rows(state: State) -> list[tuple[str, str]]:
    """Return what is said about a state."""
    measures, size = state.measures, number(np.linalg.norm(state.momentum))
    rows = [
        ("Gimbal angles", f"{_list(np.degrees(state.delta))} deg"),
        ("Momentum", f"{_list(state.momentum)} N m s, |h| = {size}"),
        ("Type", _MEANINGS[state.kind]),
        ("sigma_min", number(_zero(measures["sigma_min"]))),
        ("sqrt(det(A Aᵀ))", number(_zero(measures["sqrt_det_AAT"]))),
        ("Torque capability", f"{number(_zero(state.torque_capability))} h0 × rate limit"),
    ]
    if state.u is not None and state.signs is not None:
        signs = "".join({1: "+", -1: "−", 0: "0"}[int(s)] for s in state.signs)
        rows.append(("Singular direction u", f"{_list(state.u)}, signs {signs}"))
        words = {True: "yes", False: "no", None: "–"}
        along, against = words[state.passable_along], words[state.passable_against]
        rows.append(("Momentum can go on", f"along u: {along}; against u: {against}"))
    best = state.component.best["sigma_min"]
    count = len(state.components)
    pieces = "one piece" if count == 1 else f"{count} pieces"
    rows += [
        ("Null motion can leave", "yes" if state.escapable else "no"),
        ("Best sigma_min by null motion", f"{number(_zero(best.value))} (from here)"),
        ("Gimbal angles of this momentum", pieces),
    ]
    return rows


def state_section(state: State) -> Markup:
    """Return the section of a page that tells about a state."""
    said = table(("What", "Value"), state_rows(state), "The state looked at")
    pieces = [
        (
            str(i + 1),
            number(_zero(piece.best["sigma_min"].value)),
            _list(np.degrees(piece.best["sigma_min"].delta)),
            number(_zero(piece.best["sqrt_det_AAT"].value)),
            "yes" if i == state.here else "",
        )
        for i, piece in enumerate(state.components[:_MOST])
    ]
    left = len(state.components) - _MOST
    more = tag("p", f"{left} more pieces are not shown.", class_="note") if left > 0 else Markup("")
    caption = "All gimbal angles of this momentum: null motion leads along one piece, not between"
    found = table(_HEAD, pieces, caption, numeric=(1, 3), wide=True)
    return page.section("The state looked at", said, found, more, id="state")


def _zero(value: float) -> float:
    """Return a measure; what counts as singular is 0."""
    return 0.0 if abs(value) < SINGULAR else float(value)


def _list(values: Iterable[float]) -> str:
    """Return numbers in brackets; what is noise beside the largest is 0."""
    found = np.asarray(list(values), float)
    most = float(np.abs(found).max(initial=0.0))
    return "[" + ", ".join(number(0.0 if abs(v) <= 1e-9 * most else float(v)) for v in found) + "]"
