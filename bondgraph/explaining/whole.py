"""The equations collected, those of further states too; and with laws and sources put in."""

from collections.abc import Iterable, Iterator

from bondgraph.equations import StateEquations
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.show.display import rows_of_terms
from bondgraph.show.powers import powers, without_functions
from bondgraph.show.statements import Statement, statements
from bondgraph.show.whole import PUT_IN, put_in, together


def whole_steps(result: StateEquations) -> Iterator[Step]:
    """What a derivation ends with."""
    shown = without_functions(result)
    found, matrices = statements(shown), powers(result)
    rows = [equation(*row) for row in rows_of_terms(matrices)]
    n = len(matrices.states)
    collected = (*rows[:n], *_stated(found.rates), *rows[n:])
    yield Step("result", "Collected", _ruled(found.rates), collected)
    put = put_in(shown, found)
    sentences = (*map(together, found.loops), *_ruled(put, whole=False))
    yield Step("whole", PUT_IN.capitalize(), sentences, tuple(_stated(put)))


def _stated(those: Iterable[Statement]) -> Iterator[Equation]:
    return (
        equation(one.left_terms, one.right, node=one.node) for one in those if one.ruled is None
    )


def _ruled(those: Iterable[Statement], whole: bool = True) -> tuple[str, ...]:
    """What has several ways, as sentences."""
    return tuple(f"{one.left} = {one.ruled.text(whole)}" for one in those if one.ruled is not None)
