"""What the commands of the command line do."""

import sys
from collections.abc import Sequence
from pathlib import Path

import bondgraph as bg
from codegen import Result
from differentials.exporting import export
from differentials.figures import Figure, draw, figures, panels
from differentials.identification import linear_model
from differentials.model import model
from differentials.parameters import PRINTED_FREQUENCIES
from differentials.report import (
    causality_text,
    equations_text,
    events_text,
    modes_text,
    parameters_text,
    table,
)
from differentials.scenarios import named, scenarios, simulate
from differentials.speeds import zero_slip_ratios
from differentials.topologies import Differential, catalog, differential, equations, graph

NEXT = {
    "python": "cd {out} && python run_{name}.py",
    "c": "cc -std=c99 -O2 {out}/{name}/*.c -lm -o run_{name}",
    "fmu2": "load {out}/{name}.fmu into any tool that knows FMI 2.0",
    "fmu3": "load {out}/{name}.fmu into any tool that knows FMI 3.0",
}
"""What to do with an export."""


def list_all() -> None:
    """Every differential and every scenario there is."""
    rows = [("name", "states", "clutches", "scenario", "what it is")]
    for name, chosen in catalog.items():
        count = str(len(bg.assign_causality(graph(name)).integral))
        if chosen.full:
            count += f" or {3 * chosen.wheels}"
        rows.append((name, count, str(len(chosen.clutches)), chosen.scenario, _described(chosen)))
    print(table(rows))
    print(f"\nscenarios: {', '.join(scenarios)}")
    print("\nNext: python -m differentials show alsd")


def show(name: str, halfshafts: bool, lumped: bool) -> None:
    """A differential's equations, causality, parameters, modes and zero slip speed ratios."""
    chosen = differential(name)
    print(_headed(f"{name}: {_described(chosen)}"))
    declared = graph(name, halfshafts, lumped)
    derived = bg.derive(declared, outputs=list(chosen.clutches))
    print(equations_text(derived), "\n")
    print(_headed("Causality"))
    print(causality_text(bg.assign_causality(declared)), "\n")
    full = model(name)
    print(_headed("Parameters of the simulated model"))
    print(parameters_text(full.parameters), "\n")
    print(_headed("Modes at 80 rad/s, clutches open"))
    print(modes_text(linear_model(name)))
    if len(chosen.clutches) and not halfshafts:
        print("\n" + _headed("Speed ratios at which a slip changes sign, wheel over the others"))
        print(_ratios_text(derived, {p: v.value for p, v in full.parameters.items()}))


def run(
    name: str, scenario: str | None, changed: dict[str, float], backlash: bool, out: Path
) -> None:
    """Simulate a scenario: events on the screen, every signal as a table, and a picture."""
    chosen = differential(name)
    case = scenario or chosen.scenario
    named(case)
    result = simulate(name, case, changed, backlash=backlash)
    print(f"{name}, {case}{_changes(changed)}\n\n{events_text(result)}\n")
    _write(
        f"{name}_{case}",
        Figure(_described(chosen), ((name, case),), panels(chosen)),
        (result,),
        out,
    )


def write_export(
    name: str, target: str, scenario: str | None, changed: dict[str, float], out: Path
) -> None:
    """Write a differential in a scenario as Python, C or an FMU, and say how to go on."""
    paths = export(name, target, scenario or differential(name).scenario, changed, out)
    for path in paths:
        print(path)
    print(f"\nNext: {NEXT[target].format(name=name, out=out)}")


def draw_figures(names: Sequence[str], out: Path) -> None:
    """Run and draw the paper's figures."""
    for name in names or list(figures):
        if name not in figures:
            raise bg.SignalError(f"no figure is called {name!r}; there is {', '.join(figures)}")
    for name in names or list(figures):
        figure = figures[name]
        _write(name, figure, tuple(simulate(*case) for case in figure.runs), out)


