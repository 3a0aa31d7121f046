"""The active differentials against Appendix B and eqs. (15), (16), typed in from the paper."""

from collections.abc import Callable, Sequence

import pytest
import sympy as sp
from oracles.exported import variant_of

import bondgraph as bg
import differentials

Matrices = tuple[sp.Matrix, sp.Matrix, sp.Matrix]
i, i_f, i_r, g, h1, h2, k, b = sp.symbols("i i_f i_r g h1 h2 k b")
I_i, I_w, I_c, I_gc, I_cf, I_ir = sp.symbols("I_i I_w I_c I_gc I_cf I_ir")
I_c1, I_c2, I_s1, I_s2, I_r1, I_r2 = sp.symbols("I_c1 I_c2 I_s1 I_s2 I_r1 I_r2")
OWN = I_1, I_2, I_3, I_4 = sp.symbols("I_1 I_2 I_3 I_4")
WITH_WHEELS = I_w1, I_w2, I_w3, I_w4 = sp.symbols("I_w1 I_w2 I_w3 I_w4")
HALF = sp.Rational(1, 2)
a = i**2 * I_i / 4


def alsd(out: Sequence[sp.Symbol]) -> Matrices:
    A = [[out[0] + a, a], [a, out[1] + a]]
    B = [[i / 2, -HALF, -1, 0], [i / 2, HALF, 0, -1]]
    return sp.Matrix(A), sp.Matrix(B), sp.Matrix([[HALF, -HALF]])


def superposition(out: Sequence[sp.Symbol]) -> Matrices:
    A = [[out[0] + a, a], [a, out[1] + a]]
    B = [[i / 2, -h1 / 2, -h2 / 2, -1, 0], [i / 2, 1 - h1 / 2, 1 - h2 / 2, 0, -1]]
    F = [[h1 / 2, h1 / 2 - 1], [h2 / 2, h2 / 2 - 1]]
    return sp.Matrix(A), sp.Matrix(B), sp.Matrix(F)


def stationary(out: Sequence[sp.Symbol]) -> Matrices:
    H11, H12 = h1 / (2 * (h1 - 1)), (2 - h1) / (2 * (h1 - 1))
    H21, H22 = h2 / (2 * (h2 - 1)), (2 - h2) / (2 * (h2 - 1))
    side = a - H11 * H12 * I_c1 - H21 * H22 * I_c2
    A = [
        [out[0] + a + H12**2 * I_c1 + H21**2 * I_c2, side],
        [side, out[1] + a + H11**2 * I_c1 + H22**2 * I_c2],
    ]
    B = [[i / 2, H12, -H21, -1, 0], [i / 2, -H11, H22, 0, -1]]
    return sp.Matrix(A), sp.Matrix(B), sp.Matrix([[-H12, H11], [H21, -H22]])


def four_wheel_drive(out: Sequence[sp.Symbol]) -> Matrices:
    G1, G2 = g * h1 * i_f / (2 * i_r), g * h2 * i_f / (2 * i_r)
    J = i_f**2 / 4 * (I_i + g**2 / i_r**2 * (h1**2 * I_s1 + h2**2 * I_s2))
    one, two = -G1 * (1 + h1) * I_s1, -G2 * (1 + h2) * I_s2
    A = [
        [out[0] + (1 + h1) ** 2 * I_s1, 0, one, one],
        [0, out[1] + (1 + h2) ** 2 * I_s2, two, two],
        [one, two, out[2] + J, J],
        [one, two, J, out[3] + J],
    ]
    B = [
        [0, -(1 + h1), 0, -1, 0, 0, 0],
        [0, 0, -(1 + h2), 0, -1, 0, 0],
        [i_f / 2, G1, G2, 0, 0, -1, 0],
        [i_f / 2, G1, G2, 0, 0, 0, -1],
    ]
    F = [[1 + h1, 0, -G1, -G1], [0, 1 + h2, -G2, -G2]]
    return sp.Matrix(A), sp.Matrix(B), sp.Matrix(F)


APPENDIX_B: dict[str, Callable[[Sequence[sp.Symbol]], Matrices]] = {
    "alsd": alsd,
    "superposition_tvd": superposition,
    "stationary_tvd": stationary,
    "four_wheel_drive_tvd": four_wheel_drive,
}
DEPENDENT = {
    "alsd": ["I_i"],
    "superposition_tvd": ["I_i"],
    "stationary_tvd": ["I_i", "I_c1", "I_c2"],
    "four_wheel_drive_tvd": ["I_i", "I_s1", "I_s2"],
}
LUMPED_INPUT = {
    "alsd": I_i + I_c / i**2,
    "superposition_tvd": I_i + (I_c + I_gc) / i**2,
    "stationary_tvd": I_i + (I_c + I_s1 + I_s2) / i**2,
    "four_wheel_drive_tvd": I_i + (g / i_r) ** 2 * (I_ir + I_r1 + I_r2) + I_cf / i_f**2,
}
LUMPED_OUTPUTS = {
    "alsd": [I_1, I_2],
    "superposition_tvd": [I_1, I_2],
    "stationary_tvd": [I_1 + I_r1, I_2 + I_r2],
    "four_wheel_drive_tvd": [I_c1, I_c2, I_3, I_4],
}
UNLUMPED = {
    "alsd": "I_i I_c",
    "superposition_tvd": "I_i I_c I_gc",
    "stationary_tvd": "I_i I_c I_s1 I_s2 I_c1 I_c2 I_r1 I_r2",
    "four_wheel_drive_tvd": "I_i I_cf I_ir I_r1 I_r2 I_s1 I_s2",
}
"""Dependent inertias that are elements of their own; rigid, each output's own, not its wheel's, joins."""

