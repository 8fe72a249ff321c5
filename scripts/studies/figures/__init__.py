"""Make the figures of Giomi, Softly constrained films, that this program can compute.

Each is computed anew, from a run specification in runs/ or in closed form, and drawn to a
file. The table holds what the paper says in numbers, what is found here, the difference.
"""
