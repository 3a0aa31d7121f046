"""Causal paths and loops: gains by hand, and Mason's rule against all bond equations at once."""

import random

import numpy as np
import pytest
import sympy as sp
from references.bond_equations import is_input, kind
from references.brute_force import TransferResult, port, transfer
from references.build import Graph, bond_graph
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg

s, m, c, b, n, J = sp.symbols("s m c b n J")
OSCILLATOR = bond_graph(
    [
        bg.Se("push", "F"),
        bg.One("mass"),
        bg.I("m", "m", flow="v"),
        bg.C("spring", "c"),
        bg.R("drag", "b"),
    ],
    "push>mass>m mass>spring mass>drag",
)


def _same(one: sp.Expr, other: sp.Expr) -> bool:
    return sp.cancel(one - other) == 0


def test_an_oscillator_has_two_loops_that_touch() -> None:
    """KMR's second-order loop of I and C, -1/(m c s^2), and the first-order one of I and R, -b/(m s)."""
    found = bg.causal_paths(OSCILLATOR, "push", "drag")
    assert [path.nodes for path in found.paths] == [("push", "mass", "m", "mass", "drag")]
    assert [path.gain for path in found.paths] == [1 / (m * s)]
    gains = {loop.nodes: loop.gain for loop in found.loops}
    assert gains == {
        ("m", "mass", "drag", "mass", "m"): -b / (m * s),
        ("m", "mass", "spring", "mass", "m"): -1 / (c * m * s**2),
    }
    assert _same(found.determinant, 1 + b / (m * s) + 1 / (c * m * s**2))
    assert _same(found.transfer, c * s / (c * m * s**2 + b * c * s + 1))


def test_loops_that_do_not_touch_are_multiplied() -> None:
    """Two masses with dampers on one spring: D = (1 - L1)(1 - L2) - L3 (1 - L2) - L4 (1 - L1)."""
    graph = bond_graph(
        [bg.Se("u", "u"), bg.One("a"), bg.I("m_1", "m"), bg.R("r_1", "b"), bg.Zero("z"), bg.C("k", "c"),
         bg.One("o"), bg.I("m_2", "m"), bg.R("r_2", "b")],
        "u>a>m_1 a>r_1 a>z>o>m_2 o>r_2 z>k",
    )  # fmt: skip
    own, shared = -b / (m * s), -1 / (c * m * s**2)
    found = bg.causal_paths(graph, "u", "o")
    assert sorted(str(loop.gain) for loop in found.loops) == sorted(
        map(str, [own, own, shared, shared])
    )
    assert _same(found.determinant, (1 - own) ** 2 - 2 * shared * (1 - own))
    assert _same(found.paths[0].gain, 1 / (c * m**2 * s**3))


def test_moduli_and_signs_stand_in_the_gains() -> None:
    graph = bond_graph(
        [bg.Se("u", "u"), bg.One("a"), bg.R("r", "b"), bg.I("L", "m"), bg.GY("motor", "n"), bg.One("w"),
         bg.I("J", "J")],
        "u>a>L a>r a>motor>w>J",
    )  # fmt: skip
    found = bg.causal_paths(graph, "u", "J")
    assert [path.gain for path in found.paths] == [n / (m * s)]
    assert -(n**2) / (J * m * s**2) in [loop.gain for loop in found.loops]
    turned = bg.causal_paths(
        bond_graph(list(graph.nodes(data=True)), "a>u a>L a>r a>motor>w>J"), "u", "J"
    )
    assert [path.gain for path in turned.paths] == [-n / (m * s)]


def test_a_dependent_storage_has_a_loop_without_s() -> None:
    graph = bond_graph(
        [bg.Se("u", "u"), bg.One("a"), bg.I("m", "m"), bg.TF("t", "n"), bg.I("J", "J")],
        "u>a>m a>t>J",
    )
    found = bg.causal_paths(graph, "u", "a")
    assert [loop.gain for loop in found.loops] == [-J * n**2 / m]
    # Equal to an inertia m + n^2 J.
    assert _same(found.transfer, 1 / (s * (m + n**2 * J)))


def test_a_storage_may_be_the_start_and_a_parameter_may_be_called_s() -> None:
    assert [path.gain for path in bg.causal_paths(OSCILLATOR, "spring", "mass").paths] == [
        -1 / (m * s)
    ]
    graph = bond_graph([bg.Se("u", "u"), bg.One("a"), bg.I("m", "s")], "u>a>m")
    with pytest.raises(bg.StructureError, match="parameter s"):
        bg.causal_paths(graph, "u", "a")
    assert str(bg.causal_paths(graph, "u", "a", s="p").transfer) == "1/(p*s)"


