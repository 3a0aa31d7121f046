"""The text of exported C: fixed, whatever the names, and right for every function of a law."""

import subprocess
from pathlib import Path

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from oracles.c_model import STRICT, CModel, Pair, compiled, written
from oracles.exported import small_cases
from references.build import bond_graph

import bondgraph as bg
from codegen import to_c
from codegen.program.printing import printed
from differentials.model import model

GOLDEN = Path(__file__).parents[1] / "golden" / "alsd"


def _alsd() -> dict[str, str]:
    full = model("alsd")
    values = {symbol: one.value for symbol, one in full.parameters.items()}
    return to_c(full.equations, values | dict.fromkeys(full.starts, 80.0), full.laws, "alsd", True)


@pytest.mark.parametrize("name", ["config.h", "model.c"])
def test_the_differential_exports_as_before(name: str, update_golden: bool) -> None:
    text = _alsd()[name]
    if update_golden:
        GOLDEN.mkdir(parents=True, exist_ok=True)
        (GOLDEN / name).write_text(text, encoding="utf-8")
    assert text == (GOLDEN / name).read_text(encoding="utf-8")


def test_no_line_is_long_and_no_function_neither() -> None:
    for name, text in _alsd().items():
        assert max(map(len, text.splitlines())) <= 100, name
        length = 0
        for line in text.splitlines():
            length = 0 if line in ("{", "}") else length + 1
            if line == "}":
                assert length <= 60


NAMES = {
    "mass": "double", "push": "I", "spring": "c0", "speed": "M_PI", "damping": "BG_STATES",
    "force": "bg_model_init", "law": "NAN", "angle": "τ",
}  # fmt: skip
"""Keywords, macros, temporaries and functions as names of a model."""


def _named(names: dict[str, str]) -> bg.StateEquations:
    law = f"{names['law']}*{names['speed']}**3 + exp(-{names['angle']}**2)*{names['damping']}"
    nodes = [bg.Se("s", names["push"]), bg.One("n"), bg.I("m", names["mass"], flow=names["speed"]),
             bg.C("c", names["spring"], effort=names["force"]), bg.R("r", law=law),
             bg.Df("d", integrate=names["angle"])]  # fmt: skip
    return bg.derive(bond_graph(nodes, "s>n>m n>c n>r n>d"), outputs=["d"])


@pytest.mark.parametrize("names", [NAMES, {key: f"k_{key}" for key in NAMES},
                                   dict(zip(NAMES, ["K", "k", "Kk", "kK", "s", "v", "out", "time"],
                                            strict=True))])  # fmt: skip
def test_any_name_is_as_good_as_any_other(names: dict[str, str], tmp_path: Path) -> None:
    values = {names["mass"]: 2.0, names["spring"]: 0.1, names["damping"]: 0.3, names["law"]: 0.2}
    pair = Pair(tmp_path, _named(names), values)
    s, w = np.array([0.7, -0.4, 0.2]), np.array([1.5])
    now = pair.closed.evaluate(0.0, s, w, np.zeros(1), ())
    status, parts = pair.c.evaluate(0.0, s, w, [0.0], ())
    assert status == 0
    assert parts[5] == pytest.approx(now.rate, rel=1e-13)
    assert pair.c.rhs(0.0, s, w, []) == pytest.approx(now.rate, rel=1e-13)


