"""The twisted eight of a loop with a diameter: where it opens, where contact splits.

And its films next to the matched formula for a narrow waist,

    E(d) - E_8 = (sigma/omega) d^2 log(C/d),

with C from the narrowest film.
"""
