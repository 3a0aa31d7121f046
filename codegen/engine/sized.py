"""The sizes that a model asks the C engine for."""

from codegen.engine.sizes import Sizes
from codegen.modes.closed import ClosedModel

SLOTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
"""Sizes of generators that engines are compiled for."""


def sizes(model: ClosedModel, slots: int) -> Sizes:
    """The sizes of an engine for a model whose inputs' generators have so many slots."""
    program = model.program
    return Sizes(
        N=model.size,
        X=max(len(program.states), 1),
        U=max(len(program.inputs), 1),
        W=max(len(program.external), 1),
        K=len(program.friction),
        G=next((size for size in SLOTS if size >= slots), slots),
        R=len(program.resets),
        C=len(program.clocks),
    )
