"""Values that a program gives to tables of exported C: between them what scipy's interpolators have."""

import re
import subprocess
from pathlib import Path

import networkx as nx
import numpy as np
import pytest
from oracles.c_model import WARNED, compiled, written
from oracles.tuned import END, LEAVES, NUMBERS, PUSH, START, dragged, speed
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
from codegen.numbers.cells import steepest

Array = np.ndarray

ROUNDING = 1e-12

MAIN = r"""
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "model_internal.h"
static bg_own_tables own;
static double z[BG_TABLE_VALUES];
int main(int count, char **given)
{
    const int dx = atoi(given[1]), dy = atoi(given[2]);
    double at[2], value;
    int status;
    (void)count;
    if (fread(z, sizeof(double), BG_TABLE_VALUES, stdin) != BG_TABLE_VALUES)
        return 1;
    bg_tables_init(&own);
    status = bg_tables_set(&own, 0, z);
    if (status != BG_OK)
        return 10 + (status == BG_TABLE_VALUE);
    fwrite(&own.tables[0].steepest, sizeof(double), 1, stdout);
    while (fread(at, sizeof(double), 2, stdin) == 2) {
        value = own.tables[0].breaks[1]
                    ? bg_interpolate_over(own.tables, dx, dy, at[0], at[1], -1.0, -1.0)
                    : bg_interpolate(own.tables, dx, at[0], -1.0);
        fwrite(&value, sizeof(double), 1, stdout);
    }
    return 0;
}
"""


def _program(axes: list[Array], method: str, outside: str, folder: Path) -> Path:
    """A program over a table that was generated with no values but zeros."""
    flat = np.zeros([len(axis) for axis in axes])
    table = bg.LookupTable("map", *axes, flat, method=method, outside=outside)
    graph = nx.DiGraph(tables=[table])
    call = "map(t, v)" if len(axes) == 2 else "map(v)"
    graph.add_nodes_from([bg.Se("s", call), bg.One("n"), bg.I("m", 1, flow="v")])
    graph.add_edges_from([("s", "n"), ("n", "m")])
    files = codegen.to_c(bg.derive(graph), {}) | {"main.c": MAIN}
    needs = ("main.c", "model_table.c", "model_search.c", "model_fit.c", "model_linear.c")
    kept = {name: text for name, text in files.items() if name.endswith(".h") or name in needs}
    text = files["model.c"]
    begin, end = text.index("/* The table map"), text.index("const char *const bg_lookup_names")
    kept["model.c"] = f'#include "model_internal.h"\n\n{text[begin:end]}'
    return compiled(folder, written(folder, kept), *WARNED)


def _looked_up(program: Path, z: Array, orders: tuple[int, ...], places: list[Array]) -> Array:
    """The bound on the slope, then values."""
    told = [str(order) for order in (*orders, 0)[:2]]
    rows = np.column_stack([places[0], places[-1]])
    given = np.ascontiguousarray(z, dtype=float).tobytes() + rows.tobytes()
    done = subprocess.run([program, *told], input=given, capture_output=True, check=True)
    return np.frombuffer(done.stdout)


@pytest.mark.parametrize("method", METHODS)
def test_between_new_values_is_what_scipy_has(method: str, tmp_path: Path) -> None:
    table, parts = random_table(method, "extend")
    program = _program(parts[:-1], method, "extend", tmp_path)
    places = random_places(parts[:-1], outside=True)
    for orders in orders_of(method):
        bound, *found = _looked_up(program, parts[-1], orders, places)
        right = interpolated(method, "extend", parts, places, orders)
        assert off(np.array(found), right) < ROUNDING, orders
    if len(table.axes) == 1:
        assert bound == pytest.approx(steepest(table), rel=ROUNDING)


@pytest.mark.parametrize(
    ("method", "counts"),
    [
        ("linear", (2,)),
        ("pchip", (2,)),
        ("pchip", (3,)),
        ("akima", (3,)),
        ("akima", (4,)),
        ("bilinear", (2, 3)),
        ("bicubic", (4, 4)),
        ("bicubic", (5, 4)),
        ("bicubic", (6, 9)),
    ],
)
def test_so_it_is_of_few_points(method: str, counts: tuple[int, ...], tmp_path: Path) -> None:
    rng = np.random.default_rng(len(counts) + sum(counts))
    axes = [np.cumsum(rng.uniform(0.05, 1.0, count)) for count in counts]
    program, places = _program(axes, method, "hold", tmp_path), random_places(axes, outside=True)
    for _ in range(5):
        z = rng.normal(size=counts)
        _, *found = _looked_up(program, z, (0,) * len(axes), places)
        right = interpolated(method, "hold", [*axes, z], places, (0,) * len(axes))
        assert off(np.array(found), right) < ROUNDING


