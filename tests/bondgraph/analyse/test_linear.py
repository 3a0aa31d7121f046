"""`linearize`: laws replaced by their slopes, against hand-derived matrices and finite differences."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences

import bondgraph as bg
from codegen import simulator

F_c, I_s, a, b, c, c1, c2, d, g, k, k1, k3, m, n, r, v0, x0 = sp.symbols(
    "F_c I_s a b c c1 c2 d g k k1 k3 m n r v0 x0"
)


def _block(law: object = None, push: object = "u") -> bg.StateEquations:
    """m v' = u - law(v); the port p receives v under the name f_p."""
    nodes = [bg.Se("s", push), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("p", law=law)]
    return bg.derive(bond_graph(nodes, "s>j j>m j>p"))


def _check(model: bg.LinearModel, **expected: object) -> None:
    for name, matrix in expected.items():
        assert differences(getattr(model, name), matrix) == {}, name


def test_mass_spring_damper_is_its_textbook_matrices() -> None:
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("b", "b")]
    graph = bond_graph([*nodes, bg.C("k", "1/k", effort="F")], "s>j j>m j>k j>b")
    model = bg.linearize(bg.derive(graph), outputs=["v", "F", "e_m"])
    assert (*model.states, *model.inputs, *model.outputs) == sp.symbols("v F u v F e_m")
    assert model.parameters == (b, k, m)
    _check(model, A=[[m, 0], [0, 1 / k]], J=[[-b, -1], [1, 0]], B=[[1], [0]], E=[[0], [0]])
    _check(model, F=[[1, 0], [0, 1], [-b, -1]], D=[[0], [0], [1]], G=[[0], [0], [0]])


@pytest.mark.parametrize(
    ("law", "at", "slope"),
    [
        ("c*v", {}, c), ("c*f_p", {}, c), ("c*v + d*f_p - g", {}, c + d),
        ("c*v*abs(v)", {"v": -3}, 6 * c), ("c*f_p*abs(f_p)", {"f_p": "1/2"}, c),
        ("c*abs(v)", {"v": -2}, -c), ("c*sign(v)*sqrt(abs(v))", {"v": 4}, c / 4),
        ("max(1, v)", {"v": "3/2"}, 1), ("max(1, v)", {"v": 0}, 0), ("min(1, v)", {"v": 0}, 1),
        ("c*tanh(v/d)", {"v": 0}, c / d), ("c*v**3 + v*sin(t)", {"v": 1, "t": 0}, 3 * c),
        ("c*v**2", {"v": "v0"}, 2 * c * v0), ("c*(v - d)**3", {"v": "d + 1"}, 3 * c),
    ],
)  # fmt: skip
def test_law_is_replaced_by_its_slope(law: str, at: dict[str, object], slope: sp.Expr) -> None:
    for equations, over in ((_block(law), {}), (_block(), {"p": law}), (_block(d), {"e_p": law})):
        model = bg.linearize(equations, at=at, laws=over)
        assert (model.states, model.inputs) == (sp.symbols("v,"), sp.symbols("u,"))
        _check(model, J=[[-slope]], B=[[1]])


def test_diode_beside_a_capacitor() -> None:
    nodes = [bg.Sf("s", "i"), bg.Zero("z"), bg.C("c", "c"), bg.R("p", gives="flow")]
    equations, law = bg.derive(bond_graph(nodes, "s>z z>c z>p")), "I_s*(exp(e_p/b) - 1)"
    model = bg.linearize(equations, at={"e_p": "x0"}, laws={"p": law})
    _check(model, A=[[c]], J=[[-I_s / b * sp.exp(x0 / b)]], B=[[1]])


@pytest.mark.parametrize(
    ("law", "slope"), [("k1*q_k + k3*q_k**3", k1 + 3 * k3 * x0**2), ("k*sin(q_k)", k * sp.cos(x0))]
)
def test_spring_with_a_law_has_its_twist_as_a_state(law: str, slope: sp.Expr) -> None:
    """A hardening spring; and a pendulum, whose weight is a spring of its angle."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", law=law)]
    equations = bg.derive(bond_graph(nodes, "s>j j>m j>k"))
    model = bg.linearize(equations, at={"q_k": "x0"}, outputs=["e_k"])
    assert model.states == sp.symbols("v q_k")
    _check(model, A=[[m, 0], [0, 1]], J=[[0, -slope], [1, 0]], B=[[1], [0]], F=[[0, slope]])
    with pytest.raises(bg.SignalError, match=r"law at 'k' depends on q_k; give it a value in at"):
        bg.linearize(equations)


def test_coil_with_a_law_has_its_flux_as_a_state() -> None:
    """p' = u - r i - e and c e' = i, with i = a p + b p^3."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.C("c", "c", effort="e"), bg.R("r", "r")]
    graph = bond_graph([*nodes, bg.I("l", law="a*p_l + b*p_l**3")], "s>j j>c j>l j>r")
    model = bg.linearize(bg.derive(graph), at={"p_l": 2})
    assert model.states == sp.symbols("e p_l")
    i = a + 12 * b
    _check(model, A=[[c, 0], [0, 1]], J=[[0, i], [-1, -r * i]], B=[[0], [1]])


