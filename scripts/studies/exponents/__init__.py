"""Exponents of <|kappa_n|> and <K> at the onset of the two stored films.

The onset is fitted with the law, or is where the planar film's eigenvalue crosses zero
(eulerplateau/branches). Loads: 21 distances from 1e-4 to 1e-2 of the onset, swept
downwards.
"""
