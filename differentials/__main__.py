"""The command line: ``python -m differentials demo``."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import bondgraph as bg
from differentials.figures import FIG_11, draw
from differentials.report import causality_text, equations_text, events_text
from differentials.scenarios import scenarios, simulate
from differentials.topologies import catalog, equations, graph


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; 0 if it did what it says, 2 with one line on standard error if it can't."""
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        demo(options.out)
    except (bg.BondGraphError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    return 0


def demo(out: Path) -> None:
    """Derive the ALSD, explain its causality, run Fig. 11, and write the run and its picture."""
    chosen, scenario = catalog["alsd"], scenarios["fig11"]
    print(f"The {chosen.title}, {chosen.source} of IMECE2008-69248\n")
    print(_headed("Rigid model"))
    print(equations_text(equations("alsd")), "\n")
    print(_headed("Causality of the rigid model"))
    print(causality_text(bg.assign_causality(graph("alsd"))), "\n")
    print(_headed("Model with halfshafts (used for the simulation)"))
    print(equations_text(equations("alsd", halfshafts=True)), "\n")
    print(_headed("Fig. 11"))
    print(
        f"engine torque {scenario.engine_torque:g} N m at {scenario.engine_step:g} s, clutch torque "
        f"{scenario.clutch_torques[0]:g} N m at {scenario.clutch_step:g} s, through lags of "
        f"{1000 * scenario.lag:g} ms\n"
    )
    result = simulate("alsd", scenario)
    print(events_text(result))
    last = result.time >= result.time[-1] - 0.1
    difference = (result["tau_hs1"] - result["tau_hs2"])[last].mean()
    print(f"torque difference tau_hs1 - tau_hs2, mean over the last 0.1 s: {difference:.1f} N m\n")
    out.mkdir(parents=True, exist_ok=True)
    table, picture = out / "alsd_fig11.csv", out / "alsd_fig11.png"
    result.write_csv(table)
    draw(result, FIG_11, "Fig. 11: response of the ALSD model", picture)
    print(f"every signal:  {table}\npicture:       {picture}")


def _headed(title: str) -> str:
    return f"{title}\n{'-' * len(title)}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m differentials",
        description="Differential models of Deur, Hancock and Assadian, IMECE2008-69248.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    shown = commands.add_parser(
        "demo", help="derive the ALSD, explain its causality, run Fig. 11", description=demo.__doc__
    )
    shown.add_argument(
        "--out", type=Path, default=Path("out"), help="folder for the table and the picture (out)"
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
