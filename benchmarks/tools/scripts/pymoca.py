"""Pymoca: Modelica into CasADi's expressions, which SUNDIALS integrates by CasADi.

What it makes are residuals in states, their rates and all other unknowns, linear in the last two here: they
are solved for by a sparse linear solver of CasADi, and the rates are integrated by CVODES.
"""

from typing import Any

import casadi as ca
import numpy as np
import pymoca.backends.casadi.generator as generator
import pymoca.parser

TIGHT = {"reltol": 1e-9, "abstol": 1e-9, "max_num_steps": 100_000}


def rates(text: str, name: str, swept: tuple[str, ...] = ()) -> tuple[Any, list[str], Any]:
    """The rates as a function of states and the swept parameters, the states' names and starts."""
    made = generator.generate(pymoca.parser.parse(text), name)
    x = ca.vertcat(*(one.symbol for one in made.states))
    unknown = ca.vertcat(*(one.symbol for one in [*made.der_states, *made.alg_states]))
    p = {one.symbol.name(): one for one in [*made.parameters, *made.constants]}
    given = [one.symbol for one in p.values()]
    both = ca.vertcat(*made.equations)
    given_all = [unknown, x, made.time, *given]
    if any(ca.which_depends(both, unknown, 2, True)):
        raise ValueError("the residuals are not linear in the rates and other unknowns")
    # So the value and the slope at zero tell all.
    at_zero = ca.Function("at_zero", given_all, [both, ca.jacobian(both, unknown)])
    free = {key: ca.MX.sym(key) for key in swept}
    numbers = [free.get(key, float(one.value)) for key, one in p.items()]
    time, told = ca.MX.sym("t"), ca.MX.sym("x", x.shape[0])
    value, slope = at_zero(0, told, time, *numbers)
    names = [one.symbol.name() for one in made.states]
    solved = ca.solve(slope, -value, "csparse")[: len(names)]
    function = ca.Function("rates", [time, told, *free.values()], [solved])
    return function, names, [float(one.start) for one in made.states]


def integrator(spec: dict[str, Any], text: str, name: str, swept: tuple[str, ...] = ()) -> Any:
    """What integrates a text's model from sample to sample."""
    function, names, start = rates(text, name, swept)
    x, p, t = ca.MX.sym("x", len(names)), ca.MX.sym("p", len(swept)), ca.MX.sym("t")
    parts = [p[k] for k in range(len(swept))]
    dae = {"x": x, "t": t, "ode": function(t, x, *parts), **({"p": p} if swept else {})}
    times = np.linspace(0.0, spec["end"], spec["samples"]) if "samples" in spec else [spec["end"]]
    made = ca.integrator("run", "cvodes", dae, 0.0, list(times), TIGHT)
    return made, function, names, start


def prepare(name: str) -> Any:
    """What compiles a model of this name."""
    return lambda spec: integrator(spec, spec["modelica"], name)


def run(ready: Any) -> Any:
    """States at the samples, one row each."""
    made, _, _, start = ready
    return np.array(made(x0=start)["xf"]).T


def columns(ready: Any, found: Any, names: list[str]) -> list[list[float]]:
    """Some states at the samples."""
    return np.column_stack([found[:, ready[2].index(name)] for name in names]).tolist()


def chain_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Eigenvalues of the rates' Jacobian, and speeds."""
    function, names = ready[1:3]
    x = ca.MX.sym("x", len(names))
    A = np.array(ca.Function("A", [x], [ca.jacobian(function(0, x), x)])(np.zeros(len(names))))
    values = [f"m_{k}.w" for k in range(len(spec["inertias"]))]
    return {
        "eigenvalues": [[v.real, v.imag] for v in np.linalg.eigvals(A).tolist()],
        "values": columns(ready, found, values),
    }


def ladder_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Times and voltages."""
    names = [f"C_{k}.v" for k in range(1, spec["sections"] + 1)]
    times = np.linspace(0.0, spec["end"], spec["samples"]).tolist()
    return {"times": times, "values": columns(ready, found, names)}


def prepare_clutch(spec: dict[str, Any]) -> Any:
    """With a tanh: it knows no `pre`, so that a mode cannot be told."""
    return integrator({**spec, "end": 1.0}, spec["smooth"], "Driveline")


def clutch_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Speeds, without events."""
    return {"smooth": True, "events": [], "values": columns(ready, found, ["w_1", "w_2"])}


def prepare_sweep(spec: dict[str, Any]) -> Any:
    """An integrator that takes both parameters, for as many runs as there are."""
    told = {key: value for key, value in spec.items() if key != "samples"}
    made, _, names, start = integrator(told, spec["modelica"], "Driveline", ("k", "I_w"))
    return made, np.array(spec["pairs"]).T, names.index("k_1"), start


def sweep(ready: Any) -> Any:
    """All runs by one call."""
    made, pairs, at, start = ready
    every = made.map(pairs.shape[1])
    found = every(x0=ca.repmat(ca.DM(start), 1, pairs.shape[1]), p=pairs)["xf"]
    return np.array(found)[at].tolist()


def sweep_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The torques."""
    return {"values": found}


def prepare_gradient(spec: dict[str, Any]) -> Any:
    """The run's result as a function of both parameters, and its derivatives by CVODES' sensitivities."""
    made, _, at, start = prepare_sweep(spec)
    p = ca.MX.sym("p", 2)
    end = made(x0=start, p=p)["xf"][at]
    both = ca.Function("both", [p], [end, ca.jacobian(end, p)])
    return both, [spec["numbers"]["k"], spec["numbers"]["I_w"]]


def run_gradient(ready: Any) -> Any:
    """Value and derivatives."""
    value, slopes = ready[0](ready[1])
    return float(value), np.array(slopes)[0].tolist()


def gradient_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The value and its derivatives."""
    return {"value": found[0], "gradient": found[1]}


ROWS = {
    "chain": (prepare("Chain"), run, chain_told),
    "ladder": (prepare("Ladder"), run, ladder_told),
    "clutch": (prepare_clutch, run, clutch_told),
    "sweep": (prepare_sweep, sweep, sweep_told),
    "gradient": (prepare_gradient, run_gradient, gradient_told),
}
CANNOT: dict[str, str] = {}
