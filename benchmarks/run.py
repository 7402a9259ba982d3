"""Run all benchmarks, side by side in one process, and say which targets are met.

    python benchmarks/run.py [--quick] [--write]

Ratios are taken within a round, so that a machine that slows down slows all alike; medians
are printed. Without --quick, a missed target ends with status 1. --write puts the tables
into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import accuracy
import atlas
import guarantees
import latency
import lookahead
import lookahead_triangle
import plan_search
import throughput
import vscmg
from common import HEAD, Row

import nullmotion as nm
from nullmotion.compile import host

README = Path(__file__).parent / "README.md"
START, END = "<!-- measured: written by run.py --write -->\n", "<!-- end of measured -->\n"


def section(title: str, rows: list[Row]) -> str:
    """Return a table under a heading."""
    return "\n".join([f"### {title}", "", HEAD, *[row.markdown() for row in rows], ""])


def measure(quick: bool) -> tuple[list[Row], str]:
    """Run everything; return all rows and the report."""
    machine = host()
    text = [
        f"nullmotion {nm.__version__}, Python {platform.python_version()}, {os.cpu_count()} cores, "
        f"{machine.instruction_set}, {platform.system()} {platform.machine()}. "
        "Shared machine: trust ratios.\n"
    ]
    loops, table = throughput.closed_loop(quick)
    groups = {
        "Closed loop of a spacecraft, one core": loops,
        "Threads": throughput.threads(quick),
        "Waiting times": latency.rows(quick),
        "Plans, one core": plan_search.rows(quick),
        "Torque capability and certificates": guarantees.rows(quick),
        "Looking ahead, one core": [*lookahead.rows(quick), *lookahead_triangle.rows(quick)],
        "Startup of variable-speed CMGs": vscmg.rows(quick),
        "Singularity atlas": atlas.rows(quick),
        "Accuracy": accuracy.rows(quick),
    }
    everything = []
    for title, rows in groups.items():
        text.append(section(title, rows))
        if rows is loops:
            text.append(table + "\n")
        everything += rows
    return everything, "\n".join(text)


def main() -> int:
    """Measure, print, judge."""
    parser = argparse.ArgumentParser(description="Run all benchmarks.")
    parser.add_argument(
        "--quick", action="store_true", help="small sizes, to see that everything runs"
    )
    parser.add_argument(
        "--write", action="store_true", help="put the tables into benchmarks/README.md"
    )
    options = parser.parse_args()
    rows, text = measure(options.quick)
    print(text)
    if options.write:
        before, rest = README.read_text(encoding="utf-8").split(START)
        README.write_text(before + START + text + "\n" + END + rest.split(END)[1], encoding="utf-8")
    missed = [row.what for row in rows if row.met is False]
    if missed:
        print("missed: " + "; ".join(missed), file=sys.stderr)
    return 1 if missed and not options.quick else 0


if __name__ == "__main__":
    sys.exit(main())
