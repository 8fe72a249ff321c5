from .animations import GIF as GIF, MP4 as MP4, check_format as check_format
from .choice import chosen_steps as chosen_steps
from .colours import SIDES as SIDES, SOAP as SOAP
from .drawing import (
    STILLS as STILLS,
    SWEEP as SWEEP,
    TURN as TURN,
    draw_shapes as draw_shapes,
    pictures_folder as pictures_folder,
)
from .fields import read_field as read_field
from .pictures import RunPictures as RunPictures
