"""Pictures: what a run looks like, as diagrams, prints, renders, and a page to browse."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
