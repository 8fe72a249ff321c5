"""The pictures of a run: stills, a contact sheet, shapes that turn, an animated sweep."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import OutputError
from eulerplateau.mesh import Shape, write_whole
from eulerplateau.mesh.drawing import View, turning_views
from eulerplateau.pictures.kinds import Stage
from eulerplateau.pictures.of_run import pictures_of
from eulerplateau.pictures.render.animations import GIF, animation
from eulerplateau.pictures.render.captions import Caption, captioned, text_of
from eulerplateau.pictures.render.choice import chosen_steps
from eulerplateau.pictures.render.colours import (
    SIDES,
    SOAP,
    Scale,
    coloured_film,
    loop_colours,
    scale_of,
)
from eulerplateau.pictures.render.drawing import pictures_folder
from eulerplateau.pictures.render.fields import read_field
from eulerplateau.pictures.render.pages import contact_sheet, png
from eulerplateau.pictures.render.scene import Pixels, Scene
from eulerplateau.pictures.wire import read_wire
from eulerplateau.runs import Run, read_run

_WIDTH, _FRAME_WIDTH = 1200, 640
_TURN_FRAMES = 48
# How long a frame is shown, and how many times that where a branch or leg ends.
_MILLISECONDS, _HOLD = 80, 12


@dataclass(frozen=True)
class RunPictures:
    """What the pictures of a run have in common.

    Attributes
    ----------
    run : its rows
    out : the folder that pictures go to
    shapes : one per row, each turned as little as can be from the one before it, in units
        of a loop's length
    places : the numbers of the rows to be shown
    colour : "sides" (front of the film blue, back orange), "soap" (the same, translucent)
        or a scalar field of the shape files
    fields : by place, the values (n_v,) of that field; empty if it is none
    scale : the colours of the field at all `places`
    """

    run: Run
    out: Path
    shapes: tuple[Shape, ...]
    places: tuple[int, ...]
    colour: str
    fields: dict[int, FloatArray]
    scale: Scale | None

    @classmethod
    def read(
        cls,
        folder: Path,
        steps: Sequence[int],
        colour: str | None = None,
        out: Path | None = None,
    ) -> RunPictures:
        """Read a run, of which `steps` (at least one) are to be shown.

        Pictures go to `out`, by default to the subfolder pictures/ of the run's.
        Raises OutputError if a shape cannot be read, SpecError if there is no such step
        or field.
        """
        run = read_run(folder)
        stage = pictures_of(run.kind).stage
        colour = stage.colour if colour is None else colour
        wanted = chosen_steps(run, steps, [])
        places = [place for place, row in enumerate(run.rows) if row.step in wanted]
        fields = {}
        if colour not in (SIDES, SOAP):
            paths = {place: run.shape_path(run.rows[place]) for place in places}
            fields = {place: read_field(path, colour) for place, path in paths.items()}
        look = stage.fields.get(colour)
        scale = scale_of(colour, list(fields.values()), look) if fields else None
        out, shapes = out or pictures_folder(folder), _followed(run, stage)
        return cls(run, out, shapes, tuple(places), colour, fields, scale)

    @property
    def stage(self) -> Stage:
        """How the run's shapes are seen."""
        return pictures_of(self.run.kind).stage

    def stills(self) -> None:
        """Draw shape_*.png and, of several, a contact sheet, sheet.png.

        The views are those of the whole run, so that pictures made at different times
        compare.
        """
        shapes = self.stage.aligned(self.shapes)
        views = self.stage.views(shapes)
        images = []
        with Scene(_WIDTH, views[0]) as scene:
            for place in self.places:
                images.append(self._picture(scene, place, shapes[place], views[place]))
                self._write(f"shape_{self._step(place):04d}", "png", png(images[-1]))
        if len(images) > 1:
            high = views[0].size(_WIDTH)[1]
            self._write("sheet", "png", contact_sheet(images, high))

    def turns(self, form: str = GIF) -> None:
        """Draw turn_*.gif, or .mp4: each shape once around, all in one scale."""
        shapes = self.stage.aligned(self.shapes)
        views = turning_views(shapes, _TURN_FRAMES)
        with Scene(_FRAME_WIDTH, views[0]) as scene:
            for place in self.places:
                shape = shapes[place]
                frames = [self._picture(scene, place, shape, view) for view in views]
                content = animation(form, frames, _MILLISECONDS, [1] * len(frames))
                self._write(f"turn_{self._step(place):04d}", form, content)

    def sweep(self, form: str = GIF) -> None:
        """Draw sweep.gif, or .mp4: the shapes in sequence, held where a curve ends."""
        view = self.stage.view(self.shapes)
        ends = {series.last for series in self.run.series} | {self.places[-1]}
        with Scene(_FRAME_WIDTH, view) as scene:
            frames = [
                self._picture(scene, place, self.shapes[place], view)
                for place in self.places
            ]
        times = [_HOLD if place in ends else 1 for place in self.places]
        self._write("sweep", form, animation(form, frames, _MILLISECONDS, times))

    def _step(self, place: int) -> int:
        return int(self.run.rows[place].step)

    def _picture(self, scene: Scene, place: int, shape: Shape, view: View) -> Pixels:
        values = self.fields.get(place)
        film = coloured_film(shape, view.eye, self.colour, values, self.scale)
        wire = read_wire(self.run.shape_path(self.run.rows[place]), shape)
        colours = loop_colours(shape, values, self.scale)
        pixels = scene.pixels(shape, film, colours, wire, view)
        length, name = self.stage.bar
        bar = 0.5 * length / view.half[0], name
        text = text_of(self.run.rows[place])
        return captioned(pixels, Caption(text, view.words(shape), bar, self.scale))

    def _write(self, name: str, suffix: str, content: bytes) -> None:
        try:
            self.out.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(self.out, f"cannot be made: {error.strerror}") from None
        coloured = name if self.colour == self.stage.colour else f"{name}_{self.colour}"
        write_whole(self.out / f"{coloured}.{suffix}", content)


def _followed(run: Run, stage: Stage) -> tuple[Shape, ...]:
    """Return the shapes of a run, each turned as little as can be from the one before."""
    found = run.shapes()
    (x,) = stage.settled([(run.series, found.x / stage.size)], found.loop)
    tilings = [found.triangles(place) for place in range(len(x))]
    return tuple(
        Shape(own[: tiles.max() + 1], tiles, found.loop)
        for own, tiles in zip(x, tilings, strict=True)
    )
