"""Tables in generated C and Python are numpy's and scipy's interpolators, values and slopes."""

import subprocess
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from oracles.c_model import WARNED, compiled, written
from references.interpolated import (
    METHODS,
    interpolated,
    off,
    orders_of,
    random_places,
    random_table,
)

import bondgraph as bg
import codegen
from bondgraph.tables.edges import bits, edge, edges
from bondgraph.tables.looking import FREE, looked_up
from bondgraph.tables.pieces import pieces
from codegen.c.bounded import findings
from codegen.c.counting import counted
from codegen.program.lower import lower
from codegen.standalone.arrays import Array

ROUNDING = 1e-12
OUTSIDE = ("hold", "extend", "refuse")

FEW = 5_000
"""Arguments where Python looks in one by one."""

MAIN = r"""
#include <stdio.h>
#include <stdlib.h>
#include "model_internal.h"
int main(int count, char **given)
{
    const int dx = atoi(given[1]), dy = atoi(given[2]), edge = count > 3;
    double at[4], value;
    while (fread(at, sizeof(double), 4, stdin) == 4) {
        if (edge)
            value = bg_edge(bg_tables, dx, dy, at[0], at[2]);
        else if (bg_tables[0].breaks[1])
            value = bg_interpolate_over(bg_tables, dx, dy, at[0], at[1], at[2], at[3]);
        else
            value = bg_interpolate(bg_tables, dx, at[0], at[2]);
        fwrite(&value, sizeof(double), 1, stdout);
    }
    return 0;
}
"""


def _equations(table: bg.LookupTable) -> bg.StateEquations:
    graph = nx.DiGraph(tables=[table])
    call = "map(t, v)" if len(table.axes) == 2 else "map(v)"
    graph.add_nodes_from([bg.Se("s", call), bg.One("n"), bg.I("m", 1, flow="v")])
    graph.add_edges_from([("s", "n"), ("n", "m")])
    return bg.derive(graph)


def _by_c(
    program: Path, orders: tuple[int, ...], places: list[Array], regions: list[Array], *how: str
) -> Array:
    given = np.column_stack([places[0], places[-1], regions[0], regions[-1]])
    told = [*(str(order) for order in (*orders, 0)[:2]), *how]
    done = subprocess.run([program, *told], input=given.tobytes(), capture_output=True, check=True)
    return np.frombuffer(done.stdout)


def _program(table: bg.LookupTable, folder: Path) -> Path:
    """A program that looks into a table; the whole model would want all of its runtime."""
    files = codegen.to_c(_equations(table), {}) | {"main.c": MAIN}
    kept = {name: files[name] for name in files if name.endswith(".h")}
    kept |= {name: files[name] for name in ("main.c", "model_table.c", "model_search.c")}
    kept["model.c"] = _tables_alone(files["model.c"])
    return compiled(folder, written(folder, kept), *WARNED, "-Wno-unused-const-variable")


def _tables_alone(text: str) -> str:
    """The constants of tables among those of a model."""
    begin = text.index("/* The table map")
    end = text.index(";", text.index("const bg_table bg_tables[]")) + 1
    return '#include <math.h>\n\n#include "model_internal.h"\n\n' + text[begin:end] + "\n"


@pytest.mark.parametrize("outside", OUTSIDE)
@pytest.mark.parametrize("method", METHODS)
def test_values_and_slopes_are_the_interpolators_own(
    method: str, outside: str, tmp_path: Path
) -> None:
    table, parts = random_table(method, outside)
    places = random_places(parts[:-1], outside=True)
    program, free = _program(table, tmp_path), [np.full(len(places[0]), float(FREE))]
    for orders in orders_of(method):
        right = interpolated(method, outside, parts, places, orders)
        assert off(_by_c(program, orders, places, free), right) < ROUNDING, orders


@pytest.mark.parametrize("outside", OUTSIDE)
@pytest.mark.parametrize("method", METHODS)
def test_python_has_the_same(method: str, outside: str) -> None:
    table, parts = random_table(method, outside)
    places = [one[:FEW] for one in random_places(parts[:-1], outside=True)]
    module: dict[str, Any] = {}
    exec(codegen.to_python(_equations(table), {}), module)
    for orders in orders_of(method):
        rows = zip(*(one.tolist() for one in places), strict=True)
        found = [module["looked_up"](module["_table_map"], orders, row) for row in rows]
        right = interpolated(method, outside, parts, places, orders)
        assert off(np.array(found), right) < ROUNDING, orders


@pytest.mark.parametrize("outside", OUTSIDE)
@pytest.mark.parametrize("method", METHODS)
def test_stretches_between_corners_are_those_of_python(
    method: str, outside: str, tmp_path: Path
) -> None:
    given, parts = random_table(method, outside)
    table, program, rng = pieces(given), _program(given, tmp_path), np.random.default_rng(2)
    places = [one[:FEW] for one in random_places(parts[:-1], outside=True)]
    corners = [edges(table, axis) for axis in range(len(places))]
    regions = [rng.integers(FREE, len(one) + 1, FEW).astype(float) for one in corners]
    rows = list(zip(*(np.column_stack(one).tolist() for one in (places, regions)), strict=True))
    for orders in orders_of(method):
        right = np.array([looked_up(table, orders, at, region) for at, region in rows])
        assert off(_by_c(program, orders, places, regions), right) < ROUNDING
    for axis, found in enumerate(corners):
        for bit in range(bits(len(found))):
            right = np.array(
                [edge(table, axis, bit, at[axis], region[axis]) for at, region in rows]
            )
            told = _by_c(program, (axis, bit), [places[axis]], [regions[axis]], "edge")
            assert off(told, right) < ROUNDING


def test_looking_up_is_bounded_and_counted() -> None:
    """Of 100 points seven halves; a line is two products and a sum for each of its two factors."""
    x = np.linspace(0, 1, 100)
    equations = _equations(bg.LookupTable("map", x, x))
    files = codegen.to_c(equations, {})
    assert findings(files) == []
    found, plain = (
        counted(code.values[0] for code in (one.known.values, one.groups[0].values) if code.results)
        for one in (lower(equations), lower(equations, {"s": "sin(v)"}))
    )
    assert (plain.parts, found.parts) == ((0, 0, 0, 1), (4, 2 + 7, 0, 1))
