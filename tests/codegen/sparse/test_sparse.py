"""Sparse models in numbers: the same matrices as the exact derivation, by hand, and what is refused."""

import random
import re
from collections.abc import Callable, Hashable, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg
from codegen import SparseModel, simulator, sparse_model

if TYPE_CHECKING:
    Graph = nx.DiGraph[Any]
else:
    Graph = nx.DiGraph

REFUSALS = (bg.CausalityError, bg.AlgebraicLoopError)
Values = dict[str, Fraction]


def _driven(rng: random.Random, graph: Graph) -> Graph:
    """The same graph in which some sources drive a storage of their own, which is dependent."""
    for node, attributes in list(graph.nodes(data=True)):
        if attributes["kind"] not in ("Se", "Sf") or rng.random() < 0.5:
            continue
        effort = attributes["kind"] == "Se"
        tail, head = next(bond for bond in graph.edges if node in bond)
        graph.add_node(f"at_{node}", kind="Zero" if effort else "One")
        value = Fraction(rng.randint(1, 9), rng.randint(1, 4))
        graph.add_node(f"driven_{node}", kind="C" if effort else "I", value=value)
        graph.remove_edge(tail, head)
        nx.add_path(graph, [f"at_{node}" if end == node else end for end in (tail, head)])
        graph.add_edges_from([(node, f"at_{node}"), (f"at_{node}", f"driven_{node}")])
    return graph


def _drawn(seed: int, largest: int) -> tuple[Graph, Values]:
    """A random graph with positive storages, and values for its symbols."""
    rng = random.Random(seed)
    symbols = rng.random() < 0.6
    graph = _driven(rng, random_graph(rng, rng.randint(3, largest), mesh=0.4, symbols=symbols))
    found = (d.get("value") for _, d in graph.nodes(data=True) if d["kind"] not in ("Se", "Sf"))
    names = [value for value in found if isinstance(value, str)]
    return graph, {name: Fraction(rng.randint(1, 40), rng.randint(1, 13)) for name in names}


def _seen(graph: Graph) -> list[str]:
    return [node for node in graph if graph.nodes[node]["kind"] not in ("TF", "GY")]


def _derived(graph: Graph) -> bg.StateEquations | None:
    try:
        return bg.derive(graph, outputs=_seen(graph))
    except REFUSALS:
        return None


def _dense(matrix: sp.Matrix, values: Mapping[str, Fraction]) -> np.ndarray:
    """An exact matrix at exact values, rounded at the end."""
    at = {sp.Symbol(name): sp.Rational(v.numerator, v.denominator) for name, v in values.items()}
    result = np.zeros(matrix.shape)
    for place, entry in matrix.todok().items():
        result[place] = float(entry.xreplace(at))
    return result


def _readings(equations: bg.StateEquations, name: str, width: int) -> sp.Matrix:
    """One of F, D, H, K of the outputs, x' not resolved."""
    rows = [getattr(equations.readings[symbol], name) for symbol in equations.outputs]
    entries = {(i, j): entry for i, row in enumerate(rows) for j, entry in row.items()}
    return sp.SparseMatrix(len(rows), width, entries)


def _resolved(model: SparseModel) -> dict[str, np.ndarray]:
    """F, D and G as `derive` has them: ``H x'`` by A, J, B and E."""
    A, J, B, E, F, D, H, K = (getattr(model, name).toarray() for name in "AJBEFDHK")
    P, Q, R = (np.linalg.solve(A, part) if len(A) else part for part in (J, B, E))
    return {"F": F + H @ P, "D": D + H @ Q, "G": K + H @ R}


def _assert_close(got: np.ndarray, expected: np.ndarray, name: str) -> None:
    """To 1e-12 of the matrix's largest entry."""
    assert got.shape == expected.shape
    scale = np.abs(expected).max(initial=0.0)
    assert np.abs(got - expected).max(initial=0.0) <= 1e-12 * max(scale, 1e-12), name


