"""The passive differentials against Figs. 1 to 4 and eqs. (6) to (12), typed in from the paper."""

import pytest
import sympy as sp

import bondgraph as bg
import differentials

i, I_i, I_c, I_1, I_2, I_w, I_w1, I_w2 = sp.symbols("i I_i I_c I_1 I_2 I_w I_w1 I_w2")
k, b, k_1, k_2, k_is, b_is = sp.symbols("k b k_1 k_2 k_is b_is")
tau_e, tau_t1, tau_t2 = sp.symbols("tau_e tau_t1 tau_t2")
HALF = sp.Rational(1, 2)
a = i**2 * I_i / 4
A_6 = [[I_w1 + a, a], [a, I_w2 + a]]
B_6 = [[i / 2, -1, 0], [i / 2, 0, -1]]


def same(found: sp.Matrix, expected: list[list[object]]) -> bool:
    difference = sp.Matrix(found) - sp.Matrix(expected)
    return difference.applyfunc(sp.cancel).is_zero_matrix is True


def names(symbols: tuple[sp.Symbol, ...]) -> str:
    return " ".join(str(symbol) for symbol in symbols)


def dependent(name: str, **variant: bool) -> set[object]:
    return set(bg.assign_causality(differentials.graph(name, **variant)).derivative)


def rates(model: bg.StateEquations) -> sp.Matrix:
    x, u = sp.Matrix(model.states), sp.Matrix(model.inputs)
    return sp.Matrix(model.A).LUsolve(model.J * x + model.B * u)


@pytest.mark.parametrize("halfshafts", [False, True])
def test_fig1_the_case_turns_at_the_mean_of_the_outputs(halfshafts: bool) -> None:
    """w_i = i (w_1 + w_2)/2, and the case i times slower."""
    found = bg.derive(differentials.graph("passive", halfshafts), outputs=["input", "case"])
    assert names(found.outputs) == "omega_e omega_c"
    assert same(found.F[:, :2], [[i / 2, i / 2], [HALF, HALF]])
    assert not found.F[:, 2:].todok()


def test_eq6_the_rigid_model() -> None:
    found = differentials.equations("passive")
    assert names(found.states) == "omega_1 omega_2"
    assert names(found.inputs) == "tau_e tau_t1 tau_t2"
    assert (found.outputs, found.F.shape) == ((), (0, 2))
    assert dependent("passive") == {"I_i"}
    assert same(found.A, A_6)
    assert same(found.J, [[0, 0], [0, 0]])
    assert same(found.B, B_6)


def test_eq7_the_slipping_input_clutch() -> None:
    """I_i w_e' = tau_e - tau_i, I_wj w_j' = i tau_i/2 - tau_tj; slip w_e - w_i."""
    found = differentials.equations("passive_input_clutch")
    assert names(found.states) == "omega_e omega_1 omega_2"
    assert names(found.inputs) == "tau_e tau_f tau_t1 tau_t2"
    assert names(found.outputs) == "omega_f"
    assert dependent("passive_input_clutch") == set()
    assert same(found.A, sp.diag(I_i, I_w1, I_w2).tolist())
    assert same(found.J, sp.zeros(3, 3).tolist())
    assert same(found.B, [[1, -1, 0, 0], [0, i / 2, -1, 0], [0, i / 2, 0, -1]])
    assert same(found.F, [[1, -i / 2, -i / 2]])


def test_eq8_the_torque_that_holds_the_input_clutch() -> None:
    found = bg.holding_efforts(differentials.equations("passive_input_clutch"), ["clutch"])
    tires = i * I_i * tau_t1 / (2 * I_w1) + i * I_i * tau_t2 / (2 * I_w2)
    expected = (tau_e + tires) / (1 + i**2 * I_i / (4 * I_w1) + i**2 * I_i / (4 * I_w2))
    assert [str(symbol) for symbol in found] == ["tau_f"]
    assert sp.cancel(found[sp.Symbol("tau_f")] - expected) == 0


def test_the_locked_input_clutch_leaves_eq6() -> None:
    found = bg.linearize(differentials.equations("passive_input_clutch"), stuck=["clutch"])
    assert names(found.states) == "omega_1 omega_2"
    assert names(found.inputs) == "tau_e tau_t1 tau_t2"
    assert same(found.A, A_6)
    assert same(found.J, [[0, 0], [0, 0]])
    assert same(found.B, B_6)


