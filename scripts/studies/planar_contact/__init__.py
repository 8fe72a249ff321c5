"""Planar films that touch themselves: polygons against the exact films."""