@pytest.mark.parametrize("method", ["pchip", "akima"])
def test_slopes_of_values_in_rows_and_plateaus_are_scipys(method: str, tmp_path: Path) -> None:
    """Where chords are level, alike or turn round, slopes are chosen; whole numbers meet all of that."""
    rng = np.random.default_rng(3)
    axes = [np.arange(9.0)]
    program, places = _program(axes, method, "extend", tmp_path), random_places(axes, outside=False)
    for _ in range(40):
        z = rng.integers(-1, 2, 9).astype(float)
        if not z.any():
            continue
        _, *found = _looked_up(program, z, (0,), places)
        assert (
            off(np.array(found), interpolated(method, "extend", [*axes, z], places, (0,)))
            < ROUNDING
        )


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e308])
def test_what_is_no_number_is_refused(bad: float, tmp_path: Path) -> None:
    """So are values that are, where what is between them is none."""
    program = _program([np.arange(4.0)], "pchip", "hold", tmp_path)
    z = np.array([0.0, -bad, bad, 1.0])
    done = subprocess.run([program, "0", "0"], input=z.tobytes(), capture_output=True, check=False)
    assert done.returncode == 11


def _printed(program: Path, *words: str) -> Array:
    done = subprocess.run(
        [program, f"{END!r}", "0.01", *words], capture_output=True, text=True, check=True
    )
    return np.array([row.split(",")[:2] for row in done.stdout.splitlines()[1:]], dtype=float).T


@pytest.fixture(scope="module")
def pushed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Programs over a table of zeros, that holds its ends or refuses what is beyond."""
    found = {}
    for outside, flags in (("hold", (*WARNED, "-O1")), ("refuse", ("-O0",))):
        folder = tmp_path_factory.mktemp(outside)
        files = codegen.to_c(dragged(outside), NUMBERS, main=True, initial=START, inputs=PUSH)
        found[outside] = compiled(folder, written(folder, files), *flags)
    return found


@pytest.mark.parametrize(("words", "within"), [(["located"], 1e-9), ([], 1e-4)])
def test_a_program_takes_values_and_locates_the_corners_that_they_make(
    words: list[str], within: float, pushed: dict[str, Path]
) -> None:
    """The table is flat where it is written: it has no corner then, and three with these values."""
    t, v = _printed(pushed["hold"], "drag=-4,0,1,3", *words)
    assert np.abs(v - speed(t)).max() < within
    t, v = _printed(pushed["hold"], *words)
    assert v == pytest.approx(4 * t - 1, abs=1e-9)


@pytest.mark.parametrize("words", [["located"], [], ["step=0.001"]])
def test_a_table_that_is_left_is_named(words: list[str], pushed: dict[str, Path]) -> None:
    asked = [pushed["refuse"], "2.5", "0.01", "drag=-4,0,1,3", *words]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    told = re.search(r"at t = (\S+) w leaves table 'drag', which is from -2 to 3", done.stderr)
    assert done.returncode == 1
    assert told is not None
    assert float(told[1]) == pytest.approx(LEAVES, abs=0.02)


@pytest.mark.parametrize("told", ["drag=1,2,3", "drag=1,2,3,4,5", "drag=1,nan,3,4", "drag="])
def test_wrong_values_are_refused_by_name(told: str, pushed: dict[str, Path]) -> None:
    done = subprocess.run(
        [pushed["hold"], "1", "0.1", told], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert "table drag: give 4 finite numbers" in done.stderr


def test_what_is_worked_out_once_is_of_the_values_that_are_given(tmp_path: Path) -> None:
    """A resistance that a table tells at a parameter: v falls by exp(-map(2) t/m)."""
    graph = nx.DiGraph(tables=[bg.LookupTable("map", [0, 1, 3], [1, 1, 1])])
    graph.add_nodes_from([bg.One("n"), bg.I("m", 2, flow="v"), bg.R("r", "map(k)")])
    graph.add_edges_from([("n", "m"), ("n", "r")])
    files = codegen.to_c(bg.derive(graph), {"k": 2}, main=True, initial={"v": 1.0})
    program = compiled(tmp_path, written(tmp_path, files), "-O0")
    t, v = _printed(program, "map=5,0,8", "located")
    assert v == pytest.approx(np.exp(-2 * t), abs=1e-9)
    t, v = _printed(program, "map=5,0,8", "k=0")
    assert v == pytest.approx(np.exp(-2.5 * t), abs=1e-8)
