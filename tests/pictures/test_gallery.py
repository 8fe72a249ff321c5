"""The gallery page: all of a run is in it, exactly where exactness is promised."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import OutputError
from eulerplateau.loop import directors
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures.gallery import collect, page
from eulerplateau.runs.cell_table import CellRow
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.own_columns import (
    OfContact,
    OfDiameter,
    OfLength,
    OfRatio,
    OfSurfaceTension,
    with_own,
)
from eulerplateau.runs.record import read_run
from eulerplateau.runs.rows import (
    BranchRow,
    CurvedRodRow,
    TwistRow,
    columns,
)
from eulerplateau.runs.series_file import shape_name
from tests.helpers.command import run_here
from tests.helpers.shapes import disk_points, eight, mesh_of, rotation
from tests.runs.test_output import ROW

MEGABYTE = 1e6

PAGE = Path(__file__).parents[2] / "eulerplateau" / "pictures" / "gallery"


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(6, jitter=0.2))


def twisted(mesh: Disk, t: float) -> FloatArray:
    """The film of eq. eight, which turns from a disk to a flat eight as t goes to 1."""
    return 0.1 * eight(mesh.x[:, :2] / np.hypot(*mesh.x.T[:2]).max(), t)


def sweep(path: Path, mesh: Disk, loads: Sequence[float]) -> Path:
    with RunFolder.create(path, {"status": "finished"}) as folder:
        for step, load in enumerate(loads):
            row = replace(ROW, step=step, kL3_alpha=load, sigma_hat=3.4 * load)
            folder.record(row, mesh, twisted(mesh, load / 1000.0))
    return path


def branches(path: Path, mesh: Disk) -> Path:
    """A flat branch, and two that leave it at its middle point, to either side."""
    loads = [0.0, 100.0, 200.0, 250.0, 300.0, 250.0, 300.0]
    twists = [0.0, 0.0, 0.0, 0.2, 0.3, -0.2, -0.3]
    with RunFolder.create(path, {}, "branches", BranchRow) as folder:
        for step, (load, twist) in enumerate(zip(loads, twists, strict=True)):
            row = BranchRow(
                **asdict(replace(ROW, step=step, kL3_alpha=load)),
                branch=max(0, (step - 1) // 2),
                origin=7 if step > 2 else None,
                special=7 if step == 1 else None,
                arclength=0.0,
            )
            folder.record(row, mesh, twisted(mesh, twist) @ rotation())
    (path / "special_points.csv").write_text("number,kind,breaks\n7,bifurcation,mirror\n")
    return path


class Page(HTMLParser):
    """What a browser would take from the page."""

    def __init__(self, content: bytes) -> None:
        super().__init__()
        self.attributes: list[tuple[str, str, str | None]] = []
        self.data: dict[str, Any] = {}
        self._is_data = False
        self.feed(content.decode())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value) for name, value in attrs]
        self._is_data = ("id", "data") in attrs

    def handle_data(self, text: str) -> None:
        if self._is_data:
            self.data = json.loads(text)

    def handle_endtag(self, tag: str) -> None:
        self._is_data = False


def unpacked(text: str, kind: str) -> Any:
    return np.frombuffer(base64.b64decode(text), dtype=kind)


def test_page_holds_every_row_and_every_shape_to_16_bits(
    tmp_path: Path, mesh: Disk
) -> None:
    gallery = collect([sweep(tmp_path / "run", mesh, [1.0, 400.0, 900.0])])
    (exhibit,) = gallery.exhibits
    run = exhibit.run
    data = Page(page(gallery)).data
    (shown,) = data["runs"]
    (its_mesh,) = data["meshes"]
    assert (
        unpacked(its_mesh["triangles"], "<u4").tolist() == mesh.triangles.ravel().tolist()
    )
    assert unpacked(its_mesh["loop"], "<u4").tolist() == mesh.loop.tolist()
    x = data["unit"] * unpacked(shown["shapes"], "<i2").reshape(exhibit.x.shape)
    assert np.abs(x - exhibit.x).max() < 1e-5
    for row, cells in zip(run.rows, shown["rows"], strict=True):
        for name, cell in zip(data["columns"], cells, strict=True):
            value = getattr(row, name, None)
            if isinstance(value, float):
                assert cell == pytest.approx(value, rel=1e-9)
            else:
                assert cell == (value.value if name == "status" else value)


def test_a_loop_that_resists_twist_is_marked_and_the_mark_winds_as_it_is_twisted(
    tmp_path: Path, mesh: Disk
) -> None:
    """A flat ring has no writhe: what was turned winds round it, from weld to weld."""
    turns, own = 1.3, {"twist_energy": 0.0, "writhe": 0.0, "twist_moment": 0.0}
    summary = {"spec": {"loop": {"twist_ratio": 0.75}}}
    ring = 0.15 * mesh.x / np.hypot(*mesh.x.T[:2]).max()
    with RunFolder.create(tmp_path / "rod", summary, "sweep", TwistRow) as folder:
        for step, link in enumerate([0.0, turns]):
            row = TwistRow(**asdict(replace(ROW, step=step)), link=link, **own)
            x = ring @ rotation()
            fields = {"director": np.full_like(x, np.nan)}
            fields["director"][mesh.loop] = directors(x[mesh.loop], link)
            folder.record(row, mesh, x, fields)
    data = Page(page(collect([tmp_path / "rod", sweep(tmp_path / "bare", mesh, [1.0])])))
    shown, bare = data.data["runs"]
    assert bare["marks"] is None
    x = data.data["unit"] * unpacked(shown["shapes"], "<i2").reshape(2, mesh.n_v, 3)
    marks = unpacked(shown["marks"], "i1").reshape(2, mesh.n_b, 3) / 127
    assert np.abs(np.linalg.norm(marks, axis=-1) - 1).max() < 0.01
    for loop, across, link in zip(x[:, mesh.loop], marks, (0.0, turns), strict=True):
        edges = np.roll(loop, -1, axis=0) - loop
        edges /= np.linalg.norm(edges, axis=1)[:, None]
        # Straight across the wire, on the shape as the page has turned it.
        assert np.abs((edges * across).sum(axis=1)).max() < 0.01
        normal = np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0)
        normal /= np.linalg.norm(normal)
        beside = np.cross(edges, normal)
        angle = np.arctan2((across * beside).sum(axis=1), across @ normal)
        wound = np.unwrap(angle)[-1] - np.unwrap(angle)[0]
        assert wound == pytest.approx(2 * np.pi * link * (1 - 1 / mesh.n_b), abs=0.05)


def test_columns_the_page_shows_are_those_of_the_table() -> None:
    static = (
        Path(__file__).parents[2]
        / "eulerplateau"
        / "pictures"
        / "gallery"
        / "quantities.js"
    )
    films, cells = static.read_text().split("cell: [")
    # Of what a row does not have the page says nothing.
    film: Any = CurvedRodRow
    for own in (OfRatio, OfContact, OfDiameter, OfLength, OfSurfaceTension):
        film = with_own(own, film)
    for text, row in ((films, film), (cells, CellRow)):
        keys = {part.split('"')[0] for part in text.split('key: "')[1:]}
        assert keys <= set(columns(row))
        assert len(keys) > 10


def test_cells_that_are_not_numbers_are_null(tmp_path: Path, mesh: Disk) -> None:
    row = replace(ROW, energy=math.nan, area=math.inf, n_unstable=None)
    with RunFolder.create(tmp_path / "run", {}) as folder:
        folder.record(row, mesh, mesh.x)
    data = Page(page(collect([tmp_path / "run"]))).data
    cells = dict(zip(data["columns"], data["runs"][0]["rows"][0], strict=True))
    assert [cells[name] for name in ("energy", "area", "n_unstable")] == [None] * 3


def test_noise_of_a_flat_film_is_shown_as_zero(tmp_path: Path, mesh: Disk) -> None:
    """And nothing else: not a half turn of a flat film, not a small twist of a bent one."""
    flat = replace(ROW, abs_kappa_n=1e-10, total_gauss_curvature=-1e-11, waist_twist=-6e-12)
    turned = replace(flat, step=1, waist_twist=180.0)
    bent = replace(
        flat, step=2, abs_kappa_n=0.5, total_gauss_curvature=-0.3, waist_twist=6e-12
    )
    with RunFolder.create(tmp_path, {"status": "finished"}) as folder:
        for row in (flat, turned, bent):
            folder.record(row, mesh, twisted(mesh, 0.1))
    data = Page(page(collect([tmp_path]))).data
    names = ("abs_kappa_n", "total_gauss_curvature", "waist_twist")
    found = [
        [cells[data["columns"].index(name)] for name in names]
        for cells in data["runs"][0]["rows"]
    ]
    assert found == [[0.0, 0.0, 0.0], [0.0, 0.0, 180.0], [0.5, -0.3, 6e-12]]


def test_page_refers_to_nothing_outside_it_and_may_not(tmp_path: Path, mesh: Disk) -> None:
    content = Page(page(collect([sweep(tmp_path / "run", mesh, [1.0])])))
    names = {name for _, name, _ in content.attributes}
    assert names & {"src", "href", "srcset", "action", "data", "poster"} == set()
    (policy,) = [v for _, name, v in content.attributes if name == "content" and "src" in v]
    assert "default-src 'none'" in policy
    assert "http" not in policy


def test_names_of_folders_cannot_break_out_of_their_place(
    tmp_path: Path, mesh: Disk
) -> None:
    name = "a<b>&\"c' {{data}} <!--<script>"
    data = Page(page(collect([sweep(tmp_path / name, mesh, [1.0])]))).data
    assert data["runs"][0]["name"] == name


def test_hundred_shapes_of_547_vertices_stay_below_10_megabytes(tmp_path: Path) -> None:
    fine = mesh_of(*disk_points(13))
    loads = list(np.linspace(1.0, 900.0, 100))
    content = page(collect([sweep(tmp_path / "run", fine, loads)]))
    assert fine.n_v == 547
    assert len(content) < 10 * MEGABYTE


def test_runs_on_one_mesh_share_its_triangles(tmp_path: Path, mesh: Disk) -> None:
    other = mesh_of(*disk_points(4))
    folders = [
        sweep(tmp_path / "a" / "run", mesh, [1.0, 2.0]),
        sweep(tmp_path / "b" / "run", other, [1.0]),
        branches(tmp_path / "c", mesh),
    ]
    gallery = collect([*folders, folders[0]])
    names = [exhibit.run.name for exhibit in gallery.exhibits]
    assert names == ["a/run", "b/run", f"{tmp_path.name}/c"]
    assert [exhibit.mesh for exhibit in gallery.exhibits] == [0, 1, 0]
    assert len(gallery.meshes) == 2
    # A run starts where the first on its mesh does, turned alike.
    first, _, third = gallery.exhibits
    assert np.allclose(first.x[0], third.x[0], atol=1e-3)


def test_branches_start_at_their_special_point(tmp_path: Path, mesh: Disk) -> None:
    (exhibit,) = collect([branches(tmp_path / "run", mesh)]).exhibits
    run = exhibit.run
    places = [(series.start, series.first, series.last) for series in run.series]
    assert places == [(None, 0, 2), (1, 3, 4), (1, 5, 6)]
    assert run.series[1].group == run.series[2].group != run.series[0].group
    assert run.special[7]["kind"] == "bifurcation"
    for series in run.series[1:]:
        step = exhibit.x[series.first] - exhibit.x[1]
        assert np.abs(step).max() < 0.05


@pytest.mark.parametrize(
    ("loads", "legs"),
    [
        ([5.0], [(None, 0, 0)]),
        ([5.0, 5.0], [(None, 0, 1)]),
        ([1.0, 2.0, 3.0], [(None, 0, 2)]),
        ([3.0, 2.0, 1.0], [(None, 0, 2)]),
        ([1.0, 2.0, 3.0, 2.0, 1.0], [(None, 0, 2), (2, 3, 4)]),
        ([2.0, 1.0, 2.0, 1.0], [(None, 0, 1), (1, 2, 2), (2, 3, 3)]),
    ],
)
def test_sweep_is_split_where_its_load_turns(
    tmp_path: Path, mesh: Disk, loads: list[float], legs: list[Any]
) -> None:
    run = read_run(sweep(tmp_path / "run", mesh, loads))
    assert [(leg.start, leg.first, leg.last) for leg in run.series] == legs


@pytest.mark.parametrize(
    ("spoil", "at_fault"),
    [
        (lambda run: (run / "sweep.csv").unlink(), ""),
        (lambda run: (run / shape_name(1)).unlink(), shape_name(1)),
        (lambda run: (run / shape_name(1)).write_bytes(b"<VTKFile"), shape_name(1)),
        (lambda run: (run / "sweep.csv").write_text("load\n1\n"), "sweep.csv"),
    ],
    ids=["no table", "missing shape", "broken shape", "other table"],
)
def test_folder_that_is_no_whole_run_is_named(
    tmp_path: Path, mesh: Disk, spoil: Any, at_fault: str
) -> None:
    run = sweep(tmp_path / "run", mesh, [1.0, 2.0])
    spoil(run)
    with pytest.raises(OutputError) as caught:
        collect([run])
    assert caught.value.path == run / at_fault


def test_run_without_rows_is_named(tmp_path: Path, mesh: Disk) -> None:
    run = sweep(tmp_path / "run", mesh, [])
    with pytest.raises(OutputError) as caught:
        collect([run])
    assert caught.value.path == run


def test_shapes_of_two_meshes_in_one_run_are_refused(tmp_path: Path, mesh: Disk) -> None:
    run = sweep(tmp_path / "run", mesh, [1.0, 2.0])
    other = sweep(tmp_path / "other", mesh_of(*disk_points(4)), [1.0, 2.0])
    (other / shape_name(1)).replace(run / shape_name(1))
    with pytest.raises(OutputError) as caught:
        collect([run])
    assert caught.value.path == run / shape_name(1)


def test_table_of_special_points_that_is_none_is_named(tmp_path: Path, mesh: Disk) -> None:
    run = branches(tmp_path / "run", mesh)
    (run / "special_points.csv").write_text("kind\nfold\n")
    with pytest.raises(OutputError) as caught:
        collect([run])
    assert caught.value.path == run / "special_points.csv"
    (run / "special_points.csv").unlink()
    assert collect([run]).exhibits[0].run.special == {}


def test_command_writes_the_page_whole_or_says_why_not(tmp_path: Path, mesh: Disk) -> None:
    run = sweep(tmp_path / "run", mesh, [1.0, 2.0])
    out = tmp_path / "page.html"
    assert run_here("gallery", run, "-o", out).returncode == 0
    content = out.read_bytes()
    assert content == page(collect([run]))
    for arguments, code in (
        ((), 2),
        ((run, "-o", tmp_path / "missing" / "page.html"), 5),
        ((run, "-o", tmp_path), 5),
        ((tmp_path, "-o", out), 5),
        ((tmp_path / "nowhere", "-o", out), 5),
    ):
        ended = run_here("gallery", *arguments)
        assert ended.returncode == code
        assert "Traceback" not in ended.stderr
    assert out.read_bytes() == content
    assert {file.name for file in tmp_path.iterdir()} == {"run", "page.html"}


def test_vendored_libraries_are_those_named_and_carry_their_licences() -> None:
    vendor = PAGE / "vendor"
    pinned = json.loads((vendor / "package.json").read_text())["devDependencies"]
    libraries = (vendor / "libraries.min.js").read_text(encoding="utf-8")
    licences = (vendor / "LICENSES.txt").read_text(encoding="utf-8")
    assert f"Chart.js v{pinned['chart.js']}" in libraries
    assert f"chartjs-plugin-zoom v{pinned['chartjs-plugin-zoom']}" in libraries
    assert f'"{pinned["three"].split(".")[1]}"' in libraries
    for name in ("three", "chart.js", "chartjs-plugin-zoom", "hammerjs"):
        assert f"== {name}\n" in licences
    # Either would end the script or the comment they stand in.
    assert "</script" not in libraries.lower()
    assert "<!--" not in libraries
    assert "-->" not in licences
