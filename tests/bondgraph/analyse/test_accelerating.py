"""Linear models at points where states accelerate: what A and what is held gain by that, by hand."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences

import bondgraph as bg
from codegen import Simulator, simulator

J, m, r, c, n, theta, omega, tau, w0, th0, T0 = sp.symbols("J m r c n theta omega tau w0 th0 T0")
POINT = {theta: 0.7, omega: 3.0, tau: 1.5, J: 0.5, m: 2.0, r: 0.3, c: 0.1}
NUMBERS = {"J": 0.5, "m": 2.0, "r": 0.3, "c": 0.1, "l": 0.9, "k": 3.0}


def _crank(*more: tuple, ratio: str = "r*sin(theta)", bonds: str = "slider>m") -> bg.StateEquations:
    """J turns at omega and drives a slider at ratio * omega."""
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", ratio), bg.One("slider", flow="v"),
             *more]  # fmt: skip
    return bg.derive(
        bond_graph(nodes, f"drive>rot>J rot>angle rot>crank>slider {bonds}"), outputs=[]
    )


MASS = bg.I("m", "m", priority=-1)
GAS = bg.R("gas", law="c*f_gas**3")


def _by_hand(ratio: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """``I = J + m q^2`` and w' of ``I w' = tau - m q q' w^2 - q c (q w)^3``, v = q w against a gas."""
    inertia = J + m * ratio**2
    push = tau - m * ratio * sp.diff(ratio, theta) * omega**2 - ratio * c * (ratio * omega) ** 3
    return inertia, push / inertia


@pytest.mark.parametrize(
    ("ratio", "shown"),
    [
        ("r*sin(theta)", ["e_m"]),
        # With its rod.
        ("r*sin(theta) + r**2*sin(2*theta)/(2*sqrt(1 - r**2*sin(theta)**2))", []),
    ],
)
def test_a_slider_crank_deviates_as_lagrange_says(ratio: str, shown: list[str]) -> None:
    """x' = f(x, u) by hand, and its derivatives, at a point that accelerates."""
    at = {"theta": 0.7, "omega": 3.0, "tau": 1.5}
    equations = _crank(MASS, GAS, ratio=ratio, bonds="slider>m slider>gas")
    model = bg.linearize(equations, at=at, outputs=shown).numeric(NUMBERS)
    q = sp.sympify(ratio, {"theta": theta, "r": r})
    _, rate = _by_hand(q)
    # m (q omega)'
    force = m * (q * rate + sp.diff(q, theta) * omega**2)
    rows = [(rate, model.P[0], model.Q[0]), *((force, model.F[0], model.D[0]) for _ in shown)]
    for value, row, drive in rows:
        expected = [float(sp.diff(value, name).subs(POINT)) for name in (omega, theta, tau)]
        assert [*row, *drive] == pytest.approx(expected, rel=1e-12)
    assert model.P[1].tolist() == [1.0, 0.0]


def test_the_term_of_the_inertia_in_symbols() -> None:
    """(J + m r^2 sin^2) w' = tau - m r^2 sin cos w^2: dA/dtheta w' = m r^2 sin(2 theta) w' stands in J."""
    at = {"theta": "th0", "omega": "w0", "tau": "T0"}
    model = bg.linearize(_crank(MASS), at=at)
    inertia, rate = (
        e.subs({c: 0, theta: th0, omega: w0, tau: T0}) for e in _by_hand(r * sp.sin(theta))
    )
    sine = m * r**2 * sp.sin(2 * th0)
    wanted = [[-sine * w0, -m * r**2 * sp.cos(2 * th0) * w0**2 - sine * rate], [1, 0]]
    assert differences(model.A, [[inertia, 0], [0, 1]]) == {}
    assert (model.J - sp.Matrix(wanted)).applyfunc(sp.simplify).is_zero_matrix


def test_a_point_at_rest_needs_no_more_than_slopes_do() -> None:
    """Where A does not change with the angle nothing is asked of what accelerates."""
    model = bg.linearize(_crank(MASS), at={"theta": sp.pi / 2, "omega": 0})
    assert differences(model.A, [[J + m * r**2, 0], [0, 1]]) == {}
    with pytest.raises(
        bg.SignalError, match=r"tau counts at the operating point: give it a value in at"
    ):
        bg.linearize(_crank(MASS), at={"theta": 1, "omega": 0})
    given = bg.linearize(_crank(MASS), at={"theta": 1, "omega": 0, "tau": 0})
    assert differences(given.J, [[0, 0], [1, 0]]) == {}


