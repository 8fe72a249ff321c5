"""Renders: all of every film is seen, at one scale; animations do not jump."""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pytest
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures.render import GIF, MP4, STILLS, SWEEP, TURN, RunPictures
from tests.helpers.shapes import disk_points, eight, fitted_order, mesh_of, rotation
from tests.runs.test_folder import start
from tests.runs.test_output import ROW

Image = NDArray[np.uint8]

N_SHAPES = 7
FLAT, FOLDED = 0, 5


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(8))


def twisted(mesh: Disk, t: float) -> FloatArray:
    """The film of eq. eight, flat at t = 0, without symmetry, its loop of length 1."""
    x = eight(mesh.x[:, :2] * [1.2, 1.0] / np.hypot(*mesh.x.T[:2]).max(), t)
    x[:, 2] += t * (0.3 * x[:, 0] ** 2 + 0.2 * x[:, 1] ** 3)
    loop = x[mesh.loop]
    return x / np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1).sum()


def record(path: Path, mesh: Disk, films: list[FloatArray]) -> None:
    """A sweep of `films`, each left lying in a way of its own."""
    turn, lie = rotation(), np.eye(3)
    with start(path) as folder:
        for step, x in enumerate(films):
            lie = lie @ turn
            row = replace(ROW, step=step, kL3_alpha=100.0 * step)
            folder.record(row, mesh, x @ lie + step)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory, mesh: Disk) -> Path:
    """Six films that twist more and more, and the first again at half its size."""
    path = tmp_path_factory.mktemp("render")
    films = [twisted(mesh, t) for t in np.linspace(0.0, 0.9, N_SHAPES - 1)]
    record(path, mesh, [*films, 0.5 * films[0]])
    return path


# The child's module once for each kind of picture: VTK takes its time to start. Smaller
# pictures, and half as many frames as go around, show as much. None of it needs numba.
DRAW = """
import json, runpy, sys
from eulerplateau.pictures.render import pictures
pictures._WIDTH, pictures._FRAME_WIDTH, pictures._TURN_FRAMES = 600, 280, 24
for sys.argv[1:] in json.loads(sys.argv[1]):
    runpy.run_module("eulerplateau.pictures.render", run_name="__main__")
assert "numba" not in sys.modules
"""
EVERY = tuple(range(N_SHAPES))
BOTH = (FLAT, FOLDED)


@pytest.fixture(scope="module")
def again(run: Path) -> Path:
    """The same run, of which one shape is drawn by itself."""
    return Path(shutil.copytree(run, run.with_name("again")))


