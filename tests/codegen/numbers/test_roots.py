"""Roots of functions that are steep, flat, or jump: in Python and in C, by the same steps."""

import math
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import compiled, written
from references.build import bond_graph
from soak.families import whole

import bondgraph as bg
from codegen import switched_simulator, to_c
from codegen.standalone.roots import root

#: A function in Python and in C, two points, its root, and how exactly it is known.
CASES: list[tuple[Callable[[float], float], str, float, float, float, float]] = [
    (lambda x: x * x - 2, "x*x - 2", 0.0, 2.0, math.sqrt(2), 4e-16),
    (lambda x: math.exp(x) - 5, "exp(x) - 5", 0.0, 10.0, math.log(5), 4e-16),
    (lambda x: math.atan(x - 0.3), "atan(x - 0.3)", -1e6, 2e6, 0.3, 2e-16),
    (lambda x: 1.0 if x < 0.3 else -2.0, "x < 0.3 ? 1.0 : -2.0", 0.0, 1.0, 0.3, 4e-16),
    (lambda x: x, "x", -1.0, 3.0, 0.0, 4e-30),
    (lambda x: x * x * x, "x*x*x", -1.0, 2.0, 0.0, 4e-30),
    (lambda x: math.sqrt(0.3 - x) if x <= 0.3 else math.nan, "sqrt(0.3 - x)", 0.0, 1.0, 0.3, 4e-16),
]
#: Roots of many folds are exact: nothing cancels in the factor.
for folds in (3, 5, 7, 15, 21):

    def fold(x: float, folds: int = folds) -> float:
        return math.prod([x - 0.7] * folds)

    CASES.append((fold, "*".join(["(x - 0.7)"] * folds), -5.0, 3.0, 0.7, 4e-16))


@pytest.mark.parametrize("case", CASES, ids=[text[:12] for _, text, *_ in CASES])
def test_a_root_is_found_in_few_steps(case) -> None:
    f, _, a, b, right, near = case
    asked: list[float] = []

    def counted(x: float) -> float:
        asked.append(x)
        return f(x)

    for begin, end in ((a, b), (b, a)):
        asked.clear()
        assert abs(root(counted, begin, end) - right) <= near
        # Three steps at the most for each of the halvings from the interval to 1e-30 of it.
        assert len(asked) <= 4 * 100


def test_c_takes_the_same_steps(tmp_path: Path) -> None:
    graph = bond_graph([bg.One("j"), bg.I("m", 1), bg.R("b", 1)], "j>m j>b")
    written(tmp_path, to_c(bg.derive(graph), {}))
    lines = ["#include <math.h>", "#include <stdio.h>", '#include "model_internal.h"']
    for at, (_, text, *_) in enumerate(CASES):
        lines.append(f"static double f{at}(void *self, double x) {{ (void)self; return {text}; }}")
    lines += ["int main(void) {", "    double found = 0.0;"]
    for at, (_, _, a, b, *_) in enumerate(CASES):
        lines.append(f"    bg_root(f{at}, NULL, {a!r}, {b!r}, &found);")
        lines.append('    printf("%.17g\\n", found);')
    (tmp_path / "try.c").write_text("\n".join([*lines, "    return 0;", "}", ""]))
    program = compiled(
        tmp_path, [str(tmp_path / "try.c"), str(tmp_path / "model_roots.c")], "-ffp-contract=off"
    )
    found = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    expected = [root(f, a, b) for f, _, a, b, *_ in CASES]
    assert np.array([float(one) for one in found]) == pytest.approx(expected, rel=3e-16, abs=4e-30)


FLAT = [(f"{scale:g}*(x - {at:g})**{folds}", at)
        for scale in (1e-3, 1.0, 1e5) for at in (0.0, 0.25, 3.0) for folds in (3, 5, 7)]  # fmt: skip


@pytest.mark.parametrize(("guard", "at"), FLAT if whole("flat") else FLAT[::5])
def test_a_guard_that_is_flat_where_it_rises(guard: str, at: float) -> None:
    """``x = t - 1`` passes ``at`` at ``1 + at``: there the switch goes on, once."""
    nodes = [bg.One("m"), bg.I("M", 1, flow="v"), bg.Df("p", integrate="x"), bg.One("j"), bg.Se("u", 1),
             bg.R("r", "1 + v**2"), bg.Sw("k", on=guard)]  # fmt: skip
    graph = bond_graph(nodes, "m>M m>p u>j j>k j>r")
    (event,) = switched_simulator(graph, {}).run([0.0, 6.0], {"x": -1, "v": 1}).events
    assert (event.port, event.kind) == ("k", "on")
    assert event.time == pytest.approx(1 + at, abs=1e-12)
