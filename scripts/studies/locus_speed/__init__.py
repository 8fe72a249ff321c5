"""How long a curve of special points takes, and a film without a mesh: docs/model.md."""
