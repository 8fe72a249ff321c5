"""How fast a live film follows a slider, and whether it grows: docs/live.md."""
