"""Text that wants more than an expression, or more digits than a machine has."""

import pytest
from references.build import bond_graph

import bondgraph as bg

NOT_ALLOWED = [
    "x.y", "x.__class__", "x[0]", "(1, 2)", "[1]", "{1}", "{1: 2}", "'text'", "b'text'", "f'{x}'",
    "lambda: x", "x if y else z", "x < y", "x == y", "x and y", "not x", "~x", "x // y", "x % y",
    "x @ y", "x << 2", "x | y", "(x := 1)", "[x for x in y]", "{x for x in y}", "(x for x in y)",
    "sin(x=1)", "sin(*x)", "sin(**x)", "x.y()", "sin(x)(y)", "(lambda: 1)()", "True", "None", "...",
    "1j", "await x",
]  # fmt: skip

NO_FUNCTION = ["open('f')", "eval('1')", "exec('1')", "__import__('os')", "getattr(x, y)", "f(x)"]

NO_EXPRESSION = [
    "import os",
    "x = 1",
    "def f(): pass",
    "del x",
    "assert x",
    "x: int",
    "*x",
    "yield x",
]


@pytest.mark.parametrize("text", NOT_ALLOWED + NO_FUNCTION + NO_EXPRESSION)
def test_text_beyond_expressions_is_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match=r"^node 'q': "):
        bg.expression(text, "node 'q'")


@pytest.mark.parametrize("text", NO_FUNCTION)
def test_unknown_function_is_named(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match=f"'{text.split('(')[0]}' is not a function"):
        bg.expression(text, "node 'q'")


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9", "9**9**9**9", "2**10000", "x**10000", "x**-10000", "(1/3)**600", "10**500",
        "(9**400)**400", "9"*500, "2**(10**9)",
    ],
)  # fmt: skip
def test_numbers_of_too_many_digits_are_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match=r"node 'q': .*(digits|exponent)"):
        bg.expression(text, "node 'q'")


@pytest.mark.parametrize("text", ["((2*x)**1000)**1000", "(x**1000)**1000"])
def test_powers_of_powers_are_refused_too(text: str) -> None:
    """sympy multiplies the exponents, and writes out the numbers."""
    with pytest.raises(bg.ExpressionError, match=r"node 'q': .*(digits|exponent)"):
        bg.expression(text, "node 'q'")


@pytest.mark.parametrize("text", ["(x + y + z + w)**300", "(x + y)**99*(z + w)**99*(x + z)**99"])
def test_powers_that_multiply_out_to_very_many_terms_are_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match=r"node 'q': .*terms"):
        bg.expression(text, "node 'q'")


def test_function_values_beyond_floats_are_refused_or_kept() -> None:
    """Comparing them takes numbers that floats do not have."""
    try:
        result = bg.expression("max(exp(exp(exp(1000))), 2)", "node 'q'")
    except bg.ExpressionError:
        return
    assert result.free_symbols == set()


@pytest.mark.parametrize(
    "text",
    [
        "("*3000 + "x" + ")"*3000, "sin("*150 + "x" + ")"*150, "-"*3000 + "x", "-"*200 + "x",
        "x**"*200 + "x", "1/("*200 + "x" + ")"*200,
    ],
)  # fmt: skip
def test_deep_nesting_is_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match="node 'q': "):
        bg.expression(text, "node 'q'")


def test_long_text_is_refused() -> None:
    with pytest.raises(bg.ExpressionError, match="node 'q': text of 6001 characters, at most"):
        bg.expression("+".join(["x"] * 3001), "node 'q'")


def test_long_sum_is_not_deep() -> None:
    names = [f"a{k}" for k in range(600)]
    assert len(bg.expression("+".join(names), "here").free_symbols) == 600


@pytest.mark.parametrize("key", ["value", "law"])
def test_graph_refuses_hostile_text_and_names_the_node(key: str) -> None:
    graph = bond_graph([bg.One("j"), bg.I("m", "m"), ("r", {"kind": "R"})], "j>m j>r")
    graph.nodes["r"][key] = "__import__('os').system('true')"
    with pytest.raises(bg.BondGraphError, match="node 'r'"):
        bg.derive(graph)
