"""How often intervals of films fitted to synthetic outlines hold the truth."""
