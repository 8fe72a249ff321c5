"""Equilibria of a loop with a thickness, whose strands touch: constrained minima.

    search.py   from a start to a minimum, of every film
    descent.py  downhill on loops whose strands touch here and there, and overlap nowhere
    keeping.py  which gaps are closed, at points or along each other
    separation.py  how strands that overlap are parted before
    contacts.py  what is said of contacts in the end

Nothing of it is loaded for loops without a diameter.
"""
