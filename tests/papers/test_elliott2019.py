"""Elliott 2019, Chapters 3 and 4: every printed number that has to come back."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest

from nullmotion.papers import elliott2019 as paper
from nullmotion.papers import elliott2019_camera as camera
from nullmotion.papers import elliott2019_comparison as comparison
from nullmotion.papers.elliott2019_runs import GAINS, Section44
from nullmotion.plot import style

pytestmark = pytest.mark.slow

DIFFERS = {
    *(("equations", f"Eq 23, n = {n}", "critical_momentum") for n in (5, 7, 9, 11)),
    ("equations", "Eqs 43-47, n = 11", "momentum_error"),
    ("equations", "Eq 54, H_x = -2", "Psi"),
    ("equations", "Eq 59", "torque_ratio"),
    ("text", "TC at least 1", "radius"),
    ("text", "spherical constraint, envelope", "radius"),
    ("text", "spherical constraint, TC above 0", "radius"),
    ("text", "constrained envelope", "non-singular_inside"),
}
FIGURES = [4, *range(10, 16), *range(20, 29), *range(37, 42)]


@pytest.fixture(scope="module")
def work():
    return paper.Work(paper.SEEDS[:1]).computed(lambda size: None)


@pytest.fixture(scope="module")
def cells(work):
    return {(c.table, c.row, c.column): c for c in work.cells}


def test_statuses_are_honest(cells, work):
    assert len(cells) == len(work.cells)
    counts = Counter(c.status for c in cells.values())
    assert counts == {"reproduced": len(cells) - len(DIFFERS), "differs": len(DIFFERS)}
    assert {key for key, c in cells.items() if c.status == "differs"} == DIFFERS
    assert all(cells[key].note for key in DIFFERS)
    assert not any("|" in c.note for c in cells.values())  # it would end a column


def test_radii(cells):
    found = {row: c.computed for (_, row, column), c in cells.items() if column == "radius"}
    assert found["constrained envelope"] == pytest.approx(1.790, abs=1e-3)
    assert found["TC at least 0.5"] == pytest.approx(1.391, abs=1e-3)
    assert found["TC at least 1"] == pytest.approx(0.744, abs=1e-3)
    assert found["spherical constraint, farthest"] == pytest.approx(2.0, abs=0.005)
    assert found["spherical constraint, envelope"] == pytest.approx(1.850, abs=1e-3)
    assert found["spherical constraint, TC above 0"] == pytest.approx(1.835, abs=1e-3)


def test_gains_over_the_backbone(cells):
    assert cells["text", "static region", "gain_percent"].computed == pytest.approx(25.0, abs=0.01)
    declining = cells["text", "declining region", "gain_percent"].computed
    assert declining == pytest.approx(34.15, abs=0.01)


def test_sqp_is_never_better(work):
    assert set(work.searched) == {5, 7, 9, 11}
    for found in work.searched.values():
        assert np.isfinite(found.difference).all() and found.found > 0.9
        assert found.difference.min() > -1e-6 and found.difference.max() < 1e-6


@pytest.mark.parametrize("seed", paper.SEEDS)
def test_section_4_4(work, seed):
    section = work.section if seed == work.section.seed else Section44(seed)
    band, cb = work.promised.band, section.constrained
    assert cb.arrived == 50 and 500_000 < len(cb) < 700_000
    assert comparison.outside(cb, band) == 0
    assert cb.capability.min() > 0.02 and cb.measure.min() > 0.01
    assert set(section.gradients) == set(GAINS)
    for run in section.gradients.values():
        assert run.arrived == 50
        assert run.singular_ends >= 5
        assert comparison.above(run, band) > 0.05
    assert section.gradients[1.0].capability.min() < 0
    assert section.gradients[0.2].capability.min() >= 0


def test_all_is_written_whole(tmp_path, work, monkeypatch):
    class Ready:
        def __init__(self, seeds):
            assert seeds == paper.SEEDS

        def computed(self, done):
            done(1.0)
            return work

    monkeypatch.setattr(paper, "Work", Ready)
    monkeypatch.setattr(style, "DPI", 40)
    monkeypatch.setattr(camera, "_PIXELS", 100)
    shares = []
    result = paper.Elliott2019().run(tmp_path, shares.append)
    assert shares == sorted(shares) and shares[0] > 0 and shares[-1] <= 1
    written = json.loads((tmp_path / "tables.json").read_text())
    assert written == [cell.as_row() for cell in work.cells]
    beyond = json.loads((tmp_path / "beyond.json").read_text())
    assert beyond == work.beyond and len(beyond) == 6
    assert "| LG, k = 0.2 | 2019 | 50 |" in (tmp_path / "tables.md").read_text()
    names = [f"figure_{i:02d}.png" for i in FIGURES]
    assert sorted(path.name for path in result.figures) == names
    assert sorted(path.name for path in (tmp_path / "figures").iterdir()) == names
    assert all(path.stat().st_size > 3_000 for path in result.figures)
