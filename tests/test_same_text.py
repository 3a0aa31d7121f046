"""Same input, same bytes: all that writes text, in processes whose sets have other orders."""

import json
import os
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).parent

WRITERS = {
    "derivation": """
import random, bondgraph as bg
from references.random_graphs import random_graph
for seed in (1, 4, 8, 9):
    try: say(repr(bg.derive(random_graph(random.Random(seed), 14, mesh=0.5))))
    except bg.BondGraphError as error: say(error)
""",
    "files": """
import bondgraph as bg, networkx as nx, sympy as sp, differentials
a, b, c, d = sp.symbols("a b c d")
g = nx.DiGraph([("s", "r")])
g.nodes["s"].update(kind="Se", value="u")
g.nodes["r"].update(kind="R", value=sp.Max(a*b, c, d) + sp.Min(b, c - a) + c*d + a**b)
for one in (g, differentials.graph("alsd", True)): say(bg.to_json(one), bg.to_graphml(one))
""",
    "drawing": """
import bondgraph as bg, differentials
say(bg.drawing(differentials.graph("stationary_tvd"), powers=True).svg())
""",
    "program": """
import networkx as nx, bondgraph as bg
from codegen.program.lower import lower
g = nx.DiGraph()
laws = {"a": "p*v + q*f_a", "b": "p*e_a + r*tanh(s*f_b)", "c": "s*e_b + w_1 + w_2"}
g.add_nodes_from([bg.One("n"), bg.I("m", "m + n_1/n_2", flow="v")])
g.add_nodes_from([bg.R(name, law=law) for name, law in laws.items()])
g.add_edges_from([("n", name) for name in ("m", *laws)])
say(lower(bg.derive(g), parameters=["m", "n_1", "n_2", "p", "q", "r", "s"]))
""",
    "exported Python": """
from oracles.exported import catalog_case, small_cases
from codegen import to_python
cases = {"stationary_tvd": catalog_case("stationary_tvd"), **dict(small_cases())}
for name in ("stationary_tvd", "mixed", "crank"): say(to_python(*cases[name]))
""",
    "exported C": """
from differentials.model import model
from codegen import to_c
full = model("alsd")
values = {symbol: one.value for symbol, one in full.parameters.items()}
say(to_c(full.equations, values | dict.fromkeys(full.starts, 80.0), full.laws, "alsd", True))
""",
}

SCRIPT = """
import json, sys
writers, said = json.load(sys.stdin), {}
for name, writer in writers.items():
    lines = said[name] = []
    exec(writer, {"say": lambda *parts: lines.extend(map(str, parts))})
json.dump(said, sys.stdout)
"""


def _said(seed: str) -> dict[str, list[str]]:
    paths = os.pathsep.join(map(str, (TESTS.parent, TESTS, TESTS / "codegen")))
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], input=json.dumps(WRITERS), check=True, capture_output=True,
        text=True, env={**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": seed},
    )  # fmt: skip
    return json.loads(done.stdout)


def test_text_is_the_same_in_every_process() -> None:
    one, other = _said("1"), _said("2")
    assert [name for name in WRITERS if one[name] != other[name]] == []
    assert all(sum(map(len, lines)) > 500 for lines in one.values())


def test_a_set_has_another_order_in_the_other_process() -> None:
    """Or nothing would be seen above."""
    code = "print({'effort', 'flow', 'slip', 'rate', 'state', 'input', 'cap'})"
    texts = {
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True,
                       env={"PYTHONHASHSEED": seed}).stdout
        for seed in ("1", "2")
    }  # fmt: skip
    assert len(texts) == 2
