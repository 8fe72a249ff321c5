"""Equilibria of a loop with a thickness, whose strands touch: constrained minima.

    search.py   from a start to a minimum, of every film, and what is said of its contacts
    descent.py  downhill on loops whose strands touch here and there, and overlap nowhere
    program.py  the step that tells which gaps are closed: a quadratic program
    steps.py    the steps that may be taken from a loop, by that program
    keeping.py  which gaps are closed, at points or along each other
    everywhere.py  strands kept apart between the places they are held at too
    merit.py    what does not rise meanwhile: an exact penalty function
    record.py   what is said of contacts
    separation.py  how strands that overlap are parted before

Nothing of it is loaded for loops without a diameter.
"""
