"""How many equilibria there are (docs/catalogue.md)."""
