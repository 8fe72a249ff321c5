"""From frames to animations: GIFs, and films in MP4, which need PyAV."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from eulerplateau.errors import MissingLibraryError
from eulerplateau.pictures.render.pages import saved
from eulerplateau.pictures.render.scene import Pixels

GIF, MP4 = "gif", "mp4"
# Colours of a GIF are taken from so many of its frames: one palette, or it would flicker.
_PALETTE_FRAMES = 12
_ALMOST_WHITE = 248
# Constant quality of H.264, in which no compression is seen.
_QUALITY = "16"


def check_format(form: str) -> None:
    """Raise MissingLibraryError, which says what to install, if GIF or MP4 needs more."""
    if form == MP4:
        try:
            import av  # noqa: F401
        except ImportError:
            problem = "MP4 needs PyAV: pip install 'eulerplateau[mp4]'"
            raise MissingLibraryError(problem) from None


def animation(
    form: str, frames: Sequence[Pixels], milliseconds: int, times: Sequence[int]
) -> bytes:
    """Return an animation as the content of a file of a format, GIF or MP4.

    Each frame (height, width, 3) is shown for `milliseconds`, so many `times` (n_frames,).
    A GIF is endless. Raises MissingLibraryError for MP4 without PyAV.
    """
    check_format(form)
    write = _mp4 if form == MP4 else _gif
    return write(frames, milliseconds, times)


def _gif(frames: Sequence[Pixels], milliseconds: int, times: Sequence[int]) -> bytes:
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
    return saved(
        first,
        "GIF",
        save_all=True,
        append_images=others,
        duration=[milliseconds * time for time in times],
        loop=0,
    )


def _mp4(frames: Sequence[Pixels], milliseconds: int, times: Sequence[int]) -> bytes:
    """Return H.264 with halved colours, which browsers and slides play; sizes are even."""
    from fractions import Fraction

    import av

    content = io.BytesIO()
    height, width, _ = frames[0].shape
    with av.open(content, "w", format="mp4") as film:
        stream: Any = film.add_stream(
            "libx264", rate=Fraction(1000, milliseconds), options={"crf": _QUALITY}
        )
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        for frame, count in zip(frames, times, strict=True):
            for _ in range(count):
                pixels = av.VideoFrame.from_ndarray(frame, format="rgb24")
                film.mux(stream.encode(pixels))
        film.mux(stream.encode())
    return content.getvalue()
