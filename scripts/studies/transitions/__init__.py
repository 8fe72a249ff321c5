"""Locate the transitions of a film on many meshes, and what they depend on.

A sweep starts from the flat polygon with a seeded displacement, every load from the last
shape. Where two neighbouring loads have different states, bisection, always from the last
shape before the change, closes the bracket around the transition.
"""
