"""Mechanical systems of bond graph textbooks, against Newton's, Euler's and Lagrange's equations."""

from collections.abc import Mapping

import sympy as sp
from references.build import Node, bond_graph
from references.matrices import differences
from references.textbook import agree, rates, transfer
from rig.walked import WALKED

import bondgraph as bg

pytestmark = WALKED


def _rates(nodes: list[Node], bonds: str, energy: bool = True) -> dict[str, sp.Expr]:
    return rates(bond_graph(nodes, bonds), energy)


QUARTER_CAR: list[Node] = [
    bg.Sf("road", "V"), bg.Zero("patch"), bg.C("tire", "1/k_t"), bg.One("wheel"),
    bg.I("unsprung", "m_u"), bg.Se("weight_u", "W_u"), bg.Zero("gap"), bg.One("strut"),
    bg.C("spring", "1/k_s"), bg.R("damper", "b"), bg.One("body"), bg.I("sprung", "m_s"),
    bg.Se("weight_s", "W_s"),
]  # fmt: skip
QUARTER_CAR_BONDS = (
    "road>patch>tire patch>wheel>unsprung weight_u>wheel wheel>gap>strut>spring strut>damper "
    "gap>body>sprung weight_s>body"
)


def test_a_quarter_car() -> None:
    """Karnopp, Margolis, Rosenberg, System Dynamics: the quarter car on a road of velocity V.

    Newton for both masses; both deflections count as compression.
    """
    strut = "k_s*q_spring + b*(p_unsprung/m_u - p_sprung/m_s)"
    agree(
        _rates(QUARTER_CAR, QUARTER_CAR_BONDS),
        {
            "q_tire": "V - p_unsprung/m_u",
            "p_unsprung": f"k_t*q_tire - ({strut}) + W_u",
            "q_spring": "p_unsprung/m_u - p_sprung/m_s",
            "p_sprung": f"{strut} + W_s",
        },
    )


def test_a_quarter_cars_transmissibility() -> None:
    """The body over the road by elimination from ``m_s x'' = (b s + k_s)(y - x)`` and the wheel's law."""
    equations = bg.derive(bond_graph(QUARTER_CAR, QUARTER_CAR_BONDS), outputs=["body"])
    assert str(equations.inputs[0]) == "V"
    below = (
        "m_u*m_s*s**4 + b*(m_u + m_s)*s**3 + (m_s*(k_s + k_t) + m_u*k_s)*s**2 + b*k_t*s + k_s*k_t"
    )
    expected = bg.expression(f"k_t*(b*s + k_s)/({below})", "expected")
    assert sp.cancel(transfer(equations) - expected) == 0


def test_a_half_car_heaves_and_pitches() -> None:
    """After Karnopp, Margolis, Rosenberg: a rigid body on two struts at a and b from its centre.

    The ends move with ``v + a w`` and ``v - b w``.
    """
    nodes: list[Node] = [bg.One("heave"), bg.I("m", "m"), bg.One("pitch"), bg.I("J", "J_y"),
                         bg.Se("weight", "W")]  # fmt: skip
    bonds = "heave>m pitch>J weight>heave "
    for end, arm in (("f", "1/a"), ("r", "-1/b")):
        nodes += [bg.Sf(f"road_{end}", f"V_{end}"), bg.Zero(f"end_{end}"), bg.One(f"strut_{end}"),
                  bg.C(f"k_{end}", f"1/k{end}"), bg.R(f"c_{end}", f"c{end}"),
                  bg.TF(f"arm_{end}", arm)]  # fmt: skip
        bonds += f"road_{end}>end_{end}>strut_{end}>k_{end} strut_{end}>c_{end} "
        bonds += f"end_{end}>heave end_{end}>arm_{end}>pitch "
    front = "(V_f - p_m/m - a*p_J/J_y)"
    rear = "(V_r - p_m/m + b*p_J/J_y)"
    agree(
        _rates(nodes, bonds),
        {
            "q_k_f": front,
            "q_k_r": rear,
            "p_m": f"W + kf*q_k_f + cf*{front} + kr*q_k_r + cr*{rear}",
            "p_J": f"a*(kf*q_k_f + cf*{front}) - b*(kr*q_k_r + cr*{rear})",
        },
    )


