"""Linear blocks with a memory: each is a few `State` nodes, and a `Function` of them."""

from collections.abc import Hashable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp

from bondgraph.blocks.told import combination, known, ratio, told
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Node
from bondgraph.nodes.signals import Function, State


def Integrator(
    name: Hashable, input: object, start: object = None, low: object = None, high: object = None
) -> Node:
    """The integral of its input, a state, which begins at ``start``, 0 unless told.

    With ``low``, ``high`` or both it stays within these bounds and does not wind up: at one it rests
    for as long as its input leads beyond, and leaves as soon as that turns.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg
    >>> bg.Integrator("z", "K_i*(ref - omega)", high=5)
    ('z', {'kind': 'State', 'rate': 'K_i*(ref - omega)', 'high': 5})
    """
    return State(name, input, start, low, high)


def TransferFunction(name: Hashable, input: object, num: Any, den: Any) -> list[Node]:
    """A signal that is ``num(s)/den(s)`` times its input, at rest at first.

    ``num``, ``den``: coefficients from the highest power of s down, numbers, names or expressions; one
    number for a constant. The states are ``x_<name>_1`` to ``x_<name>_n``, in controllable canonical form:
    each is the rate of the one before. A leading coefficient by name must not be zero.

    Raises `StructureError`, naming the node, where it is improper, and for coefficients that are none.

    >>> import bondgraph as bg
    >>> for node in bg.TransferFunction("y", "u", ["b", 1], [1, 2, "c"]):
    ...     print(node[0], node[1].get("rate", node[1].get("value")))
    x_y_1 x_y_2
    x_y_2 u - c*x_y_1 - 2*x_y_2
    y x_y_1 + b*x_y_2
    """
    where = f"node {name!r}"
    top, bottom = _polynomial(num, f"{where}, num"), _polynomial(den, f"{where}, den")
    order = len(bottom) - 1
    if not bottom:
        raise StructureError(f"{where}: its den is zero; give coefficients")
    if len(top) > len(bottom):
        raise StructureError(
            f"{where}: its num has degree {len(top) - 1}, its den {order}: it is improper, as it would "
            "need rates of its input; add a fast pole to den, (tau*s + 1), or take the rates from the graph"
        )
    a = [ratio(where, one, bottom[0]) for one in bottom[:0:-1]]
    b = [ratio(where, one, bottom[0]) for one in reversed(top)]
    b += [0] * (order + 1 - len(b))
    states = [f"x_{name}_{at + 1}" for at in range(order)]
    nodes = [State(one, after) for one, after in pairwise(states)]
    if order:
        back = [(_minus(where, one), state) for one, state in zip(a, states, strict=True)]
        nodes.append(State(states[-1], combination(where, [(1, input), *back])))
    own = [(_beside(where, b[at], a[at], b[order]), states[at]) for at in range(order)]
    return [*nodes, Function(name, combination(where, [*own, (b[order], input)]))]


def StateSpace(
    name: Hashable, inputs: Any, A: Any, B: Any, C: Any, D: Any = None, start: Any = None
) -> list[Node]:
    """Signals ``y = C x + D u`` with ``x' = A x + B u``, u one input or a list of them.

    Matrices are rows of numbers, names and expressions, or arrays of numpy or sympy; D is zero unless
    given. The states are ``x_<name>_1`` and so on, ``start`` what each begins at, 0 unless told. One output
    is called ``<name>``, several ``<name>_1`` and so on.

    Raises `StructureError`, naming the node and the matrix, for shapes that do not fit.

    >>> import bondgraph as bg
    >>> for node in bg.StateSpace("y", "u", A=[[0, 1], ["-k", "-d"]], B=[[0], [1]], C=[[1, 0]]):
    ...     print(node[0], node[1].get("rate", node[1].get("value")))
    x_y_1 x_y_2
    x_y_2 -k*x_y_1 - d*x_y_2 + u
    y x_y_1
    """
    where = f"node {name!r}"
    given = list(inputs) if isinstance(inputs, list | tuple) else [inputs]
    n, m = len(_rows(A, where, "A")), len(given)
    a = _rows(A, where, "A", n, n)
    b, c = _rows(B, where, "B", n, m), _rows(C, where, "C", None, n)
    d = [[0] * m for _ in c] if D is None else _rows(D, where, "D", len(c), m)
    starts = [None] * n if start is None else list(start)
    if len(starts) != n:
        raise StructureError(f"{where}: start has {len(starts)} values for {n} states")
    states = [f"x_{name}_{at + 1}" for at in range(n)]
    names = [name] if len(c) == 1 else [f"{name}_{at + 1}" for at in range(len(c))]
    nodes = [
        State(one, combination(where, _terms(a[at], states, b[at], given)), starts[at])
        for at, one in enumerate(states)
    ]
    return nodes + [
        Function(one, combination(where, _terms(c[at], states, d[at], given)))
        for at, one in enumerate(names)
    ]


def _terms(
    own: Sequence[Any], states: Sequence[str], by: Sequence[Any], inputs: Sequence[Any]
) -> list[tuple[Any, Any]]:
    return [*zip(own, states, strict=True), *zip(by, inputs, strict=True)]


def _polynomial(given: Any, where: str) -> list[Any]:
    """Coefficients from the highest power down, without zeros before the first."""
    if isinstance(given, np.ndarray):
        given = given.tolist()
    found = list(given) if isinstance(given, list | tuple) else [given]
    for one in found:
        if isinstance(one, list | tuple):
            raise StructureError(f"{where} has rows; give one list of coefficients")
        told(where, "{coefficient}", coefficient=one)
    while found and known(found[0], where) == 0:
        del found[0]
    return found


def _minus(where: str, value: Any) -> Any:
    size = known(value, where)
    return told(where, "-{value}", value=value) if size is None else -size


def _beside(where: str, b: Any, a: Any, through: Any) -> Any:
    """A coefficient of the numerator less what goes straight through: ``b - a*through``."""
    above, below, past = (known(one, where) for one in (b, a, through))
    if past == 0 or below == 0:
        return b
    if above is not None and below is not None and past is not None:
        return above - below * past
    return told(where, "{b} - {a}*{through}", b=b, a=a, through=through)


def _rows(
    given: Any, where: str, letter: str, height: int | None = None, width: int | None = None
) -> list[list[Any]]:
    """A matrix as rows, of this shape."""
    if isinstance(given, np.ndarray | sp.MatrixBase):
        given = given.tolist()
    if not isinstance(given, list | tuple):
        given = [[given]]
    if not all(isinstance(row, list | tuple) for row in given):
        raise StructureError(f"{where}: {letter} is {given!r}; give a list of rows")
    rows = [list(row) for row in given]
    shape = (len(rows) if height is None else height, width)
    if width is not None and (len(rows) != shape[0] or any(len(row) != width for row in rows)):
        sizes = f"{len(rows)} rows of {sorted({len(row) for row in rows})}"
        raise StructureError(f"{where}: {letter} has {sizes}; it must be {shape[0]} by {width}")
    return rows
