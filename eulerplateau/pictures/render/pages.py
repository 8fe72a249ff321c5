"""From pixels to pictures: captions, colour bars, contact sheets, GIFs."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.mesh.drawing import ASPECT
from eulerplateau.pictures.figure import load_matplotlib
from eulerplateau.pictures.render.colours import Scale
from eulerplateau.pictures.render.scene import Pixels

if TYPE_CHECKING:
    from PIL.Image import Image

_INCHES = 8.0
_THUMBNAIL = 400
# Colours of a GIF are taken from so many of its frames: one palette, or it would flicker.
_PALETTE_FRAMES = 12
_ALMOST_WHITE = 248


def caption(row: Any) -> str:
    """Return what is written below the shape of a row, of a sweep or of a branch."""
    parts = [f"${row.load_name.tex} = {row.load:.6g}$"]
    if hasattr(row, "branch"):
        parts.append(f"branch {row.branch}")
    if not row.converged:
        parts.append("not converged")
    return ", ".join(parts)


def captioned(pixels: Pixels, text: str, scale: Scale | None) -> Pixels:
    """Return the image with its caption, and the colour bar of `scale` if there is one."""
    writing = _writing(text, scale, pixels.shape[1])
    found = pixels.copy()
    lower = found[-len(writing) :]
    opacity = writing[..., 3:] / 255.0
    lower[:] = np.rint(lower + opacity * (writing[..., :3].astype(float) - lower))
    return found


@lru_cache(maxsize=1)
def _writing(text: str, scale: Scale | None, width: int) -> Pixels:
    """Return what stands below an image (height, width, RGBA), as high as there is any.

    The frames of a turning shape have the same: to write it takes longer than to render.
    """
    load_matplotlib()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_INCHES, _INCHES * ASPECT), dpi=width / _INCHES, frameon=False)
    canvas: Any = FigureCanvasAgg(figure)
    figure.text(0.03, 0.035, text, fontsize=13)
    if scale is not None:
        _add_bar(figure, scale)
    canvas.draw()
    drawn: Pixels = np.asarray(canvas.buffer_rgba())
    first = int(np.flatnonzero(drawn[..., 3].any(axis=1))[0])
    return drawn[first:].copy()


def _add_bar(figure: Any, scale: Scale) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    axes = figure.add_axes((0.58, 0.085, 0.36, 0.022))
    colours = ScalarMappable(Normalize(scale.low, scale.high), scale.colours)
    bar = figure.colorbar(colours, cax=axes, orientation="horizontal", extend="both")
    bar.set_label(scale.label, fontsize=11, labelpad=2)
    bar.ax.locator_params(nbins=5)
    bar.ax.tick_params(labelsize=9)
    bar.formatter.set_powerlimits((-3, 4))


def png(image: Pixels) -> bytes:
    """Return an image (height, width, 3) as the content of a PNG file."""
    from PIL import Image as Images

    return _saved(Images.fromarray(image), "PNG")


def contact_sheet(images: Sequence[Pixels]) -> bytes:
    """Return the PNG of all images, row by row, in about the shape of one of them."""
    from PIL import Image as Images

    columns = math.ceil(math.sqrt(len(images)))
    rows = math.ceil(len(images) / columns)
    width, height = _THUMBNAIL, round(ASPECT * _THUMBNAIL)
    sheet = Images.new("RGB", (columns * width, rows * height), "white")
    for place, image in enumerate(images):
        small = Images.fromarray(image).resize((width, height), Images.Resampling.LANCZOS)
        sheet.paste(small, (place % columns * width, place // columns * height))
    return _saved(sheet, "PNG")


def gif(frames: Sequence[Pixels], milliseconds: Sequence[int]) -> bytes:
    """Return an endless GIF; `milliseconds` (n_frames,) is how long each frame is shown."""
    from PIL import Image as Images

    some = frames[:: max(1, len(frames) // _PALETTE_FRAMES)]
    palette = Images.fromarray(np.concatenate(some)).quantize(256)
    colours = np.array(palette.getpalette()).reshape(-1, 3)
    # The background, which would come out greyish.
    colours[colours.min(axis=1) > _ALMOST_WHITE] = 255
    palette.putpalette(colours.ravel().tolist())
    plain = Images.Dither.NONE
    first, *others = (
        Images.fromarray(frame).quantize(palette=palette, dither=plain) for frame in frames
    )
    return _saved(
        first,
        "GIF",
        save_all=True,
        append_images=others,
        duration=list(milliseconds),
        loop=0,
    )


def _saved(image: Image, kind: str, **options: Any) -> bytes:
    content = io.BytesIO()
    image.save(content, format=kind, **options)
    return content.getvalue()
