"""What a sweep and an exploration take besides solving, and a large film in all."""
