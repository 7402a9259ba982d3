"""A law in one file, named by an entry point, is everywhere: list, compare, contract tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

LAW = '''"""Jacobian transpose."""
from dataclasses import dataclass
from typing import ClassVar
import nullmotion as nm

@dataclass(frozen=True)
class Transpose(nm.Law):
    """delta_dot = gain A^T hdot / mean momentum^2."""
    name: ClassVar[str] = "transpose"
    full_name: ClassVar[str] = "Jacobian transpose"
    citation: ClassVar[str] = "this file"
    claims: ClassVar[frozenset] = frozenset(nm.Claim) - {nm.Claim.EXACT_TORQUE}
    gain: float = 1.0
    def step(self, array, obs, state):
        return self.gain * array.unit_jacobian(obs.delta).T @ obs.hdot / array.mean_momentum, state
'''
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def environment(tmp_path):
    """An environment in which an installed distribution offers the law."""
    assert len(LAW.strip().splitlines()) <= 15
    (tmp_path / "my_transpose.py").write_text(LAW)
    info = tmp_path / "my_transpose-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-transpose\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[nullmotion.laws]\ntranspose = my_transpose\n")
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    return {**os.environ, "PYTHONPATH": path, "COLUMNS": "200"}


def call(line, environment, cwd):
    done = subprocess.run(
        [sys.executable, "-m", *line.split()],
        env=environment,
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_law_from_an_entry_point_is_listed(environment, tmp_path):
    found = json.loads(call("nullmotion list laws --json", environment, tmp_path))
    assert any(entry["name"] == "transpose" for entry in found)


@pytest.mark.slow
def test_a_law_from_an_entry_point_is_compared(environment, tmp_path):
    line = "nullmotion compare elliptic-singularity --laws transpose,sr --out result"
    assert "transpose" in call(line, environment, tmp_path)
    assert "transpose" in (tmp_path / "result" / "compare.json").read_text()


@pytest.mark.slow
def test_a_law_from_an_entry_point_is_held_to_its_claims(environment):
    line = "pytest -q -p no:cacheprovider tests/contract/test_laws.py -k transpose"
    out = call(line, environment, ROOT)
    assert " passed" in out
    assert " failed" not in out
