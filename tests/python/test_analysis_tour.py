"""The tour of the analyses does what it says: its commands, its script and its figure."""

from __future__ import annotations

import re
from pathlib import Path

from analysis_tour import NAMES, follow, picture_in
from pictures import DOCS, difference
from running import ROOT


def test_tour_runs_as_it_stands_and_draws_its_figure(tmp_path: Path) -> None:
    for name in ("arenas", "conf", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    printed = follow(tmp_path)
    shape, exponent, order, cluster, border = printed.splitlines()
    assert shape.endswith("100, 2) True 133.0")
    assert 1.8 < float(exponent.split()[-1]) <= 2.0
    assert float(order.split()[-1]) > 0.9 > 0.4 > float(order.split()[2])
    assert 10 <= int(cluster.split()[-1]) <= 100
    share, area = map(int, re.findall(r"(\d+)%", border))
    assert abs(share - area) < 15
    assert difference(DOCS / NAMES[0], picture_in(tmp_path)) == ""