@pytest.mark.parametrize("rate", [0, "2"])
def test_a_gear_that_an_input_sets_while_it_moves(rate: object) -> None:
    """(J + m n^2) w' = tau - m n n' w at n = 2, n' as told."""
    more = [bg.Se("lever", "n"), bg.R("rest", 1)]
    equations = _crank(MASS, *more, ratio="n", bonds="slider>m lever>rest")
    at = {"omega": 3, "tau": 5, "n": 2, "theta": 0}
    model = bg.linearize(equations, at=at, rates={"n": rate}, inputs=["tau", "n"])
    speed = sp.Symbol("n_rate")
    acceleration = (tau - m * n * speed * omega) / (J + m * n**2)
    there = {omega: 3, tau: 5, n: 2, speed: rate}
    wanted = {name: sp.diff(acceleration, name).subs(there) for name in (omega, tau, n, speed)}
    numbers = model.numeric({"J": 0.5, "m": 2})
    found = numbers.P[0, 0], *numbers.Q[0], numbers.R[0, 1]
    expected = [float(wanted[name].subs({J: 0.5, m: 2})) for name in (omega, tau, n, speed)]
    assert found == pytest.approx(expected, rel=1e-12)
    for unknown in ("omega", "nobody"):
        with pytest.raises(bg.SignalError, match=f"rates: no open input is called {unknown}"):
            bg.linearize(equations, at=at, rates={unknown: 1})


def _clutched(ratio: str = "r*sin(theta)", twins: bool = False) -> bg.StateEquations:
    """The slider hangs on dry friction, which holds it where it sticks; twins share what they hold."""
    extra = [GAS, bg.Zero("z"), bg.R("clutch", effort="F", law=bg.DryFriction("N")), bg.One("k"),
             bg.I("mass", "m", flow="u", priority=-2)]  # fmt: skip
    extra += [bg.R("twin", law=bg.DryFriction("N"))] if twins else []
    bonds = "slider>gas slider>z>clutch z>k>mass" + " z>twin" * twins
    return _crank(*extra, ratio=ratio, bonds=bonds)


@pytest.mark.parametrize("twins", [False, True])
def test_what_friction_holds_behind_a_crank_is_the_crank_alone(twins: bool) -> None:
    """Stuck, u = q omega: the slider-crank again; F is what moves the mass, m (q omega)'."""
    q = r * sp.sin(theta)
    _, rate = _by_hand(q)
    force = m * (q * rate + sp.diff(q, theta) * omega**2)
    at = {"theta": 0.7, "omega": 3.0, "tau": 1.5, "u": 0.9 * float(sp.sin(0.7))}
    shown = {"u": q * omega, "e_mass": force} | ({} if twins else {"F": force})
    equations = _clutched(twins=twins)
    stick = dict.fromkeys(["clutch", "twin"] if twins else ["clutch"], "stick")
    model = bg.linearize(equations, at=at, mode=stick, outputs=shown)
    assert list(map(str, model.states)) == ["omega", "theta"]
    numbers = model.numeric(NUMBERS)
    rows = [(rate, numbers.P[0], numbers.Q[0])]
    rows += zip(shown.values(), numbers.F, numbers.D, strict=True)
    for value, row, drive in rows:
        expected = [float(sp.diff(value, name).subs(POINT)) for name in (omega, theta, tau)]
        assert [*row, *drive] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    # What it holds may be told as well, as by a run.
    told = at | {"F": float(force.subs(POINT)), **({"e_twin": 0.0} if twins else {})}
    again = bg.linearize(equations, at=told, mode=stick, outputs=shown).numeric(NUMBERS)
    assert pytest.approx(numbers.P, rel=1e-12) == again.P
    with pytest.raises(bg.SignalError, match="tau counts at the operating point"):
        bg.linearize(equations, at={k: at[k] for k in at if k != "tau"}, mode=stick)


