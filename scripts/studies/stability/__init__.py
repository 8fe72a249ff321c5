"""What becomes of stiff and extreme cases: docs/stability.md and docs/stability.csv."""
