"""Three adhesions under rising and falling contractility; stars at ever shorter edges.

sweeps.py   where minima end that are followed, and in what
stars.py    the energy of stars with protrusions, tips and the rest apart
"""
