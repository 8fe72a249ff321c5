"""Pictures as the content of files, and contact sheets of many."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from eulerplateau.pictures.render.scene import Pixels

if TYPE_CHECKING:
    from PIL.Image import Image

# Three across two columns of a journal leave captions readable.
_THUMBNAIL, _ACROSS = 600, 3


def png(image: Pixels) -> bytes:
    """Return an image (height, width, 3) as the content of a PNG file."""
    from PIL import Image as Images

    return saved(Images.fromarray(image), "PNG")


def contact_sheet(images: Sequence[Pixels]) -> bytes:
    """Return the PNG of all images, of one size, row by row, at most three in a row."""
    from PIL import Image as Images

    columns = min(math.ceil(math.sqrt(len(images))), _ACROSS)
    rows = math.ceil(len(images) / columns)
    high, wide, _ = images[0].shape
    width, height = _THUMBNAIL, round(_THUMBNAIL * high / wide)
    sheet = Images.new("RGB", (columns * width, rows * height), "white")
    for place, image in enumerate(images):
        small = Images.fromarray(image).resize((width, height), Images.Resampling.LANCZOS)
        sheet.paste(small, (place % columns * width, place // columns * height))
    return saved(sheet, "PNG")


def saved(image: Image, kind: str, **options: Any) -> bytes:
    """Return an image as the content of a file of a kind Pillow knows."""
    content = io.BytesIO()
    image.save(content, format=kind, **options)
    return content.getvalue()
