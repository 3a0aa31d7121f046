"""``list``, ``show``, ``derive``, ``explain``: what there is and what follows from it."""

from typing import Any

import click

import bondgraph as bg
import differentials.commands.options as options
from bondgraph.algebra.expressions import TIME
from bondgraph.nodes.laws import SLIP
from differentials.commands.printing import causality_data, equations_data, headed, print_json
from differentials.commands.subject import Subject, causality_of, mode_text
from differentials.identification import linear_model
from differentials.model import model
from differentials.report import modes_text, parameters_text
from differentials.speeds import zero_slip_ratios


@options.command(
    "show stationary_tvd",
    "show alsd --halfshafts --json",
    "show examples/oscillator.json",
)
@options.subject
@options.variants
@options.reads
@options.as_json
def show(
    subject: Subject, halfshafts: bool, unlumped: bool, on: tuple[str, ...], off: tuple[str, ...],
    reads: tuple[str, ...], as_json: bool,
) -> None:  # fmt: skip
    """Equations, causality, parameters and modes of MODEL.

    MODEL is a name that `bondgraph list` shows, or a graph in a .json or .graphml file.
    """
    declared = subject.graph(halfshafts, unlumped, on, off)
    derived = bg.derive(declared, outputs=list(subject.ports), inputs=reads)
    if as_json:
        print_json(_shown(subject, declared, derived))
        return
    click.echo(headed(f"{subject.name}: {subject.title}") + "\n" + mode_text(subject, on, derived))
    click.echo(f"{derived}\n\n" + headed("Causality"))
    click.echo(causality_of(declared) + "\n")
    if subject.differential is None:
        click.echo(_open_text(subject, derived))
        return
    full = model(subject.name)
    click.echo(headed("Parameters of the simulated model"))
    click.echo(
        parameters_text(full.parameters) + "\n\n" + headed("Modes at 80 rad/s, clutches open")
    )
    click.echo(modes_text(linear_model(subject.name)))
    if subject.ports and not halfshafts:
        click.echo(
            "\n" + headed("Speed ratios at which a slip changes sign, wheel over the others")
        )
        click.echo(_ratios_text(derived, {p: v.value for p, v in full.parameters.items()}))


def _shown(subject: Subject, declared: Any, derived: bg.StateEquations) -> dict[str, object]:
    values: dict[str, object] = {name.name: None for name in derived.parameters}
    if subject.differential is not None:
        full = model(subject.name).parameters
        values |= {name: {"value": p.value, "unit": p.unit, "meaning": p.meaning,
                          "source": p.source} for name, p in full.items()}  # fmt: skip
    return {
        "model": subject.name, "title": subject.title, "equations": equations_data(derived),
        "causality": causality_data(bg.assign_causality(declared)), "parameters": values,
    }  # fmt: skip


def _open_text(subject: Subject, derived: bg.StateEquations) -> str:
    """What a file's graph still needs to be run, and how it is given."""
    needed = ", ".join(map(str, derived.parameters)) or "none"
    given = [f"{port.given} from {port.element.name}" for port in derived.ports
             if port.element.name not in derived.laws and port.element.switch is None]  # fmt: skip
    either = ", ".join(sorted(_read_by_laws(derived)))
    given += [f"{name} in values" for name in derived.reduction.structure.opened]
    begun = (*derived.states, *derived.further_states)
    return "\n".join(
        [
            headed("To run it"),
            f"numbers (--set NAME=NUMBER):              {needed}",
            *([f"numbers or signals (--set, --input):       {either}"] if either else []),
            f"signals or laws (--input, --law):         {', '.join(given) or 'none'}",
            f"starts (--initial STATE=NUMBER, else 0):  {', '.join(map(str, begun))}",
        ]
    )


def _read_by_laws(derived: bg.StateEquations) -> set[str]:
    """What laws, switches and controllers read that nothing in the graph gives."""
    parts = [part for one in derived.switches for part in one.read]
    parts += [reset.value for task in derived.tasks for reset in task.resets]
    used = [*(law.free_symbols for law in derived.laws.values()), *(p.free_symbols for p in parts)]
    known = {*derived.signals, *derived.states, *derived.inputs, *derived.further_states}
    known |= {*derived.held, *derived.parameters, TIME, SLIP}
    return {str(name) for name in set().union(*used) - known}


def _ratios_text(derived: bg.StateEquations, values: dict[str, float]) -> str:
    lines = []
    for slip, ratio in zero_slip_ratios(derived).items():
        numbers = {symbol: values[symbol.name] for symbol in ratio.free_symbols}
        lines.append(f"{slip} = 0 at {ratio} = {float(ratio.subs(numbers)):.4f}")
    return "\n".join(lines)


@options.command(
    "derive alsd",
    "derive alsd --halfshafts --latex",
    "derive examples/oscillator.json --output spring --json",
)
@options.subject
@options.variants
@click.option(
    "--output",
    "outputs",
    multiple=True,
    metavar="NAME",
    help="A node whose effort or flow y shows, by default the clutches. May be repeated.",
)
@options.reads
@click.option("--latex", "as_latex", is_flag=True, help="The equations as LaTeX.")
@options.as_json
def derive(
    subject: Subject, halfshafts: bool, unlumped: bool, on: tuple[str, ...], off: tuple[str, ...],
    outputs: tuple[str, ...], reads: tuple[str, ...], as_latex: bool, as_json: bool,
) -> None:  # fmt: skip
    """The state equations of MODEL: A x' = J x + B u + E u', y = F x + D u + G u'."""
    if as_latex and as_json:
        raise click.UsageError("--latex and --json exclude each other; keep one")
    declared = subject.graph(halfshafts, unlumped, on, off)
    derived = bg.derive(declared, outputs=list(outputs or subject.ports), inputs=reads)
    if as_json:
        print_json(equations_data(derived))
    else:
        click.echo(
            bg.latex(derived) if as_latex else mode_text(subject, on, derived) + str(derived)
        )


@options.command(
    "explain passive",
    "explain alsd --halfshafts --latex",
    "explain examples/oscillator.json",
)
@options.subject
@options.variants
@options.reads
@click.option("--latex", "as_latex", is_flag=True, help="The derivation as LaTeX.")
def explain(
    subject: Subject, halfshafts: bool, unlumped: bool, on: tuple[str, ...], off: tuple[str, ...],
    reads: tuple[str, ...], as_latex: bool,
) -> None:  # fmt: skip
    """How the equations of MODEL come about, step by step."""
    explained = bg.explain(subject.graph(halfshafts, unlumped, on, off), inputs=reads)
    click.echo(explained.latex() if as_latex else explained.text())
