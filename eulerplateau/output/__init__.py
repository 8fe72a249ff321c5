"""What a run leaves on disk: the table of rows, the shapes, the run folder."""
