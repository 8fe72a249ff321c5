"""The example runs and their meshes, which come with the package."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from eulerplateau.errors import OutputError
from eulerplateau.mesh import write_whole

# In a clone these are links to folders that also hold what is made from the examples.
_SUFFIXES = {"runs": (".toml",), "meshes": (".toml", ".vtp")}


def write_examples(folder: Path) -> list[Path]:
    """Write the examples to the folders `runs` and `meshes` in `folder`; return the files.

    Files that are there already are left alone. Raises OutputError, before anything is
    written, if one of them differs from the example, and if a file cannot be written.
    """
    examples = {folder / name: content for name, content in _examples().items()}
    for path, content in examples.items():
        if _differs(path, content):
            problem = "is there already and differs from the example; choose another folder"
            raise OutputError(path, problem)
    for path, content in examples.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(path.parent, f"cannot be made: {error.strerror}") from None
        if not path.exists():
            write_whole(path, content)
    return list(examples)


def _examples() -> dict[str, bytes]:
    """Return the content of each example by its path in the folder it is written to."""
    stored = files("eulerplateau") / "examples"
    return {
        f"{part}/{file.name}": file.read_bytes()
        for part, suffixes in _SUFFIXES.items()
        for file in sorted((stored / part).iterdir(), key=lambda file: file.name)
        if file.name.endswith(suffixes)
    }


def _differs(path: Path, content: bytes) -> bool:
    try:
        return path.read_bytes() != content
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
