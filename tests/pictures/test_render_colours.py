"""Colours of film and loop: sides, soap, fields; exact where they can be."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.shape import Shape
from eulerplateau.pictures.figure import FieldLook
from eulerplateau.pictures.render.colours import (
    LOOP,
    SIDES,
    SOAP,
    coloured_film,
    loop_colours,
    scale_of,
)
from tests.helpers.shapes import disk_points, eight, mesh_of

ABOVE = np.array([0.0, 0.0, 1.0])
ASLANT = np.array([0.0, -0.6, 0.8])


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(5))


def film(mesh: Disk, t: float) -> Shape:
    x = eight(mesh.x[:, :2] / np.hypot(*mesh.x.T[:2]).max(), t)
    return Shape(x, mesh.triangles, mesh.loop)


def only(mesh: Disk, value: float, *, on_loop: bool) -> FloatArray:
    """A field that is `value` on the loop, or inside, and NaN elsewhere."""
    values = np.full(mesh.n_v, np.nan if on_loop else value)
    values[mesh.loop] = value if on_loop else np.nan
    return values


def test_a_flat_film_has_one_colour_a_side(mesh: Disk) -> None:
    front, back = (
        np.unique(coloured_film(film(mesh, 0.0), eye, SIDES, None, None).rgba, axis=0)
        for eye in (ABOVE, -ABOVE)
    )
    assert front.shape == back.shape == (1, 4)
    assert front[0, 2] > front[0, 0]
    assert back[0, 2] < back[0, 0]
    assert front[0, 3] == back[0, 3] == 1.0


@pytest.mark.parametrize("eye", [ABOVE, ASLANT])
def test_triangles_come_farthest_first_and_all_of_them(mesh: Disk, eye: FloatArray) -> None:
    shape = film(mesh, 0.7)
    painted = coloured_film(shape, eye, SOAP, None, None).corners.reshape(-1, 3, 3)
    assert (np.diff(painted.mean(axis=1) @ eye) >= -1e-15).all()
    corners = shape.x[shape.triangles]
    assert np.array_equal(np.sort(painted, axis=0), np.sort(corners, axis=0))


def test_soap_is_translucent_and_less_so_aslant(mesh: Disk) -> None:
    """Through a sheet at angle a passes the part that passes it straight to the 1/cos a."""
    straight, aslant = (
        coloured_film(film(mesh, 0.0), eye, SOAP, None, None).rgba[:, 3]
        for eye in (ABOVE, ASLANT)
    )
    assert (straight > 0.0).all()
    assert (straight < aslant).all()
    assert (aslant < 1.0).all()
    assert np.log(1.0 - aslant) * 0.8 == pytest.approx(np.log(1.0 - straight))


def test_a_field_inside_has_the_colours_of_its_bar_up_to_the_loop(mesh: Disk) -> None:
    shape = film(mesh, 0.0)
    values = only(mesh, 0.3, on_loop=False)
    scale = scale_of("angle_defect", [values, -values])
    front, back = (
        coloured_film(shape, eye, "angle_defect", values, scale).rgba[:, :3]
        for eye in (ABOVE, -ABOVE)
    )
    assert front == pytest.approx(np.tile(scale.rgb(np.array([0.3])), (len(front), 1)))
    assert (back < front).all()
    assert (loop_colours(shape, values, scale) == LOOP).all()


def test_a_field_on_the_loop_has_the_colours_of_its_bar(mesh: Disk) -> None:
    shape = film(mesh, 0.5)
    values = np.full(mesh.n_v, np.nan)
    values[mesh.loop] = np.linspace(1.0, 2.0, mesh.n_b)
    scale = scale_of("kappa", [values])
    loop = loop_colours(shape, values, scale)
    assert np.array_equal(loop, scale.rgb(values[mesh.loop]))
    rgb = coloured_film(shape, ABOVE, "kappa", values, scale).rgba[:, :3]
    assert np.ptp(rgb, axis=1).max() < 1e-12


def test_the_scale_is_the_same_for_all_shapes_and_symmetric_where_signs_matter(
    mesh: Disk,
) -> None:
    weak, strong = only(mesh, -0.1, on_loop=False), only(mesh, -5.0, on_loop=False)
    signed = scale_of(
        "angle_defect", [weak, strong], FieldLook("angle defect", signed=True)
    )
    assert (signed.low, signed.high) == (-5.0, 5.0)
    unsigned = scale_of("contact_angle", [-weak, -strong])
    assert (unsigned.low, unsigned.high) == (0.1, 5.0)


def test_a_field_that_is_rounding_is_not_blown_up(mesh: Disk) -> None:
    values = 1e-14 * np.random.default_rng(1).standard_normal(mesh.n_v)
    scale = scale_of("kappa_n", [values])
    assert np.ptp(scale.rgb(values), axis=0).max() < 0.01


def test_a_field_without_a_value_is_refused(mesh: Disk) -> None:
    with pytest.raises(SpecError) as caught:
        scale_of("kappa", [np.full(mesh.n_v, np.nan)])
    assert caught.value.key == "--colour"
