"""solvers/large_loops."""
