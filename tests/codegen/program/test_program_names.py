"""Names of every sort reach generated code: none may collide with what the code brings itself."""

import numpy as np
import pytest
from oracles.models import exact_rate
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator
from codegen.program.lower import lower

AWKWARD = [
    ("c0", "c1", "c2"), ("c1", "c0", "x0"), ("x0", "x1", "c0"), ("exp", "array", "select"),
    ("lambda_", "numpy", "np"), ("sqrt", "abs", "float"), ("_Dummy_1", "beta", "E"), ("I", "S", "N"),
    ("Abs", "sign", "Max"), ("print", "len", "d_x"), ("now", "self", "run"), ("Q", "O", "zoo"),
    ("oo", "nan", "beta"), ("gamma", "zeta", "Piecewise"), ("größe", "ω", "x_"),
]  # fmt: skip


def _two_masses(m: str, k: str, b: str) -> bg.StateEquations:
    """Two masses of one value with a shared, costly expression in it; a spring and a damper."""
    mass = f"{m}**2 + sqrt({m}**2 + {b}**2) + {m}*{b}"
    nodes = [
        bg.One("n1"), bg.I("m1", mass, flow="v1"), bg.Zero("between"), bg.C("s", f"1/({k} + {mass})"),
        bg.R("d", f"{b}*({k} + {mass})"), bg.One("n2"), bg.I("m2", f"2*({mass})", flow="v2"),
        bg.Se("push", "P"),
    ]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n1>m1 n1>between>n2>m2 between>s n2>d"))


def _exactly(equations: bg.StateEquations, names: tuple[str, ...], x, u) -> np.ndarray:
    # 3, 4, 12/5 make the square root rational only by luck; evalf does the rest in exact_rate.
    return exact_rate(equations, dict(zip(names, (3, 2, 4), strict=True)), x, u)


@pytest.mark.parametrize("names", AWKWARD, ids=" ".join)
def test_parameters_of_any_name(names: tuple[str, str, str]) -> None:
    equations = _two_masses(*names)
    run = simulator(equations, dict(zip(names, (3, 2, 4), strict=True)))
    x, u = [0.3, -1.2, 0.7], [2.5]
    assert run.rhs(0.0, x, u) == pytest.approx(_exactly(equations, names, x, u), rel=1e-13)


@pytest.mark.parametrize("names", AWKWARD, ids=" ".join)
def test_states_inputs_and_outputs_of_any_name(names: tuple[str, str, str]) -> None:
    state, given, received = names
    nodes = [bg.Se("push", given), bg.One("n"), bg.I("m", "mass", flow=state),
             bg.R("rub", law=f"d*{received} + d**2*tanh({state} + {received}) + d**2*{given}",
                  flow=received)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n>m n>rub"), outputs=["rub"])
    run = simulator(equations, {"mass": 2.0, "d": 0.5})
    assert (run.states, run.inputs, run.outputs) == ((state,), (given,), (received,))
    expected = (3.0 - (0.5 * 1.5 + 0.25 * np.tanh(3.0) + 0.25 * 3.0)) / 2
    assert run.rhs(0.0, [1.5], [3.0]) == pytest.approx([expected], rel=1e-14)
    result = run.run([0.0, 0.1], {state: 1.5}, {given: 3.0})
    assert result[state][0] == 1.5
    assert result[received] == pytest.approx(result[state], rel=1e-14)


def test_temporaries_pass_over_every_name_that_is_taken() -> None:
    """Names that other parts of the program use count as taken: c3 stands in a law alone."""
    equations = _two_masses("c0", "c2", "c1")
    program = lower(equations, {"push": "c3*c4"}, ["c0", "c1", "c2", "c3"])
    temporaries = {name.name for name, _ in program.coefficients.assignments}
    assert temporaries
    assert not temporaries & {"c0", "c1", "c2", "c3", "c4"}


def test_a_rate_does_not_collide_with_a_parameter_called_like_it() -> None:
    """The rate of an input w is d_w inside; a parameter and an input may be called d_w themselves."""
    nodes = [bg.Sf("imposed", "d_w*w + d_w**2"), bg.Zero("n"), bg.I("m", "m"), bg.C("c", "C")]
    graph = bond_graph([*nodes, bg.One("o")], "imposed>n>o>m n>c")
    run = simulator(bg.derive(graph), {"d_w": 3.0, "m": 1.0, "C": 1.0})
    assert run.inputs == ("w",)
    assert run.rhs(0.0, [0.5, 0.25], [2.0]) == pytest.approx([0.25, 15.0 - 0.5], rel=1e-14)
