"""Random starts of loops with a diameter: where they end, checked by brute force."""
