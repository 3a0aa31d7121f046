"""The routes: each goes one way with a kind and checks what comes of it.

A route that is refused raises a `BondGraphError`, one that goes wrong an `AssertionError`.
"""

import csv
import re
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from types import MappingProxyType

import numpy as np
import sympy as sp
from click.testing import CliRunner

import bondgraph as bg
import codegen
from bondgraph.show.powers import without_functions
from bondgraph.show.putting_in import closed
from bondgraph.show.statements import statements
from codegen.numbers.lambdified import lambdified
from codegen.tuning import TUNING
from differentials.commands.app import app
from oracles.exported import loaded
from oracles.routes.bench import (
    CLOSE,
    EXACT,
    FEW,
    LOCATED,
    MANY,
    UNIT,
    WIDER,
    Bench,
    same,
    stepped,
)
from oracles.ruled import ruled_misfit
from oracles.units import sampled, simulated

Route = Callable[[Bench], None]


def explain(bench: Bench) -> None:
    """Every state, every switch and every law is told; of many states, how many there are.

    Switches and laws of nodes of signals are told with the node.
    """
    kind = bench.kind
    text = str(bg.explain(kind.graph, inputs=kind.read))
    states = [*map(str, kind.equations.states)]
    nodes = {str(e.name): str(e.whole) for e in kind.equations.elements.values() if e.of_signals}
    parts = [*kind.switches, *map(str, kind.equations.laws)]
    told = [*states, *(nodes.get(name, name) for name in parts)]
    untold = [name for name in told if name not in text]
    if len(states) > 100:
        first, last = ", ".join(states[:5]), ", ".join(states[-2:])
        assert f"{len(states)} states: {first}, ..., {last}" in text
        assert {*untold} < {*states}
    else:
        assert untold == []


def explicit(bench: Bench) -> None:
    """The rates, at what the run gives at one instant, are those of the run about it.

    So what laws give that are left to be solved, of which only nonlinear loops have some.
    """
    kind, rates = bench.kind, bg.explicit(bench.kind.equations, bench.kind.laws)
    run, h = bench.about, CLOSE * kind.end
    assert bool(rates.implicit) == kind.loop
    for name, expr in rates.implicit.items():
        given, scale = run[str(name)][4], np.abs(bench.run[str(name)]).max()
        assert abs(_at(bench, expr, rates.where) - given) < 1e-6 * scale, f"the law of {name}"
    for state, rate in rates.items():
        slope = (run[str(state)][5] - run[str(state)][3]) / (2 * h)
        scale = max(abs(slope), np.abs(bench.run[str(state)]).max() / kind.end)
        assert abs(_at(bench, rate, rates.where) - slope) <= 1e-3 * scale, f"the rate of {state}"


def _at(bench: Bench, expr: sp.Expr, where: Mapping[sp.Symbol, sp.Expr]) -> float:
    """An expression at the instant of a kind, over names of parts."""
    kind, run, h = bench.kind, bench.about, CLOSE * bench.kind.end
    for name, part in reversed(where.items()):
        expr = expr.xreplace({name: part})
    numbers = {sp.Symbol(name): value for name, value in kind.numbers.items()}
    found = expr.subs(numbers).subs(sp.Symbol("t"), kind.at)
    moving = {name: name.name.removeprefix("d_") for name in found.free_symbols}
    values = {name: _value(run, name.name, source, h) for name, source in moving.items()}
    return float(found.subs(values))


def _value(run: codegen.Result, name: str, source: str, h: float) -> float:
    """A signal in the middle, or of ``d_...`` its slope."""
    values = run[source]
    return float(values[4] if name == source else (values[5] - values[3]) / (2 * h))