def _assert_equal(model: SparseModel, equations: bg.StateEquations, values: Values) -> None:
    assert model.states == tuple(map(str, equations.states))
    assert model.inputs == tuple(map(str, equations.inputs))
    assert model.outputs == tuple(map(str, equations.outputs))
    n, m = len(model.states), len(model.inputs)
    for name in "AJBE":
        _assert_close(
            getattr(model, name).toarray(), _dense(getattr(equations, name), values), name
        )
    resolved = _resolved(model)
    for name in "FDG":
        _assert_close(resolved[name], _dense(getattr(equations, name), values), f"resolved {name}")
    for name, width in (("F", n), ("D", m), ("H", n), ("K", m)):
        direct = _dense(_readings(equations, name, width), values)
        _assert_close(getattr(model, name).toarray(), direct, name)


@pytest.mark.parametrize("seed", [*seeds("sparse"), 2049, 2111, 2802, 3039, 3086, 3818, 3884])
def test_small_graph_has_the_matrices_of_the_exact_derivation(seed: int) -> None:
    graph, values = _drawn(seed, 13)
    equations = _derived(graph)
    if equations is None:
        with pytest.raises(REFUSALS):
            sparse_model(graph, values, _seen(graph))
    else:
        _assert_equal(sparse_model(graph, values, _seen(graph)), equations, values)


@pytest.mark.parametrize("seed", seeds("larger-sparse"))
def test_larger_graph_has_the_matrices_of_the_exact_derivation(seed: int) -> None:
    graph, values = _drawn(seed, 40)
    equations = _derived(graph)
    if equations is not None:
        _assert_equal(sparse_model(graph, values, _seen(graph)), equations, values)


def test_random_graphs_are_of_all_sorts() -> None:
    """Of the first small graphs some are refused, some have E, G, dependent storages."""
    graphs = [_drawn(seed, 13)[0] for seed in range(60)]
    equations = [found for graph in graphs if (found := _derived(graph))]
    assert 30 < len(equations) < 60
    assert sum(bool(found.E.todok()) for found in equations) >= 2
    assert sum(bool(found.G.todok()) for found in equations) > 10
    storages = [[e for e in found.elements.values() if e.kind.stores] for found in equations]
    dependent = [len(held) - len(e.states) for held, e in zip(storages, equations, strict=True)]
    assert sum(count > 0 for count in dependent) > 10


GEAR = [bg.Se("drive", "u"), bg.One("a"), bg.I("m1", "m1", flow="w"), bg.TF("gear", "n"),
        bg.One("b"), bg.I("m2", "m2", priority=-1), bg.R("d", "b")]  # fmt: skip
GEAR_BONDS = "drive>a>m1 a>gear>b>m2 b>d"
NUMBERS = {"m1": 2, "m2": 3, "n": 5, "b": 7}


def _gear() -> Graph:
    return bond_graph(GEAR, GEAR_BONDS)


def test_two_geared_masses_by_hand() -> None:
    """w_b = n w: A = m1 + n^2 m2, J = -n^2 b; the force on m1 is u - n (m2 n w' + b n w)."""
    model = sparse_model(_gear(), NUMBERS, ["m1", "b", "m2"])
    parts = {name: getattr(model, name).toarray().tolist() for name in "AJBEFDHK"}
    assert parts == {
        "A": [[77.0]], "J": [[-175.0]], "B": [[1.0]], "E": [[0.0]],
        "F": [[-175.0], [5.0], [5.0]], "D": [[1.0], [0.0], [0.0]],
        "H": [[-75.0], [0.0], [0.0]], "K": [[0.0], [0.0], [0.0]],
    }  # fmt: skip
    assert model.states == ("w",)
    assert model.inputs == ("u",)
    assert model.outputs == ("e_m1", "f_b", "f_m2")


def test_a_causal_graph_will_do() -> None:
    causal = bg.assign_causality(_gear())
    assert sparse_model(causal, NUMBERS).A.toarray().tolist() == [[77.0]]


def test_a_source_across_a_capacitor_has_no_state() -> None:
    """i = V/R + C V'."""
    nodes = [bg.Se("V", "V"), bg.Zero("n"), bg.C("c", "C"), bg.R("r", "R")]
    model = sparse_model(bond_graph(nodes, "V>n>c n>r"), {"C": 3, "R": 4}, ["V"])
    assert model.states == ()
    assert model.A.shape == (0, 0)
    assert model.D.toarray().tolist() == [[0.25]]
    assert model.K.toarray().tolist() == [[3.0]]


