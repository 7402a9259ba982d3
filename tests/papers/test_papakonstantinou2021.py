"""Papakonstantinou et al. 2021: every printed number that has to come back, and the optimum."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest

from nullmotion.papers import papakonstantinou2021 as paper
from nullmotion.papers import papakonstantinou2021_figures as figures
from nullmotion.papers.papakonstantinou2021_beyond import certificate, rows
from nullmotion.papers.papakonstantinou2021_cases import CASES, COUPLED, NONE, Manoeuvre
from nullmotion.plan import enumerate as everything
from nullmotion.plot import style

pytestmark = pytest.mark.slow

LAST = 69  # t = 6.9 s
OPTIMA = {
    "roll": ((1, 0, -1, -1, 0, 0, 0, 0, 0, 0), 103.0, 4),
    "three-axis": ((1, 1, 1, 0, 0, 0, 0, 0, 0, 0), 216.6, 336),
    "kinematic": ((1, 1, 1, 1, 0, -1, 0, 0, 0, 0), 2671.0, 2191),
}
DIFFERS = {
    ("1", "complex", "g1"),
    ("1", "kinematic", "maneuver_deg"),
    ("1", "kinematic", "inertia_kg_m2"),
    ("4", "time_low_manipulability", "change_percent"),
    ("text", "three-axis, search", "L"),
    ("text", "kinematic, search", "L"),
    ("text", "kinematic, search", "expansions"),
}


@pytest.fixture(scope="module")
def runs():
    return paper.published()


@pytest.fixture(scope="module")
def flights(runs):
    return paper.fly(runs, lambda: None)


@pytest.fixture(scope="module")
def cells(runs, flights):
    return {(c.table, c.row, c.column): c for c in paper.cells(runs, flights)}


@pytest.fixture(scope="module")
def coupled():
    return Manoeuvre(CASES["three-axis"], COUPLED)


def change(cells, table):
    return [c.computed for c in cells.values() if c.table == table]


def test_roll_without_null_motion(flights):
    run = flights["roll"]["none"]
    assert run.t[LAST] == pytest.approx(6.9)
    assert len(run.t) == 71
    assert run.attitude_deg[LAST, 2] == pytest.approx(-86.25, abs=0.005)
    assert run.manipulability[LAST] == pytest.approx(0.609, abs=0.0005)
    assert run.terms.mean == pytest.approx(0.603939, abs=1e-6)
    assert (run.terms.low, run.terms.excess) == (26, 17)
    assert np.degrees(run.greatest_errors[:2]) == pytest.approx([5.02, 17.95], abs=0.005)
    assert run.terms.value(run.cost, off_axis=True) == pytest.approx(0.12943, abs=5e-6)
    assert run.terms.value(run.cost) == pytest.approx(0.12666, abs=5e-6)


def test_counts_with_the_papers_courses(flights):
    found = {
        name: [(by[c].terms.low, by[c].terms.excess) for c in ("none", "paper")]
        for name, by in flights.items()
    }
    assert found["roll"] == [(26, 17), (13, 25)]
    assert found["three-axis"] == [(31, 14), (3, 30)]
    assert found["kinematic"] == [(57, 14), (10, 47)]


def test_tables_2_to_4(cells):
    assert change(cells, "2") == pytest.approx([85.07, -50, 7.46, 47.06], abs=0.05)
    assert change(cells, "3") == pytest.approx([67.03, -90.32, -0.003, 114.29], abs=0.05)
    assert change(cells, "4") == pytest.approx([411.01, -82.46, 0.638, 235.71], abs=0.05)


def test_gains_and_final_angles(cells, flights):
    assert cells["text", "roll, search", "cost_gain_percent"].computed == pytest.approx(
        99.26, abs=0.01
    )
    assert cells["text", "three-axis, search", "cost_gain_percent"].computed == pytest.approx(
        103.41, abs=0.01
    )
    assert flights["roll"]["paper"].attitude_deg[LAST, 2] == pytest.approx(-87.72, abs=0.005)


def test_the_kinematic_run_sticks_below_its_target(flights):
    run = flights["kinematic"]["none"]
    assert np.linalg.norm(run.run.momentum[LAST]) == pytest.approx(1.155, abs=0.001)
    assert run.momentum_error[LAST] == pytest.approx([0.345, 0, 0], abs=0.001)
    assert np.degrees(run.run.delta[LAST]) == pytest.approx([-90, 0, 90, 0], abs=0.01)


@pytest.mark.parametrize(("name", "rollouts"), [("roll", 308), ("three-axis", 330)])
def test_the_search_returns_the_printed_course(runs, name, rollouts):
    assert runs[name].heuristic_course == runs[name].case.course
    assert runs[name].heuristic.rollouts == rollouts


@pytest.mark.parametrize("name", OPTIMA)
def test_the_optimum_is_proven(runs, name):
    run, (knots, gain, rank) = runs[name], OPTIMA[name]
    assert run.optimum.proven and certificate(run.optimum)["holds"]
    assert run.optimum.knots == knots
    base = run.value(NONE)
    assert 100 * (run.optimum.value / base - 1) == pytest.approx(gain, abs=0.5)
    values = everything.all_values(run.rollouts)
    assert values.max() == pytest.approx(run.optimum.value, rel=1e-12)
    assert 1 + np.count_nonzero(values > run.value(run.case.course) * (1 + 1e-9)) == rank
    ties = np.count_nonzero(values >= run.optimum.value * (1 - 1e-9)) - 1
    assert ties == len(run.optimum.ties)
    assert ties == 0 or run.optimum.ties == [tuple(-k for k in knots)]


@pytest.mark.parametrize("name", OPTIMA)
def test_flights_and_plans_have_the_same_cost(runs, flights, name):
    for run in flights[name].values():
        parts = runs[name].parts(run.law.knots)
        assert run.terms.mean == pytest.approx(parts["mean_manipulability"], rel=1e-9)
        assert run.terms.error == pytest.approx(parts["greatest_error"], rel=1e-9)
        assert run.terms.low == parts["samples_of_low_manipulability"]
        assert run.terms.excess == parts["samples_of_rate_excess"]
        assert run.terms.value(run.cost) == pytest.approx(runs[name].value(run.law.knots), rel=1e-9)


def test_the_null_motion_drawn_is_what_the_law_asks_for_beyond_the_base_law(flights):
    run = flights["three-axis"]["paper"]
    array, law = run.run.setup.array, run.law.base_law
    A = array.jacobian(run.run.delta)
    w = run.manipulability[:, None, None]
    damped = A @ A.transpose(0, 2, 1) + law.lambda0 * np.exp(-law.mu * w) * np.eye(3)
    base = A.transpose(0, 2, 1) @ np.linalg.solve(damped, run.run.hdot[..., None])
    asked = run.run.rates_asked - base[..., 0]
    assert run.null_motion[:-1] == pytest.approx(asked[:-1], abs=1e-12)


def test_with_omega_x_h_the_printed_course_is_worse_than_none(coupled):
    base, printed = coupled.value(NONE), coupled.value(coupled.case.course)
    assert printed / base - 1 == pytest.approx(-0.05, abs=0.005)
    assert coupled.optimum.proven and coupled.optimum.value > 1.6 * base


def test_statuses_are_honest(cells):
    counts = Counter(c.status for c in cells.values())
    assert counts["differs"] == sum(not c.agrees for c in cells.values())
    differing = {key for key, c in cells.items() if c.status == "differs"}
    assert differing == DIFFERS
    assert all(cells[key].note for key in differing)
    assert {c.table for c in cells.values()} == {"1", "2", "3", "4", "text"}
    assert counts == {"reproduced": len(cells) - len(DIFFERS), "differs": len(DIFFERS)}


def test_all_is_written_whole(tmp_path, runs, flights, cells, coupled, monkeypatch):
    monkeypatch.setattr(paper, "published", lambda: runs)
    monkeypatch.setattr(paper, "fly", lambda given, done: flights)
    monkeypatch.setattr(paper, "planned", lambda given: [*runs.values(), coupled])
    every = dict(figures.FIGURES)
    assert list(every) == [6, 7, 8, 9, 10, 11]
    monkeypatch.setattr(figures, "FIGURES", {i: every[i] for i in (7, 9, 10)})  # one of a kind
    monkeypatch.setattr(style, "DPI", 40)
    shares = []
    result = paper.Papakonstantinou2021().run(tmp_path, shares.append)
    assert shares == sorted(shares) and shares[0] > 0 and shares[-1] <= 1
    written = json.loads((tmp_path / "tables.json").read_text())
    assert written == [cell.as_row() for cell in result.cells]
    assert len(written) == len(cells)
    beyond = json.loads((tmp_path / "beyond.json").read_text())
    assert beyond == result.beyond and len(beyond) == 4 * 4
    text = (tmp_path / "tables.md").read_text()
    assert "## Beyond the paper" in text and "| three-axis | with omega x h |" in text
    names = [f"figure_{i:02d}.png" for i in (7, 9, 10, 12)] + ["figure_optimum.png"]
    assert [path.name for path in result.figures] == names
    assert sorted(p.name for p in (tmp_path / "figures").iterdir()) == sorted(names)
    assert all(path.stat().st_size > 5_000 for path in result.figures)


def test_rows_beyond_the_paper(runs):
    found = {row["course"]: row for row in rows(runs["kinematic"])}
    assert set(found) == {"SRI alone", "the paper's L", "the paper's search", "exact optimum"}
    assert found["SRI alone"]["gain_percent"] == 0
    assert found["SRI alone"]["time_low_manipulability_s"] == pytest.approx(5.7)
    assert found["the paper's L"]["rank"] == 2191
    best = found["exact optimum"]
    assert (best["rank"], best["ties"], best["proven"]) == (1, 1, True)
    assert best["certificate"]["holds"] and best["rollouts"] < 200
