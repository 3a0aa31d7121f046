r"""Sums of factors times signals, written as a person would: as text for a terminal, and as LaTeX."""

from collections.abc import Iterable, Sequence

import sympy as sp

Term = tuple[sp.Expr, sp.Expr]
"""A factor and the signal it stands at; the signal is 1 where there is none."""

Sum = tuple[Term, ...]


def rate(name: sp.Symbol) -> sp.Symbol:
    """The symbol of a signal's rate: ``omega'``, which no signal can be called.

    >>> rate(sp.Symbol("omega"))
    omega'
    """
    return sp.Symbol(f"{name.name}'")


def alone(expr: sp.Expr) -> Sum:
    """An expression as a sum of one term."""
    return ((sp.Integer(1), expr),)


def total(terms: Sum) -> sp.Expr:
    """The sum as one expression."""
    return sp.Add(*(factor * signal for factor, signal in terms))


def plain(expr: sp.Expr) -> str:
    """An expression as text, powers with ``^``.

    >>> plain(sp.Symbol("i")**2/4)
    'i^2/4'
    """
    return str(sp.sstr(expr)).replace("**", "^")


def typeset(expr: sp.Expr) -> str:
    r"""An expression as LaTeX; names that are Greek letters become these, rates have a dot.

    >>> print(typeset(rate(sp.Symbol("omega_1"))/2))
    \frac{\dot{\omega}_{1}}{2}
    """
    rates = {s: _dotted(s) for s in expr.free_symbols if s.name.endswith("'")}
    return str(sp.latex(expr, symbol_names=rates))


def _dotted(name: sp.Symbol) -> str:
    base, line, index = sp.latex(sp.Symbol(name.name[:-1])).partition("_")
    return rf"\dot{{{base}}}{line}{index}"


def text_pieces(terms: Iterable[Term]) -> list[str]:
    """Each term with its sign, to be joined by spaces.

    >>> i, a, b = sp.symbols("i a b")
    >>> text_pieces([(i/2, a), (-1/i, b), (1 - i, a)])
    ['i/2*a', '- b/i', '+ (1 - i)*a']
    """
    return _signed([(factor, _text_product(_magnitude(factor), s)) for factor, s in terms])


def latex_pieces(terms: Iterable[Term]) -> list[str]:
    r"""Each term with its sign, in LaTeX.

    >>> i, a = sp.symbols("i tau_1")
    >>> print(*latex_pieces([(i/2, a), (-i, a)]))
    \frac{i}{2} \tau_{1} - i \tau_{1}
    """
    return _signed([(factor, _latex_product(_magnitude(factor), s)) for factor, s in terms])


def _signed(products: Sequence[tuple[sp.Expr, str]]) -> list[str]:
    pieces = []
    for factor, product in products:
        negative = _is_negative(factor)
        lead = ("-" if negative else "") if not pieces else ("- " if negative else "+ ")
        pieces.append(lead + product)
    return pieces or ["0"]


def _is_negative(factor: sp.Expr) -> bool:
    """Whether a minus sign can stand before the whole factor: of a sum, if every term has one."""
    parts = factor.args if factor.is_Add else (factor,)
    return all(part.could_extract_minus_sign() for part in parts)


def _magnitude(factor: sp.Expr) -> sp.Expr:
    return -factor if _is_negative(factor) else factor


def _text_product(factor: sp.Expr, signal: sp.Expr) -> str:
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
    if signal == 1:
        return _bracketed(factor, typeset(factor), brackets)
    own = _bracketed(signal, typeset(signal), brackets)
    over, under = sp.fraction(factor)
    if over != 1:
        return f"{_bracketed(factor, typeset(factor), brackets)} {own}"
    return own if under == 1 else rf"\frac{{{typeset(signal)}}}{{{typeset(under)}}}"


def _bracketed(expr: sp.Expr, text: str, brackets: Sequence[str]) -> str:
    return f"{brackets[0]}{text}{brackets[1]}" if expr.is_Add else text
