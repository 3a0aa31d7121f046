r"""Sums of factors times signals, written as a person would: as text for a terminal, and as LaTeX."""

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any

import sympy as sp

from bondgraph.show.plain import plain, typed

Term = tuple[sp.Expr, sp.Expr]
"""A factor and the signal it stands at; the signal is 1 where there is none."""

Sum = tuple[Term, ...]


def rate(name: sp.Symbol) -> sp.Symbol:
    """The symbol of a signal's rate: ``omega'``, which no signal can be called.

    >>> rate(sp.Symbol("omega"))
    omega'
    """
    return sp.Symbol(f"{name.name}'")


def total(terms: Sum) -> sp.Expr:
    """The sum as one expression."""
    return sp.Add(*(factor * signal for factor, signal in terms))


def over_common(terms: Iterable[Term]) -> sp.Expr:
    """The sum of products, those whose factors have the same denominator over it once.

    >>> a, b, x, y = sp.symbols("a b x y")
    >>> over_common([(a/(a + b), x), (-b/(a + b), y), (b, x)])
    b*x + (a*x - b*y)/(a + b)
    """
    found: dict[sp.Expr, list[sp.Expr]] = {}
    for factor, name in terms:
        over, under = sp.fraction(factor)
        found.setdefault(under, []).append(over * name)
    return sp.Add(*(sp.Add(*over) / under for under, over in found.items()))


def split(expr: sp.Expr, signals: Collection[sp.Symbol]) -> Sum:
    """An expression as factors times signals, as far as it is a sum of such; positive terms first.

    >>> R, i, u = sp.symbols("R i u")
    >>> split(u - R*i, {i, u})
    ((1, u), (-R, i))
    """
    terms: list[Term] = []
    for term in sp.Add(expr).as_ordered_terms():
        used = sorted(term.free_symbols & set(signals), key=str)
        terms.append(term.as_independent(*used, as_Add=False) if used else (term, sp.Integer(1)))
    return positive_first(terms)


def signed_terms(expr: sp.Expr) -> Sum:
    """A sum's terms behind signs, positive ones first.

    >>> x, y = sp.symbols("x y")
    >>> signed_terms(3*y - x**2)
    ((1, 3*y), (-1, x**2))
    """
    terms = expr.as_ordered_terms() if expr != 0 else []
    signs = [_sign_and_size(term) for term in terms]
    return positive_first((sp.Integer(-1 if negative else 1), size) for negative, size in signs)


def positive_first(terms: Iterable[Term]) -> Sum:
    """The same sum, terms with a minus sign last."""
    return tuple(sorted(terms, key=lambda term: _sign_and_size(term[0])[0]))


def typeset(expr: Any) -> str:
    r"""An expression or a matrix as LaTeX; names that are Greek letters become these, rates have a dot.

    Names of several letters stand upright, as words do.

    >>> print(typeset(rate(sp.Symbol("omega_1"))), typeset(sp.Symbol("e_left_J")))
    \dot{\omega}_{1} e_{left,J}
    >>> print(typeset(sp.Symbol("ref") - sp.Symbol("rate_z")))
    \mathrm{ref} - \mathrm{rate}_{z}
    """
    names = {name: _typeset_name(name.name) for name in expr.free_symbols}
    return typed(expr, names)


def _typeset_name(name: str) -> str:
    base, line, index = sp.latex(sp.Symbol(name.rstrip("'"))).partition("_")
    if len(base) > 1 and base.isalnum():
        base = rf"\mathrm{{{base}}}"
    head = rf"\dot{{{base}}}" if name.endswith("'") else base
    return f"{head}{line}{index.replace(' ', ',')}"


def text_pieces(terms: Iterable[Term]) -> list[str]:
    """Each term with its sign, to be joined by spaces.

    >>> i, a, b = sp.symbols("i a b")
    >>> text_pieces([(i/2, a), (-1/i, b), (1 - i, a), (a*i, a)])
    ['i/2*a', '- b/i', '+ (1 - i)*a', '+ a^2*i']
    """
    return _signed(terms, _text_product)


def latex_pieces(terms: Iterable[Term]) -> list[str]:
    r"""Each term with its sign, in LaTeX.

    >>> i, a = sp.symbols("i tau_1")
    >>> print(*latex_pieces([(i/2, a), (-i, a)]))
    \frac{i}{2} \tau_{1} - i \tau_{1}
    """
    return _signed(terms, _latex_product)


def _signed(terms: Iterable[Term], product: Callable[[sp.Expr, sp.Expr], str]) -> list[str]:
    pieces: list[str] = []
    for factor, signal in terms:
        negative, size = _sign_and_size(factor)
        lead = ("-" if negative else "") if not pieces else ("- " if negative else "+ ")
        pieces.append(lead + product(size, signal))
    return pieces or ["0"]


def _sign_and_size(factor: sp.Expr) -> tuple[bool, sp.Expr]:
    """Whether a minus sign can stand before the whole factor, and what then stands behind it."""
    if factor.is_Mul:
        parts = [_sign_and_size(part) for part in factor.args]
        return sum(negative for negative, _ in parts) % 2 == 1, sp.Mul(*(size for _, size in parts))
    negative = all(part.could_extract_minus_sign() for part in sp.Add.make_args(factor))
    return negative, -factor if negative else factor


def _one_power(factor: sp.Expr, signal: sp.Expr) -> Term:
    """A factor that has the signal as a factor itself, multiplied with it."""
    twice = signal.is_Symbol and any(
        part.as_base_exp()[0] == signal for part in sp.Mul.make_args(factor)
    )
    return (factor * signal, sp.Integer(1)) if twice else (factor, signal)


def _text_product(factor: sp.Expr, signal: sp.Expr) -> str:
    factor, signal = _one_power(factor, signal)
    if signal == 1:
        return _bracketed(factor, plain(factor), "()")
    own = _bracketed(signal, plain(signal), "()")
    over, under = sp.fraction(factor)
    if over != 1:
        return f"{_bracketed(factor, plain(factor), '()')}*{own}"
    if under == 1:
        return own
    return f"{own}/{f'({plain(under)})' if under.is_Add or under.is_Mul else plain(under)}"


def _latex_product(factor: sp.Expr, signal: sp.Expr) -> str:
    brackets = (r"\left(", r"\right)")
    factor, signal = _one_power(factor, signal)
    if signal == 1:
        return _bracketed(factor, typeset(factor), brackets)
    own = _bracketed(signal, typeset(signal), brackets)
    over, under = sp.fraction(factor)
    if over != 1:
        return f"{_bracketed(factor, typeset(factor), brackets)} {own}"
    return own if under == 1 else rf"\frac{{{typeset(signal)}}}{{{typeset(under)}}}"


def _bracketed(expr: sp.Expr, text: str, brackets: Sequence[str]) -> str:
    return f"{brackets[0]}{text}{brackets[1]}" if expr.is_Add else text
