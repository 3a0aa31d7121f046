"""Numbers and text become exact expressions."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

import bondgraph as bg
from bondgraph.algebra.atoms import number, symbol

x, y = sp.symbols("x y")
tenth = sp.Rational(1, 10)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x", x),
        (" x ", x),
        ("x + 2*y - 3", x + 2 * y - 3),
        ("-x**2", -(x**2)),
        ("2**-1", sp.Rational(1, 2)),
        ("x**2**3", x**8),
        ("1/3", sp.Rational(1, 3)),
        ("0.1", tenth),
        ("0.1 + 0.2", 3 * tenth),
        ("1e-3", sp.Rational(1, 1000)),
        ("1.5e3", sp.Integer(1500)),
        ("123456789.123456789", sp.Rational(12345678912345679, 10**8)),
        ("h1/(h1 - 1)", sp.Symbol("h1") / (sp.Symbol("h1") - 1)),
        ("sqrt(4*x**2/x**2)", sp.Integer(2)),
        ("sin(x)*cos(y)", sp.sin(x) * sp.cos(y)),
        ("atan2(x, y)", sp.atan2(x, y)),
        ("abs(x) + Abs(x)", 2 * sp.Abs(x)),
        ("min(x, y, 1) + max(x, 2)", sp.Min(x, y, 1) + sp.Max(x, 2)),
        ("sign(-3)", sp.Integer(-1)),
        ("+x", x),
        ("2*pi*x", 2 * sp.pi * x),
        ("hypot(x, 3)", sp.sqrt(x**2 + 9)),
        ("log10(x) + log10(1000)", sp.log(x) / sp.log(10) + 3),
        ("Piecewise((x, x > 1), (2*y, True))", sp.Piecewise((x, x > 1), (2 * y, True))),
        ("Piecewise((1, 0 < x <= y), (2, True))", sp.Piecewise((1, (x > 0) & (x <= y)), (2, True))),
        (
            "Piecewise((1, not x > 1 or y != 2), (2, True))",
            sp.Piecewise((1, (x <= 1) | sp.Ne(y, 2)), (2, True)),
        ),
        (
            "Piecewise((1, (x > 1) & ~(y == 2) | (y < 0)), (2, True))",
            sp.Piecewise((1, (x > 1) & sp.Ne(y, 2) | (y < 0)), (2, True)),
        ),
        ("Piecewise((1, x < 0), (2, x >= 0))", sp.Piecewise((1, x < 0), (2, True))),
        (
            "3*Piecewise((Piecewise((1, y > 1), (x, True)), x > 1), (2, True))",
            3 * sp.Piecewise((sp.Piecewise((1, y > 1), (x, True)), x > 1), (2, True)),
        ),
    ],
)
def test_text_is_read_exactly(text: str, expected: sp.Expr) -> None:
    assert bg.expression(text, "here") == expected


ROOT = sp.Pow(-1, sp.Rational(1, 3))


@pytest.mark.parametrize(
    "value",
    [
        "cos((-1)**(1/3))", "x*(-8)**(1/3)", "x + cos(y*(-1)**(2/3))", "asin(2)*x", "x*acos(-3/2)",
        "cos(3)**(1/3)", "x*log(cos(3))", "max(x, cos((-1)**(1/3)))", sp.cos(ROOT), x + sp.acos(2),
        sp.exp(sp.I) + sp.exp(-sp.I), sp.Piecewise((ROOT, x > 0), (1, True)),
        sp.Piecewise((1, x > sp.cos(ROOT)), (2, True)),
    ],
)  # fmt: skip
def test_complex_constants_are_refused_wherever_they_stand(value: object) -> None:
    """Also inside what is real again by other means, such as ``exp(i) + exp(-i)``."""
    with pytest.raises(
        bg.ExpressionError, match=r"here: .*is not (a real number|a finite real|comparable|allowed)"
    ):
        bg.expression(value, "here")


@pytest.mark.parametrize("text", ["acos(1/2)*x", "sqrt(sqrt(2) - 1)", "cos(1)**(1/3)", "(-2)**x", "log(2)*x",
                                  "abs((-1)**(1/3))", "((-1)**(1/3))**3", "tan(2)"])  # fmt: skip
def test_real_constants_stay(text: str) -> None:
    value = bg.expression(text, "here").subs(x, 2)
    assert complex(value).imag == 0.0


@pytest.mark.parametrize("name", ["E", "I", "N", "O", "Q", "S", "oo", "nan", "beta", "gamma"])
def test_names_are_plain_symbols_whatever_sympy_calls_so(name: str) -> None:
    result = bg.expression(name, "here")
    assert result == sp.Symbol(name)
    assert result.is_real is None


def test_letters_that_look_alike_are_one_name_everywhere() -> None:
    """Python reads the full-width x as x (NFKC), so a flow of that name is the value's x too."""
    assert bg.expression("\uff58", "here") == symbol("\uff58", "here") == x


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (2, sp.Integer(2)),
        (0.1, tenth),
        (-2.5, sp.Rational(-5, 2)),
        (Fraction(1, 3), sp.Rational(1, 3)),
        (np.float64(0.1), tenth),
        (np.int64(3), sp.Integer(3)),
        (sp.Float("0.1") * x, x / 10),
        (sp.Float("0.3"), 3 * tenth),
        (sp.pi * x, sp.pi * x),
        (1e22, sp.Integer(10) ** 22),
    ],
)
def test_values_become_exact(value: object, expected: sp.Expr) -> None:
    result = bg.expression(value, "here")
    assert result == expected
    assert not result.has(sp.Float)


