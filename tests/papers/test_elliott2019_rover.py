"""Elliott 2019, Chapter 5: Table 4, Figures 34 to 36, and what the command writes."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest

from nullmotion import papers
from nullmotion.papers import elliott2019_rover as paper
from nullmotion.papers import elliott2019_rover_figures as figures
from nullmotion.papers import elliott2019_rover_steps as table4
from nullmotion.plot import style

pytestmark = pytest.mark.slow

FIGURES = {f"figure_{name}.png" for name in ("34", "35", "35_torques", "36", "36_torques")}


@pytest.fixture(scope="module")
def steps():
    calls = []
    found = table4.steps(lambda: calls.append(1))
    assert len(calls) == table4.COUNT
    return found


@pytest.fixture(scope="module")
def cells(steps):
    found = {(c.table, c.row, c.column): c for c in paper.cells(steps)}
    assert len(found) == len(paper.cells(steps))
    return found


def test_every_step_comes_down_with_margin_to_spare(steps):
    assert len(steps) == 10
    for step in steps.values():
        assert step.run.outcome == "landed"
        assert step.plan.least_margin > 0 and step.run.least_margin > 0
        assert step.run.max_angle_error < 0.05
        assert step.run.energy_balance < 1e-5


def test_e1_comes_back_and_rises(cells):
    printed = {"0": 5.6, "15": 6.7, "30": 6.6, "45": 8.3, "55": 10.7}
    for row, value in printed.items():
        cell = cells["4", row, "e1_J_kg_m"]
        assert cell.published == value and cell.tolerance == pytest.approx(0.35 * value)
        assert cell.computed == pytest.approx(value, rel=0.35)
        assert cell.status == "matched" and "35 %" in cell.note
    ratio = cells["4", "55 over 0", "e1_ratio"]
    assert ratio.computed >= 1.4 and ratio.status == "matched"
    level, steep = (cells["4", row, "e1_J_kg_m"].computed for row in ("0", "55"))
    assert ratio.computed == pytest.approx(steep / level)


def test_e2_differs_and_its_spread_is_said(cells, steps):
    printed = {"0": 19.2, "15": 18.0, "30": 16.5, "45": 13.6, "55": 12.3}
    for row, value in printed.items():
        cell, step = cells["4", row, "e2_J_kg_m"], steps[2, row]
        assert cell.published == value and cell.status == "differs"
        costs = [plan.cost_of_travel for plan in step.plans]
        assert len(costs) == 3 and max(costs) > 1.05 * min(costs)
        assert f"{min(costs):.1f} to {max(costs):.1f} J/(kg m) over 3 planner" in cell.note
        margins = [plan.least_margin for plan in step.plans]
        assert min(margins) > 0.95 * max(margins)  # as good by what is planned for


def test_the_mean_counts_four_edges_like_e1(cells):
    for row in table4.TABLE_4:
        e1, e2 = (cells["4", row, f"e{edge}_J_kg_m"].computed for edge in (1, 2))
        mean = cells["4", row, "average_J_kg_m"]
        assert mean.computed == pytest.approx((4 * e1 + 2 * e2) / 6)
        six = cells["6", row, "peter_J_kg_m"]
        assert six.computed == mean.computed and six.published == mean.published
        assert six.status == mean.status == "matched"


def test_counts(cells):
    found = Counter((c.table, c.status) for c in cells.values())
    assert found == {
        ("4", "matched"): 11, ("4", "differs"): 5, ("6", "reproduced"): 20, ("6", "matched"): 5,
        ("7", "reproduced"): 10, ("7", "matched"): 5, ("8", "reproduced"): 5,
        ("9", "reproduced"): 5, ("text", "matched"): 1,
    }  # fmt: skip


@pytest.mark.parametrize("key", [(1, "0"), (1, "55"), (2, "30")])
def test_torques_of_the_figures_obey_the_equation_of_motion(steps, key):
    step = steps[key]
    chassis, edge = step.plan.rover.chassis, step.edge
    for source in (step.run, step.plan):
        t, driven, holding, off, low, high = figures.signals(source)
        turning = getattr(source, "turning", np.ones(len(t), bool))
        speeding = chassis.inertia_about_edge(edge) * source.theta_ddot
        np.testing.assert_allclose((driven - holding)[turning], speeding[turning], atol=1e-4)
        spare = np.minimum(high - off, off - low)[turning]
        np.testing.assert_allclose(spare, source.margin[turning], atol=1e-9)
        assert np.isnan(off[~turning]).all() and spare.min() > 0


def test_all_is_written_whole(tmp_path, steps, monkeypatch):
    monkeypatch.setattr(table4, "steps", lambda done: steps)
    monkeypatch.setattr(style, "DPI", 40)
    shares = []
    result = papers.get("elliott2019-rover")().run(tmp_path, shares.append)
    assert {path.name for path in result.figures} == FIGURES
    assert len(result.figures) == figures.COUNT
    assert {path.name for path in (tmp_path / "figures").iterdir()} == FIGURES
    assert shares == sorted(shares)
    rows = json.loads((tmp_path / "tables.json").read_text())
    assert {row["table"] for row in rows} == {"4", "6", "7", "8", "9", "text"}
    beyond = json.loads((tmp_path / "beyond.json").read_text())
    assert len(beyond) == 10 and {row["outcome"] for row in beyond} == {"landed"}
    text = (tmp_path / "tables.md").read_text()
    assert "67 printed values: 40 reproduced, 22 matched, 5 differs." in text
