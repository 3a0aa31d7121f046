"""Numbers in twice double precision against long decimals, and rates of models with 32 digits."""

from decimal import Context, Decimal, localcontext

import networkx as nx
import numpy as np

import bondgraph as bg
from codegen import simulator
from codegen.numbers.ladder import Ladder
from codegen.numbers.pairs import Pair, from_decimals, matmul, pair, plus, times


def _long(value: Pair) -> list[Decimal]:
    return [Decimal(h) + Decimal(low) for h, low in zip(*map(np.ravel, value), strict=True)]


def _random(rng: np.random.Generator, *shape: int) -> Pair:
    size = 10.0 ** rng.uniform(-12, 12, shape)
    hi = rng.normal(size=shape) * size
    return Pair(hi, rng.uniform(-0.5, 0.5, shape) * np.spacing(hi))


def test_sums_and_products_have_twice_the_digits() -> None:
    rng = np.random.default_rng(5)
    a, b = _random(rng, 500), _random(rng, 500)
    with localcontext(Context(prec=120)):
        for one, two, total, product in zip(
            _long(a), _long(b), _long(plus(a, b)), _long(times(a, b)), strict=True
        ):
            assert abs(total - (one + two)) <= Decimal("1e-31") * max(abs(one), abs(two))
            assert abs(product - one * two) <= Decimal("1e-31") * abs(one * two)


def test_a_product_of_matrices_keeps_them_where_terms_cancel() -> None:
    rng = np.random.default_rng(6)
    a, b = _random(rng, 5, 7), _random(rng, 7, 3)
    found = matmul(a, b)
    with localcontext(Context(prec=120)):
        rows, columns = np.reshape(_long(a), (5, 7)), np.reshape(_long(b), (7, 3))
        for i in range(5):
            for j in range(3):
                terms = [rows[i, k] * columns[k, j] for k in range(7)]
                value = Decimal(found.hi[i, j]) + Decimal(found.lo[i, j])
                assert abs(value - sum(terms)) <= Decimal("1e-30") * sum(map(abs, terms))


def test_long_decimals_become_pairs() -> None:
    third = Context(prec=60).divide(Decimal(1), Decimal(3))
    found = from_decimals([[third]])
    with localcontext(Context(prec=60)):
        assert abs(_long(found)[0] - third) < Decimal("1e-32")


def test_a_slow_motion_beside_one_a_million_million_times_faster() -> None:
    """x' = -y/T - .., as a sum and a difference: the fast one is gone, the slow one has every digit."""
    fast, slow, t = 1e12, 1.0, 1.5
    M = pair(np.array([[-fast, fast], [fast, -fast]]))
    M = plus(M, pair(-slow / 2 * np.ones((2, 2))))
    found = Ladder(M, 2 * fast).after(pair(np.array([[1.0, 0.0]])), np.array([t])).hi[0]
    assert np.abs(found / (0.5 * np.exp(-slow * t)) - 1).max() < 1e-15


def test_rates_have_digits_that_doubles_have_not() -> None:
    """(d + c)/m with c below the last digit of d; 0.1 and 0.3 are decimals, not their doubles."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from([bg.One("j"), bg.I("m", "m", flow="v"), bg.R("d", "d"), bg.R("c", "c")])
    graph.add_edges_from([("j", "m"), ("j", "d"), ("j", "c")])
    ready = simulator(bg.derive(graph), {"m": 0.3, "d": 1e9, "c": 0.1e-9})
    rates = ready.closed.sharp_rates
    assert rates is not None
    with localcontext(Context(prec=60)):
        right = -(Decimal("1e9") + Decimal("1e-10")) / Decimal("0.3")
        assert abs(_long(rates)[0] - right) < Decimal("1e-31") * abs(right)
