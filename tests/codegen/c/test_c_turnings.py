"""Laws turned round by a search, in generated C and Python: the places that scipy's brentq finds."""

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from oracles.c_model import WARNED, compiled, written
from scipy.optimize import brentq

import bondgraph as bg
import codegen
from bondgraph.inverses.inverse import Inverse
from codegen.c.bounded import findings
from codegen.c.counting import counted

LAWS: list[tuple[str, Callable, tuple[float, float]]] = [
    ("k*f_r + c*f_r**3", lambda x, k, c: k * x + c * x**3, (-1e3, 1e3)),
    ("-k*f_r - c*sinh(f_r)", lambda x, k, c: -k * x - c * np.sinh(x), (-30.0, 30.0)),
    (
        "k*f_r + c*f_r*exp(-k) + f_r**5",
        lambda x, k, c: (k + c * np.exp(-k)) * x + x**5,
        (-1e3, 1e3),
    ),
    ("k*f_r + c*log(1 + f_r)", lambda x, k, c: k * x + c * np.log1p(x), (-0.999, 1e3)),
    ("k*f_r + c/(1 - f_r)**1.5", lambda x, k, c: k * x + c / (1 - x) ** 1.5, (-1e3, 0.99)),
    ("f_r + tanh(f_r)", lambda x, k, c: x + np.tanh(x), (-1e3, 1e3)),
]
NUMBERS = {"k": 0.7, "c": 2.5}

MAIN = r"""
#include <stdio.h>
#include "model_internal.h"
int main(void)
{
    const double a[] = {2.5, 0.7};
    double value;
    while (fread(&value, sizeof value, 1, stdin) == 1) {
        value = bg_searched(bg_turnings[0], 0.0, value, a);
        fwrite(&value, sizeof value, 1, stdout);
    }
    return 0;
}
"""


def _equations(law: str) -> bg.StateEquations:
    """A resistance that an effort source presses its law on."""
    graph = nx.DiGraph()
    graph.add_nodes_from([bg.Se("s", "u"), bg.One("j"), bg.R("r", law=law)])
    graph.add_edges_from([("s", "j"), ("j", "r")])
    return bg.derive(graph)


def _values(law: Callable, ends: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    places = np.random.default_rng(7).uniform(*ends, 400)
    values = np.array([law(x, **NUMBERS) for x in places])
    right = [
        brentq(lambda x, v=v: law(x, **NUMBERS) - v, *ends, xtol=1e-15, rtol=1e-15) for v in values
    ]
    return values, np.array(right)


@pytest.mark.parametrize(("text", "law", "ends"), LAWS)
def test_c_finds_the_place(text: str, law: Callable, ends: tuple, tmp_path: Path) -> None:
    files = codegen.to_c(_equations(text), NUMBERS)
    begin = files["model.c"].index("static double law_of_inverse_")
    end = files["model.c"].index(";", files["model.c"].index("const bg_law bg_turnings[]")) + 1
    alone = (
        '#include <math.h>\n\n#include "model_internal.h"\n\n' + files["model.c"][begin:end] + "\n"
    )
    kept = {name: files[name] for name in files if name.endswith(".h") or name == "model_search.c"}
    program = compiled(
        tmp_path, written(tmp_path, kept | {"model.c": alone, "main.c": MAIN}), *WARNED
    )
    values, right = _values(law, ends)
    done = subprocess.run([program], input=values.tobytes(), capture_output=True, check=True)
    assert np.frombuffer(done.stdout) == pytest.approx(right, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(("text", "law", "ends"), LAWS)
def test_python_and_numpy_find_the_place(text: str, law: Callable, ends: tuple) -> None:
    equations = _equations(text)
    module: dict[str, Any] = {}
    exec(codegen.to_python(equations, NUMBERS), module)
    (name,) = (name for name in module if name.startswith("_inverse_"))
    (inverse,) = equations.laws["r"].expression.atoms(Inverse)
    given = [NUMBERS[str(one)] for one in inverse.places[1:]]
    values, right = _values(law, ends)
    found = [module[name](value, *given) for value in values.tolist()]
    assert found == pytest.approx(right, rel=1e-12, abs=1e-12)
    solved = inverse.numeric
    assert [solved(value, *given) for value in values.tolist()] == pytest.approx(found, rel=1e-13)


def test_steps_are_bounded_and_counted() -> None:
    """Whatever the search needs, a step is told how much that is at the most."""
    equations = _equations(LAWS[0][0])
    assert findings(codegen.to_c(equations, NUMBERS)) == []
    assert counted([equations.laws["r"].expression]).multiplications > 200


def test_parameters_for_which_the_law_turns_back_are_refused_by_name() -> None:
    equations = _equations(LAWS[0][0])
    with pytest.raises(
        bg.ParameterError, match=r"R 'r': its law is turned round .* c has to be positive"
    ):
        codegen.to_c(equations, {"k": 1.0, "c": -0.1})


def test_an_exponent_whose_undoing_is_whole_is_refused_by_name() -> None:
    """Undone, ``k f**(1/2)`` is a square, which gives a flow for efforts that the law never has."""
    equations = _equations("k*f_r**n")
    assert codegen.to_c(equations, {"k": 2.0, "n": 1.5})
    with pytest.raises(
        bg.ParameterError, match=r"1/n is whole at n = 0.5; write that exponent into the law"
    ):
        codegen.simulator(equations, {"k": 2.0, "n": 0.5})


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_values_that_the_law_never_has_end_a_run_by_name(backend: str) -> None:
    """Of ``tanh f + atan f`` there are none beyond 1 + pi/2."""
    simulator = codegen.simulator(_equations("tanh(f_r) + atan(f_r)"), {}, backend=backend)
    assert simulator.run([0, 1], inputs={"u": 2.5})["f_r"] == pytest.approx(13.9, rel=0.1)
    with pytest.raises(bg.SimulationError, match="at t = 0 f_r has no value"):
        simulator.run([0, 1], inputs={"u": 2.6})
