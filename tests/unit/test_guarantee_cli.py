"""``nullmotion guarantee``: table, certificates on disk, their check, bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from nullmotion.cli import app, guard


def _run(*arguments: str) -> int:
    return guard.call(app, ["guarantee", *arguments])


@pytest.mark.slow
def test_both_given_and_checked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A claim is proven, written, and checked from its file."""
    out = tmp_path / "g"
    assert (
        _run("box90-cubic", "--radius", "0.5", "--torque-capability", "1", "--out", str(out)) == 0
    )
    assert "proven with" in capsys.readouterr().out
    record = json.loads((out / "guarantee.json").read_text())
    row = record["guarantees"][0]
    assert row["marked"] == "certified" and row["proven_radius"] == 0.5
    assert row["radius"] == pytest.approx(0.744, abs=0.001)
    assert (out / "guarantee.png").stat().st_size > 10_000
    assert _run("--check", str(out / row["certificate"])) == 0
    assert "every box holds" in capsys.readouterr().out


def test_a_false_claim(capsys: pytest.CaptureFixture[str]) -> None:
    """Exit status 1 and a momentum that refutes it."""
    assert _run("box90-cubic", "--radius", "1.4", "--torque-capability", "0.5") == 1
    assert "false, TC = 0.4" in capsys.readouterr().out


@pytest.mark.slow
def test_one_given(capsys: pytest.CaptureFixture[str]) -> None:
    """The other is searched and proven, in SI if asked."""
    si = ("--h0-Nms", "2", "--rate-limit-deg-s", "60")
    assert _run("planar", "--set", "n=5", "--radius", "2", *si) == 0
    printed = capsys.readouterr().out
    assert "for every |h| <= 2: proven" in printed and "TC >= 2.49" in printed
    assert "5.2" in printed  # N m: 2.49 x 2 N m s x 1.047 rad/s
    assert _run("scissored-pairs", "--torque-capability", "1") == 0
    assert "|h| <= 1.73" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "allowed:"),
        (("box90-cubik",), "did you mean box90-cubic"),
        (("planar", "--set", "n=2"), "constraint.n = 2"),
        (("planar", "--set", "n"), "--set = 'n'"),
        (("planar", "--set", "q=1"), "allowed: n"),
        (("box90-cubic", "--radius", "-1", "--torque-capability", "1"), "radius = -1.0"),
        (("box90-cubic", "--radius", "9"), "radius = 9.0"),
        (("box90-cubic", "--torque-capability", "2"), "torque_capability = 2.0"),
        (("box90-cubic", "--h0-Nms", "1"), "--rate-limit-deg-s = None"),
        (("--check", "nowhere.json"), "certificate = 'nowhere.json'"),
    ],
)
def test_bad_input(
    arguments: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """One message, exit status 2."""
    assert _run(*arguments) == 2
    error = capsys.readouterr().err
    assert message in error and "Traceback" not in error
