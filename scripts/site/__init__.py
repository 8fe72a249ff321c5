"""What makes a site of the documentation's pages; `scripts/docs` and `mkdocs.yml` use it.

`formulas.py` turns formulas into MathML. `theme` is laid over the theme's files: a style,
the font of formulas (STIX Two Math 2.12), and `iframe-worker` 1.0.4, by which the search
works from disk and which the theme's plugin `offline` would have browsers fetch.
"""
