"""Pictures as the content of files, and contact sheets of many."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.pictures.render.scene import Pixels

if TYPE_CHECKING:
    from PIL.Image import Image

# Three across two columns of a journal leave captions readable.
_THUMBNAIL, _ACROSS = 600, 3
# Room above the tallest shape of a sheet and below each, as parts of a picture's width.
_OVER, _UNDER = 0.1, 0.02


def png(image: Pixels) -> bytes:
    """Return an image (height, width, 3) as the content of a PNG file."""
    from PIL import Image as Images

    return saved(Images.fromarray(image), "PNG")


def contact_sheet(images: Sequence[Pixels], high: int) -> bytes:
    """Return the PNG of all images, of one size, row by row, at most three in a row.

    In their first `high` rows they show a shape, below it what is written: there each shape
    stands on its caption, so that it is nearer to that than to the caption above.
    """
    from PIL import Image as Images

    closer = _on_captions(images, high)
    columns = min(math.ceil(math.sqrt(len(closer))), _ACROSS)
    rows = math.ceil(len(closer) / columns)
    tall, wide, _ = closer[0].shape
    width, height = _THUMBNAIL, round(_THUMBNAIL * tall / wide)
    sheet = Images.new("RGB", (columns * width, rows * height), "white")
    for place, image in enumerate(closer):
        small = Images.fromarray(image).resize((width, height), Images.Resampling.LANCZOS)
        sheet.paste(small, (place % columns * width, place // columns * height))
    return saved(sheet, "PNG")


def _on_captions(images: Sequence[Pixels], high: int) -> list[Pixels]:
    """Return images with their shapes moved down to their captions, and cut at the top."""
    width = images[0].shape[1]
    over, under = round(_OVER * width), round(_UNDER * width)
    shapes = [image[:high] for image in images]
    inked = [np.flatnonzero((shape < 255).any(axis=(1, 2))) for shape in shapes]
    tallest = max((int(np.ptp(rows)) + 1 for rows in inked if rows.size), default=1)
    found = []
    for image, shape, rows in zip(images, shapes, inked, strict=True):
        field = np.full((over + tallest + under, width, 3), 255, dtype=np.uint8)
        own = shape[rows[0] : rows[-1] + 1] if rows.size else shape[:0]
        field[len(field) - under - len(own) : len(field) - under] = own
        found.append(np.concatenate([field, image[high:]]))
    return found


def saved(image: Image, kind: str, **options: Any) -> bytes:
    """Return an image as the content of a file of a kind Pillow knows."""
    content = io.BytesIO()
    image.save(content, format=kind, **options)
    return content.getvalue()
