"""Inverses that are found by search, and guarded ones, inside expressions."""

import sympy as sp

from bondgraph.algebra.residues import is_zero
from bondgraph.inverses.guarding import guarded
from bondgraph.inverses.inverse import inverse_of

q, k, e = sp.symbols("q k e")


def test_a_place_at_zero_is_a_number() -> None:
    """``k q + q^3`` is zero at zero, whatever k; sympy tells a zero in digits as an integer."""
    found = inverse_of(k * q + q**3, q, e)
    assert found is not None
    at_zero, at_three = (found.xreplace({k: sp.Integer(2), e: sp.Integer(v)}) for v in (0, 3))
    assert [one.is_number for one in (found, at_zero, at_three)] == [False, True, True]
    assert [float(one.evalf()) for one in (at_zero, at_three)] == [0, 1]
    assert at_zero.is_finite
    assert at_zero.is_real


def test_guards_hide_no_identity() -> None:
    root = guarded(sp.sqrt(e - 2), e, "pipe")
    assert root != sp.sqrt(e - 2)
    assert is_zero(root - sp.sqrt(e - 2))
    assert is_zero(1 / (root + k) - 1 / (sp.sqrt(e - 2) + k))
    assert not is_zero(root - 2 * sp.sqrt(e - 2))


def test_sums_over_guards_that_are_outside_at_numbers_are_decided() -> None:
    """At numbers that sympy puts in they have no value; it raised what is no error of ours."""
    one, other = guarded(sp.log(e), e, "a"), guarded(sp.log(q - 5), q, "b")
    assert not is_zero(4 / (5 * one) + sp.sqrt(2) / (other - 3) + sp.sqrt(3) / one)