def test_names_of_ports_and_models_cannot_end_comments_or_strings(tmp_path: Path) -> None:
    rude = '*/ int x; /* "\\ ??/ \n'
    nodes = [bg.Se("s", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R(rude, law="v**3", effort="e", flow="f"),
             bg.R(rude + "2", law=bg.DryFriction(1), effort="e_2", flow="f_2")]  # fmt: skip
    graph = bond_graph(nodes, "s>n>m")
    graph.add_edges_from([("n", rude), ("n", rude + "2")])
    files = to_c(bg.derive(graph), {"m": 1.0}, name=rude, main=True)
    program = compiled(tmp_path, written(tmp_path, files))
    done = subprocess.run([program], capture_output=True, check=False)
    assert done.stderr.startswith(b"usage: " + rude.encode())


x, y = sp.symbols("x y")
EXPRESSIONS = (
    sp.pi * x + sp.E * y, sp.sqrt(2) * x + sp.log(2) * y, 2**80 * x + sp.Integer(10) ** 20,
    x**7 / (x + 3) ** 2,
    sp.sign(x - y) / (2 * sp.sign(x + 5)), sp.Max(x, y, sp.Rational(1, 3)) - sp.Min(2 * x, y, x * y, 1),
    sp.Piecewise((1, x > y), (2, True)) / sp.Piecewise((3, x > 0), (4, True)), sp.Abs(x - y) ** 3,
    sp.Piecewise((x, sp.And(x > 0, y < 1)), (y, sp.Or(x < -1, sp.And(y > 0, x < 0))), (x * y, True)),
    sp.Rational(10**30 + 1, 3 * 10**29) * x, sp.atan2(x, y) + sp.cbrt(sp.Abs(x)) + sp.sinh(y),
    sp.Piecewise((x, sp.Not(sp.Eq(x, y))), (0, True)), sp.Float("1e-300") * x * sp.Float("1e299"),
)  # fmt: skip


def test_every_function_of_laws_is_right_in_c(tmp_path: Path) -> None:
    points = [(0.3, 0.7), (-1.5, 0.2), (0.4, -2.0), (-0.5, -0.6), (1.0, 1.0)]
    lines = [
        "#include <math.h>",
        "#include <stdio.h>",
        '#include "model_internal.h"',
        "int main(void)",
        "{",
    ]
    for a, b in points:
        lines += ["    {", f"        const double x = {a!r}, y = {b!r};"]
        lines += [
            f'        printf("%.17g\\n", (double)({printed(expr, language, {})}));'
            for expr in EXPRESSIONS
            for language in ("c", "checked_c")
        ]
        lines += ["    }"]
    written(tmp_path, _alsd())
    (tmp_path / "try.c").write_text("\n".join([*lines, "    return 0;", "}", ""]))
    program = compiled(tmp_path, [str(tmp_path / "try.c")], "-O2")
    found = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    expected = [
        float(expr.subs({x: sp.Rational(a), y: sp.Rational(b)}).evalf(30))
        for a, b in points
        for expr in EXPRESSIONS
        for _ in range(2)
    ]
    assert [float(one) for one in found] == pytest.approx(expected, rel=1e-14, abs=1e-15)


@pytest.mark.parametrize("name", ["slip_damper", "mixed"])
def test_friction_that_is_solved_for_jointly_compiles_without_a_warning(
    name: str, tmp_path: Path
) -> None:
    """Its loop has no more places than ports and laws, which an optimising compiler looks at."""
    equations, numbers, laws = dict(small_cases())[name]
    written(tmp_path, to_c(equations, numbers, laws))
    command = ["gcc", "-O2", *STRICT, "-Werror", "-c", "model_evaluate.c"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_what_is_no_number_is_reported_and_not_clipped_away(tmp_path: Path) -> None:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="max(0, log(v)) + sign(v)")]
    pair = Pair(tmp_path, bg.derive(bond_graph(nodes, "n>m n>r")), {})
    assert pair.c.evaluate(0.0, [2.0], [], [], ())[0] == 0
    status, _ = pair.c.evaluate(0.0, [-2.0], [], [], ())
    assert "no finite value" in pair.c.message(status)


def test_parameters_that_change_what_is_redundant_are_refused(tmp_path: Path) -> None:
    """Slips v - w/a and v - w/b are one where a = b."""
    nodes = [bg.One("n"), bg.I("m", "m", flow="v"), bg.One("k"), bg.I("l", "l", flow="w"),
             bg.Zero("z1"), bg.TF("g1", "a"), bg.Zero("z2"), bg.TF("g2", "b"),
             bg.R("b1", law=bg.DryFriction(3)), bg.R("b2", law=bg.DryFriction(2))]  # fmt: skip
    bonds = "n>m k>l n>z1>g1>k z1>b1 n>z2>g2>k z2>b2"
    values = {"m": 1.0, "l": 2.0, "a": 1.5, "b": 1.5}
    pair = Pair(tmp_path, bg.derive(bond_graph(nodes, bonds)), values)
    assert pair.c.evaluate(0.0, [0.5, 0.1], [], [], (0, 0))[0] == 0
    other = CModel(pair.library, pair.program, values | {"b": 1.6})
    assert other.evaluate(0.0, [0.5, 0.1], [], [], (0, 1))[0] == 0
    status, _ = other.evaluate(0.0, [0.5, 0.1], [], [], (0, 0))
    assert "redundant" in other.message(status)
    none = CModel(pair.library, pair.program, values | {"m": 0.0})
    assert "singular" in none.message(none.status)


@pytest.mark.parametrize("count", [3, 4, 12])
def test_several_redundant_ports_share_as_fairly_as_can_be(count: int, tmp_path: Path) -> None:
    """All on one shaft: the same fraction of each one's breakaway effort."""
    ports = [bg.R(f"b{k}", law=bg.DryFriction(k + 1)) for k in range(count)]
    graph = bond_graph([bg.Se("s", "P"), bg.One("n"), bg.I("m", 1), *ports],
                       "s>n>m " + " ".join(f"n>{p[0]}" for p in ports))  # fmt: skip
    pair = Pair(tmp_path, bg.derive(graph), {})
    status, parts = pair.c.evaluate(0.0, [0.0], [0.7], [0.0], (0,) * count)
    assert status == 0
    caps = np.arange(1, count + 1)
    found = parts[2][pair.closed.friction_inputs]
    assert found == pytest.approx(0.7 * caps / caps.sum(), rel=1e-12)


def test_strings_are_not_broken_at_their_blanks(tmp_path: Path) -> None:
    """Of brakes called by several words, more than stand on a line."""
    names = [f"a brake with number {at}" for at in range(6)]
    brakes = [bg.R(name, law=bg.DryFriction("1"), effort=f"e{at}", flow=f"f{at}")
              for at, name in enumerate(names)]  # fmt: skip
    graph = nx.DiGraph()
    graph.add_nodes_from([bg.One("j"), bg.I("m", "m"), *brakes])
    graph.add_edges_from([("j", "m"), *(("j", name) for name in names)])
    files = to_c(bg.derive(graph), {"m": 1.0}, main=True)
    for name in names:
        assert f'"{name}"' in files["model.c"]
    program = compiled(tmp_path, written(tmp_path, files), "-O0")
    done = subprocess.run([program, "1", "1"], capture_output=True, text=True, check=False)
    assert done.returncode == 0