@pytest.mark.parametrize("seed", range(4))
def test_models_are_the_slopes_of_a_simulators_rates(seed: int) -> None:
    """A spring, a clutch and a damper between geared shafts, with laws of many signals."""
    rng = np.random.default_rng(seed)
    nodes = [
        bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.Zero("z"), bg.TF("gear", "r"),
        bg.C("k", law="k1*q_k + k3*q_k**3"), bg.One("l"), bg.I("n", "n", flow="w"), bg.R("d", "d"),
        bg.R("air", law="c*w*abs(w) + a*v*w*e_d"), bg.R("dry", law=bg.DryFriction("y", "1 + slip")),
        bg.Zero("h"), bg.R("o", law="b*f_o + u*v"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "s>j j>m j>z z>k z>gear>l l>n l>air j>dry l>h h>d h>o")
    equations = bg.derive(graph)
    values = {str(name): round(rng.uniform(0.5, 3), 3) for name in (a, b, c, d, k1, k3, m, n, r)}
    x, u = rng.uniform(0.5, 2, 3) * rng.choice([-1, 1], 3), rng.uniform(1, 2, 2)
    run, names = simulator(equations, values), ("v", "w", "q_k", "u", "y")
    # d gives e_d = d (w - f_o) = b f_o + u v.
    e_d = values["d"] * (values["b"] * x[1] + u[0] * x[0]) / (values["b"] + values["d"])
    at = dict(zip(names, [*x, *u], strict=True)) | {"f_dry": x[0], "e_d": e_d}
    model = bg.linearize(equations, at=at, inputs=["y"]).numeric(values)
    assert (*run.states, *run.inputs) == (*model.states, *model.inputs) == names
    step = 1e-5 * np.eye(5)
    rates = np.array([[run.rhs(0, x + h[:3], u + h[3:]) for h in (dh, -dh)] for dh in step])
    slopes = (rates[:, 0] - rates[:, 1]).T / 2e-5
    assert np.hstack([model.P, model.Q]) == pytest.approx(slopes, rel=1e-7, abs=1e-8)


def test_law_of_a_port_beside_a_resistance_is_solved_with_it() -> None:
    """Two dampers in series, 1/(1/r + 1/slope), between the mass and the wall."""
    port = bg.R("p", law="c*f_p**3")
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.Zero("z"), bg.R("r", "r"), port]
    equations = bg.derive(bond_graph(nodes, "j>m j>z z>r z>p"))
    model = bg.linearize(equations, at={"f_p": 2}, outputs=["f_p", "e_p"])
    share = r / (12 * c + r)
    _check(model, J=[[-12 * c * share]], F=[[share], [12 * c * share]])


def test_laws_that_read_what_other_laws_give() -> None:
    """e_p = a e_q + d v and e_q = c v + b e_p, so e_q = (c + b d) v/(1 - a b)."""
    laws = {"p": "a*e_q + d*v", "q": "c*v + b*e_p", "o": "g*e_p"}
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), *(bg.R(at, law=laws[at]) for at in "pqo")]
    equations = bg.derive(bond_graph(nodes, "j>m j>p j>q j>o"))
    e_p, e_q = (d + a * c) / (1 - a * b), (c + b * d) / (1 - a * b)
    model = bg.linearize(equations, outputs=["e_p", "e_q", "e_o"])
    _check(model, F=[[e_p], [e_q], [g * e_p]], J=[[-e_p - e_q - g * e_p]])
    with pytest.raises(bg.SignalError, match=r"'p', 'q'.*depend on one another at once"):
        bg.linearize(equations, laws={"p": "a*e_q", "q": "e_p/a"})