def test_a_rigid_bar_between_two_masses_follows_them() -> None:
    """After Karnopp, Margolis, Rosenberg: mass and moment of inertia of a bar are both dependent.

    Kinetic energy with ``v = (b v_f + a v_r)/(a + b)`` and ``w = (v_f - v_r)/(a + b)``.
    """
    nodes: list[Node] = [
        bg.Se("push_f", "F_f"), bg.One("f"), bg.I("m_f", "m_1", flow="v_f"), bg.Se("push_r", "F_r"),
        bg.One("r"), bg.I("m_r", "m_2", flow="v_r"), bg.TF("fh", "b/(a + b)"),
        bg.TF("rh", "a/(a + b)"), bg.Zero("centre"), bg.One("heave"), bg.I("m", "m", priority=-1),
        bg.TF("fp", "1/(a + b)"), bg.TF("rp", "-1/(a + b)"), bg.Zero("turn"), bg.One("pitch"),
        bg.I("J", "J_y", priority=-1),
    ]  # fmt: skip
    graph = bond_graph(
        nodes,
        "push_f>f>m_f push_r>r>m_r f>fh>centre r>rh>centre>heave>m f>fp>turn r>rp>turn>pitch>J",
    )
    equations = bg.derive(graph, outputs=["heave", "pitch"])
    a, b, m, J, m_1, m_2 = sp.symbols("a b m J_y m_1 m_2")
    span = (a + b) ** 2
    mutual = (m * a * b - J) / span
    mass = [[m_1 + (m * b**2 + J) / span, mutual], [mutual, m_2 + (m * a**2 + J) / span]]
    assert equations.states == sp.symbols("v_f v_r")
    assert differences(equations.A, mass) == {}
    assert (equations.J.todok(), equations.E.todok()) == ({}, {})
    assert differences(equations.B, sp.eye(2)) == {}
    assert differences(equations.F, sp.Matrix([[b, a], [1, -1]]) / (a + b)) == {}


def test_a_rack_and_its_pinion_are_one_inertia() -> None:
    """After Karnopp, Margolis, Rosenberg, rack and pinion: ``(J + m r^2) w' = T - b r^2 w - r F_k``."""
    nodes: list[Node] = [
        bg.Se("drive", "T"), bg.One("pinion"), bg.I("J", "J_p", flow="w"), bg.TF("mesh", "r"),
        bg.One("rack"), bg.I("m", "m"), bg.R("b", "b"), bg.C("k", "1/k", effort="F_k"),
    ]  # fmt: skip
    equations = bg.derive(
        bond_graph(nodes, "drive>pinion>J pinion>mesh>rack>m rack>b rack>k"), outputs=["rack"]
    )
    J, m, r, b, k = sp.symbols("J_p m r b k")
    assert equations.states == sp.symbols("w F_k")
    assert differences(equations.A, sp.diag(J + m * r**2, 1 / k)) == {}
    assert differences(equations.J, [[-b * r**2, -r], [r, 0]]) == {}
    assert differences(equations.B, [[1], [0]]) == {}
    assert differences(equations.F, [[r, 0]]) == {}


def test_a_seismograph_shows_the_frames_displacement() -> None:
    """After Karnopp, Margolis, Rosenberg, seismic instrument: ``Q/V = m s/(m s^2 + b s + k)``."""
    nodes: list[Node] = [bg.Sf("frame", "V"), bg.Zero("gap"), bg.One("link"), bg.C("k", "1/k"),
                         bg.R("b", "b"), bg.One("mass"), bg.I("m", "m")]  # fmt: skip
    bonds = "frame>gap>link>k link>b gap>mass>m"
    agree(_rates(nodes, bonds), {"q_k": "V - p_m/m", "p_m": "k*q_k + b*(V - p_m/m)"})
    model = bg.linearize(bg.derive(bond_graph(nodes, bonds), outputs=[]), outputs=["e_k"])
    force = bg.expression("k*m*s/(m*s**2 + b*s + k)", "expected")
    assert sp.cancel(transfer(model) - force) == 0


CART: list[Node] = [
    bg.Se("push", "F"), bg.One("cart"), bg.I("M", "M", flow="v"), bg.One("rot"),
    bg.I("J", "J_c", flow="w"), bg.Df("angle", integrate="theta"), bg.TF("across", "l*cos(theta)"),
    bg.Zero("sum"), bg.One("x"), bg.I("m_x", "m", priority=-1), bg.TF("up", "-l*sin(theta)"),
    bg.One("y"), bg.I("m_y", "m", priority=-1), bg.Se("weight", "-m*g"),
]  # fmt: skip
CART_BONDS = "push>cart>M rot>J rot>angle rot>across>sum cart>sum>x>m_x rot>up>y>m_y weight>y"