def test_what_is_held_behind_a_ratio_of_the_time() -> None:
    """u = n omega with n = 2 + sin t: (J + m n^2) w' = tau - m n n' w."""
    model = bg.linearize(
        _clutched("2 + sin(t)"), at={"t": 1, "omega": 3, "tau": 1, "theta": 0, "u": 6 + 3 * sp.sin(1)},
        laws={"gas": "0"}, mode={"clutch": "stick"}, outputs=["F"],
    )  # fmt: skip
    ratio, speed = 2 + np.sin(1), np.cos(1)
    numbers = model.numeric(NUMBERS)
    inertia = 0.5 + 2 * ratio**2
    assert numbers.P[0, 0] == pytest.approx(-2 * ratio * speed / inertia)
    # F = m (n omega)'
    assert numbers.F[0, 0] == pytest.approx(2 * (ratio * numbers.P[0, 0] + speed))
    assert numbers.Q[0, 0] == pytest.approx(1 / inertia)


def test_what_a_law_beyond_its_slope_does_to_what_is_held() -> None:
    """A pump takes c w^2, which m brings, u = c w^2, while J w' = tau: m takes m u' = 2 c m w tau/J."""
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="w"), bg.One("wheel"),
             bg.R("pump", gives="flow", law="c*w**2"), bg.Zero("z"), bg.R("clutch", law=bg.DryFriction("N")),
             bg.I("m", "m", flow="u", priority=-1)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "drive>rot>J z>pump z>clutch wheel>z wheel>m"))
    model = bg.linearize(
        equations, at={"w": "w0", "tau": "T0"}, mode={"clutch": "stick"}, outputs=["e_m"]
    )
    assert list(map(str, model.states)) == ["w"]
    assert differences(model.J, [[0]]) == {}
    assert differences(model.F, [[2 * c * m * T0 / J]]) == {}
    assert differences(model.D, [[2 * c * m * w0 / J]]) == {}


def test_a_level_beyond_its_slope_of_friction_that_slips_on_a_spring() -> None:
    """F = c p^2 on a spring k stretched at v, p' = n w: it slips at v - F'/k = v - 2 c p n w/k."""
    k, p0 = sp.symbols("k p0")
    law = bg.DryFriction("c*p**2")
    nodes = [bg.Sf("speed", "v"), bg.Zero("z"), bg.C("K", "1/k", effort="F"), bg.Sf("press", "w"),
             bg.C("n", "1/n", effort="p"), bg.R("a", effort="F_a", flow="s", law=law)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "speed>z z>K z>a press>n"))
    model = bg.linearize(
        equations, at={"p": "p0", "s": 1, "v": "v", "w": "w0"}, mode={"a": "slip"}, outputs=["s"]
    )
    states = [sp.Symbol("p")]
    assert list(model.states) == states
    assert differences(model.F, [[-2 * c * n * w0 / k]]) == {}
    assert differences(model.D, [[1, -2 * c * n * p0 / k]]) == {}


@pytest.fixture(scope="module")
def two_cranks() -> tuple[bg.StateEquations, Simulator]:
    """Two cranks on one shaft, a spring with a law and a storage whose value moves."""
    more = [bg.TF("cam", "r*cos(theta) + l"), bg.One("tappet", flow="h"),
            bg.I("M", "m*(2 + sin(theta))", priority=-1),
            bg.C("spring", law="k*q_spring + q_spring**3"), bg.R("oil", "c"), bg.Zero("gap"), bg.One("end"),
            bg.I("I", "J*(2 + cos(theta))", flow="w")]  # fmt: skip
    equations = _crank(
        MASS,
        GAS,
        *more,
        bonds="slider>m slider>gas rot>cam>tappet>M tappet>gap>spring gap>oil gap>end>I",
    )
    return equations, simulator(equations, NUMBERS)


