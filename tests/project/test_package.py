"""What is installed: the types, the page's files, the example runs and meshes."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = Path("eulerplateau", "examples")


def committed(*folders: str) -> list[Path]:
    """Return the committed files of these folders, or all, relative to the repository."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--", *folders],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return [Path(name) for name in listed.stdout.split("\0") if name]


@pytest.mark.parametrize("name", ["runs", "meshes"])
def test_patterns_of_the_examples_are_those_of_the_committed_files(name: str) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    patterns = project["tool"]["setuptools"]["package-data"][
        f"eulerplateau.examples.{name}"
    ]
    for path in committed(name):
        assert path.parent == Path(name)
        assert any(path.match(pattern) for pattern in patterns), path


@pytest.mark.parametrize("name", ["runs", "meshes"])
def test_examples_are_links_to_the_folders_of_the_repository(name: str) -> None:
    assert (ROOT / EXAMPLES / name).resolve() == ROOT / name


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the wheel of a clone as it is now, without network."""
    clone = tmp_path_factory.mktemp("clone")
    for path in committed():
        if (ROOT / path).exists():  # and not just deleted
            (clone / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / path, clone / path, follow_symlinks=False)
    # What one who has run the examples has beside them.
    run_folder = clone / "runs" / "elongated"
    run_folder.mkdir()
    (run_folder / "other.toml").write_text("")
    build = ["wheel", "--no-build-isolation", "--no-deps", "--no-index", "."]
    subprocess.run([sys.executable, "-m", "pip", *build], cwd=clone, check=True)
    (made,) = clone.glob("eulerplateau-*.whl")
    return made


@pytest.mark.slow
def test_wheel_holds_the_package_and_the_committed_examples(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as file:
        packed = {Path(name): file.read(name) for name in file.namelist()}
    code = {p for p in committed("eulerplateau") if p.suffix in {".py", ".pyi", ".typed"}}
    assert code <= packed.keys()
    files = committed("runs", "meshes")
    examples = {EXAMPLES / path: (ROOT / path).read_bytes() for path in files}
    inside = {path: packed[path] for path in packed if EXAMPLES in path.parents}
    assert inside == examples
    page = Path("eulerplateau", "pictures", "gallery")
    assert {page / "page.html", page / "vendor" / "libraries.min.js"} <= packed.keys()


@pytest.mark.slow
def test_the_wheel_by_itself_writes_the_examples(wheel: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(wheel) as file:
        file.extractall(tmp_path / "installed")
    program = "import sys; sys.path.insert(0, 'installed'); import eulerplateau.cli; "
    program += "assert 'installed' in eulerplateau.__file__; eulerplateau.cli.main()"
    command = [sys.executable, "-P", "-c", program, "examples", "."]
    subprocess.run(command, cwd=tmp_path, check=True)
    for path in committed("runs", "meshes"):
        assert (tmp_path / path).read_bytes() == (ROOT / path).read_bytes()
