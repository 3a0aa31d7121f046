"""``figures`` and ``demo``: the paper's pictures, and a tour of what the toolkit does."""

import sys
from pathlib import Path

import click

import bondgraph as bg
import differentials.commands.options as options
from bondgraph.writing import made_folder
from codegen import Result
from differentials.aligned import table
from differentials.commands.names import OneOf
from differentials.commands.pictures import save_all, told
from differentials.commands.printing import headed
from differentials.commands.subject import causality_of
from differentials.figures import Figure, draw, figures
from differentials.identification import linear_model
from differentials.loop_figures import LOOP_FIGURES
from differentials.parameters import PRINTED_FREQUENCIES
from differentials.report import events_text, modes_text
from differentials.scenarios import scenarios, simulate
from differentials.topologies import catalog, equations, graph

DRAWN = {**figures, **LOOP_FIGURES}
"""What can be drawn by name."""


@options.command("figures --out out", "figures fig11", "figures ice")
@click.argument("names", nargs=-1, type=OneOf(tuple(DRAWN), "figure"), metavar="[FIGURE]...")
@options.folder
def draw_figures(names: tuple[str, ...], out: Path) -> None:
    """Run and draw the paper's Figs. 11 to 14, or those that are named: of closed loops step_steer, ice."""
    for name in names or tuple(figures):
        told(_drawn(name, DRAWN[name], out))


def _drawn(name: str, figure: Figure, out: Path) -> list[Path]:
    """Run a figure's cases, with a bar where someone looks on."""
    made_folder(out)
    hidden = not sys.stderr.isatty()
    with click.progressbar(figure.runs, label=name, file=sys.stderr, hidden=hidden) as runs:
        results = tuple(simulate(*case) for case in runs)
    return _saved(name, figure, results, out)


def _saved(name: str, figure: Figure, results: tuple[Result, ...], out: Path) -> list[Path]:
    """A figure's picture and tables; where there are several, they are called like their scenarios."""
    several = len({subject for subject, _ in figure.runs}) > 1
    cases = [f"{subject}_{case}" if several else case for subject, case in figure.runs]
    cases = [name] if len(results) == 1 else cases
    tables = dict(zip(cases, results, strict=True))
    return save_all(name, tables, lambda path: draw(figure, results, path), out)


@options.command("demo --out out")
@options.folder
def demo(out: Path) -> None:
    """A tour: equations, causality, modes and two simulations."""
    chosen, derived = catalog["alsd"], equations("alsd")
    click.echo(f"The {chosen.title}, {chosen.source} of IMECE2008-69248\n")
    click.echo(headed("Rigid model"))
    click.echo(f"{derived}\n")
    click.echo(headed("Causality of the rigid model"))
    click.echo(causality_of(graph("alsd")) + "\n")
    click.echo(headed("Model with halfshafts (used for the simulation)"))
    click.echo(f"{equations('alsd', halfshafts=True)}\n")
    click.echo(headed("Its modes at 80 rad/s, clutch open"))
    click.echo(modes_text(linear_model("alsd")) + "\n")
    _figure_11(out)
    click.echo("\n" + headed("All differentials of the paper"))
    click.echo(_comparison() + "\n")
    click.echo(headed("Fig. 13: torque to the faster wheel"))
    other = simulate("stationary_tvd", "fig13")
    click.echo(events_text(other))
    told(_saved("stationary_tvd_fig13", figures["fig13"], (other,), out))


def _figure_11(out: Path) -> None:
    case = scenarios["fig11"]
    click.echo(headed("Fig. 11"))
    click.echo(
        f"engine torque {case.engine_torque:g} N m at {case.engine_step:g} s, clutch torque "
        f"{case.clutch_torques[0]:g} N m at {case.clutch_step:g} s, through lags of "
        f"{1000 * case.lag:g} ms\n"
    )
    result = simulate("alsd", "fig11")
    click.echo(events_text(result))
    last = result.time >= result.time[-1] - 0.1
    difference = (result["tau_hs1"] - result["tau_hs2"])[last].mean()
    click.echo(
        f"torque difference tau_hs1 - tau_hs2, mean over the last 0.1 s: {difference:.1f} N m\n"
    )
    told(_saved("alsd_fig11", figures["fig11"], (result,), out))


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
