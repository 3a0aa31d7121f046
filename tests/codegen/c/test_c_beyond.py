"""What a law that is turned round never gives ends runs on every route, by the law's name and in time.

A mass has the speed ``exp(p) - 1``: it is driven at ``v = -3 t``, to -1 at t = 1/3, or begins at -2.
"""

import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles.c_model import WARNED, compiled, written
from references.build import bond_graph

import bondgraph as bg
import codegen

LEFT = r"at t = (\S+) (?:v|w) \+ 1 leaves what is above 0: the law of 'm' gives it in no state; begin where"


def _equations() -> bg.StateEquations:
    """A flywheel shares the speed of the mass, which is dependent."""
    nodes = [bg.Se("T", "T"), bg.One("n"), bg.I("J", "J"),
             bg.I("m", law="exp(p_m) - 1", flow="w", priority=-1)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "T>n>J n>m"))


def _driven() -> bg.StateEquations:
    nodes = [
        bg.Sf("v", "v"),
        bg.Zero("n"),
        bg.R("r", "r"),
        bg.One("o"),
        bg.I("m", law="exp(p_m) - 1"),
    ]
    return bg.derive(bond_graph(nodes, "v>o o>m o>n n>r"))


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_runs_end_where_it_is(backend: str) -> None:
    made = codegen.simulator(_driven(), {"r": 1.0}, backend=backend)
    with pytest.raises(bg.SimulationError, match=LEFT) as told:
        made.run(np.linspace(0, 2, 5), inputs={"v": codegen.Ramp(0.0, -3.0)})
    found = re.search(LEFT, str(told.value))
    assert found is not None
    assert float(found[1]) == pytest.approx(1 / 3, abs=1e-8)


def test_steps_in_python_end_there() -> None:
    module: dict[str, Any] = {}
    exec(codegen.to_python(_equations(), {"J": 1.0}), module)
    with pytest.raises(module["EvaluationError"], match=LEFT):
        module["simulate"]([0.0, 1.0], {"w": -2.0}, {"T": -1.0}, step=0.1)


@pytest.mark.parametrize("words", [["located"], []])
def test_programs_in_c_end_there(words: list[str], tmp_path: Path) -> None:
    files = codegen.to_c(
        _equations(),
        {"J": 1.0},
        main=True,
        initial={"w": -2.0},
        inputs={"T": codegen.Constant(-1.0)},
    )
    program = compiled(tmp_path, written(tmp_path, files), *WARNED)
    asked = [program, "1.0", "0.1", *words]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert re.search(LEFT, done.stderr), done.stderr


def test_steps_in_python_end_where_slopes_have_no_value_at_all() -> None:
    """At -1 itself the slope 1/(1 + v) is a division by zero, which says nothing."""
    module: dict[str, Any] = {}
    exec(codegen.to_python(_driven(), {"r": 1.0}), module)
    with pytest.raises(module["EvaluationError"], match=LEFT) as told:
        module["simulate"]([0.0, 1.0, 2.0], {}, {"v": lambda t: -t}, step=0.25)
    found = re.search(LEFT, str(told.value))
    assert found is not None
    assert float(found[1]) == pytest.approx(1.0, abs=0.25)


def test_what_lies_between_two_ends_says_so() -> None:
    """``tanh(p)`` gives no speed from 1 on."""
    nodes = [bg.Sf("v", "v"), bg.One("o"), bg.I("m", law="tanh(p_m)"), bg.Zero("n"), bg.R("r", "r")]
    made = codegen.simulator(bg.derive(bond_graph(nodes, "v>o>m o>n>r")), {"r": 1.0})
    with pytest.raises(
        bg.SimulationError, match="v leaves what is between -1 and 1: the law of 'm'"
    ):
        made.run([0.0, 1.0], inputs={"v": codegen.Ramp(0.0, 3.0)})
