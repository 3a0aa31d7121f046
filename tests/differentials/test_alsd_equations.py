"""The ALSD's matrices against Appendix B and eqs. (12), (15), (16), typed in from the paper."""

import pytest
import sympy as sp

import bondgraph as bg
import differentials

i, I_i, I_c, I_1, I_2, I_w, I_w1, I_w2, k, b = sp.symbols("i I_i I_c I_1 I_2 I_w I_w1 I_w2 k b")
HALF = sp.Rational(1, 2)


def same(found: sp.Matrix, expected: list[list[object]]) -> bool:
    return sp.expand(sp.Matrix(found) - sp.Matrix(expected)).is_zero_matrix is True


def test_the_rigid_model_is_appendix_b() -> None:
    found = differentials.equations("alsd")
    a = i**2 * I_i / 4
    assert [str(s) for s in found.states] == ["omega_1", "omega_2"]
    assert [str(s) for s in found.inputs] == ["tau_e", "tau_f", "tau_t1", "tau_t2"]
    assert same(found.A, [[I_w1 + a, a], [a, I_w2 + a]])
    assert same(found.B, [[i / 2, -HALF, -1, 0], [i / 2, HALF, 0, -1]])
    assert same(found.F, [[HALF, -HALF]])
    for zero in (found.J, found.E, found.D, found.G):
        assert not zero.todok()


def test_unlumped_inertias_give_the_lumped_a() -> None:
    """Appendix B: I_wj* = I_wj + I_j, I_i* = I_i + I_c/i^2."""
    graph = differentials.graph("alsd", lumped=False)
    found = bg.derive(graph, outputs=["clutch"])
    lumped = differentials.equations("alsd")
    values = {I_i: I_i + I_c / i**2, I_w1: I_w1 + I_1, I_w2: I_w2 + I_2}
    assert set(bg.assign_causality(graph).derivative) == {"I_i", "I_c", "I_1", "I_2"}
    assert same(found.A, lumped.A.subs(values, simultaneous=True).tolist())
    assert (found.B, found.F) == (lumped.B, lumped.F)


def test_the_full_model_has_halfshafts_and_wheels() -> None:
    """Eqs. (15), (16): tau_hs = tau_k + b (w - w_t) for tau_t, and I_w w_t' = tau_hs - tau_t."""
    found = differentials.equations("alsd", halfshafts=True)
    names = "omega_1 omega_2 tau_k1 tau_k2 omega_t1 omega_t2"
    assert [str(s) for s in found.states] == names.split()
    a = i**2 * I_i / 4
    assert same(found.A[:2, :2], [[I_1 + a, a], [a, I_2 + a]])
    assert same(found.A[2:, 2:], sp.diag(1 / k, 1 / k, I_w, I_w).tolist())
    assert not found.A[:2, 2:].todok()
    expected = [
        [-b, 0, -1, 0, b, 0],
        [0, -b, 0, -1, 0, b],
        [1, 0, 0, 0, -1, 0],
        [0, 1, 0, 0, 0, -1],
        [b, 0, 1, 0, -b, 0],
        [0, b, 0, 1, 0, -b],
    ]
    assert same(found.J, expected)
    rows = [
        [i / 2, -HALF, 0, 0],
        [i / 2, HALF, 0, 0],
        [0] * 4,
        [0] * 4,
        [0, 0, -1, 0],
        [0, 0, 0, -1],
    ]
    assert same(found.B, rows)
    assert same(found.F, [[HALF, -HALF, 0, 0, 0, 0]])


@pytest.mark.parametrize("halfshafts", [False, True])
def test_the_clutch_column_of_b_is_minus_f_transposed(halfshafts: bool) -> None:
    found = differentials.equations("alsd", halfshafts)
    assert found.B[:, 1] == -found.F.T


@pytest.mark.parametrize("halfshafts", [False, True])
def test_a_is_symmetric_and_positive_definite(halfshafts: bool) -> None:
    A = sp.Matrix(differentials.equations("alsd", halfshafts).A)
    positive = {symbol: sp.Symbol(symbol.name, positive=True) for symbol in A.free_symbols}
    assert A == A.T
    assert all(A[:n, :n].det().subs(positive).expand().is_positive for n in range(1, A.rows + 1))


def test_unknown_names_are_refused() -> None:
    with pytest.raises(bg.StructureError, match="no differential is called 'alds'"):
        differentials.graph("alds")
