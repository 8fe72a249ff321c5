"""scripts/figures: a figure by its name, and what the committed page holds."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from matplotlib.image import imread

from scripts.studies.figures.__main__ import main

ROOT = Path(__file__).parents[2]


def make(*arguments: str) -> Result:
    return CliRunner().invoke(main, arguments)


def test_one_figure_is_made_and_the_page_left_alone(tmp_path: Path) -> None:
    done = make("planar-energy", "--out", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert [path.name for path in (tmp_path / "figures").iterdir()] == ["planar-energy.png"]
    assert imread(tmp_path / "figures" / "planar-energy.png").std() > 0.05
    assert not (tmp_path / "paper.md").exists()


def test_unknown_figure_ends_with_exit_code_2(tmp_path: Path) -> None:
    assert make("frenet", "--out", str(tmp_path)).exit_code == 2


def test_committed_page_shows_every_committed_figure_and_no_other() -> None:
    page = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"!\[[^]]*\]\(figures/([^)]*)\)", page))
    assert shown == {path.name for path in (ROOT / "docs" / "figures").iterdir()}


@pytest.mark.parametrize("path", sorted((ROOT / "docs" / "figures").iterdir()))
def test_committed_figures_are_small_and_nothing_is_cut_off(path: Path) -> None:
    """Nothing touches the border; legible at the size it is shown on a page."""
    assert path.stat().st_size < 200_000
    image = imread(path)[..., :3]
    border = [image[0], image[-1], image[:, 0], image[:, -1]]
    assert all((side > 0.95).all() for side in border)
