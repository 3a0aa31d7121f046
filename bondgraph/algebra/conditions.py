"""Conditions of piecewise expressions in text: comparisons, and those that and, or, not make of them."""

import ast
from collections.abc import Callable, Sequence
from typing import Any

import sympy as sp

from bondgraph.errors import ExpressionError, shortened

PIECEWISE = "Piecewise"
"""What a choice among expressions is called in text."""

EXAMPLE = "Piecewise((a, x > 1), (b, True))"

Build = Callable[[ast.AST], sp.Expr]

_COMPARED: dict[type, Callable[[Any, Any], Any]] = {
    ast.Lt: sp.Lt,
    ast.LtE: sp.Le,
    ast.Gt: sp.Gt,
    ast.GtE: sp.Ge,
    ast.Eq: sp.Eq,
    ast.NotEq: sp.Ne,
}

_JOINED: dict[type, Callable[..., Any]] = {
    ast.And: sp.And,
    ast.Or: sp.Or,
    ast.BitAnd: sp.And,
    ast.BitOr: sp.Or,
}


def read_pieces(arguments: Sequence[ast.expr], build: Build, where: str) -> sp.Expr:
    """The value of the first condition that holds; ``build`` makes the expression of a node."""
    pieces = []
    for pair in arguments:
        if not isinstance(pair, ast.Tuple) or len(pair.elts) != 2:
            raise ExpressionError(
                f"{where}: {shortened(ast.unparse(pair))} is no piece; Piecewise takes pairs of a value "
                f"and a condition, as in {EXAMPLE}"
            )
        pieces.append((build(pair.elts[0]), read_condition(pair.elts[1], build, where)))
    if not pieces:
        raise ExpressionError(f"{where}: Piecewise takes pairs, as in {EXAMPLE}")
    return sp.Piecewise(*pieces)


def read_condition(node: ast.AST, build: Build, where: str) -> Any:
    """The condition of a syntax node."""
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        return sp.true if node.value else sp.false
    if isinstance(node, ast.Compare):
        sides = [build(side) for side in (node.left, *node.comparators)]
        made = [_COMPARED.get(type(one)) for one in node.ops]
        if None not in made:
            return sp.And(*(make(*sides[k : k + 2]) for k, make in enumerate(made) if make))
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not | ast.Invert):
        return sp.Not(read_condition(node.operand, build, where))
    if isinstance(node, ast.BoolOp):
        return _JOINED[type(node.op)](*(read_condition(one, build, where) for one in node.values))
    if isinstance(node, ast.BinOp) and type(node.op) in _JOINED:
        both = (read_condition(side, build, where) for side in (node.left, node.right))
        return _JOINED[type(node.op)](*both)
    raise ExpressionError(
        f"{where}: {shortened(ast.unparse(node))} is no condition; that is a comparison by "
        "< <= > >= == != of expressions, several joined by and, or, not, or True"
    )
