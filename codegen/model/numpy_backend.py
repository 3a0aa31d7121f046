"""Blocks of a program as Python functions over numpy."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import sympy as sp

from codegen.numbers.lambdified import lambdified
from codegen.program.records import Block


@lru_cache(maxsize=256)
def compiled(code: Block) -> Callable[..., list[Any]]:
    """A function of the block's arguments, in their order, that returns its results as a list.

    The block's own temporaries are used. Arguments and temporaries are renamed inside, so that a name
    like ``exp`` or ``array`` is as good as any other. The last ones are kept: the blocks of a model are
    the same whatever its numbers.
    """
    if not code.results:
        return lambda *arguments: []
    arguments = [sp.Symbol(f"_a{at}") for at in range(len(code.arguments))]
    temporaries = [sp.Symbol(f"_c{at}") for at in range(len(code.assignments))]
    inside = dict(zip(code.arguments, arguments, strict=True))
    inside |= dict(zip((name for name, _ in code.assignments), temporaries, strict=True))
    values = [value.xreplace(inside) for _, value in code.assignments]
    results = [result.xreplace(inside) for result in code.results]

    def shared(expressions: Sequence[sp.Expr]) -> tuple[list[Any], list[Any]]:
        return list(zip(temporaries, values, strict=True)), list(expressions)

    function: Callable[..., list[Any]] = lambdified(arguments, results, cse=shared, beside=values)
    return function