def _divider() -> Graph:
    """V over r1 and the node voltage, which r2 and the coil share."""
    nodes = [bg.Se("V", "V"), bg.One("a"), bg.R("r1", "r1"), bg.Zero("z"), bg.R("r2", "r2"),
             bg.I("coil", "L", flow="i")]  # fmt: skip
    return bond_graph(nodes, "V>a>r1 a>z>r2 z>coil")


def test_a_loop_of_resistances_by_hand() -> None:
    """L i' = (V - r1 i) r2/(r1 + r2)."""
    model = sparse_model(_divider(), {"r1": 1, "r2": 3, "L": 5}, ["r2"])
    assert model.J.toarray() == pytest.approx(np.array([[-0.75]]), rel=1e-15)
    assert model.B.toarray() == pytest.approx(np.array([[0.75]]), rel=1e-15)


def test_a_source_that_drives_an_inertia_by_hand() -> None:
    """A speed drives m1 and, over a damper, m2: m2 v' = b (s - v); the source feels m1 s' + b (s - v)."""
    nodes = [bg.Sf("s", "s"), bg.One("a"), bg.I("m1", 2), bg.Zero("z"), bg.R("b", "b"),
             bg.I("m2", 5, flow="v")]  # fmt: skip
    graph = bond_graph(nodes, "s>a>m1 a>z>b z>m2")
    model = sparse_model(graph, {"b": 3}, ["s"])
    parts = {name: getattr(model, name).toarray().tolist() for name in "AJBEFDHK"}
    assert parts == {
        "A": [[5.0]], "J": [[-3.0]], "B": [[3.0]], "E": [[0.0]],
        "F": [[-3.0]], "D": [[3.0]], "H": [[0.0]], "K": [[2.0]],
    }  # fmt: skip


def test_constant_laws_are_known_inputs() -> None:
    nodes = [bg.Se("weight", "-m*g"), bg.Se("push", "P"), bg.One("n"), bg.I("mass", "m", flow="v")]
    model = sparse_model(bond_graph(nodes, "weight>n push>n n>mass"), {"m": 2, "g": 9.81})
    assert model.inputs == ("e_weight", "P")
    assert {name: signal(0.0) for name, signal in model.known.items()} == {"e_weight": -19.62}


def test_the_rate_of_a_dependent_storage_in_a_loop_of_signals() -> None:
    """A one- and a zero-junction with a bond and a gyrator between them: f_I = -e_C/r, f_C = m f_I'/r.

    The effort of the inertia stands in a loop of signals and is still a rate: (c + m/r^2) e_C' = 0.
    """
    nodes = [bg.C("c", Fraction(4, 3)), bg.One("x"), bg.GY("r", Fraction(5, 2)), bg.Zero("z"),
             bg.I("m", Fraction(1, 2))]  # fmt: skip
    graph = bond_graph(nodes, "x>c x>z>r>x m>z")
    assert bg.assign_causality(graph).derivative == ("m",)
    model = sparse_model(graph, {}, ["m"])
    assert model.A.toarray() == pytest.approx(np.array([[4 / 3 + 0.5 / 2.5**2]]), rel=1e-14)
    assert model.J.toarray() == pytest.approx(np.array([[0.0]]), abs=1e-14)
    assert model.F.toarray() == pytest.approx(np.array([[-0.4]]), rel=1e-14)


