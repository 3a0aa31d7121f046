"""Fields: storages and resistances with several ports, as one-ports that share a matrix or an energy."""

from collections.abc import Hashable, Mapping, Sequence

import sympy as sp

from bondgraph.algebra.atoms import normal, symbol
from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.expressions import expression
from bondgraph.algebra.residues import is_zero, residues
from bondgraph.errors import ExpressionError, StructureError

MOST_PORTS = 64


def port_names(value: object, where: str) -> tuple[str, ...]:
    """The names of a field's ports; `StructureError` for anything but a list of different identifiers."""
    if (
        isinstance(value, str)
        or not isinstance(value, Sequence)
        or not 1 <= len(value) <= MOST_PORTS
    ):
        raise StructureError(
            f"{where}: ports must be a list of 1 to {MOST_PORTS} names, not {value!r}"
        )
    names = tuple(str(normal(name)) for name in value)
    for name in names:
        try:
            symbol(name, f"{where}, port {name!r}")
        except ExpressionError as error:
            raise StructureError(str(error)) from None
    if len(set(names)) < len(names):
        raise StructureError(f"{where}: two ports have one name: {list(names)}")
    return names


def part(name: Hashable, port: str) -> str:
    """The name of a field's port as a node.

    >>> part("beam", "tip")
    'beam.tip'
    """
    return f"{name}.{port}"


def matrix(value: object, ports: Sequence[str], symmetric: bool, where: str) -> list[list[sp.Expr]]:
    """A field's matrix, checked: square, regular, and symmetric where energy demands it."""
    rows = value.tolist() if isinstance(value, sp.MatrixBase) else value
    size = len(ports)
    if isinstance(rows, str) or not isinstance(rows, Sequence) or len(rows) != size:
        raise StructureError(f"{where}: the value must be a matrix of {size} rows, one a port")
    found: list[list[sp.Expr]] = []
    for row in rows:
        if isinstance(row, str) or not isinstance(row, Sequence) or len(row) != size:
            raise StructureError(f"{where}: each row of the value must have {size} entries")
        found.append([expression(entry, where) for entry in row])
    for i in range(size):
        for j in range(i):
            if symmetric and not is_zero(found[i][j] - found[j][i]):
                raise StructureError(
                    f"{where}: the entries of ports {ports[i]!r} and {ports[j]!r} differ, {found[i][j]} and "
                    f"{found[j][i]}: only a symmetric matrix stores energy"
                )
    value = residues()
    rank = ResidueRows(
        {j: v for j, entry in enumerate(row) if (v := value(entry))} for row in found
    )
    if not all(rank.pivot(i, jordan=False) for i in range(size)):
        raise StructureError(
            f"{where}: the determinant of the value vanishes; a field needs full rank"
        )
    return found


def gradient(
    energy: object, states: Sequence[sp.Symbol], where: str
) -> tuple[sp.Expr, list[sp.Expr]]:
    """An energy function and its slopes along the states, which are the laws of the ports.

    >>> q = sp.Symbol("q")
    >>> gradient("k*q**2/2", [q], "node 'spring'")[1]
    [k*q]
    """
    function = expression(energy, f"{where}, energy")
    unused = [str(state) for state in states if state not in function.free_symbols]
    if unused:
        raise StructureError(f"{where}: the energy does not depend on {', '.join(unused)}")
    real = {name: sp.Dummy(name.name, real=True) for name in function.free_symbols}
    plain = {dummy: name for name, dummy in real.items()}
    inner = function.xreplace(real)
    return function, [sp.diff(inner, real[state]).xreplace(plain) for state in states]


def inverts(back: sp.Expr, given: sp.Symbol) -> bool:
    """Whether a law put into its inverse gives the variable back, at points near zero of either sign.

    Parameters are taken between 1 and 2. What has no real value at a point says nothing there, but it must
    have one at some.
    """
    names = sorted(back.free_symbols - {given}, key=str)
    told = 0
    for at in range(1, 9):
        point = {name: 1 + sp.Rational((7 * at + 3 * k) % 11, 11) for k, name in enumerate(names)}
        point[given] = sp.Rational((-1) ** at * at, 37)
        value = sp.N(back.subs(point) - point[given], 30)
        if not value.is_real or not value.is_finite:
            continue
        told += 1
        if abs(value) > 1e-20:
            return False
    return told > 0


def port_variable(given: object, port: str, default: str, where: str) -> sp.Symbol:
    """The symbol of a port's effort or flow: what a mapping of ports to names has, else the default."""
    if given is None:
        return sp.Symbol(default)
    if not isinstance(given, Mapping):
        raise StructureError(
            f"{where}: with ports, effort and flow map ports to names, not {given!r}"
        )
    return symbol(given[port], f"{where}, port {port!r}") if port in given else sp.Symbol(default)