def demo(out: Path) -> None:
    """Derive the ALSD, run Fig. 11, and set the torque vectoring differentials beside it."""
    chosen, derived = catalog["alsd"], equations("alsd")
    print(f"The {chosen.title}, {chosen.source} of IMECE2008-69248\n")
    print(_headed("Rigid model"))
    print(equations_text(derived), "\n")
    print(_headed("Causality of the rigid model"))
    print(causality_text(bg.assign_causality(graph("alsd"))), "\n")
    print(_headed("Model with halfshafts (used for the simulation)"))
    print(equations_text(equations("alsd", halfshafts=True)), "\n")
    print(_headed("Its modes at 80 rad/s, clutch open"))
    print(modes_text(linear_model("alsd")), "\n")
    print(_headed("Fig. 11"))
    _demo_scenario()
    result = simulate("alsd", "fig11")
    print(events_text(result))
    last = result.time >= result.time[-1] - 0.1
    difference = (result["tau_hs1"] - result["tau_hs2"])[last].mean()
    print(f"torque difference tau_hs1 - tau_hs2, mean over the last 0.1 s: {difference:.1f} N m\n")
    _write("alsd_fig11", figures["fig11"], (result,), out)
    print("\n" + _headed("All differentials of the paper"))
    print(_comparison(), "\n")
    print(_headed("Fig. 13: torque to the faster wheel"))
    other = simulate("stationary_tvd", "fig13")
    print(events_text(other))
    _write("stationary_tvd_fig13", figures["fig13"], (other,), out)


def _demo_scenario() -> None:
    case = scenarios["fig11"]
    print(
        f"engine torque {case.engine_torque:g} N m at {case.engine_step:g} s, clutch torque "
        f"{case.clutch_torques[0]:g} N m at {case.clutch_step:g} s, through lags of "
        f"{1000 * case.lag:g} ms\n"
    )


def _comparison() -> str:
    """One line per differential: orders, what is dependent, oscillations of the simulated model."""
    rows = [("name", "states", "full", "dependent storages", "oscillations [Hz]", "as printed")]
    for name, chosen in catalog.items():
        causal = bg.assign_causality(graph(name))
        full = str(3 * chosen.wheels) if chosen.full else "-"
        swings = [
            f"{m.damped_frequency:.1f}" for m in linear_model(name).modes() if m.pole.imag > 0
        ]
        printed = [f"{frequency:g}" for frequency in PRINTED_FREQUENCIES.get(name, ())]
        dependent = ", ".join(map(str, causal.derivative)) or "none"
        states = str(len(causal.integral))
        rows.append(
            (name, states, full, dependent, ", ".join(swings) or "none", ", ".join(printed) or "-")
        )
    return table(rows)


def _ratios_text(derived: bg.StateEquations, values: dict[str, float]) -> str:
    lines = []
    for slip, ratio in zero_slip_ratios(derived).items():
        numbers = {symbol: values[symbol.name] for symbol in ratio.free_symbols}
        lines.append(f"{slip} = 0 at {ratio} = {float(ratio.subs(numbers)):.4f}")
    return "\n".join(lines)


def _write(name: str, figure: Figure, results: tuple[Result, ...], out: Path) -> None:
    """Tables of all runs and the picture; without matplotlib the tables alone, and a hint."""
    out.mkdir(parents=True, exist_ok=True)
    for (_, case), result in zip(figure.runs, results, strict=True):
        label = name if len(results) == 1 else case
        result.write_csv(out / f"{label}.csv")
        print(f"every signal:  {out / f'{label}.csv'}")
    picture = out / f"{name}.png"
    try:
        draw(figure, results, picture)
    except bg.MissingExtraError as error:
        print(f"no picture: {error}", file=sys.stderr)
    else:
        print(f"picture:       {picture}")


def _described(chosen: Differential) -> str:
    return f"{chosen.title} ({chosen.source})"


def _changes(changed: dict[str, float]) -> str:
    return "".join(f", {name} = {value:g}" for name, value in changed.items())


def _headed(title: str) -> str:
    return f"{title}\n{'-' * len(title)}"