def test_an_inverted_pendulum_on_a_cart_is_lagranges() -> None:
    """A classical mechanism: inverted pendulum on a cart, theta from upright.

    Lagrange: ``(M + m) v' + m l cos w' - m l sin w^2 = F``,
    ``m l cos v' + (J + m l^2) w' - m g l sin = 0``.
    """
    M, m, J, rod, g, F, w, theta = sp.symbols("M m J_c l g F w theta")
    coupling = m * rod * sp.cos(theta)
    mass = sp.Matrix([[M + m, coupling], [coupling, J + m * rod**2]])
    right = sp.Matrix([F + m * rod * sp.sin(theta) * w**2, m * g * rod * sp.sin(theta)])
    found = _rates(CART, CART_BONDS, energy=False)
    assert set(found) == {"v", "w", "theta"}
    assert found["theta"] == w
    rest = mass * sp.Matrix([found["v"], found["w"]]) - right
    # Sine and cosine by the tangent of half the angle, so that expanding the numerator decides.
    half = sp.Symbol("half")
    circle = {sp.sin(theta): 2 * half / (1 + half**2), sp.cos(theta): (1 - half**2) / (1 + half**2)}
    over = [sp.fraction(sp.together(row.xreplace(circle)))[0] for row in rest]
    assert [sp.expand(row) for row in over] == [0, 0]


def test_an_inverted_pendulum_near_upright() -> None:
    """The same cart: small angles turn the weight into a negative spring of m g l."""
    model = bg.linearize(
        bg.derive(bond_graph(CART, CART_BONDS), outputs=[]),
        at={"theta": 0, "w": 0, "v": 0},
    )
    M, m, J, rod, g = sp.symbols("M m J_c l g")
    assert model.states == sp.symbols("v w theta")
    mass = [[M + m, m * rod, 0], [m * rod, J + m * rod**2, 0], [0, 0, 1]]
    assert differences(model.A, mass) == {}
    assert differences(model.J, [[0, 0, 0], [0, 0, m * g * rod], [0, 1, 0]]) == {}
    assert differences(model.B[:, 0], [[1], [0], [0]]) == {}


def test_a_free_body_turns_by_eulers_equations() -> None:
    """Karnopp, Margolis, Rosenberg, System Dynamics: the ring of three modulated gyrators.

    Euler: ``J_1 w_1' = T_1 + (J_2 - J_3) w_2 w_3`` and round.
    """
    nodes: list[Node] = []
    bonds = ""
    for at in (1, 2, 3):
        nodes += [bg.One(f"axis_{at}"), bg.I(f"I_{at}", f"J_{at}", flow=f"w_{at}"),
                  bg.Se(f"T_{at}", f"T_{at}"), bg.GY(f"g_{at}", f"J_{at}*w_{at}")]  # fmt: skip
        bonds += f"axis_{at}>I_{at} T_{at}>axis_{at} "
    bonds += "axis_1>g_3>axis_2 axis_2>g_1>axis_3 axis_3>g_2>axis_1"
    agree(
        _rates(nodes, bonds, energy=False),
        {
            "w_1": "(T_1 + (J_2 - J_3)*w_2*w_3)/J_1",
            "w_2": "(T_2 + (J_3 - J_1)*w_3*w_1)/J_2",
            "w_3": "(T_3 + (J_1 - J_2)*w_1*w_2)/J_3",
        },
    )


def test_a_car_that_corners_at_constant_speed() -> None:
    """After Karnopp, Margolis, Rosenberg, vehicle dynamics: two wheels in line, slip velocity over U.

    ``m (v_y' + U w)`` is the sum of the tires' forces; a yaw moment from outside.
    """
    nodes: list[Node] = [
        bg.Sf("speed", "U"), bg.One("ahead"), bg.GY("frame", "m*w"), bg.One("aside"),
        bg.I("m", "m", flow="v_y"), bg.One("yaw"), bg.I("J", "J_z", flow="w"), bg.Se("moment", "M_z"),
        bg.Zero("front"), bg.TF("to_front", "a"), bg.R("tire_f", "C_f/U"), bg.Zero("rear"),
        bg.TF("to_rear", "-b"), bg.R("tire_r", "C_r/U"),
    ]  # fmt: skip
    bonds = (
        "speed>ahead aside>frame>ahead aside>m moment>yaw>J aside>front>tire_f yaw>to_front>front "
        "aside>rear>tire_r yaw>to_rear>rear"
    )
    front, rear = "C_f*(v_y + a*w)/U", "C_r*(v_y - b*w)/U"
    agree(
        _rates(nodes, bonds, energy=False),
        {"v_y": f"-U*w - ({front} + {rear})/m", "w": f"(M_z - a*{front} + b*{rear})/J_z"},
    )


