"""Pictures of a run up and down: its diagram, and films on the way."""

from __future__ import annotations

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from eulerplateau.pictures import draw_diagram
from eulerplateau.pictures.render import draw_shapes
from eulerplateau.runs import read_run
from scripts.studies.common import shrink, shrink_shaded

# Loads at which films are shown, rising and falling.
_RISING, _FALLING = (600.0, 1600.0, 1860.0, 3000.0, 10000.0), (850.0,)


def draw_run(folder: Path, out: Path) -> None:
    """Draw run.png and shapes.png of a run; raises OSError if that fails."""
    rows = read_run(folder).rows
    top = int(max(rows, key=lambda row: row.sigma_hat).step)
    rising = {row.sigma_hat: row.step for row in rows[: top + 1]}
    falling = {row.sigma_hat: row.step for row in rows[top:]}
    steps = [rising[load] for load in _RISING] + [falling[load] for load in _FALLING]
    with TemporaryDirectory() as temporary:
        sheet = Path(temporary) / "sheet.png"
        if not draw_diagram(folder) or not draw_shapes(folder, steps, out=sheet.parent):
            raise OSError(f"{folder} is not drawn")
        shrink_shaded(sheet)
        shutil.copyfile(sheet, out / "shapes.png")
    shutil.copyfile(folder / "diagram.png", out / "run.png")
    shrink(out / "run.png")
