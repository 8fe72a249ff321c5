"""Runs: what a specification says, and the sweep that carries it out."""
