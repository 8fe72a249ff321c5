"""A bad specification names its key and ends with exit code 2."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, Literal

import pytest
from pydantic import Field, ValidationError, field_validator, model_validator

from eulerplateau.errors import OutputError, SpecError
from eulerplateau.settings import Settings, load_toml, validate


class Colour(Enum):
    RED = "red"


class Square(Settings):
    kind: Literal["square"]
    side: float = Field(gt=0)


class Points(Settings):
    kind: Literal["points"]
    points: tuple[tuple[float, float], ...]


class Range(Settings):
    start: float
    stop: float

    @model_validator(mode="after")
    def _rises(self) -> Range:
        if self.stop <= self.start:
            raise ValueError("stop should be above start")
        return self


class Example(Settings):
    shape: Annotated[Square | Points, Field(discriminator="kind")]
    count: int = 1
    colour: Colour = Colour.RED
    file: Path | None = None
    loads: float | tuple[float, ...] = 1.0
    ranges: tuple[Range, ...] = ()

    @field_validator("count")
    @classmethod
    def _odd(cls, count: int) -> int:
        if count % 2 == 0:
            raise ValueError("should be odd")
        return count


SQUARE = 'shape = { kind = "square", side = 2 }\n'


def load(tmp_path, text):
    path = tmp_path / "example.toml"
    path.write_text(text, encoding="utf-8")
    return load_toml(path, Example)


def test_what_toml_can_say_is_accepted(tmp_path):
    text = SQUARE + 'colour = "red"\nfile = "a/b"\nloads = [1, 2.5]\n'
    example = load(tmp_path, text + "ranges = [{ start = 0, stop = 1 }]")
    assert isinstance(example.shape, Square)
    assert example.shape.side == 2.0
    assert example.colour is Colour.RED
    assert example.file == Path("a/b")
    assert example.loads == (1.0, 2.5)
    assert example.ranges[0].stop == 1.0


BAD_SPECS = {
    "misspelt": ("shape = { kind = 'square', sid = 2 }", "shape.sid"),
    "unknown": (SQUARE + "colr = 'red'", "colr"),
    "missing": ("count = 1", "shape"),
    "missing_inside": ("shape = { kind = 'square' }", "shape.side"),
    "no_kind": ("shape = { side = 1 }", "shape.kind"),
    "unknown_kind": ("shape = { kind = 'cube' }", "shape.kind"),
    "table_for_a_number": (SQUARE + "count = { a = 1 }", "count"),
    "number_for_a_table": ("shape = 3", "shape"),
    "string_for_a_number": ("shape = { kind = 'square', side = '2' }", "shape.side"),
    "float_for_an_integer": (SQUARE + "count = 3.0", "count"),
    "boolean_for_an_integer": (SQUARE + "count = true", "count"),
    "date": (SQUARE + "count = 2026-01-01", "count"),
    "out_of_range": ("shape = { kind = 'square', side = 0 }", "shape.side"),
    "nan": ("shape = { kind = 'square', side = nan }", "shape.side"),
    "infinity": ("shape = { kind = 'square', side = -inf }", "shape.side"),
    "overflow": (f"shape = {{ kind = 'square', side = 1{'0' * 400} }}", "shape.side"),
    "in_a_list": (
        "shape = { kind = 'points', points = [[0, 0], [1, 'x']] }",
        "shape.points[1][1]",
    ),
    "neither_of_two_types": (SQUARE + "loads = 'many'", "loads"),
    "in_a_union": (SQUARE + "loads = [1, nan]", "loads[1]"),
    "not_a_member": (SQUARE + "colour = 'green'", "colour"),
    "own_check": (SQUARE + "count = 2", "count"),
    "own_check_of_a_table": (SQUARE + "ranges = [{ start = 1, stop = 0 }]", "ranges[0]"),
}


@pytest.mark.parametrize("case", BAD_SPECS)
def test_a_bad_spec_names_its_key_on_one_line(tmp_path, case):
    text, key = BAD_SPECS[case]
    with pytest.raises(SpecError) as caught:
        load(tmp_path, text)
    assert caught.value.key == key
    assert caught.value.exit_code == 2
    assert len(str(caught.value).splitlines()) == 1
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize("content", [b"count = ", b"count = \xff\xfe", b"a = 1\na = 2"])
def test_what_is_not_toml_names_the_file(tmp_path, content):
    path = tmp_path / "broken.toml"
    path.write_bytes(content)
    with pytest.raises(SpecError) as caught:
        load_toml(path, Example)
    assert caught.value.key == str(path)


def test_a_missing_file_and_a_folder_name_the_path(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(SpecError) as caught:
            load_toml(path, Example)
        assert caught.value.key == str(path)


def test_a_file_that_cannot_be_opened_is_an_io_failure(tmp_path):
    (tmp_path / "file").write_text("")
    path = tmp_path / "file" / "below.toml"
    with pytest.raises(OutputError) as caught:
        load_toml(path, Example)
    assert caught.value.exit_code == 5


def test_a_check_of_the_whole_names_the_source():
    with pytest.raises(SpecError) as caught:
        validate({"start": 1, "stop": 1}, Range, "range.toml")
    assert caught.value.key == "range.toml"


def test_settings_are_frozen():
    bounds = validate({"start": 0, "stop": 1}, Range, "here")
    with pytest.raises(ValidationError):
        bounds.stop = 2.0
