"""The matrices of what carries power: without rows and columns of what nodes of signals are made of."""

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from bondgraph.equations import StateEquations


def powers(model: StateEquations) -> StateEquations:
    """The equations for their matrices alone, without signals as outputs, states and inputs.

    >>> import bondgraph as bg
    >>> powers(bg.derive(bg.graph([bg.RateLimiter("r", "ref", 2), bg.Function("u", "2*r")]))).states
    ()
    """
    return without_idle(without_functions(model))


def without_functions(model: StateEquations) -> StateEquations:
    """The equations without outputs that are nodes of signals: these are stated as what they are."""
    told = {one.effort for one in model.elements.values() if one.is_effort_told}
    own = {*model.inputs, *told}
    kept = [at for at, name in enumerate(model.outputs) if name not in own]
    if len(kept) == len(model.outputs):
        return model
    rows = {letter: _part(model, letter, rows=kept) for letter in "FDG"}
    return replace(model, outputs=tuple(model.outputs[at] for at in kept), **rows)


def without_idle(model: StateEquations) -> StateEquations:
    """The equations for their matrices alone: without signals' states, and inputs that move no state."""
    model = _without_apart(model)
    own = {p.given for p in model.ports if p.element.of_signals}
    used = {j for letter in "BEDG" for _, j in getattr(model, letter).todok()}
    kept = [j for j, name in enumerate(model.inputs) if j in used or name not in own]
    if len(kept) == len(model.inputs):
        return model
    columns = {letter: _part(model, letter, columns=kept) for letter in "BEDG"}
    return replace(model, inputs=tuple(model.inputs[j] for j in kept), **columns)


def _without_apart(model: StateEquations) -> StateEquations:
    """Without states of nodes of signals, whose rows share nothing with others."""
    reduction = model.reduction
    places = [reduction.structure.ports[port].element.of_signals for port in reduction.states]
    shared = {at for letter in "AJ" for pair in getattr(model, letter).todok() if pair[0] != pair[1]
              for at in pair}  # fmt: skip
    shared |= {j for _, j in model.F.todok()}
    kept = [at for at, own in enumerate(places) if not own or at in shared]
    if len(kept) == len(places):
        return model
    parts = {letter: _part(model, letter, kept, kept) for letter in "AJ"}
    parts |= {letter: _part(model, letter, rows=kept) for letter in "BE"}
    parts["F"] = _part(model, "F", columns=kept)
    return replace(model, states=tuple(model.states[at] for at in kept), **parts)


def _part(
    model: StateEquations, letter: str, rows: Sequence[int] | None = None,
    columns: Sequence[int] | None = None,
) -> sp.ImmutableSparseMatrix:  # fmt: skip
    whole = getattr(model, letter)
    every = [list(range(size)) if kept is None else list(kept)
             for size, kept in zip(whole.shape, (rows, columns), strict=True)]  # fmt: skip
    return sp.ImmutableSparseMatrix(whole.extract(*every))
