"""The page of a paper: its values and its runs, as text."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import numpy as np

import nullmotion as nm
from nullmotion import sim
from nullmotion.papers import Cell
from nullmotion.report.paper import paper_report

EVIL = "</td><script>alert(1)</script>&amp;"
CELLS = [
    Cell("4", "pi", "total_time_s", 1.86, 1.864, 0.01),
    Cell("4", "nd", "flag", "Y", "N", note=EVIL),
    Cell("4", "gsr", "reserve", 0.026, 0.0261, 0.001, parameters="fitted"),
    Cell("text", EVIL, "angle_deg", None, -12.5),
]


class Cells(HTMLParser):
    def __init__(self, content):
        super().__init__()
        self.rows, self.names, self._open = [], [], False
        self.feed(content)

    def handle_starttag(self, name, attributes):
        self.names.append(name)
        if name == "tr":
            self.rows.append([])
        self._open = name in ("td", "th") or (self._open and name == "span")
        if name in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, name):
        self._open = self._open and name not in ("td", "th")

    def handle_data(self, data):
        if self._open:
            self.rows[-1][-1] += data


def test_every_value_is_on_the_page_as_text(tmp_path):
    path = paper_report(tmp_path / "a.html", f"Title {EVIL}", "", [c.as_row() for c in CELLS])
    content = path.read_text(encoding="utf-8")
    found = Cells(content)
    assert "script" not in found.names
    bodies = [row for row in found.rows if row and row[0] != "Row"]
    assert [row[6] for row in bodies] == ["reproduced", "differs", "matched", "not printed"]
    assert bodies[0][:5] == ["pi", "total_time_s", "1.86", "1.864", "0.01"]
    assert bodies[1][7] == EVIL and bodies[3][0] == EVIL
    assert bodies[3][2:4] == ["–", "−12.5"]
    assert "3 printed values: 1 reproduced, 1 matched, 1 differs" in content
    assert "2 of 3 as printed" in content and "1 not printed" in content
    assert re.findall(r'<a href="#([\w-]+)"', content) == ["table-4", "table-text"]


def test_runs_are_shown_in_momentum_space(tmp_path):
    setup = sim.Setup(
        nm.layouts.pyramid(), nm.laws.create("sr"), np.zeros(4), np.array([0.1, 0, 0]), steps=20
    )
    runs = {"one": sim.run(setup), EVIL: sim.run(setup)}
    path = paper_report(tmp_path / "a.html", "T", "C", [c.as_row() for c in CELLS], runs)
    content = path.read_text(encoding="utf-8")
    assert 'id="atlas-motion"' in content and content.count("<script") == 2
    assert len(content) < 1_200_000
    assert [p.name for p in tmp_path.iterdir()] == ["a.html"]
