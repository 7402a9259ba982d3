"""Kim et al. 2012: both startups, the same on full plants, and what the command writes."""

from __future__ import annotations

import json

import numpy as np
import pytest

from nullmotion.papers import kim2014 as paper
from nullmotion.papers import kim2014_beyond as beyond
from nullmotion.papers import kim2014_figures as figures
from nullmotion.papers import kim2014_steering as steering
from nullmotion.papers.kim2014_cases import CASES, fly
from nullmotion.papers.kim2014_text import cells as printed
from nullmotion.plot import style

pytestmark = pytest.mark.slow

INERTIA, DESIRED = 6.95e-4, 200.0
GAIN = {"case1": 6.95e-3, "case2": 2.085e-2}  # I_W k_m [1/s]
LIMITED = {
    (case, kept): beyond.Variant(case, "all positive", "full", "torque", True, kept)
    for case in CASES
    for kept in (False, True)
}
DIFFERS = {
    ("start", "q"),
    ("start", "elements_of_theta_2"),
    ("case1", "bound_of_Eq_46_holds"),
    ("case2", "bound_of_Eq_46_holds"),
    ("case1", "bound_of_Eq_50_holds"),
}


@pytest.fixture(scope="module")
def flights():
    return fly()


@pytest.fixture(scope="module")
def cells(flights):
    return {(c.row, c.column): c for c in printed(flights)}


@pytest.fixture(scope="module")
def limited():
    return beyond.fly(list(LIMITED.values()), lambda: None)


def for_good(t, size, level):
    """Return from when on a size stays below a level."""
    outside = np.flatnonzero(size >= level)
    return t[outside[-1] + 1]


@pytest.mark.parametrize(
    ("case", "momentum", "room", "wheels"), [("case1", 565, 15, 583), ("case2", 200, 10, 223)]
)
def test_settling(flights, cells, case, momentum, room, wheels):
    run = flights[case].run
    mu = INERTIA * (DESIRED - run.wheel_speed)
    share = np.linalg.norm(mu, axis=1) / np.linalg.norm(mu[0])
    off = np.abs(run.wheel_speed / DESIRED - 1.0).max(axis=1)
    found = for_good(run.t, share, 0.02), for_good(run.t, off, 0.02)
    assert found[0] == pytest.approx(momentum, abs=room)
    assert found[1] == pytest.approx(wheels, abs=15)
    assert cells[case, "momentum_settling_s"].computed == pytest.approx(found[0], abs=1e-9)
    assert cells[case, "wheel_settling_time_s"].computed == pytest.approx(found[1], abs=1e-9)


@pytest.mark.parametrize("case", CASES)
def test_attitude_settles_within_20_s(flights, cells, case):
    run = flights[case].run
    e0 = np.abs(np.sum(run.q_BN * run.reference, axis=1))
    found = for_good(run.t, np.sqrt(np.maximum(1.0 - e0**2, 0.0)), 0.01)
    assert found < 20.0
    assert cells[case, "attitude_settling_time_s"].computed == pytest.approx(found, abs=0.011)


def test_gimbals_saturate_in_case_1_alone(flights, cells):
    peak = {case: np.nanmax(np.abs(startup.run.rates)) for case, startup in flights.items()}
    assert peak["case1"] == 25.0
    assert np.nanmax(np.abs(flights["case1"].run.rates_asked)) > 100.0
    assert 20.0 < peak["case2"] < 25.0
    flags = [cells[case, "gimbal_rate_saturated"].computed for case in CASES]
    assert flags == ["Y", "N"]
    assert flights["case2"].run.status == []


@pytest.mark.parametrize("case", CASES)
def test_momentum_error_decays_as_predicted(flights, case):
    startup = flights[case]
    rate, off = startup.decay
    assert rate == pytest.approx(GAIN[case], rel=0.01)
    assert off < 0.01
    rows = (startup.share < np.exp(-1)) & (startup.share > 0.01)
    t, share = startup.run.t[rows], startup.share[rows]
    assert share == pytest.approx(share[0] * np.exp(-GAIN[case] * (t - t[0])), rel=0.01)


def test_the_papers_control_asks_for_nearly_a_newton_metre(flights):
    first = np.abs(flights["case1"].run.wheel_acceleration[0]).max()
    assert first == pytest.approx(1270, abs=10)
    assert INERTIA * first == pytest.approx(0.88, abs=0.01)


def test_null_motion_gives_no_torque(flights):
    startup = flights["case2"]
    run = startup.run
    Q = steering.torque_matrices(run)[:-1]
    command = np.concatenate([run.wheel_acceleration, run.rates_asked], axis=1)[:-1]
    given = np.einsum("kij,kj->ki", Q, command)
    assert given == pytest.approx(run.hdot[:-1], abs=1e-9)
    wheel, gimbal = steering.ranged(run, startup.det)
    null = command - np.concatenate([wheel, gimbal], axis=1)[:-1]
    assert np.einsum("kij,kj->ki", Q, null) == pytest.approx(0.0, abs=1e-9)
    assert startup.null_motion[:-1] == pytest.approx(null[:, 4:], abs=1e-12)
    assert np.abs(null[:, 4:]).max() > 1.0


