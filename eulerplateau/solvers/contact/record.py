"""What is said of the contacts of an equilibrium."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from eulerplateau.film import FilmOfLoop
from eulerplateau.loop import NO_GAPS, Contacts, Gaps, LoopEnergy, Strands
from eulerplateau.solvers.contact.keeping import Keeping, Touching
from eulerplateau.solvers.second_variation import TangentModel, stability


def contacts_of(
    strands: Strands, film: FilmOfLoop, energy: LoopEnergy, state: Touching
) -> Contacts:
    """Return the contacts of a loop at rest, of which `energy` knows nothing.

    Those whose force cannot be told from none are let go for the index without them.
    """
    x, gaps = state.model.x, state.gaps
    curve, between = strands.curve(x), strands.between(x, gaps)
    places = np.stack([curve(gaps.s), curve(gaps.t)])
    _, widths = strands.at(x, gaps)
    pushes = -state.forces @ between.jacobian()
    found = Contacts(
        s=gaps.s,
        t=gaps.t,
        points=np.stack([film.lift(each) for each in places]),
        forces=state.forces,
        gaps=widths,
        angles=between.angles(),
        at_a_point=gaps.slides & ~strands.laid_along(x, gaps),
        slides=gaps.slides,
        uncertain=state.uncertain,
        pushes=film.lift(pushes.reshape(x.shape)),
        smallest_gap=strands.smallest_gap(x, 0.5 * strands.diameter),
        risen=state.risen,
    )
    if not found.doubtful.any():
        return found
    fewer = Keeping(energy, strands).without(state, found.doubtful)
    return replace(found, unstable_let_go=stability(fewer.model).n_unstable)


def contacts_at(
    strands: Strands, film: FilmOfLoop, energy: LoopEnergy, model: TangentModel, gaps: Gaps
) -> Contacts:
    """Return the contacts of an equilibrium, stable or not, at which a model is made."""
    state = Touching(model, gaps, NO_GAPS, radius=0.0, iteration=0)
    return contacts_of(strands, film, energy, state)