def test_a_train_of_a_thousand_gears() -> None:
    """w_k = n_k w_(k-1), so A = sum m_k prod n^2 and J = -sum b_k prod n^2."""
    graph: Graph = nx.DiGraph()
    graph.add_nodes_from([bg.Se("drive", "u"), bg.One("w0"), bg.I("m0", 1), bg.R("b0", 2)])
    graph.add_edges_from([("drive", "w0"), ("w0", "m0"), ("w0", "b0")])
    square, A, J = Fraction(1), Fraction(1), Fraction(-2)
    for k in range(1, 1000):
        m, b = Fraction(1 + k % 3, 7), Fraction(1 + k % 5, 11)
        n = Fraction(5, 4) if k % 2 else Fraction(-7, 9)
        graph.add_nodes_from(
            [bg.TF(f"g{k}", n), bg.One(f"w{k}"), bg.I(f"m{k}", m), bg.R(f"b{k}", b)]
        )
        nx.add_path(graph, [f"w{k - 1}", f"g{k}", f"w{k}", f"m{k}"])
        graph.add_edge(f"w{k}", f"b{k}")
        square *= n**2
        A, J = A + m * square, J - b * square
    model = sparse_model(graph, {})
    assert model.A.toarray() == pytest.approx(np.array([[float(A)]]), rel=1e-12)
    assert model.J.toarray() == pytest.approx(np.array([[float(J)]]), rel=1e-12)
    assert model.B.toarray().tolist() == [[1.0]]


def _with(attributes: tuple[Hashable, dict[str, object]]) -> Graph:
    """The two geared masses with one element in another's place."""
    graph = _gear()
    name, new = attributes
    graph.nodes[name].clear()
    graph.nodes[name].update(new)
    return graph


def _changed_by_a_state() -> Graph:
    return _with(bg.R("d", "b*w"))


