"""Text, numbers and sympy expressions become exact sympy expressions; nothing is ever evaluated as Python."""

import math
from collections.abc import Callable, Iterable, Iterator
from numbers import Real

import sympy as sp

from bondgraph.algebra.atoms import MAX_DIGITS, MAX_EXPONENT, decimal, number, symbol
from bondgraph.algebra.called import Called
from bondgraph.algebra.functions import ALLOWED, FUNCTIONS, PARTS
from bondgraph.algebra.lookups import Handle, Look
from bondgraph.algebra.reading import Functions, read
from bondgraph.algebra.residues import residues
from bondgraph.algebra.whole import whole
from bondgraph.errors import ExpressionError, TableError, shortened
from bondgraph.tables.record import Sampled

TIME = sp.Symbol("t")
"""The time, in laws and known sources."""

MAX_TERMS = 10_000

_PARTS = (*PARTS, Handle, Look)

_NOT_REAL = (sp.nan, sp.zoo, sp.oo, -sp.oo, sp.I)


def expression(value: object, where: str, tables: Iterable[Sampled] = ()) -> sp.Expr:
    """The exact expression that a number, a text or a sympy expression stands for.

    Text may hold numbers, names, ``pi``, ``+ - * / **``, parentheses, the functions in `FUNCTIONS`, and
    ``Piecewise((value, condition), ..., (value, True))`` with comparisons, ``and``, ``or``, ``not``; other
    names become plain symbols. It may call ``tables``, too: `LookupTable` objects. A float counts as the
    rational of its shortest decimal form.

    Raises `ExpressionError`, naming ``where``, for anything else: text that calls or imports,
    numbers that are not finite and real, names that cannot be symbols.

    >>> expression("h1/(h1 - 1)", "node 'gear'"), expression(0.1, "node 'gear'")
    (h1/(h1 - 1), 1/10)
    """
    if isinstance(value, str):
        result = read(value, where, callable_in_text(tables, where))
    elif isinstance(value, sp.Expr):
        floats = value.atoms(sp.Float)
        result = whole(
            value.xreplace({part: decimal(part, where) for part in floats}) if floats else value
        )
    elif isinstance(value, Real | sp.Number) and not isinstance(value, bool):
        result = number(value, where)
    else:
        raise ExpressionError(f"{where}: {value!r} is neither a number, a text nor an expression")
    try:
        _check_value(result, value, where)
        _check_parts(result, where)
    except (OverflowError, RecursionError) as error:
        raise ExpressionError(
            f"{where}: {shortened(str(value))} is out of bounds: {error}"
        ) from None
    return result


def callable_in_text(tables: Iterable[Sampled], where: str) -> Functions:
    """The functions of all text, and these tables; `TableError` for two of one name.

    Of tables that are equal one is enough.
    """
    found: dict[str, Sampled] = {}
    for table in tables:
        if not isinstance(table, Sampled):
            raise TableError(f"{where}: {shortened(repr(table))} in tables is no LookupTable")
        if found.setdefault(table.name, table).digest != table.digest:
            raise TableError(f"{where}: there are two tables {table.name!r}; rename one")
    if not found:
        return FUNCTIONS
    return {**FUNCTIONS, **{name: _looking(table) for name, table in found.items()}}


def _looking(table: Sampled) -> tuple[int, int, Callable[..., sp.Expr]]:
    count = len(table.axes)
    handle = Handle(table, (0,) * count)
    return count, count, lambda *places: Look(handle, *places)


def _check_value(expr: sp.Expr, value: object, where: str) -> None:
    if expr.is_real is False or (not isinstance(expr, sp.Symbol) and expr.has(*_NOT_REAL)):
        raise ExpressionError(f"{where}: {value!r} is not a finite real expression")


def expanded_terms(expr: sp.Expr) -> int:
    """An upper bound on the number of terms that multiplying an expression out would give."""
    if expr.is_Add:
        return sum(map(expanded_terms, expr.args))
    if expr.is_Mul:
        return math.prod(map(expanded_terms, expr.args))
    if expr.is_Pow and expr.exp.is_Integer:
        terms, power = expanded_terms(expr.base), abs(int(expr.exp))
        return math.comb(terms + power - 1, power) if terms > 1 else 1
    return 1


def _check_parts(expr: sp.Expr, where: str) -> None:
    """Refuse what no backend could print, no stage could decide, or no patience could expand."""
    if isinstance(expr, sp.Symbol) and expr.is_commutative:
        symbol(expr.name, where)
        return
    for part in _declared_parts(expr):
        if not isinstance(part, _PARTS) or part.is_commutative is False:
            raise ExpressionError(f"{where}: {shortened(str(part))} is not allowed; {ALLOWED}")
        if isinstance(part, sp.Symbol):
            symbol(part.name, where)
        elif isinstance(part, sp.Expr) and not _may_be_real(part):
            raise ExpressionError(f"{where}: {shortened(str(part))} is not a real number")
        if part.is_Pow and part.exp.is_Rational and abs(part.exp) > MAX_EXPONENT:
            raise ExpressionError(f"{where}: an exponent of more than {MAX_EXPONENT}")
        if part.is_Rational and max(abs(part.p), part.q).bit_length() > 4 * MAX_DIGITS:
            raise ExpressionError(f"{where}: a number of more than {MAX_DIGITS} digits")
    if expanded_terms(expr) > MAX_TERMS:
        raise ExpressionError(f"{where}: multiplied out it would have over {MAX_TERMS} terms")
    try:
        residues()(expr)
    except ZeroDivisionError:
        raise ExpressionError(
            f"{where}: a denominator of {shortened(str(expr))} vanishes"
        ) from None


def _declared_parts(expr: sp.Expr) -> Iterator[sp.Basic]:
    """All parts but laws that were turned round: what these are made of was checked as it was declared."""
    walk = sp.preorder_traversal(expr)
    for part in walk:
        if isinstance(part, Called) and not isinstance(part, Look):
            walk.skip()
        else:
            yield part


def _may_be_real(part: sp.Expr) -> bool:
    """False for a constant that is complex or has no value, such as a root of -1 inside a cosine."""
    if part.is_number is False or part.is_real:
        return True
    value = part.evalf() if part.is_real is None else sp.I
    if not value.is_number or value.has(*_NOT_REAL[:4]):
        return False
    real, imaginary = value.as_real_imag()
    return bool(abs(imaginary) <= 1e-9 * abs(real))
