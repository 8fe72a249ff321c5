from .alignment import (
    EYE as EYE,
    aligned as aligned,
    settled as settled,
    turn_onto as turn_onto,
)
from .child import draw_in_child as draw_in_child
from .film import (
    BACK as BACK,
    FRONT as FRONT,
    GLOSS as GLOSS,
    LOOP as LOOP,
    load_pyvista as load_pyvista,
    loop_stripe as loop_stripe,
    loop_tube as loop_tube,
    point_camera as point_camera,
)
from .picture import Picture as Picture, check_drawing as check_drawing
from .view import (
    ABOVE as ABOVE,
    LOOP_RADIUS as LOOP_RADIUS,
    UP as UP,
    View as View,
    common_view as common_view,
    is_flat as is_flat,
    mean_normal as mean_normal,
    own_views as own_views,
    turning_views as turning_views,
    view_from as view_from,
)