def test_single_precision_counts_by_its_own_shortest_decimal() -> None:
    assert bg.expression(np.float32(0.1), "here") == tenth


@pytest.mark.parametrize("value", [0.1, 1 / 3, 2.0**-40, 1e300, 5e-324, 0.1 + 0.2])
def test_exact_number_is_the_float_again(value: float) -> None:
    assert float(number(value, "here")) == value


@pytest.mark.parametrize(
    "value",
    [
        True, np.bool_(True), None, 1j, float("nan"), float("inf"), -float("inf"), np.nan, [1], b"x",
        sp.nan, sp.oo, sp.zoo, sp.I, sp.I * x, sp.true, x > 1, sp.Matrix([x]), sp.sqrt(-2),
        sp.Float("nan"), sp.Float("inf"), "1e999", "sqrt(-1)", "log(0)", "log(-1)", "asin(2)",
    ],
)  # fmt: skip
def test_values_that_are_not_finite_and_real_are_refused(value: object) -> None:
    with pytest.raises(bg.ExpressionError, match=r"^node 'q': "):
        bg.expression(value, "node 'q'")


@pytest.mark.parametrize(
    "value",
    [
        sp.Symbol("x", imaginary=True),
        sp.Symbol("x", commutative=False),
        sp.Function("f")(x),
        sp.Integral(x, x),
        sp.Derivative(sp.Function("f")(x), x),
    ],
    ids=str,
)
def test_sympy_expressions_without_a_real_value_are_refused(
    value: sp.Expr,
) -> None:
    with pytest.raises(bg.ExpressionError, match=r"^node 'q': "):
        bg.expression(value, "node 'q'")


@pytest.mark.parametrize(
    "text", ["1/0", "x/(y - y)", "0**-1", "1/sin(0)", "x**-1/0", "(x - x)**-2"]
)
def test_division_by_zero_is_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match=r"node 'q': .*division by zero"):
        bg.expression(text, "node 'q'")


@pytest.mark.parametrize(
    "name", ["", "2x", "a b", "a-b", "a.b", "class", "lambda", "None", 5, None]
)
def test_names_that_generated_code_could_not_carry_are_refused(name: object) -> None:
    with pytest.raises(bg.ExpressionError, match=r"node 'q': .*cannot be a symbol"):
        symbol(name, "node 'q'")


@pytest.mark.parametrize("text", ["", "  ", "x +", "x y", "(x", "x)", "#", "x;y", "x\ny", "\x00"])
def test_text_that_is_no_expression_is_refused(text: str) -> None:
    with pytest.raises(bg.ExpressionError, match=r"node 'q': .*is not an expression"):
        bg.expression(text, "node 'q'")


def test_wrong_number_of_arguments_is_refused() -> None:
    with pytest.raises(bg.ExpressionError, match="sin takes 1"):
        bg.expression("sin(x, y)", "node 'q'")
    with pytest.raises(bg.ExpressionError, match="min takes 2"):
        bg.expression("min(x)", "node 'q'")


def test_nothing_is_evaluated(tmp_path: Path) -> None:
    target = tmp_path / "made"
    for text in (
        f"open({str(target)!r}, 'w')",
        f"__import__('pathlib').Path({str(target)!r}).touch()",
        f"[x for x in (1,) if open({str(target)!r}, 'w')]",
        f"(lambda: open({str(target)!r}, 'w'))()",
    ):
        with pytest.raises(bg.ExpressionError, match=r"^node 'q': "):
            bg.expression(text, "node 'q'")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x^2", r"'x \^ 2' is not allowed; a power is written \*\*"),
        ("x if y > 1 else 2", r"a choice is written Piecewise\(\(a, condition\), \(b, True\)\)"),
        ("x > 1", "a comparison stands in a condition"),
        ("x and y", "and, or, not stand in a condition"),
        ("not x", "and, or, not stand in a condition"),
        ("Piecewise((1, x > 1 && y > 1), (2, True))", "&& is written and here"),
        ("Piecewise((1, x > 1 || y > 1), (2, True))", r"\|\| is written or here"),
        ("Piecewise((1, !(x > 1)), (2, True))", "! is written not here"),
        ("Piecewise((1, x = 1), (2, True))", "= is written == here"),
        ("sinn(x)", r"'sinn' is not a function an expression may use \(did you mean 'sin'\?\)"),
        ("piecewise((1, x > 1), (2, True))", r"did you mean 'Piecewise'\?"),
        ("Piecewise(x, y)", "'x' is no piece; Piecewise takes pairs"),
        ("Piecewise()", "Piecewise takes pairs"),
        ("Piecewise((1, x), (2, True))", "'x' is no condition; that is a comparison"),
        ("Piecewise((1, x in y), (2, True))", "'x in y' is no condition"),
        (sp.Symbol("pi"), "pi is a number and cannot be a symbol; rename it"),
    ],
)  # fmt: skip
def test_what_is_spelled_otherwise_is_told_with_its_spelling(text: object, told: str) -> None:
    with pytest.raises(bg.ExpressionError, match=rf"^node 'q': .*{told}"):
        bg.expression(text, "node 'q'")


@pytest.mark.parametrize(
    ("text", "way"),
    [
        ("q = c*sqrt(dp)", r"write what stands on the right alone, 'c\*sqrt\(dp\)'"),
        ("np.sqrt(x)", r"functions stand without their module, as in sqrt\(x\)"),
        ("2*math.pi*x", "a constant is called pi here"),
    ],
)
def test_what_python_writes_otherwise_has_its_way_out(text: str, way: str) -> None:
    with pytest.raises(bg.ExpressionError, match=way):
        bg.expression(text, "law")
