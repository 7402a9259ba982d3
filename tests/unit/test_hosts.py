"""Kernels for CPUs other than this one: fewer lanes, no fused multiply-add."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.compile import llvm
from nullmotion.sim import Setup, run_batch


@pytest.fixture
def on(monkeypatch):
    """Compile for another CPU that this one can stand in for."""

    def pretend(host: llvm.Host) -> None:
        llvm.machine.cache_clear()
        monkeypatch.setattr(llvm, "host", lambda: host)

    yield pretend
    llvm.machine.cache_clear()


def finals() -> np.ndarray:
    starts = np.random.default_rng(8).uniform(-1, 1, (21, 4))
    array = nm.layouts.pyramid(rate_limit=np.pi)
    setup = Setup(array, nm.laws.create("gsr"), np.zeros(4), np.array([1.0, 0.2, 0.0]), steps=80)
    return run_batch(setup, delta=starts).final_gimbal_rad


@pytest.mark.parametrize("lanes", [1, 2, 4])
def test_lanes_do_not_change_a_bit(on, lanes):
    here = llvm.host()
    expected = finals()
    on(llvm.Host(here.cpu, here.features, "fewer lanes", lanes, here.fma))
    np.testing.assert_array_equal(finals(), expected)


@pytest.mark.skipif(llvm.host().instruction_set == "NEON", reason="names an x86 CPU")
@pytest.mark.parametrize(("name", "lanes"), [("SSE2", 2), ("scalar", 1)])
def test_a_cpu_without_fused_multiply_add(on, name, lanes):
    expected = finals()
    on(llvm.Host("x86-64", "", name, lanes, False))
    np.testing.assert_allclose(finals(), expected, atol=1e-11)
