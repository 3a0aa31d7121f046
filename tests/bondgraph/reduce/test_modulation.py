"""Values that change with states, integrals, inputs and time, against Lagrange's equations."""

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

t, J, m, M, rod, r, k, tau = sp.symbols("t J m M l r k tau")
SPEED = sp.Symbol("omega")


def _lagrange(energy: sp.Expr, force: sp.Expr, angle: sp.Symbol, speed: sp.Symbol) -> sp.Expr:
    """``d/dt dT/dw - dT/dtheta - Q`` with the angle's acceleration as the symbol ``alpha``."""
    alpha = sp.Symbol("alpha")
    momentum = sp.diff(energy, speed)
    rate = sp.diff(momentum, angle) * speed + sp.diff(momentum, speed) * alpha
    return rate - sp.diff(energy, angle) - force


def _agrees(equations: bg.StateEquations, energy: sp.Expr, force: sp.Expr, known: dict) -> None:
    """One degree of freedom: ``A w' - J w - B u`` is Lagrange's equation."""
    (angle,) = equations.integrals
    (speed,) = equations.states
    u = sp.Matrix([known[name] for name in equations.inputs])
    row = equations.A[0] * sp.Symbol("alpha") - equations.J[0] * speed - (equations.B * u)[0]
    assert sp.simplify(row - _lagrange(energy, force, angle, speed)) == 0


def _moving_mass(ratio: str, *more: tuple, bonds: str = "") -> nx.DiGraph:
    """A shaft that carries a mass along by a ratio that changes with the shaft's angle."""
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", ratio), bg.One("slider"),
             bg.I("m", "m", priority=-1), *more]  # fmt: skip
    return bond_graph(nodes, f"drive>rot>J rot>angle rot>crank>slider>m {bonds}")


theta = sp.Symbol("theta")

SLIDERS = {
    "scotch yoke": r * sp.cos(theta),
    "slider-crank": -r * sp.cos(theta) - sp.sqrt(rod**2 - r**2 * sp.sin(theta) ** 2),
    "eccentric": r * sp.sin(theta) + sp.Rational(1, 5) * r * sp.sin(3 * theta),
}


@pytest.mark.parametrize("name", SLIDERS)
def test_mechanisms_are_lagranges(name: str) -> None:
    position = SLIDERS[name]
    ratio = sp.diff(position, theta)
    equations = bg.derive(_moving_mass(ratio), outputs=["slider"])
    energy = J * SPEED**2 / 2 + m * (ratio * SPEED) ** 2 / 2
    _agrees(equations, energy, tau, {tau: tau})
    assert equations.integrals == {theta: sp.Symbol("f_angle")}
    assert equations.varying == (SPEED, theta)
    assert theta not in equations.parameters
    assert sp.simplify(equations.F[0] - ratio) == 0


def test_the_pendulums_rod_carries_its_mass_by_two_ratios() -> None:
    """x = l sin theta, y = -l cos theta: the moving ratios leave J + m l^2, printed so."""
    nodes = [bg.TF("up", "l*sin(theta)"), bg.One("y"), bg.I("m_y", "m", priority=-1),
             bg.Se("weight", "W")]  # fmt: skip
    graph = _moving_mass("l*cos(theta)", *nodes, bonds="rot>up>y>m_y weight>y")
    equations = bg.derive(graph, outputs=[])
    assert sp.Matrix([[J + rod**2 * m]]) == equations.A
    assert sp.zeros(1, 1) == equations.J
    energy = (J + m * rod**2) * SPEED**2 / 2
    weight = sp.Symbol("W")
    _agrees(equations, energy, tau + weight * rod * sp.sin(theta), {tau: tau, weight: weight})


