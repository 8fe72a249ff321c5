"""Films kept in their plane, by the Fourier series of a lobe's tangent angle.

    relaxation.py     `relax_in_plane`: downhill from a start, without contact
    kernels.py        its Newton steps, start_kernels.py: how a start is read; compiled

Beyond the load of contact the strands would cross: planar/ has those films.
"""