def test_the_holding_torque_makes_the_slipping_model_move_as_eq6() -> None:
    """Eq. (8) put into eq. (7) gives the output accelerations of eq. (6), the input's i times their mean."""
    slipping = differentials.equations("passive_input_clutch")
    held = rates(slipping).subs(dict(bg.holding_efforts(slipping, ["clutch"])))
    rigid = sp.Matrix(A_6).LUsolve(sp.Matrix(B_6) * sp.Matrix([tau_e, tau_t1, tau_t2]))
    expected = [[i * (rigid[0] + rigid[1]) / 2], [rigid[0]], [rigid[1]]]
    assert same(held, expected)


def test_eq9_the_compliant_input_shaft() -> None:
    """I_i w_e' = tau_e - tau_is, tau_is = k_is theta + b_is (w_e - w_i), w_i = i (w_1 + w_2)/2."""
    graph = differentials.graph("passive_input_shaft")
    found = bg.derive(graph, outputs=["input_shaft"])
    assert names(found.states) == "omega_e omega_1 omega_2 tau_kis"
    assert names(found.inputs) == "tau_e tau_t1 tau_t2"
    assert dependent("passive_input_shaft") == set()
    assert same(found.A, sp.diag(I_i, I_w1, I_w2, 1 / k_is).tolist())
    whole = sp.Matrix([[b_is, -b_is * i / 2, -b_is * i / 2, 1]])
    twist = sp.Matrix([[1, -i / 2, -i / 2, 0]])
    rows = [-whole, i / 2 * whole, i / 2 * whole, twist]
    assert same(found.J, sp.Matrix.vstack(*rows).tolist())
    assert same(found.B, [[1, 0, 0], [0, -1, 0], [0, 0, -1], [0, 0, 0]])
    assert names(found.outputs) == "tau_is"
    assert same(found.F, whole.tolist())
    assert differentials.equations("passive_input_shaft").F.shape == (0, 4)


def test_eqs10_and_11_halfshafts_on_massless_outputs() -> None:
    """The torques are equal: one state, I_i w_e' = tau_e - 2 tau/i, I_wj w_tj' = tau - tau_tj."""
    found = differentials.equations("passive_halfshafts")
    assert names(found.states) == "omega_e tau_k1 omega_t1 omega_t2"
    assert names(found.inputs) == "tau_e tau_t1 tau_t2"
    assert dependent("passive_halfshafts") == {"halfshaft_2_spring"}
    assert same(found.A, sp.diag(I_i, 1 / k_1 + 1 / k_2, I_w1, I_w2).tolist())
    assert same(found.J, [[0, -2 / i, 0, 0], [2 / i, 0, -1, -1], [0, 1, 0, 0], [0, 1, 0, 0]])
    assert same(found.B, [[1, 0, 0], [0, 0, 0], [0, -1, 0], [0, 0, -1]])
    assert found.F.shape == (0, 4)


def test_eq10_the_common_torque_rises_with_both_springs_in_series() -> None:
    graph = differentials.graph("passive_halfshafts")
    found = bg.derive(graph, outputs=["halfshaft_1", "halfshaft_2"])
    omega_e, _, omega_t1, omega_t2 = found.states
    k_e = k_1 * k_2 / (k_1 + k_2)
    assert sp.cancel(rates(found)[1] - k_e * (2 * omega_e / i - omega_t1 - omega_t2)) == 0
    assert names(found.outputs) == "tau_hs1 tau_hs2"
    assert same(found.F, [[0, 1, 0, 0], [0, 1, 0, 0]])


