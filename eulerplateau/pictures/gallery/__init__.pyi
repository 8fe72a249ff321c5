from .collection import (
    Gallery as Gallery,
    Mesh as Mesh,
    Run as Run,
    Series as Series,
    collect as collect,
)
from .document import page as page
