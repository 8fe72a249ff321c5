"""Specifications as files: read, with keys replaced, and the files that they name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from eulerplateau.errors import SpecError
from eulerplateau.settings import Model, Settings, read_toml, validate

# Keys that name a file.
FILE_KEYS = "mesh.file", "start.file", "cell.points"


def read_spec(path: Path, overrides: dict[str, Any], model: type[Model]) -> Model:
    """Read a specification, with `overrides` {dotted key: value} on top.

    A relative file that it names is looked for beside it. Raises SpecError.
    """
    data = read_toml(path)
    for key, value in overrides.items():
        override(data, key, value)
    return validate(located(data, path.parent), model, str(path))


def located(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a specification, read as plain data, with its files looked for in a folder."""
    for key in FILE_KEYS:
        name, _, entry = key.partition(".")
        section = data.get(name)
        if isinstance(section, dict) and isinstance(section.get(entry), str):
            section[entry] = str(folder / at_home(key, section[entry]))
    return data


def at_home(key: str, file: str) -> Path:
    """Return the path of a file, `~` being the home directory.

    Raises SpecError if nobody has that home, or no file can have the name.
    """
    if "\0" in file:
        raise SpecError(key, f"found {file!r}; a file's name holds no NUL")
    try:
        return Path(file).expanduser()
    except RuntimeError:
        raise SpecError(key, f"found {file!r}; whose home directory is not known") from None


def described(spec: Settings) -> dict[str, Any]:
    """Return a specification as run.json has it: files are found from wherever one is."""
    data: dict[str, Any] = spec.model_dump(mode="json")
    return located(data, Path.cwd())


def override(data: dict[str, Any], key: str, value: Any) -> None:
    """Replace a dotted key of a specification read as plain data; raises SpecError."""
    *sections, name = key.split(".")
    if not sections:
        raise SpecError(key, "should name its section, as in solver.name or sweep.loads")
    for section in sections:
        data = data.setdefault(section, {})
        if not isinstance(data, dict):
            raise SpecError(key, f"{section} is not a section of the specification")
    data[name] = value


def leaves(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the dotted keys of nested tables; how they are written makes no difference."""
    for key, value in table.items():
        if isinstance(value, dict) and value:
            yield from leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
