"""A loop of fishing line, loaded and unloaded: where it jumps, where it opens again.

loads.py    the loads, by the line's diameter
cycle.py    the films of one diameter without a mesh, next to those of a run on one
racket.py   where strands touch that wind round each other
welded.py   runs of a line whose ends are welded
figures.py  the diagram
"""
