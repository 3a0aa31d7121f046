"""`lower`: names sorted, expressions shared, nothing lost, and always the same program."""

import pytest
import sympy as sp
from oracles.models import oscillator, series_circuit
from references.build import bond_graph

import bondgraph as bg
from codegen.program.lower import lower
from codegen.program.records import Block, block

CIRCUIT = bg.derive(series_circuit())
SLIDER = bg.derive(oscillator(bg.Se("push", "P")))
NUMBERS = ("m", "k", "F_c")


def _names(symbols) -> list[str]:
    return [symbol.name for symbol in symbols]


def _value(code: Block, values: dict[str, float]) -> list[float]:
    """A block computed by substitution, one assignment after the other."""
    known = {sp.Symbol(name): sp.Float(value, 30) for name, value in values.items()}
    for name, expr in code.assignments:
        known[name] = expr.subs(known)
    return [float(result.subs(known)) for result in code.results]


def test_names_are_sorted_into_parameters_states_and_inputs() -> None:
    program = lower(SLIDER, parameters=NUMBERS)
    assert _names(program.parameters) == ["F_c", "k", "m"]
    assert _names(program.states) == ["v", "F"]
    assert _names(program.inputs) == ["f", "P"]
    assert _names(program.external) == ["P"]
    assert "slip" in _names(program.readings)
    assert [port.name for port in program.friction] == ["ground"]
    port = program.friction[0]
    assert program.inputs[port.input].name == "f"
    assert program.readings[port.reading].name == "slip"


def test_a_name_of_a_law_that_is_no_parameter_is_an_input() -> None:
    program = lower(SLIDER, parameters=("m", "k"))
    assert _names(program.external) == ["P", "F_c"]
    assert _names(program.parameters) == ["k", "m"]


def test_a_missing_parameter_is_named() -> None:
    with pytest.raises(bg.ParameterError, match=r"missing parameter\(s\) C, R; give each a number"):
        lower(CIRCUIT, parameters=["L"])


def test_coefficients_are_the_entries_of_the_matrices() -> None:
    program = lower(CIRCUIT, parameters=["R", "L", "C"])
    values = _value(program.coefficients, {"R": 5.0, "L": 0.3, "C": 0.02})
    found = {}
    for name, pattern in program.layout.items():
        places = list(zip(pattern.rows, pattern.columns, strict=True))
        found[name] = {place: values.pop(0) for place in places}
    assert found["A"] == pytest.approx({(0, 0): 0.3, (1, 1): 0.02})
    assert found["J"] == pytest.approx({(0, 0): -5.0, (0, 1): -1.0, (1, 0): 1.0})
    assert found["B"] == {(0, 0): 1.0}
    assert found["E"] == {}
    assert values == [] or set(program.layout) > set("AJBE")


def test_a_common_subexpression_is_computed_once() -> None:
    a, b, x = sp.symbols("a b x")
    shared = sp.exp(-a / b)
    code = block([shared * x, 1 + shared, sp.sin(shared)])
    exponentials = [expr.count(sp.exp) for _, expr in code.assignments]
    exponentials += [expr.count(sp.exp) for expr in code.results]
    assert sum(exponentials) == 1
    numbers = {"a": 0.3, "b": 0.7, "x": -2.0}
    e = float(sp.exp(sp.Float("-0.3", 30) / sp.Float("0.7", 30)))
    assert _value(code, numbers) == pytest.approx([-2 * e, 1 + e, float(sp.sin(e))], rel=1e-14)


def test_assignments_use_only_arguments_and_what_is_assigned_before() -> None:
    a, b = sp.symbols("a b")
    inner = sp.sqrt(a + b)
    code = block([inner + sp.sin(inner), sp.sin(inner) * sp.exp(sp.sin(inner)), sp.exp(inner)])
    known = set(code.arguments)
    for name, expr in code.assignments:
        assert expr.free_symbols <= known
        known.add(name)
    assert all(expr.free_symbols <= known for expr in code.results)


def test_an_empty_block_and_a_constant_one() -> None:
    assert block([]) == Block((), (), ())
    assert block([sp.Integer(3)]).results == (3,)


def test_the_same_input_gives_an_equal_program() -> None:
    laws = {"ground": bg.DryFriction("F_c", "1 + exp(-slip/v_s)")}
    names = [*NUMBERS, "v_s"]
    assert lower(SLIDER, laws, names) == lower(SLIDER, dict(laws), reversed(names))
    again = bg.derive(oscillator(bg.Se("push", "P")))
    assert lower(again, laws, names) == lower(SLIDER, laws, names)


def _with_law(law: object) -> bool:
    parameters = ("m", "k", "F_c", "b", "P_0")
    return lower(SLIDER, {"push": law}, parameters).affine


@pytest.mark.parametrize("law", ["P_0", "-b*v", "P_0 - b*(v - w)", "k*F"])
def test_affine_models_are_known_as_such(law: str) -> None:
    assert _with_law(law)


@pytest.mark.parametrize("law", ["-b*v*abs(v)", "P_0*sin(t)", "b*v*F", "w**2", "max(v, 0)"])
def test_other_models_are_not_taken_for_affine(law: str) -> None:
    assert not _with_law(law)


@pytest.mark.parametrize(
    ("friction", "affine"),
    [
        (bg.DryFriction("F_c"), True), (bg.DryFriction("F_c", 1, "3/2"), True),
        (bg.DryFriction("F_c + b*v"), True), (bg.DryFriction("N", 1, "b"), False),
        (bg.DryFriction("F_c", "1 + exp(-slip/b)"), False), (bg.DryFriction("F_c*v**2"), False),
        (bg.DryFriction("F_c*t"), False), (bg.DryFriction("N", 1, "1 + F**2"), False),
        (bg.DryFriction("F", 1, "1 + v"), False),
    ],
)  # fmt: skip
def test_friction_is_affine_with_an_affine_level_and_a_constant_curve(friction, affine) -> None:
    """A breakaway that is a parameter must be compared with the curve: that is the general path."""
    assert lower(SLIDER, {"ground": friction}, ("m", "k", "F_c", "b")).affine is affine


def test_a_law_of_a_law_state_is_affine_if_it_is_linear() -> None:
    def spring(law: str) -> bool:
        nodes = [bg.One("n"), bg.I("m", "m"), bg.C("s", law=law)]
        return lower(bg.derive(bond_graph(nodes, "n>m n>s")), parameters=["m", "k"]).affine

    assert spring("k*q_s")
    assert not spring("k*q_s**3")
