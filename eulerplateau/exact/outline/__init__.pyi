from .fit import (
    OutlineFit as OutlineFit,
    fit_outline as fit_outline,
    fit_racket as fit_racket,
)
