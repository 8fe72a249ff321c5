"""solvers/in_plane."""