def test_eq12_halfshafts_and_output_inertias() -> None:
    """Eq. (6) with tau_hs for tau_t; tau_hs' = k (w - w_t) + b (w' - w_t'), I_w w_t' = tau_hs - tau_t."""
    graph = differentials.graph("passive", halfshafts=True)
    found = bg.derive(graph, outputs=["halfshaft_1", "halfshaft_2"])
    assert names(found.states) == "omega_1 omega_2 tau_k1 tau_k2 omega_t1 omega_t2"
    assert names(found.inputs) == "tau_e tau_t1 tau_t2"
    assert dependent("passive", halfshafts=True) == {"I_i"}
    outputs = sp.Matrix([[I_1 + a, a], [a, I_2 + a]])
    assert same(found.A, sp.diag(outputs, 1 / k, 1 / k, I_w, I_w).tolist())
    tau_hs = [[b, 0, 1, 0, -b, 0], [0, b, 0, 1, 0, -b]]
    twists = [[1, 0, 0, 0, -1, 0], [0, 1, 0, 0, 0, -1]]
    assert same(found.J, (-sp.Matrix(tau_hs)).tolist() + twists + tau_hs)
    rows = [[i / 2, 0, 0], [i / 2, 0, 0], [0] * 3, [0] * 3, [0, -1, 0], [0, 0, -1]]
    assert same(found.B, rows)
    assert names(found.outputs) == "tau_hs1 tau_hs2"
    assert same(found.F, tau_hs)


@pytest.mark.parametrize("halfshafts", [False, True])
def test_fig4_the_case_is_referred_to_the_input(halfshafts: bool) -> None:
    """I_i* = I_i + I_c/i^2, and rigid I_wj* = I_wj + I_j; all but the outputs are dependent."""
    found = bg.derive(differentials.graph("passive", halfshafts, lumped=False), outputs=[])
    lumped = differentials.equations("passive", halfshafts)
    values = {I_i: I_i + I_c / i**2} | ({} if halfshafts else {I_w1: I_w1 + I_1, I_w2: I_w2 + I_2})
    extra = {"I_i", "I_c"} | (set() if halfshafts else {"I_1", "I_2"})
    assert dependent("passive", halfshafts=halfshafts, lumped=False) == extra
    assert same(found.A, lumped.A.subs(values, simultaneous=True).tolist())
    assert (found.J, found.B) == (lumped.J, lumped.B)


def test_a_locked_alsd_is_a_spool() -> None:
    """w_1 = w_2 = w: (I_w1 + I_w2 + i^2 I_i) w' = i tau_e - tau_t1 - tau_t2."""
    alsd = differentials.equations("alsd")
    spool = bg.linearize(alsd, stuck=["clutch"])
    assert names(spool.states) == "omega_2"
    assert names(spool.inputs) == "tau_e tau_t1 tau_t2"
    inertia = I_w1 + I_w2 + i**2 * I_i
    assert same(spool.A, [[inertia]])
    assert same(spool.B, [[i, -1, -1]])
    rate = (i * tau_e - tau_t1 - tau_t2) / inertia
    held = bg.holding_efforts(alsd, ["clutch"])[sp.Symbol("tau_f")]
    assert sp.cancel(held - (tau_t2 - tau_t1 - (I_w1 - I_w2) * rate)) == 0


def test_a_locked_full_alsd_is_a_spool_on_two_halfshafts() -> None:
    alsd = differentials.equations("alsd", halfshafts=True)
    spool = bg.linearize(alsd, stuck=["clutch"])
    assert names(spool.states) == "omega_2 tau_k1 tau_k2 omega_t1 omega_t2"
    assert same(spool.A, sp.diag(I_1 + I_2 + i**2 * I_i, 1 / k, 1 / k, I_w, I_w).tolist())
    tau_hs = [[b, 1, 0, -b, 0], [b, 0, 1, 0, -b]]
    twists = [[1, 0, 0, -1, 0], [1, 0, 0, 0, -1]]
    assert same(spool.J, [[-2 * b, -1, -1, b, b], *twists, *tau_hs])
    assert same(spool.B, [[i, 0, 0], [0] * 3, [0] * 3, [0, -1, 0], [0, 0, -1]])
    omega_1, omega_2, tau_k1, tau_k2, omega_t1, omega_t2 = alsd.states
    left, right = tau_k1 + b * (omega_1 - omega_t1), tau_k2 + b * (omega_2 - omega_t2)
    rate = (i * tau_e - left - right) / (I_1 + I_2 + i**2 * I_i)
    held = bg.holding_efforts(alsd, ["clutch"])[sp.Symbol("tau_f")]
    assert sp.cancel(held - (right - left - (I_1 - I_2) * rate)) == 0
