"""Where regular cells change: by exact cells, and by polygons as a second way.

located.py   inflections, folds and lost symmetry of exact cells
polygons.py  the same of cells whose edge is a polygon, extrapolated
"""