def test_two_weights_over_a_pulley() -> None:
    """Atwood's machine: ``(J/r^2 + m_1 + m_2) v' = (m_1 - m_2) g``; one storage of three is free."""
    nodes: list[Node] = [
        bg.One("pulley"), bg.I("J", "J_p", priority=-1), bg.TF("rim_1", "r"), bg.One("down"),
        bg.I("one", "m_1", flow="v", priority=1), bg.Se("weight_1", "m_1*g"), bg.TF("rim_2", "r"),
        bg.One("up"), bg.I("two", "m_2", priority=-1), bg.Se("weight_2", "-m_2*g"),
    ]  # fmt: skip
    bonds = "pulley>J pulley>rim_1>down>one weight_1>down pulley>rim_2>up>two weight_2>up"
    agree(_rates(nodes, bonds, energy=False), {"v": "(m_1 - m_2)*g/(J_p/r**2 + m_1 + m_2)"})


def test_an_absorber_stills_the_mass_at_its_own_frequency() -> None:
    """After Den Hartog, undamped absorber; ``v/F = s (m s^2 + k)/(...)`` by Newton for both masses."""
    nodes: list[Node] = [
        bg.Se("shake", "F"), bg.One("main"), bg.I("M", "M"), bg.C("K", "1/K"), bg.Zero("between"),
        bg.C("k", "1/k"), bg.One("absorber"), bg.I("m", "m"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "shake>main>M main>K main>between>k between>absorber>m")
    expected = bg.expression("s*(m*s**2 + k)/((M*s**2 + K + k)*(m*s**2 + k) - k**2)", "expected")
    assert sp.cancel(transfer(bg.derive(graph, outputs=["main"])) - expected) == 0


def test_a_train_of_gears_reflects_its_inertias() -> None:
    """After Brown, Engineering System Dynamics: inertias behind ratios count with their squares."""
    nodes: list[Node] = [
        bg.Se("drive", "T"), bg.One("a"), bg.I("J_a", "J_1", flow="w"), bg.TF("first", "1/n_1"),
        bg.One("b"), bg.I("J_b", "J_2"), bg.TF("second", "1/n_2"), bg.One("c"), bg.I("J_c", "J_3"),
        bg.R("load", "c_l"),
    ]  # fmt: skip
    bonds = "drive>a>J_a a>first>b>J_b b>second>c>J_c c>load"
    total = "(J_1 + J_2/n_1**2 + J_3/(n_1*n_2)**2)"
    agree(_rates(nodes, bonds, energy=False), {"w": f"(T - c_l*w/(n_1*n_2)**2)/{total}"})


def _along(expr: sp.Expr, rates: Mapping[str, sp.Expr]) -> sp.Expr:
    """The rate of an expression over the states."""
    return sp.Add(*(sp.diff(expr, sp.Symbol(state)) * rate for state, rate in rates.items()))


def test_a_mass_on_an_elastic_string_obeys_lagrange_in_polar_coordinates() -> None:
    """A classical mechanism: masses along x and y, a spring along the radius.

    Lagrange: ``r'' = r theta'^2 - F/m - g sin``, ``r theta'' = -2 r' theta' - g cos``.
    """
    nodes: list[Node] = [
        bg.One("x"), bg.I("m_x", "m", flow="v_x"), bg.One("y"), bg.I("m_y", "m", flow="v_y"),
        bg.Se("weight", "-m*g"), bg.TF("xr", "cos(theta)"), bg.TF("yr", "sin(theta)"),
        bg.Zero("along"), bg.One("radius"), bg.C("k", "1/k", effort="F"), bg.Df("length", integrate="r"),
        bg.TF("xt", "-sin(theta)/r"), bg.TF("yt", "cos(theta)/r"), bg.Zero("across"),
        bg.One("turn"), bg.Df("angle", integrate="theta"),
    ]  # fmt: skip
    bonds = (
        "x>m_x y>m_y weight>y x>xr>along y>yr>along>radius>k radius>length "
        "x>xt>across y>yt>across>turn>angle"
    )
    found = _rates(nodes, bonds, energy=False)
    assert set(found) == {"v_x", "v_y", "F", "r", "theta"}
    r, theta, F, m, g, k = sp.symbols("r theta F m g k")
    radial = _along(found["r"], found) - r * found["theta"] ** 2 + F / m + g * sp.sin(theta)
    turning = r * _along(found["theta"], found) + 2 * found["r"] * found["theta"]
    assert sp.simplify(radial) == 0
    assert sp.simplify(turning + g * sp.cos(theta)) == 0
    assert sp.cancel(found["F"] - k * found["r"]) == 0
