from .collection import (
    Exhibit as Exhibit,
    Gallery as Gallery,
    Mesh as Mesh,
    collect as collect,
)
from .document import page as page
