"""Functions and roots as symbols, so that what is left of expressions are fractions of polynomials."""

import sympy as sp


class Generators:
    """Each function, and each power that is no whole one, named once; `back` puts them in again.

    Sums, products and whole powers are kept, and so are roots of numbers.

    >>> names, x = Generators(), sp.Symbol("x")
    >>> plain = names.plain(x*sp.sin(x)**2 + sp.sqrt(x))
    >>> plain.is_polynomial(), names.back(plain)
    (True, sqrt(x) + x*sin(x)**2)
    """

    def __init__(self) -> None:
        self.named: dict[sp.Expr, sp.Dummy] = {}
        self._known: dict[sp.Expr, sp.Expr] = {}

    def plain(self, expr: sp.Expr) -> sp.Expr:
        """The expression over symbols; those that are not its own stand for functions and roots."""
        if expr.is_Symbol or (expr.is_number and not expr.has(sp.Function)):
            return expr
        if expr not in self._known:
            if expr.is_Add or expr.is_Mul:
                found = expr.func(*map(self.plain, expr.args))
            elif expr.is_Pow and expr.exp.is_Integer:
                found = self.plain(expr.base) ** expr.exp
            else:
                found = self.named.setdefault(expr, sp.Dummy(str(expr)))
            self._known[expr] = found
        return self._known[expr]

    def back(self, expr: sp.Expr) -> sp.Expr:
        """An expression over these symbols with what they stand for."""
        if not self.named:
            return expr
        return expr.xreplace({name: part for part, name in self.named.items()})

    def pairs(self) -> list[tuple[sp.Dummy, sp.Dummy]]:
        """The sine and the cosine of each angle, both of which are named for it."""
        angles = dict.fromkeys(
            part.args[0] for part in self.named if isinstance(part, sp.sin | sp.cos)
        )
        return [tuple(self.plain(round_(angle)) for round_ in (sp.sin, sp.cos)) for angle in angles]
