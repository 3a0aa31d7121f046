"""Blocks of a program as Python functions over numpy."""

from collections.abc import Callable, Sequence
from typing import Any

import sympy as sp

from codegen.program import Block


def compiled(code: Block) -> Callable[..., list[Any]]:
    """A function of the block's arguments, in their order, that returns its results as a list.

    The block's own temporaries are used, and arguments are renamed inside, so that a name like
    ``exp`` or ``array`` is as good as any other.
    """
    if not code.results:
        return lambda *arguments: []

    def shared(expressions: Sequence[sp.Expr]) -> tuple[list[Any], list[Any]]:
        return list(code.assignments), list(expressions)

    function: Callable[..., list[Any]] = sp.lambdify(
        list(code.arguments), list(code.results), modules="numpy", cse=shared, dummify=True
    )
    return function