@pytest.fixture(scope="module")
def child(run: Path, again: Path) -> subprocess.CompletedProcess[bytes]:
    """The child that draws pictures of every kind, without a display.

    It is told of the backend that Jupyter asks for, which is not there elsewhere.
    """
    wanted = [
        (run, STILLS, GIF, "sides", EVERY),
        (run, STILLS, GIF, "soap", BOTH),
        (run, STILLS, GIF, "angle_defect", BOTH),
        (run, STILLS, GIF, "kappa_n", BOTH),
        (run, TURN, GIF, "sides", (FOLDED,)),
        (run, SWEEP, GIF, "sides", EVERY),
        (run, SWEEP, MP4, "sides", EVERY),
        (again, STILLS, GIF, "sides", (3,)),
    ]
    calls = [
        [str(to), str(to / "pictures"), *how, *map(str, steps)]
        for to, *how, steps in wanted
    ]
    command = [sys.executable, "-c", DRAW, json.dumps(calls)]
    environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    environment["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
    return subprocess.run(command, env=environment, capture_output=True, check=False)


@pytest.fixture(scope="module")
def drawn(run: Path, child: subprocess.CompletedProcess[bytes]) -> Path:
    """The pictures of every kind."""
    child.check_returncode()
    return run / "pictures"


def read(path: Path) -> Image:
    from PIL import Image as Images

    with Images.open(path) as image:
        return np.asarray(image.convert("RGB"))


def frames(path: Path) -> tuple[list[Image], list[int]]:
    """The frames of a GIF and how long each is shown, in milliseconds."""
    from PIL import Image as Images

    images, times = [], []
    with Images.open(path) as animation:
        for number in range(getattr(animation, "n_frames", 1)):
            animation.seek(number)
            images.append(np.asarray(animation.convert("RGB")))
            times.append(animation.info["duration"])
    return images, times


def above(image: Image, bar: bool = False) -> Image:
    """The image without what is written below it, a colour `bar` or not."""
    return image[: -written(image, bar)]


def below(image: Image, bar: bool = False) -> Image:
    """What is written below an image."""
    return image[-written(image, bar) :]


def written(image: Image, bar: bool) -> int:
    """How many pixels high that is: lines of 28 points below a picture 8 inches wide."""
    points = 2.4 * 28.0 + (72.0 if bar else 0.0)
    return 2 * math.ceil(0.5 * points * image.shape[1] / 8.0 / 72.0)


def inked(image: Image, bar: bool = False) -> NDArray[np.bool_]:
    return above(image, bar).min(axis=2) < 250


def width(image: Image) -> int:
    columns = np.flatnonzero(inked(image).any(axis=0))
    return int(columns[-1] - columns[0] + 1)


def assert_whole(image: Image, bar: bool = False) -> None:
    """Something is seen, and white all around it: it is not cut off."""
    ink = inked(image, bar)
    assert ink.mean() > 0.02
    for edge in (ink[0], ink[-1], ink[:, 0], ink[:, -1]):
        assert not edge.any()
    assert (below(image, bar).min(axis=2) < 128).any()  # the caption


def test_all_of_every_shape_is_seen_and_captioned(drawn: Path) -> None:
    for step in EVERY:
        assert_whole(read(drawn / f"shape_{step:04d}.png"))


def test_a_flat_film_has_its_true_outline(drawn: Path) -> None:
    """Seen from above it is 1.2 times as long as it is wide, to a pixel or two.

    The ends of its axes are vertices, or off them by less than a pixel.
    """
    ink = inked(read(drawn / f"shape_{FLAT:04d}.png"))
    across, up = (int(ink.any(axis=axis).sum()) for axis in (0, 1))
    tube = 0.007 / 0.1 * bar_length(read(drawn / f"shape_{FLAT:04d}.png"))
    assert (across - tube) / (up - tube) == pytest.approx(1.2, abs=3.0 / up)


def test_the_scale_bar_is_a_tenth_of_the_loops_length(drawn: Path, run: Path) -> None:
    for step in BOTH:
        image = read(drawn / f"shape_{step:04d}.png")
        pictures = RunPictures.read(run, [step])
        shapes = pictures.stage.aligned(pictures.shapes)
        view = pictures.stage.views(shapes)[step]
        right = np.cross([0.0, 0.0, 1.0], view.eye)
        seen = np.ptp(shapes[step].x @ right) / np.linalg.norm(right) + 0.007
        assert width(image) / bar_length(image) == pytest.approx(seen / 0.1, rel=0.02)


def bar_length(image: Image) -> int:
    """The longest row of black pixels below an image."""
    dark = below(image).max(axis=2) < 100
    ends = np.diff(np.pad(dark.astype(int), ((0, 0), (1, 1))), axis=1)
    starts, stops = (np.argwhere(ends == sign) for sign in (1, -1))
    return int((stops - starts)[:, 1].max())


def test_front_and_back_are_told_apart_in_grey(drawn: Path) -> None:
    """Of a film that turns over the blue side is darker throughout than the orange one."""
    from PIL import Image as Images

    image = above(read(drawn / f"shape_{FOLDED:04d}.png"))
    grey = np.asarray(Images.fromarray(image).convert("L"))
    red, _, blue = image.astype(int).transpose(2, 0, 1)
    front, back = grey[blue > red + 60], grey[red > blue + 60]
    assert len(front) > 500 < len(back)
    assert np.percentile(front, 98) < np.percentile(back, 2)


def test_all_pictures_have_one_scale(drawn: Path) -> None:
    large, small = (width(read(drawn / f"shape_{step:04d}.png")) for step in (0, 6))
    # The tube, 0.007 L wide in all pictures, is a fiftieth of the film's width.
    tube = 0.007 / 0.35 * large
    assert (large - tube) / (small - tube) == pytest.approx(2.0, rel=0.02)


def test_the_view_is_the_runs_whatever_is_shown(drawn: Path, again: Path) -> None:
    alone = again / "pictures"
    assert [path.name for path in alone.iterdir()] == ["shape_0003.png"]
    assert (read(alone / "shape_0003.png") == read(drawn / "shape_0003.png")).all()


def cells_of(sheet: Image) -> list[Image]:
    """The fields of a contact sheet of all shapes, three in a row."""
    wide, height = 600, len(sheet) // -(-N_SHAPES // 3)
    return [
        sheet[y : y + height, x : x + wide]
        for y in range(0, len(sheet), height)
        for x in range(0, sheet.shape[1], wide)
    ]


def test_a_caption_is_nearer_to_its_own_shape_than_to_the_next_below(drawn: Path) -> None:
    cells = cells_of(read(drawn / "sheet.png"))
    for cell in cells[:N_SHAPES]:
        shape = np.flatnonzero(inked(cell).any(axis=1))
        text = np.flatnonzero((below(cell) < 200).any(axis=(1, 2))) + len(above(cell))
        own = text[0] - shape[-1]
        assert all(
            len(cell) - text[-1] + np.flatnonzero(inked(other).any(axis=1))[0] > 2 * own
            for other in cells[:N_SHAPES]
        )


def test_contact_sheet_shows_every_shape(drawn: Path) -> None:
    sheet = read(drawn / "sheet.png")
    wide = 600
    cells = cells_of(sheet)
    assert len(cells) >= N_SHAPES
    for cell in cells[:N_SHAPES]:
        assert_whole(cell)
    assert all((cell == 255).all() for cell in cells[N_SHAPES:])
    assert sheet.shape[1] == 3 * wide  # or letters would be too small in print


def test_a_film_that_turns_over_shows_two_colours_in_every_style(drawn: Path) -> None:
    for name in ("", "_soap"):
        flat, folded = (read(drawn / f"shape_{step:04d}{name}.png") for step in BOTH)
        assert bluish(flat) > 0.1
        assert reddish(flat) < 0.001
        assert bluish(folded) > 0.02
        assert reddish(folded) > 0.02


def bluish(image: Image, bar: bool = False) -> float:
    colours = above(image, bar).astype(int)
    return float((colours[..., 2] > colours[..., 0] + 15).mean())


def reddish(image: Image, bar: bool = False) -> float:
    colours = above(image, bar).astype(int)
    return float((colours[..., 0] > colours[..., 2] + 15).mean())


@pytest.mark.parametrize("field", ["angle_defect", "kappa_n"])
def test_a_field_has_its_colours_and_their_bar(drawn: Path, field: str) -> None:
    """Neither field vanishes on a film that is twisted; both do on a flat one."""
    flat, folded = (read(drawn / f"shape_{step:04d}_{field}.png") for step in BOTH)
    assert reddish(flat, True) + bluish(flat, True) < 0.001
    seen = inked(folded, True).mean()
    assert reddish(folded, True) + bluish(folded, True) > 0.02 * seen
    for image in (flat, folded):
        assert_whole(image, True)
        bar = below(image, True).astype(int)
        assert np.ptp(bar[..., 0] - bar[..., 2]) > 200


def test_a_turn_goes_once_around_without_leaving_the_picture(drawn: Path) -> None:
    images, times = frames(drawn / f"turn_{FOLDED:04d}.gif")
    assert len(set(times)) == 1
    for image in images:
        assert_whole(image)
    steps = [unlike(a, b) for a, b in zip(images, [*images[1:], images[0]], strict=True)]
    assert 0.0 < max(steps) < 0.5 * max(unlike(images[0], image) for image in images)


def test_a_sweep_shows_each_shape_and_holds_the_last(drawn: Path) -> None:
    images, times = frames(drawn / "sweep.gif")
    assert len(images) == N_SHAPES
    assert times[-1] > 5 * times[0]
    for image in images:
        assert_whole(image)


def test_a_film_in_mp4_has_the_frames_of_the_gif(drawn: Path) -> None:
    """Of even size, in the pixels browsers play, as long as the GIF and alike."""
    images, times = frames(drawn / "sweep.gif")
    with av.open(drawn / "sweep.mp4") as film:
        stream = film.streams.video[0]
        pixels = [frame.to_ndarray(format="rgb24") for frame in film.decode(stream)]
        assert stream.codec_context.name == "h264"
        assert stream.codec_context.pix_fmt == "yuv420p"
        assert float(len(pixels) / stream.average_rate) == pytest.approx(sum(times) / 1000)
    shown = np.repeat(np.arange(len(times)), np.array(times) // times[0])
    assert len(pixels) == len(shown)
    for found, place in zip(pixels, shown, strict=True):
        assert found.shape == images[place].shape
        assert not any(size % 2 for size in found.shape[:2])
        assert np.abs(found.astype(int) - images[place]).mean() < 3.0


def unlike(a: Image, b: Image) -> float:
    """Which part of two pictures differs."""
    return float((np.abs(a.astype(int) - b).max(axis=2) > 30).mean())


def test_frames_of_one_shape_however_it_lies_are_alike(tmp_path: Path, mesh: Disk) -> None:
    record(tmp_path, mesh, [twisted(mesh, 0.4)] * 2)
    shapes = RunPictures.read(tmp_path, [0, 1]).shapes
    assert np.abs(shapes[0].x - shapes[1].x).max() < 1e-12


def test_displacement_from_frame_to_frame_is_proportional_to_the_step(
    tmp_path: Path, mesh: Disk
) -> None:
    """From flat to past the quarter turn, where principal axes would swap with a jump."""
    counts = [8, 16, 32]
    largest = []
    for count in counts:
        folder = tmp_path / str(count)
        record(folder, mesh, [twisted(mesh, t) for t in np.linspace(0.0, 0.9, count + 1)])
        shapes = RunPictures.read(folder, range(count + 1)).shapes
        x = np.array([shape.x[shape.loop] for shape in shapes])
        largest.append(float(np.linalg.norm(np.diff(x, axis=0), axis=2).max()))
    assert fitted_order([1.0 / count for count in counts], largest) == pytest.approx(
        1.0, abs=0.1
    )


def test_the_child_says_nothing_without_a_display(
    child: subprocess.CompletedProcess[bytes],
) -> None:
    """VTK complains that there is no X server before it finds that it needs none."""
    assert child.stdout == child.stderr == b""


def test_the_child_does_not_mind_the_backend_of_a_notebook(
    child: subprocess.CompletedProcess[bytes],
) -> None:
    assert child.returncode == 0, child.stderr
    assert child.stdout == child.stderr == b""