every = pytest.mark.parametrize("name", list(APPENDIX_B))


def same(found: sp.Matrix, expected: sp.Matrix) -> bool:
    assert found.shape == expected.shape
    return (sp.Matrix(found) - expected).applyfunc(sp.cancel).is_zero_matrix is True


def numbered(stem: str, count: int) -> list[str]:
    return [f"{stem}{j}" for j in range(1, count + 1)]


def signals(name: str) -> tuple[int, list[str], list[str]]:
    """How many outputs, the inputs and the slips."""
    wheels = 4 if name == "four_wheel_drive_tvd" else 2
    torques = ["tau_f"] if name == "alsd" else ["tau_f1", "tau_f2"]
    slips = ["omega_f"] if name == "alsd" else ["omega_f1", "omega_f2"]
    return wheels, ["tau_e", *torques, *numbered("tau_t", wheels)], slips


def text(symbols: Sequence[sp.Symbol]) -> list[str]:
    return [str(symbol) for symbol in symbols]


@every
def test_the_rigid_model_is_appendix_b(name: str) -> None:
    found = differentials.equations(name)
    A, B, F = APPENDIX_B[name](WITH_WHEELS)
    wheels, inputs, slips = signals(name)
    assert text(found.states) == numbered("omega_", wheels)
    assert (text(found.inputs), text(found.outputs)) == (inputs, slips)
    assert same(found.A, A)
    assert same(found.B, B)
    assert same(found.F, F)
    assert same(found.J, sp.zeros(wheels, wheels))


@every
def test_the_full_model_is_eqs_15_and_16(name: str) -> None:
    """tau_hs = tau_k + b (w - w_t) for tau_t, tau_k' = k (w - w_t), I_w w_t' = tau_hs - tau_t."""
    found = differentials.equations(name, halfshafts=True)
    A, B, F = APPENDIX_B[name](OWN)
    n, inputs, slips = signals(name)
    states = [*numbered("omega_", n), *numbered("tau_k", n), *numbered("omega_t", n)]
    assert len(states) == (12 if name == "four_wheel_drive_tvd" else 6)
    assert text(found.states) == states
    assert (text(found.inputs), text(found.outputs)) == (inputs, slips)
    one = sp.eye(n)
    assert same(found.A, sp.diag(A, one / k, I_w * one))
    side = sp.Matrix([[-b, -1, b], [1, 0, -1], [b, 1, -b]])
    assert same(found.J, sp.kronecker_product(side, one))
    inner = B[:, :-n]
    assert same(found.B, sp.diag(sp.Matrix.vstack(inner, sp.zeros(n, inner.cols)), -one))
    assert same(found.F, sp.Matrix.hstack(F, sp.zeros(F.rows, 2 * n)))


@every
@pytest.mark.parametrize("halfshafts", [False, True])
def test_the_inertias_that_do_not_own_a_state(name: str, halfshafts: bool) -> None:
    causal = bg.assign_causality(differentials.graph(name, halfshafts))
    assert sorted(map(str, causal.derivative)) == sorted(DEPENDENT[name])
    n, _, _ = signals(name)
    own = numbered("I_" if halfshafts else "I_w", n)
    full = [*own, *numbered("I_w", n), *(f"halfshaft_{j + 1}_spring" for j in range(n))]
    assert sorted(map(str, causal.integral)) == sorted(full if halfshafts else own)


@every
@pytest.mark.parametrize("halfshafts", [False, True])
def test_unlumped_inertias_give_appendix_b_with_the_sums(name: str, halfshafts: bool) -> None:
    """Unlumped, an output's inertias are its parts' (I_j, I_rj, I_cj) and, rigid, its wheel's."""
    graph = differentials.graph(name, halfshafts, lumped=False)
    found = variant_of(name, halfshafts, lumped=False)
    parts = LUMPED_OUTPUTS[name]
    own = [w + part for w, part in zip(WITH_WHEELS, parts, strict=False)]
    A, _, _ = APPENDIX_B[name](sp.symbols("X1 X2 X3 X4"))
    sums = dict(zip(sp.symbols("X1 X2 X3 X4"), parts if halfshafts else own, strict=False))
    A = A.subs({I_i: LUMPED_INPUT[name], **sums}, simultaneous=True)
    n, _, _ = signals(name)
    lumped = variant_of(name, halfshafts)
    assert same(found.A, sp.diag(A, sp.Matrix(lumped.A)[n:, n:]))
    assert (found.J, found.B, found.F) == (lumped.J, lumped.B, lumped.F)
    dependent = set(UNLUMPED[name].split())
    if not halfshafts:
        dependent |= {str(symbol) for part in parts for symbol in part.free_symbols}
    assert set(bg.assign_causality(graph).derivative) == dependent
