"""Draw docs/images/demo.png, the picture of the README: laws on the elliptic singularity."""

from pathlib import Path

import nullmotion as nm
from nullmotion.campaign.compare import compare
from nullmotion.plot import compare_figure

LAWS = ["pseudo-inverse", "sr", "gsr", "dsea", "nd", "vcbsae"]

scenario = nm.load_scenario("elliptic-singularity")
comparison = compare(scenario, LAWS)
compare_figure(
    comparison,
    Path(__file__).with_name("demo.png"),
    title="One command, six steering laws: constant torque into an elliptic singularity",
)
