"""The paper's interpolation of a round cell's radius against the cubic it stands for.

In units of R_0 and alpha / R_0^3: over k_s and sigma, and its orders at both ends.
"""
