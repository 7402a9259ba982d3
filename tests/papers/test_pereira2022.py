"""Pereira 2022: the cases of Eq 45, and what the command writes."""

from __future__ import annotations

import json

import numpy as np
import pytest

from nullmotion.papers import pereira2022 as paper
from nullmotion.papers import pereira2022_figures as figures
from nullmotion.papers.pereira2022_cases import CASES, fly
from nullmotion.plot import style

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def flights():
    return {name: fly(law) for name, law in CASES.items()}


@pytest.fixture(scope="module")
def cells(flights):
    return {(c.row, c.column): c for c in paper.cells(flights)}


def test_one_move_without_the_term_meets_the_singularity(flights):
    found = flights["N = 1, no term"]
    assert found.mismatch.max() > 0.3
    assert found.distance.min() < 0.1
    assert found.mismatch.max() == pytest.approx(0.516, abs=0.005)
    assert found.t[np.argmax(found.mismatch)] == pytest.approx(31.5, abs=0.15)


def test_one_move_with_the_term_loses_less(flights):
    found = flights["N = 1, term"]
    assert found.mismatch.max() < 0.3 * flights["N = 1, no term"].mismatch.max()
    assert found.distance.min() > 0.3


def test_five_moves_give_the_torque_and_keep_away(flights):
    found = flights["N = 5, term"]
    assert found.mismatch.max() < 1e-3
    assert found.distance.min() >= 0.49
    assert found.peak_rate < 1.3
    assert found.relative_error < 0.06
    assert flights["N = 5, no term"].distance.min() < found.distance.min()


@pytest.mark.parametrize("name", CASES)
def test_flights_are_whole(flights, name):
    run = flights[name].run
    assert run.status == [] and sum(run.law_counts.values()) == 0
    assert np.abs(run.inertial_momentum).max() < 1e-5  # nothing from outside
    assert np.degrees(run.pointing_error[-1]) < 0.05
    assert np.abs(run.wheel_momentum).max() < 0.5


def test_the_middle_of_the_moves_matches_the_mean_torque(flights):
    middle = fly({"N_p": 5, "midpoint": True})
    assert middle.mean_error.max() < 0.3 * flights["N = 5, term"].mean_error.max()
    assert middle.mean_error.max() == pytest.approx(0.009, abs=0.001)


def test_statuses_are_honest(cells):
    differing = {key for key, c in cells.items() if c.status == "differs"}
    assert differing == {("N = 1, no term", "rates_saturate")}
    assert all(cells[key].note for key in differing)
    unprinted = [c for c in cells.values() if c.published is None]
    assert len(unprinted) == 12
    assert all(c.status == "not printed" and c.parameters == "inferred" for c in unprinted)


def test_all_is_written_whole(tmp_path, flights, monkeypatch):
    monkeypatch.setattr(paper, "BEYOND", {})
    monkeypatch.setattr(paper, "flights", lambda cases, done: {n: flights[n] for n in cases})
    monkeypatch.setattr(style, "DPI", 40)
    result = paper.Pereira2022().run(tmp_path)
    names = {f"figure_{i:02d}.png" for i in (*range(7, 10), *range(11, 19))}
    assert {path.name for path in result.figures} == names
    assert len(result.figures) == figures.COUNT
    assert {path.name for path in (tmp_path / "figures").iterdir()} == names
    rows = json.loads((tmp_path / "tables.json").read_text())
    assert {row["status"] for row in rows} == {"reproduced", "differs", "not printed"}
    beyond = json.loads((tmp_path / "beyond.json").read_text())
    assert [row["case"] for row in beyond] == list(CASES)
    text = (tmp_path / "tables.md").read_text()
    assert "27 printed values: 26 reproduced, 1 differs." in text