def _double_pendulum() -> bg.StateEquations:
    """Point masses m and M on rods l and r: their velocities by six ratios of two angles."""
    nodes: list = []
    bonds = ""
    for j, (name, length) in enumerate((("a", "l"), ("b", "r")), start=1):
        nodes += [bg.One(name, flow=f"w_{j}"), bg.Df(f"angle_{j}", integrate=f"th_{j}"),
                  bg.Se(f"T_{j}", f"T_{j}"), bg.I(f"J_{j}", f"J_{j}", flow=f"w_{j}")]  # fmt: skip
        bonds += f"{name}>angle_{j} T_{j}>{name} {name}>J_{j} "
        for axis, turn in (("x", "cos"), ("y", "sin")):
            nodes.append(bg.TF(f"{name}{axis}", f"{length}*{turn}(th_{j})"))
    for axis in ("x", "y"):
        nodes += [bg.One(f"first_{axis}"), bg.I(f"m_{axis}", "m", priority=-1), bg.Zero(f"sum_{axis}"),
                  bg.One(f"second_{axis}"), bg.I(f"M_{axis}", "M", priority=-1)]  # fmt: skip
        bonds += f"a>a{axis}>first_{axis}>m_{axis} first_{axis}>sum_{axis} b>b{axis}>sum_{axis} "
        bonds += f"sum_{axis}>second_{axis}>M_{axis} "
    return bg.derive(bond_graph(nodes, bonds), outputs=[])


def test_the_double_pendulum_is_lagranges() -> None:
    equations = _double_pendulum()
    angles, speeds = sp.symbols("th_1 th_2"), sp.symbols("w_1 w_2")
    accelerations, torques = sp.symbols("a_1 a_2"), sp.symbols("T_1 T_2")
    (J_1, J_2), (th_1, th_2), (w_1, w_2) = sp.symbols("J_1 J_2"), angles, speeds
    x = rod * sp.sin(th_1), rod * sp.sin(th_1) + r * sp.sin(th_2)
    y = -rod * sp.cos(th_1), -rod * sp.cos(th_1) - r * sp.cos(th_2)
    velocities = [[sum(sp.diff(c, q) * w for q, w in zip(angles, speeds, strict=True)) for c in axis]
                  for axis in (x, y)]  # fmt: skip
    energy = (J_1 * w_1**2 + J_2 * w_2**2) / 2
    energy += sum(m * axis[0] ** 2 / 2 + M * axis[1] ** 2 / 2 for axis in velocities)
    found = equations.A * sp.Matrix(accelerations) - equations.J * sp.Matrix(speeds)
    found -= equations.B * sp.Matrix(equations.inputs)
    assert equations.inputs == torques
    for at, (angle, speed) in enumerate(zip(angles, speeds, strict=True)):
        momentum = sp.diff(energy, speed)
        rate = sum(sp.diff(momentum, q) * w for q, w in zip(angles, speeds, strict=True))
        rate += sum(sp.diff(momentum, w) * a for w, a in zip(speeds, accelerations, strict=True))
        expected = rate - sp.diff(energy, angle) - torques[at]
        assert sp.simplify(sp.expand(found[at] - expected)) == 0


def test_a_ratio_of_the_speed_itself_enters_a() -> None:
    """p = m (c w)^2... : v = c w w, (m v n)' with n = c w: two parts in A, none left over."""
    equations = bg.derive(_moving_mass("c*omega"), outputs=[])
    c = sp.Symbol("c")
    # v = c w^2, F = m v' = 2 m c w w', torque c w F.
    assert sp.expand(equations.A[0] - (J + 2 * m * c**2 * SPEED**2)) == 0
    assert sp.zeros(1, 1) == equations.J


def test_a_ratio_of_time_enters_j() -> None:
    """v = n w, n = 1 + t: (m n w)' = m n w' + m w."""
    equations = bg.derive(_moving_mass("1 + t"), outputs=[])
    assert sp.expand(equations.A[0] - (J + m * (1 + t) ** 2)) == 0
    assert sp.expand(equations.J[0] + m * (1 + t)) == 0


def test_a_ratio_of_an_input_enters_e() -> None:
    """v = n w with n from outside: (m n w)' = m n w' + m w n', once and not twice."""
    nodes = [bg.Se("lever", "n"), bg.R("rest", 1)]
    equations = bg.derive(_moving_mass("n", *nodes, bonds="lever>rest"), outputs=[])
    n = sp.Symbol("n")
    assert sp.expand(equations.A[0] - (J + m * n**2)) == 0
    assert sp.zeros(1, 1) == equations.J
    assert equations.E[0, equations.inputs.index(n)] == -m * n * SPEED


def test_a_storage_that_loses_mass_has_its_rate_in_j() -> None:
    nodes = [bg.Se("push", "P"), bg.One("j"), bg.I("rocket", "m - k*t", flow="v")]
    equations = bg.derive(bond_graph(nodes, "push>j>rocket"))
    assert sp.Matrix([[m - k * t]]) == equations.A
    assert sp.Matrix([[k]]) == equations.J


