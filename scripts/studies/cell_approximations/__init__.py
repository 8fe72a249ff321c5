"""The paper's formulas for regular cells against exact ones.

widths.py   widths over all directions, and what traction is exactly
"""