def whole(bench: Bench) -> None:
    """All states are shown, of many how many; what is stated holds at one instant, rates by differences."""
    equations = without_functions(bench.kind.equations)
    states, found = [*equations.states, *equations.further_states], statements(equations)
    kept = equations.kept
    text = str(equations)
    if "entries that are not zero" in text:
        assert f"{len(equations.states)} states" in text
    else:
        assert [name for name in states if f"{name}'" not in text and name not in kept] == []
        # What stays but at instants is told with what sets it.
        assert [name for name in kept if not re.search(rf"\b{name}(:| becomes)", text)] == []
    for one in (*found.given, *found.rates, *found.kept, *closed(equations, found)):
        if one.ruled is not None:
            assert ruled_misfit(one, partial(_number, bench), 1e-3) == ""
            continue
        sizes = [
            abs(_number(bench, factor * part)) for factor, part in (*one.left_terms, *one.right)
        ]
        off = abs(_number(bench, one.left) - _number(bench, one.value))
        assert off <= 1e-3 * max(sizes), f"{one.left} = {one.value}"


def _number(bench: Bench, expr: sp.Expr) -> float:
    """An expression at the instant; a name with a stroke is a rate."""
    kind, h = bench.kind, CLOSE * bench.kind.end
    names = sorted(expr.free_symbols, key=str)
    known = {**kind.numbers, "t": kind.at}
    values = [
        known[name.name] if name.name in known
        else 0.0 if name.name.removesuffix("'") in known
        else _value(bench.about, name.name, name.name.removesuffix("'"), h)
        for name in names
    ]  # fmt: skip
    return float(lambdified(names, expr)(*values))


def latex(bench: Bench) -> None:
    """Every matrix has its place, every symbol stands in it."""
    text = bg.latex(bench.kind.equations)
    letters = [sp.latex(name) for name in bench.kind.equations.states]
    assert [one for one in letters if one not in text] == []


def drawing(bench: Bench) -> None:
    """Every node is drawn, a switch as one, every bond with its stroke, every signal."""
    parts = {port.given for port in bench.kind.equations.ports if port.element.whole is not None}
    switches = [one for one in bench.kind.equations.plain_switches if one.port.given not in parts]
    stops = [node for node, kind in bench.kind.graph.nodes(data="kind") if kind == "Stop"]
    drawn = bg.drawing(bench.kind.graph)
    drawn.save(bench.folder / "kind.svg")
    assert {node.name for node in drawn.scene.nodes} >= {*bench.kind.graph}
    assert all(bond.stroke for bond in drawn.scene.bonds)
    assert len(drawn.scene.signals) == len(drawn.subject.signals)
    bonds = drawn.text().splitlines()[: len(drawn.scene.bonds)]
    assert sum(line.count("Sw: ") for line in bonds) == len(switches)
    assert sum(line.count("Stop: ") for line in bonds) == len(stops)


def json(bench: Bench) -> None:
    same(bg.from_json(bg.to_json(bench.kind.graph)), bench.kind.equations)


def graphml(bench: Bench) -> None:
    same(bg.from_graphml(bg.to_graphml(bench.kind.graph)), bench.kind.equations)


