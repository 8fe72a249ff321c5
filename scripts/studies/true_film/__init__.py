"""The true film's branches: where they lose stability, what follows, what pinches.

Everything is computed anew from eulerplateau.exact.conformal (docs/true-film.md). Numbers
go to true_film.json, the films to true_film.csv, pictures to pictures/true-film/.
"""