REFUSED: dict[str, tuple[Callable[[], Graph], dict[str, object], type[Exception], str]] = {
    "negative state": (_gear, {"m1": -1}, bg.SingularStorageError, "I 'm1'"),
    "negative dependent storage": (_gear, {"m2": -0.1}, bg.SingularStorageError, "I 'm2'"),
    "zero storage": (_gear, {"m2": 0}, bg.ParameterError, "I 'm2'"),
    "law": (lambda: _with(bg.R("d", law="w**3", gives="effort")), {}, bg.StructureError, "R 'd'"),
    "friction": (lambda: _with(bg.R("d", law=bg.DryFriction(3), gives="effort")), {},
                 bg.StructureError, "R 'd'"),
    "source over time": (lambda: _with(bg.Se("drive", "sin(t)")), {}, bg.StructureError,
                         "Se 'drive'"),
    "source of a state": (lambda: _with(bg.Se("drive", "b*w")), {}, bg.StructureError,
                          "Se 'drive'"),
    "nonlinear storage": (lambda: _with(bg.I("m1", law="p_m1**3", flow="w")), {},
                          bg.StructureError, "I 'm1'"),
    "value of a state": (_changed_by_a_state, {}, bg.BondGraphError, "'d'"),
    "value of the time": (lambda: _with(bg.R("d", "b*t")), {}, bg.BondGraphError, "'d'"),
    "zero modulus": (_gear, {"n": 0}, bg.ParameterError, "TF 'gear'"),
    "infinite value": (lambda: _with(bg.R("d", "1/b")), {"b": 0}, bg.ParameterError, "'d'"),
    "root of a negative": (lambda: _with(bg.R("d", "sqrt(b)")), {"b": -1}, bg.ParameterError,
                           "'d'"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_refused_by_name(case: str) -> None:
    build, values, error, name = REFUSED[case]
    with pytest.raises(error, match=re.escape(name)):
        sparse_model(build(), NUMBERS | values)


@pytest.mark.parametrize(("missing", "node"), [("m1", "m1"), ("n", "gear"), ("b", "d")])
def test_a_missing_parameter_is_refused_with_its_node(missing: str, node: str) -> None:
    values = {name: value for name, value in NUMBERS.items() if name != missing}
    with pytest.raises(bg.ParameterError, match=f"{missing}") as caught:
        sparse_model(_gear(), values)
    assert repr(node) in str(caught.value)


@pytest.mark.parametrize("value", ["3", None, True, float("nan"), 1j])
def test_a_parameter_that_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(bg.ParameterError, match="'n'"):
        sparse_model(_gear(), NUMBERS | {"n": value})


def test_a_field_of_storages_is_refused() -> None:
    coils = bg.I("coils", [[2, 1], [1, 2]], ports=["one", "two"])
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.One("b"), bg.R("r", 1), coils]
    graph = bond_graph(nodes, "u>a b>r")
    graph.add_edge("a", "coils", port="one")
    graph.add_edge("b", "coils", port="two")
    with pytest.raises(bg.SingularStorageError, match=r"I 'coils\.one'"):
        sparse_model(graph, {})


def test_an_integrating_detector_is_refused() -> None:
    graph = _gear()
    graph.add_nodes_from([bg.Df("angle", integrate="theta")])
    graph.add_edge("a", "angle")
    with pytest.raises(bg.StructureError, match="Df 'angle'"):
        sparse_model(graph, NUMBERS)


def test_a_detector_that_reads_is_an_output() -> None:
    graph = _gear()
    graph.add_nodes_from([bg.Df("speed")])
    graph.add_edge("b", "speed")
    assert sparse_model(graph, NUMBERS, ["speed"]).F.toarray().tolist() == [[5.0]]


@pytest.mark.parametrize(("output", "match"), [("nobody", "'nobody'"), ("gear", "'gear'")])
def test_outputs_that_do_not_exist_are_refused(output: str, match: str) -> None:
    with pytest.raises(bg.StructureError, match=match):
        sparse_model(_gear(), NUMBERS, [output])


@pytest.mark.parametrize("values", [(1, -1), (0.3, -0.3), (Fraction(1, 3), Fraction(-1, 3))])
def test_a_loop_that_parameters_make_singular_is_refused(values: tuple[object, object]) -> None:
    with pytest.raises(bg.BondGraphError):
        sparse_model(_divider(), {"r1": values[0], "r2": values[1], "L": 1})


def test_a_loop_singular_in_decimals_only_is_refused() -> None:
    """r1 + r2 = 0.1 + 0.2 - 0.3 is nothing, though not in floats."""
    graph = _divider()
    graph.nodes["r1"]["value"] = "a + b"
    with pytest.raises(bg.BondGraphError):
        sparse_model(graph, {"a": 0.1, "b": 0.2, "r2": -0.3, "L": 1})


def test_a_loop_over_three_resistances_singular_in_decimals_only_is_refused() -> None:
    """Conductances 1/r1 + 1/r2 + 1/r3 = 0.1 + 0.2 - 0.3."""
    nodes = [bg.Se("V", "V"), bg.One("a"), bg.R("r1", "1/g1"), bg.Zero("z"), bg.R("r2", "1/g2"),
             bg.R("r3", "1/g3"), bg.I("coil", 1, flow="i")]  # fmt: skip
    graph = bond_graph(nodes, "V>a>r1 a>z>r2 z>r3 z>coil")
    values = {"g1": 0.1, "g2": 0.2, "g3": -0.3}
    with pytest.raises(bg.ParameterError):
        simulator(bg.derive(graph), values)
    with pytest.raises(bg.BondGraphError):
        sparse_model(graph, values)


def test_a_parameter_named_like_a_signal_is_refused_as_by_simulator() -> None:
    with pytest.raises(bg.ParameterError, match="w"):
        simulator(bg.derive(_gear()), NUMBERS | {"w": 1})
    with pytest.raises(bg.ParameterError, match="w"):
        sparse_model(_gear(), NUMBERS | {"w": 1})


def test_a_parameter_named_like_an_input_gives_it_as_for_simulator() -> None:
    assert simulator(bg.derive(_gear()), NUMBERS | {"u": 3}).inputs == ()
    model = sparse_model(_gear(), NUMBERS | {"u": 3})
    assert {name: signal(0.0) for name, signal in model.known.items()} == {"u": 3.0}


@pytest.mark.parametrize(("zero", "flow"), [("R2", 1.0), ("R3", 1.0), ("R1", 2.0)])
def test_a_resistance_of_zero_is_a_short_circuit(zero: str, flow: float) -> None:
    """1 V over R1 in series with R2 and R3 side by side, all of 1 ohm but one."""
    nodes = [
        bg.Se("e", "u"), bg.One("w"), bg.R("R1", "R1"), bg.Zero("n"), bg.R("R2", "R2"), bg.R("R3", "R3"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "e>w w>R1 w>n n>R2 n>R3")
    values = dict.fromkeys(("R1", "R2", "R3"), 1) | {zero: 0}
    model = sparse_model(graph, values, ["w"])
    assert model.D[0, model.inputs.index("u")] == pytest.approx(flow)
