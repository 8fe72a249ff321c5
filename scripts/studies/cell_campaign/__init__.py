"""Random cells from random starts: each ends as a minimum or says why not.

cases.py   a random cell, and what it comes to
"""