def test_a_storage_modulated_by_a_position() -> None:
    """A capacitance c(x) beside a shaft with its own angle: (c e)' = i, c' = dc/dx v."""
    nodes = [bg.Sf("current", "i_s"), bg.Zero("plates"), bg.C("c", "c0/(d + x)", effort="u"),
             bg.Sf("slide", "v"), bg.Zero("end"), bg.R("rub", "b"), bg.De("none"),
             bg.One("moved"), bg.I("m", "m", flow="w"), bg.Df("place", integrate="x")]  # fmt: skip
    graph = bond_graph(nodes, "current>plates>c slide>end>rub end>none end>moved>m moved>place")
    equations = bg.derive(graph, outputs=[])
    c0, d, x, u, w = sp.symbols("c0 d x u w")
    c = c0 / (d + x)
    at = equations.states.index(u)
    assert sp.simplify(equations.A[at, at] - c) == 0
    assert sp.simplify(equations.J[at, at] + sp.diff(c, x) * w) == 0


def test_gyrators_and_resistances_are_modulated_by_signals_of_elsewhere() -> None:
    """A motor whose field current sets its constant, and a valve that a state opens."""
    nodes = [bg.Se("field", "u_f"), bg.One("coil"), bg.I("L_f", "L_f", flow="i_f"), bg.R("R_f", "R_f"),
             bg.Se("armature", "u_a"), bg.One("loop"), bg.I("L_a", "L_a", flow="i_a"),
             bg.GY("motor", "K*i_f"), bg.One("shaft"), bg.I("J", "J", flow="w"),
             bg.R("air", "c*w")]  # fmt: skip
    graph = bond_graph(
        nodes, "field>coil>L_f coil>R_f armature>loop>L_a loop>motor>shaft>J shaft>air"
    )
    equations = bg.derive(graph, outputs=[])
    K, c, i_f, w = sp.symbols("K c i_f w")
    assert (
        sp.Matrix([[-sp.Symbol("R_f"), 0, 0], [0, 0, -K * i_f], [0, K * i_f, -c * w]])
        == equations.J
    )
    assert not (equations.J + equations.J.T)[1, 2]


def test_a_signal_that_is_no_state_is_put_in_over_states() -> None:
    """The ratio follows the speed of the far shaft, which is 3 omega."""
    nodes = [bg.TF("gear", 3), bg.One("far", flow="fast"), bg.I("n", "n", priority=-1)]
    graph = _moving_mass("c*fast", *nodes, bonds="rot>gear>far>n")
    equations = bg.derive(graph, outputs=["slider"])
    assert sp.Symbol("fast") not in equations.A.free_symbols
    assert sp.expand(equations.F[0] - 3 * sp.Symbol("c") * SPEED) == 0


@pytest.mark.parametrize(
    ("ratio", "error", "message"),
    [
        (
            "f_slider",
            bg.AlgebraicLoopError,
            "depends on f_slider, which depends on that value at once",
        ),
        ("e_m", bg.DependentSourceError, "'m' gives, and so on the rates of states"),
    ],
)
def test_a_value_that_depends_on_itself_is_refused(
    ratio: str, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        bg.derive(_moving_mass(ratio), outputs=[])


def test_detectors_draw_no_power_and_add_no_input() -> None:
    bare = bg.derive(_moving_mass("r"), outputs=["slider"])
    nodes = [bg.Zero("between"), bg.De("gauge", effort="p", integrate="impulse"), bg.Df("tacho")]
    graph = _moving_mass("r", *nodes, bonds="rot>tacho")
    graph.remove_edge("crank", "slider")
    graph.add_edges_from([("crank", "between"), ("between", "slider"), ("between", "gauge")])
    equations = bg.derive(graph, outputs=["slider", "gauge", "tacho"])
    assert (equations.A, equations.B, equations.inputs) == (bare.A, bare.B, bare.inputs)
    assert equations.integrals == {
        theta: sp.Symbol("f_angle"),
        sp.Symbol("impulse"): sp.Symbol("p"),
    }
    assert [str(name) for name in equations.outputs] == ["f_slider", "p", "f_tacho"]


def test_states_and_integrals_have_names_of_their_own() -> None:
    with pytest.raises(bg.StructureError, match="both impose a variable theta"):
        bg.derive(_moving_mass("r", bg.Df("other", integrate="theta"), bonds="rot>other"))