def commands(bench: Bench) -> None:
    """``simulate`` of a file, its table read again."""
    kind, table = bench.kind, bench.folder / "run.csv"
    words = ["simulate", str(bench.file), "-o", str(table), "--until", f"{kind.end!r}"]
    words += ["--sample", f"{kind.end / 50!r}"]
    for switch, given in (
        ("--set", kind.numbers),
        ("--initial", kind.initial),
        ("--input", kind.inputs),
        ("--law", kind.later),
    ):
        words += [word for name, value in given.items() for word in (switch, f"{name}={value}")]
    words += [word for name in kind.on for word in ("--on", name)]
    done = CliRunner().invoke(app, words)
    if done.exit_code:
        raise bg.BondGraphError(done.stderr.strip())
    with table.open(encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    found = dict(zip(head, np.array(rows, dtype=float).T, strict=True))
    # A table does not list what nodes of signals are made of.
    inner = {name for name in kind.switches if name in bench.run.inner}
    assert not inner & {*head}
    bench.check({**found, **{name: bench.run[name] for name in inner}}, EXACT)


def numpy(bench: Bench) -> None:
    bench.check(bench.run, EXACT)


def stepper(bench: Bench) -> None:
    """Steps from outside."""
    _stepped_outside(bench, bench.ready, EXACT)


def stepper_in_c(bench: Bench) -> None:
    with _in_c_alone():
        _stepped_outside(bench, bench.compiled, LOCATED)


def _stepped_outside(bench: Bench, ready: codegen.Simulator, within: float) -> None:
    kind = bench.kind
    one = ready.stepper(kind.initial, kind.signals, initially_on=kind.on)
    names = dict.fromkeys([*one.signals, *kind.switches])
    rows, told = [[one.signals[name] for name in names]], [*one.events]
    for t in kind.times()[1:]:
        found = one.advance(t - one.time)
        rows.append([found[name] for name in names])
        told += one.events
    bench.check(dict(zip(names, np.array(rows).T, strict=True)), within)
    assert [(e.port, e.kind) for e in told] == [(e.port, e.kind) for e in bench.run.events]


def c_exact(bench: Bench) -> None:
    _in_c(bench, "exact", EXACT)


def c_located(bench: Bench) -> None:
    _in_c(bench, "DOP853", LOCATED)


def _in_c(bench: Bench, method: str, within: float) -> None:
    kind = bench.kind
    with _in_c_alone():
        run = bench.compiled.run(
            kind.times(), kind.initial, kind.signals, method, initially_on=kind.on
        )
    assert run.backend == "c"
    bench.check(run, within)
    assert [(e.port, e.kind) for e in run.events] == [(e.port, e.kind) for e in bench.run.events]


@contextmanager
def _in_c_alone() -> Iterator[None]:
    """What numpy would do for C is a refusal."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", codegen.BackendWarning)
            yield
    except codegen.BackendWarning as told:
        raise bg.SimulationError(str(told)) from None


def sweep_numpy(bench: Bench) -> None:
    _swept(bench, "numpy", EXACT)


def sweep_c(bench: Bench) -> None:
    """By the loop in C."""
    with _in_c_alone():
        _swept(bench, "c", LOCATED)


def _swept(bench: Bench, backend: str, within: float) -> None:
    """Two runs: the kind's own, and one with another first number, against that by itself.

    As often as it takes for the runs of an affine kind to be done side by side.
    """
    kind, (name, value) = bench.kind, next(iter(bench.kind.numbers.items()))
    family = codegen.Family(kind.equations, kind.numbers, kind.laws, backend=backend)
    state = next(iter(kind.known(kind.times(), bench.run)))
    measures = {"all": codegen.samples(state), "last": codegen.final(state)}
    often = TUNING.side_by_side // 2 if family.program.affine and not kind.on else 1
    rows = codegen.Table(**{name: [value, 1.01 * value] * often})
    found = codegen.sweep(
        family, rows, kind.times(), measures, kind.initial, kind.signals,
        workers=0, progress=False, initially_on=kind.on,
    )  # fmt: skip
    if found.failed:
        raise bg.SimulationError(found.failed[0].message)
    other = codegen.simulator(kind.equations, {**kind.numbers, name: 1.01 * value}, kind.laws).run(
        kind.times(), kind.initial, kind.signals, initially_on=kind.on
    )
    for row, run in zip(found["all"], (bench.run, other) * often, strict=True):
        assert np.abs(row - run[state]).max() <= within * np.ptp(run[state])
    assert found["last"].tolist() == found["all"][:, -1].tolist()


def to_python(bench: Bench) -> None:
    """Fixed steps, as a real-time target takes them."""
    kind = bench.kind
    module = loaded(codegen.to_python(kind.equations, kind.numbers, kind.laws, "kind"))
    on = {"initially_on": list(kind.on)} if kind.switches else {}
    run = module.simulate(kind.times(), kind.initial, kind.signals, step=kind.end / FEW, **on)
    bench.check(run, stepped(FEW), aside=1.5 * kind.end / FEW)


def to_c_stepped(bench: Bench) -> None:
    """The same in C."""
    end = bench.kind.end
    bench.check(bench.printed(f"step={end / MANY!r}"), stepped(MANY), aside=1.5 * end / MANY)


def to_c_located(bench: Bench) -> None:
    bench.check(bench.printed("located"), LOCATED)


def _fmu(version: str, how: str) -> Route:
    def route(bench: Bench) -> None:
        kind, (path, case) = bench.kind, bench.unit(version)
        known = kind.known(kind.times(), bench.run)
        names = list(dict.fromkeys([*map(str, bench.run.states), *known, *kind.switches]))
        found = sampled(simulated(path, how, case, names, 51), case, 51)
        # An importer reads of an event what is before or after it.
        bench.check(found, UNIT, aside=1e-7 * kind.end)

    return route


def linearize(bench: Bench) -> None:
    """In the mode of the run: along it, rates change as the linear model says."""
    kind, run, h = bench.kind, bench.about, WIDER * bench.kind.end
    # Twice the distance before, once, at it, and the same after.
    samples = [1, 2, 4, 6, 7]
    given = {*map(str, kind.equations.inputs)}
    outside = [name for name in kind.inputs if name not in given]
    # What a switch gives or receives, its mode tells, and the run but to rounding.
    told = {
        str(name) for one in kind.equations.switches for name in (one.port.given, one.port.received)
    }
    names = {*map(str, kind.equations.signals), *run.states, *outside, *kind.read} - told
    read = {*map(str, set().union(*(law.free_symbols for law in kind.equations.laws.values())))}
    point = {name: float(run[name][4]) for name in names} | {"t": kind.at}
    # On which side of a corner a law is, may depend on its numbers.
    point |= {name: value for name, value in kind.numbers.items() if name in read}
    model = bg.linearize(
        kind.equations,
        at=point,
        laws=kind.laws,
        mode=kind.mode,
        inputs=[name for name in outside if name in read],
        rates={name: _value(run, f"d_{name}", name, CLOSE * kind.end) for name in kind.read},
    )
    numbers = {sp.Symbol(name): value for name, value in kind.numbers.items()}
    sizes = len(model.states), len(model.inputs)
    A, J, B = (
        np.array(getattr(model, one).subs(numbers), dtype=float).reshape(sizes[0], size)
        for one, size in zip("AJB", (sizes[0], *sizes), strict=True)
    )
    x, u = (
        np.array([run[str(name)][samples] for name in some]).reshape(len(some), 5)
        for some in (model.states, model.inputs)
    )
    change = A @ (x[:, 4] - 2 * x[:, 2] + x[:, 0]) / (4 * h * h)
    expected = (J @ (x[:, 3] - x[:, 1]) + B @ (u[:, 3] - u[:, 1])) / (2 * h)
    scale = np.abs(A) @ np.abs(x).max(axis=1) / kind.end**2 + np.abs(J) @ np.ptp(x, axis=1) / h
    assert (np.abs(change - expected) <= 2e-2 * scale + 1e-9).all(), (change, expected)


def trim(bench: Bench) -> None:
    """A steady state, from which a run does not move."""
    kind = bench.kind
    rest, ready = kind.rest or {}, bench.ready
    point = codegen.trim(ready, rest.get("inputs"), rest.get("initial"))
    start = {name: point[name] for name in ready.states}
    run = ready.run([0.0, 0.01 * kind.end], start, rest.get("inputs"), initially_on=kind.on)
    for name in ready.states:
        assert abs(run[name][-1] - start[name]) < 1e-6 * (1 + abs(start[name])), name


ROUTES: Mapping[str, Route] = MappingProxyType(
    {
        "print": whole, "explain": explain, "explicit": explicit, "latex": latex,
        "drawing": drawing, "JSON": json, "GraphML": graphml, "numpy": numpy,
        "stepper": stepper, "linearize": linearize, "trim": trim,
        "sweep": sweep_numpy, "command line": commands,
        "to_python": to_python, "C, exact": c_exact, "C, located": c_located,
        "stepper in C": stepper_in_c,
        "sweep in C": sweep_c, "to_c, fixed steps": to_c_stepped,
        "to_c, located": to_c_located, "FMI 2 ME": _fmu("2.0", "ModelExchange"),
        "FMI 2 CS": _fmu("2.0", "CoSimulation"), "FMI 3 ME": _fmu("3.0", "ModelExchange"),
        "FMI 3 CS": _fmu("3.0", "CoSimulation"),
    }
)  # fmt: skip
"""By the heads of their columns, those that need a compiler last."""

COMPILED = tuple(ROUTES)[tuple(ROUTES).index("C, exact") :]
