from .collection import (
    Exhibit as Exhibit,
    Gallery as Gallery,
    Mesh as Mesh,
    collect as collect,
)
from .document import page as page
from .parts import (
    base64_of as base64_of,
    cell_of as cell_of,
    film_colours as film_colours,
    part as part,
)
