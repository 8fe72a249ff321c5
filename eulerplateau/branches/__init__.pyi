from .exploration import Limits as Limits, Visit as Visit, explore as explore
from .point import (
    BranchPoint as BranchPoint,
    Settings as Settings,
    first_point as first_point,
)
from .scaling import PowerLaw as PowerLaw, fit_power as fit_power
from .special import BIFURCATION as BIFURCATION, FOLD as FOLD, SpecialPoint as SpecialPoint
