"""A loop of fishing line, loaded and unloaded: where it jumps, where it opens again.

loads.py    the loads, by the line's diameter
cycle.py    the films of one diameter without a mesh, next to those of a run on one
figures.py  the diagram
"""
