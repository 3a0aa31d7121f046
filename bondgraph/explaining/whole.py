"""The equations collected, those of further states too; and with laws and sources put in."""

from collections.abc import Iterable, Iterator

from bondgraph.equations import StateEquations
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.show.display import rows_of_terms
from bondgraph.show.statements import Statement, statements
from bondgraph.show.whole import PUT_IN, put_in, together


def whole_steps(result: StateEquations) -> Iterator[Step]:
    """What a derivation ends with."""
    found = statements(result)
    rows = [equation(*row) for row in rows_of_terms(result)]
    n = len(result.states)
    collected = (*rows[:n], *_stated(found.rates), *rows[n:])
    yield Step("result", "Collected", (), collected)
    sentences = tuple(map(together, found.loops))
    yield Step("whole", PUT_IN.capitalize(), sentences, tuple(_stated(put_in(result, found))))


def _stated(those: Iterable[Statement]) -> Iterator[Equation]:
    return (equation(one.left_terms, one.right, node=one.node) for one in those)
