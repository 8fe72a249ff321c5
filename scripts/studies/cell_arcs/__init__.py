"""Regular cells with line tension as their bending rigidity vanishes, against arcs."""
