"""Elliott 2019, Tables 6 to 9: reaction-wheel rovers, missions and chassis."""

from __future__ import annotations

import numpy as np
import pytest

from nullmotion.papers import elliott2019_rover_chassis as chassis
from nullmotion.papers import elliott2019_rover_missions as missions
from nullmotion.papers import elliott2019_rover_wheels as wheels
from nullmotion.rover.impulsive import impulsive_step
from nullmotion.rover.rover import Site, peter
from nullmotion.rover.versine_cmg import cmg_versine
from nullmotion.rover.wheels import hypothesised


@pytest.fixture(scope="module")
def cells():
    every = wheels.cells() + missions.cells() + chassis.cells()
    found = {(c.table, c.row, c.column): c for c in every}
    assert len(found) == len(every)
    return found


def printed(value, digits):
    """As the paper prints it."""
    return value if isinstance(value, str) else f"{value:.{digits}f}"


def test_table_6_impulsive_to_print(cells):
    found = [c for key, c in cells.items() if key[0] == "6" and "impulsive" in key[2]]
    assert len(found) == 10
    for cell in found:
        assert printed(cell.computed, 1) == printed(cell.published, 1)
        assert cell.status == "reproduced"


def test_table_6_versine_within_a_thousandth(cells):
    found = [c for key, c in cells.items() if key[0] == "6" and "versine" in key[2]]
    assert len(found) == 10 and [c.published for c in found].count("NA") == 1
    for cell in found:
        assert cell.status == "reproduced"
        if cell.published == "NA":
            assert cell.computed == "NA"
        else:
            assert cell.computed == pytest.approx(cell.published, rel=1e-3)
    assert {c.row for c in found} == {"0", "15", "30", "45", "55"}


def test_table_7_wheels_to_print(cells):
    found = [c for key, c in cells.items() if key[0] == "7" and not key[2].startswith("peter")]
    assert len(found) == 10
    for cell in found:
        assert printed(cell.computed, 1) == printed(cell.published, 1)


def test_table_7_peter_within_half_a_thousandth(cells):
    found = [c for key, c in cells.items() if key[0] == "7" and key[2].startswith("peter")]
    assert len(found) == 5
    for cell in found:
        assert cell.computed == pytest.approx(cell.published, rel=5e-4)
        assert cell.status == "matched" and "160.17" in cell.note
    even = cells["text", "equal cost", "distance_m"]
    assert even.computed == pytest.approx(78.28, abs=0.01) and even.status == "matched"


@pytest.mark.parametrize(("table", "digits"), [("8", 1), ("9", 2)])
def test_tables_8_and_9_to_print(cells, table, digits):
    found = [c for key, c in cells.items() if key[0] == table]
    assert len(found) == 5
    for cell in found:
        assert printed(cell.computed, digits) == printed(cell.published, digits)
        assert cell.status == "reproduced"


def test_table_9_in_closed_form(cells):
    exact = {
        "tetrahedron": 1 / np.sqrt(2),
        "cube": np.sqrt(2),
        "octahedron": 1.0,
        "dodecahedron": (3 + np.sqrt(5)) / 2,
        "icosahedron": (1 + np.sqrt(5)) / 2,
    }
    for name, value in exact.items():
        assert cells["9", name, "eta"].computed == pytest.approx(value, rel=1e-12)


def test_all_edges_cost_the_same():
    site = Site(incline=wheels.INCLINES["30"])
    rover = hypothesised()
    costs = [impulsive_step(rover, edge, site).cost_of_travel for edge in range(1, 7)]
    assert costs == pytest.approx([costs[0]] * 6)


def test_peters_column_when_there_is_one():
    made = {"0": 9.0, "55": 40.0}
    found = {c.row: c for c in wheels.cells(made) if c.column == "peter_J_kg_m"}
    assert set(found) == {"0", "55"}
    assert found["0"].status == "reproduced" and found["55"].status == "differs"


def test_a_slow_versine_stalls_and_a_fast_one_tips_on_ten_degrees():
    site = Site(incline=np.radians(10.0))
    slow, fast = (cmg_versine(peter(), 1, site, rate) for rate in (0.3, 2.0))
    assert (slow.outcome, fast.outcome) == ("stalled", "tipped")