@pytest.mark.parametrize(
    ("value", "told"), [({"value": "b*v"}, "reads v"), ({"law": "b*v**3"}, "not linear")]
)
def test_what_has_no_constant_gain_is_refused_by_name(value: dict[str, str], told: str) -> None:
    graph = OSCILLATOR.copy()
    graph.nodes["drag"].pop("value")
    graph.nodes["drag"].update(value)
    with pytest.raises(bg.StructureError, match=f"'drag'.*{told}"):
        bg.causal_paths(graph, "push", "mass")


def test_nodes_that_are_not_there_or_give_nothing_are_refused() -> None:
    with pytest.raises(bg.StructureError, match="did you mean 'mass'"):
        bg.causal_paths(OSCILLATOR, "push", "mas")
    with pytest.raises(bg.StructureError, match="gives nothing of its own"):
        bg.causal_paths(OSCILLATOR, "mass", "drag")


def test_paths_are_shown_as_text_and_as_markdown() -> None:
    found = bg.causal_paths(OSCILLATOR, "push", "drag")
    assert str(found).splitlines()[1] == "  push -> mass -> m -> mass -> drag: 1/(m*s)"
    shown = found._repr_markdown_()
    assert "| loop | m → mass → drag → mass → m | $- \\frac{b}{m s}$ |" in shown
    assert "\\Delta" in shown


def test_fields_pass_from_port_to_port() -> None:
    """A transformer's windings: e = [[L1, M], [M, L2]] f'; the second is loaded with R."""
    graph = bond_graph(
        [
            bg.Se("u", "u"),
            bg.One("a"),
            bg.I("coils", "m", ports=["p", "q"]),
            bg.One("w"),
            bg.R("load", "b"),
        ],
        "u>a w>load",
    )
    graph.nodes["coils"]["value"] = [["L1", "M"], ["M", "L2"]]
    graph.add_edge("a", "coils", port="p")
    graph.add_edge("w", "coils", port="q")
    L1, L2, M = sp.symbols("L1 L2 M")
    found = bg.causal_paths(graph, "u", "w")
    # s L1 f1 + s M f2 = u, s M f1 + s L2 f2 = -b f2.
    assert _same(found.transfer, -s * M / (s * L1 * (s * L2 + b) - (s * M) ** 2))


def _numbers(graph: Graph, rng: random.Random) -> dict[str, float]:
    values = (data.get("value") for _, data in graph.nodes(data=True))
    return {name: rng.uniform(0.3, 2) for name in values if isinstance(name, str)}


def _judged(graph: Graph, judge: TransferResult, node: str, source: str) -> complex:
    if kind(graph, node) == "Zero":
        return judge.effort[next(bond for bond in graph.edges if node in bond)][source]
    if kind(graph, node) == "One":
        return judge.flow[next(bond for bond in graph.edges if node in bond)][source]
    effort, flow = port(graph, judge, node)
    strokes = bg.assign_causality(graph).strokes
    bond = next(bond for bond in graph.edges if node in bond)
    return effort[source] if strokes[bond] == node else flow[source]


@pytest.mark.parametrize("seed", seeds("causal-paths"))
def test_masons_rule_is_the_transfer_function_of_all_bond_equations(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(3, 9), mesh=0.25)
    sources = [node for node in graph if is_input(graph, node)]
    ends = [node for node in graph if kind(graph, node) not in ("TF", "GY")]
    values, at = _numbers(graph, rng), complex(rng.uniform(0.2, 1), rng.uniform(0.2, 2))
    try:
        judge = transfer(graph, at, values)
    except np.linalg.LinAlgError:
        return
    for source in sources[:2]:
        end = rng.choice(ends)
        found = bg.causal_paths(graph, source, end).transfer
        got = complex(found.subs({**values, "s": at}))
        expected = _judged(graph, judge, end, source)
        assert abs(got - expected) <= 1e-9 * max(1, abs(expected)), (source, end)
    if sources and (joints := [node for node in ends if kind(graph, node) in ("Zero", "One")]):
        other = bg.assign_causality(graph, derivative=True)
        got = complex(
            bg.causal_paths(other, sources[0], joints[0]).transfer.subs({**values, "s": at})
        )
        expected = _judged(graph, judge, joints[0], sources[0])
        assert abs(got - expected) <= 1e-9 * max(1, abs(expected))