@pytest.mark.parametrize("seed", range(3))
def test_models_are_the_slopes_of_rates_at_points_that_accelerate(
    seed: int, two_cranks: tuple[bg.StateEquations, Simulator]
) -> None:
    rng = np.random.default_rng(seed)
    equations, run = two_cranks
    x, u = rng.uniform(0.3, 1.5, len(run.states)), rng.uniform(1, 2, len(run.inputs))
    at = dict(zip((*run.states, *run.inputs), map(float, [*x, *u]), strict=True))
    model = bg.linearize(equations, at=at).numeric(NUMBERS)
    assert (*model.states, *model.inputs) == (*run.states, *run.inputs)
    step = 1e-5 * np.eye(len(at))
    count = len(x)
    ends = [[run.rhs(0, x + h[:count], u + h[count:]) for h in (dh, -dh)] for dh in step]
    slopes = np.array([over - under for over, under in ends]).T / 2e-5
    assert np.hstack([model.P, model.Q]) == pytest.approx(slopes, rel=1e-7, abs=1e-7)


def test_what_is_held_behind_a_ratio_that_an_input_sets() -> None:
    """Stuck, u = n w: (J + m n^2) w' = tau - m n n' w, and F = m (n w)'."""
    extra = [bg.Zero("z"), bg.R("clutch", effort="F", law=bg.DryFriction("N")), bg.One("k"),
             bg.I("mass", "m", flow="u", priority=-2), bg.Se("lever", "n"), bg.R("rest", 1)]  # fmt: skip
    equations = _crank(*extra, ratio="n", bonds="slider>z>clutch z>k>mass lever>rest")
    at = {"omega": 3, "tau": 5, "n": 2, "theta": 0, "u": 6}
    model = bg.linearize(equations, at=at, rates={"n": 4}, mode={"clutch": "stick"}, outputs=["F"])
    rate = sp.Symbol("n_rate")
    acceleration = (tau - m * n * rate * omega) / (J + m * n**2)
    names = (omega, tau, n, rate)
    there = {omega: 3, tau: 5, n: 2, rate: 4, J: 0.5, m: 2}
    numbers = model.numeric({"J": 0.5, "m": 2})
    force = m * (n * acceleration + rate * omega)
    found = numbers.P[0, 0], *numbers.Q[0], numbers.R[0, 1]
    shown = numbers.F[0, 0], *numbers.D[0], numbers.G[0, 1]
    for value, row in ((acceleration, found), (force, shown)):
        expected = [float(sp.diff(value, name).subs(there)) for name in names]
        assert row == pytest.approx(expected, rel=1e-12)


def test_what_holds_beside_a_resistance_behind_a_crank() -> None:
    """All of q w goes through the damper: J w' = tau - c q^2 w, and the clutch takes c q w."""
    extra = [bg.Zero("z"), bg.R("clutch", effort="F", law=bg.DryFriction("N")), bg.R("oil", "c")]
    equations = _crank(*extra, bonds="slider>z>clutch z>oil")
    at = {"omega": "w0", "theta": "th0", "tau": "T0"}
    model = bg.linearize(equations, at=at, mode={"clutch": "stick"}, outputs=["F"])
    q, slope = r * sp.sin(th0), r * sp.cos(th0)
    assert differences(model.J, [[-c * q**2, -2 * c * q * slope * w0], [1, 0]]) == {}
    assert differences(model.F, [[c * q, c * slope * w0]]) == {}


def test_laws_in_a_loop_tell_what_accelerates_where_they_are_affine() -> None:
    """e_p = a e_q + d w and e_q = b e_p: e_p = d w/(1 - a b), which the point does not tell."""
    ports = [bg.R("p", law="a*e_q + d*omega"), bg.R("q", law="b*e_p")]
    equations = _crank(MASS, *ports, bonds="slider>m rot>p rot>q")
    a, b, d = sp.symbols("a b d")
    drag = d * (1 + b) / (1 - a * b)
    at = {"omega": "w0", "theta": "th0", "tau": "T0"}
    model = bg.linearize(equations, at=at)
    inertia = J + m * r**2 * sp.sin(th0) ** 2
    moved = m * r**2 * sp.sin(th0) * sp.cos(th0)
    rate = (T0 - moved * w0**2 - drag * w0) / inertia
    expected = -m * r**2 * sp.cos(2 * th0) * w0**2 - 2 * moved * rate
    assert sp.simplify(model.J[0, 1] - expected) == 0
    assert sp.simplify(model.J[0, 0] + 2 * moved * w0 + drag) == 0