def test_singularity_measure_is_that_of_the_gimbals(flights):
    startup = flights["case1"]
    rows = slice(0, 3000, 50)
    s = startup.run.setup.array.unit_jacobian(startup.run.delta[rows])
    values = np.linalg.svd(s, compute_uv=False)
    assert startup.det[rows] == pytest.approx(np.prod(values**2, axis=1), abs=1e-12)
    assert startup.weights[rows, 1] == pytest.approx(1 / np.cosh(startup.det[rows]))


def test_lyapunov_falls_below_its_bound_where_no_limit_acts(flights):
    first, second = (flights[case].lyapunov for case in CASES)
    assert len(second.above) == 0 and second.applies
    assert len(first.above) > 0 and not first.applies
    assert first.gained_while_cut > 0.1
    assert first.V[-1] < first.V[0] and second.V[-1] < second.V[0]


@pytest.mark.parametrize("which", LIMITED)
def test_startup_within_5_mN_m_and_5_rad_s(limited, which):
    startup = limited[LIMITED[which]]
    row = beyond.row(LIMITED[which], startup)
    assert row["settled"] and startup.error[-1] < 1e-3
    assert row["peak_wheel_torque_Nm"] <= 5e-3 * (1 + 1e-9)
    assert row["peak_gimbal_rate_rad_s"] < 5.0 * 1.05
    assert row["limited_time_s"] > 0 and row["last_limited_time_s"] < 60.0
    assert row["momentum_drift"] < 1e-8
    assert row["attitude_settling_time_s"] < 100.0
    if which[1]:
        assert row["limited_time_s"] < 10.0 and row["attitude_settling_time_s"] < 40.0


def test_the_reduced_plant_loses_momentum_and_the_full_one_does_not():
    given = [
        beyond.Variant("case2", signs, plant, "rate")
        for plant in ("reduced", "full")
        for signs in beyond.SIGNS
    ]
    rows = [beyond.row(*item) for item in beyond.fly(given, lambda: None).items()]
    assert all(row["settled"] for row in rows)
    assert all(row["limited_time_s"] == 0 for row in rows)
    assert min(row["momentum_drift"] for row in rows[:2]) > 0.1
    assert min(row["final_momentum_drift"] for row in rows[:2]) > 0.01
    assert max(row["momentum_drift"] for row in rows[2:]) < 1e-8


def test_every_case_has_every_plant():
    given = beyond.variants()
    assert len(given) == len(set(given)) == 28
    assert beyond.kernels(given) == 5
    setups = {v: v.setup for v in given if v.case == "case1"}
    for variant, flown in setups.items():
        assert flown.units.drive == variant.drive
        assert flown.units.terms == ("published" if variant.plant == "reduced" else "all")
        assert flown.array.rate_limit[0] == pytest.approx(5.0 if variant.limited else 25.0)
        assert flown.array.wheels.torque_limit[0] == (5e-3 if variant.limited else np.inf)
        assert np.sign(flown.delta).tolist() == list(beyond.SIGNS[variant.signs])
        assert flown.law.as_published is not variant.kept


def test_statuses_are_honest(cells):
    differing = {key for key, c in cells.items() if c.status == "differs"}
    assert differing == DIFFERS
    assert all(cells[key].note for key in differing)
    fitted = [c for c in cells.values() if c.row in CASES]
    assert all(c.parameters == "fitted" and c.note for c in fitted)
    assert all("|" not in c.note for c in cells.values())  # they are cells of Markdown tables


def test_all_is_written_whole(tmp_path, flights, limited, monkeypatch):
    monkeypatch.setattr(paper, "fly", lambda done: flights)
    monkeypatch.setattr(beyond, "variants", lambda: list(LIMITED.values()))
    monkeypatch.setattr(beyond, "fly", lambda given, done: limited)
    monkeypatch.setattr(style, "DPI", 40)
    result = paper.Kim2014().run(tmp_path)
    names = {f"figure_{i:02d}.png" for i in range(2, 14)}
    names |= {"figure_lyapunov.png", "figure_limits.png"}
    assert {path.name for path in result.figures} == names
    assert len(result.figures) == figures.COUNT
    assert {path.name for path in (tmp_path / "figures").iterdir()} == names
    rows = json.loads((tmp_path / "tables.json").read_text())
    assert {row["status"] for row in rows} == {"reproduced", "matched", "differs", "not printed"}
    settling = {r["row"]: r["computed"] for r in rows if r["column"] == "momentum_settling_s"}
    assert list(settling) == list(CASES)
    others = json.loads((tmp_path / "beyond.json").read_text())
    assert [row["case"] for row in others] == [case for case, _ in LIMITED]
    assert "46 printed values: 17 reproduced, 24 matched, 5 differs." in (
        tmp_path / "tables.md"
    ).read_text(encoding="utf-8")