def test_law_that_reads_the_force_of_a_dependent_mass_enters_the_inertia() -> None:
    """(m + d) v' = u + g F with F = d v'."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.I("d", "d", effort="F")]
    graph = bond_graph([*nodes, bg.R("p", law="-g*F")], "s>j j>m j>d j>p")
    model = bg.linearize(bg.derive(graph), outputs=["F", "v"])
    all_in = m + d - g * d
    _check(model, A=[[all_in]], J=[[0]], B=[[1]], F=[[0], [1]], D=[[d / all_in], [0]])


def test_known_sources_stay_inputs_and_names_in_laws_become_some() -> None:
    assert bg.linearize(_block("c*v", push="F_0*sin(w0*t)")).inputs == sp.symbols("e_s,")
    assert bg.linearize(_block()).inputs == sp.symbols("u e_p")
    at = {"v": 5, "z": 7, "y": 3}
    model = bg.linearize(_block("c*z*v + d*y**2"), at=at, inputs=["z", "y", "u"])
    assert model.inputs == sp.symbols("u y z")
    _check(model, J=[[-7 * c]], B=[[1, -6 * d, -5 * c]])
    _check(bg.linearize(_block("c*x0*v")), J=[[-c * x0]])


@pytest.mark.parametrize("side", [1, -1])
def test_slipping_friction_has_the_slope_of_its_curve_on_either_side(side: int) -> None:
    """e = sign(v) F_c (1 + a exp(-|v|/b)), so de/dv = -F_c a/b exp(-|v|/b) either way."""
    law = bg.DryFriction("F_c", "1 + a*exp(-slip/b)")
    slope = -F_c * a / b * sp.exp(-3 / b)
    _check(bg.linearize(_block(law), at={"f_p": 3 * side}), J=[[-slope]], B=[[1]])
    model = bg.linearize(_block(law), at={"f_p": 3 * side, "F_c": 10}, inputs=["F_c"])
    level = 1 + a * sp.exp(-3 / b)
    _check(model, J=[[-slope.subs(F_c, 10)]], B=[[1, -side * level]])
    plain = bg.linearize(_block(bg.DryFriction("F_c*d")), at={"f_p": side}, inputs=["F_c"])
    _check(plain, J=[[0]], B=[[1, -side * d]])


def test_source_on_a_loop_of_capacitors_enters_by_its_rate() -> None:
    """e1 + e2 = v and c1 e1' = c2 e2' + g e2^3, so (c1 + c2) e1' = c2 v' + 3 g x0^2 (v - e1)."""
    port = bg.R("p", law="g*e_p**3", gives="flow")
    nodes = [bg.Se("v", "v"), bg.One("j"), bg.C("c1", "c1"), bg.Zero("z"), bg.C("c2", "c2"), port]
    equations = bg.derive(bond_graph(nodes, "v>j>c1 j>z>c2 z>p"))
    model = bg.linearize(equations, at={"e_p": "x0"}, outputs=["f_v"])
    slope, share = 3 * g * x0**2, c1 / (c1 + c2)
    _check(model, A=[[c1 + c2]], J=[[-slope]], B=[[slope]], E=[[c2]])
    _check(model, F=[[-share * slope]], D=[[share * slope]], G=[[share * c2]])


@pytest.mark.parametrize(
    ("law", "more", "message"),
    [
        ("c*abs(v - d)", {"at": {"v": "d"}}, r"law at 'p' has a corner .* where -?[dv] [+-] [dv] = 0"),
        ("max(2, v)", {"at": {"v": 2}}, "law at 'p' has a corner"),
        ("c*sign(v)", {"at": {"v": 0}}, "law at 'p' has a corner"),
        ("sqrt(v)", {"at": {"v": 0}}, "law at 'p' has no finite real slope"),
        ("c*v**2", {}, "law at 'p' depends on v; give it a value in at"),
        ("c*v*t", {}, "law at 'p' depends on t; give it a value in at"),
        (bg.DryFriction("F_c", "1 + slip"), {}, "dry friction at 'p' .* give f_p a number"),
        (bg.DryFriction("F_c"), {"inputs": ["F_c"]}, "dry friction at 'p' .* give f_p a number"),
        ("c*v", {"outputs": ["nobody"]}, "no signal is called nobody; there are .*f_p, f_s, u, v"),
        ("c*v", {"outputs": "v"}, "outputs must be a list of signals, not 'v'"),
        ("c*v", {"inputs": ["no"]}, "no law reads an input no"),
        ("c*v", {"at": [3]}, r"at must map signals to values, not be \[3\]"),
    ],
)  # fmt: skip
def test_what_has_no_slope_or_no_name_is_refused(
    law: object, more: dict[str, object], message: str
) -> None:
    with pytest.raises(bg.SignalError, match=message):
        bg.linearize(_block(law), **more)
