"""Elastic loops spanned by soap films: the Euler-Plateau problem on triangulated disks."""

__version__ = "0.1.0"
