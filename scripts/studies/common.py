"""Where the repository is, for studies that read its files or write to its docs."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parents[2]
