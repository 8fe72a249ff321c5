"""How often the intervals of fitted cells hold the truth: coverage over synthetic sets.

Areas of round cells at ten stiffnesses over three decades, with Gaussian noise of 5 % of
the area on a rigid substrate; sigma and alpha / R_0^3 are the paper's.
"""
