"""Other modelling tools of today beside this one: Modelica compilers, JAX, CasADi, a circuit simulator.

Each tool has an environment of its own in ``.peers/``, made when it is missing, and each row of each a
process of its own with a limit of time, in which nothing is compiled yet. What is timed stands in
`tools/worker.py`. Errors are to exact solutions by matrix exponentials, with its clutch to
`tests/references/fig11.py`.
Run it alone on the machine: ``python benchmarks/modelling.py [seconds for one row of a tool] [row ...]``.
"""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests")]

from references.fig11 import fig11  # noqa: E402
from tools import chains, drivelines, environments, ladders, verdicts  # noqa: E402
from tools.known import OURS, Found, Tool, asked, tools  # noqa: E402
from tools.tables import line, number, ratio, trouble  # noqa: E402

CHAINS = (10, 50, 100, 200)
RUNS, FEW = 1000, 100
"""Of a sweep; of tools that make one run after the other."""

TOGETHER = ("ours, C", "Jaxonomy", "Diffrax")
"""Those that do not."""


HEAD = (
    "",
    *(cell for key in ("derive", "anew", "first", "again") for cell in (f"{key} [s]", "/ ours")),
)
BASES = {"prepare": "ours, C", "anew": "ours, numpy", "first": "ours, numpy", "again": "ours, C"}
"""What each is compared with: the way that is the faster."""


def table(
    title: str,
    row: str,
    every: tuple[Tool, ...],
    spec: Found,
    seconds: float,
    said: Callable[[Found], str],
) -> dict[str, Found]:
    """Print a row for all tools."""
    print(f"\n{title}\n{line(HEAD, 'result')}", flush=True)
    found: dict[str, Found] = {}
    for tool in every:
        one = found[tool.title] = asked(tool, row, spec, seconds)
        if one.get("cannot") == "circuits only":
            continue
        if one.get("answer", {}).get("by_hand"):
            one.pop("prepare")
        cells = [tool.title]
        for key, base in BASES.items():
            cells += [number(one.get(key)), ratio(one.get(key), found.get(base, {}).get(key))]
        print(line(cells, trouble(one) or said(one["answer"])), flush=True)
    return found


def show_chains(every: tuple[Tool, ...], seconds: float) -> None:
    """From a graph or a text to equations, to a first run of a new process, and another run."""
    going = every
    for count in CHAINS:
        one = chains.chain(count)
        exact, values = chains.speeds(one), np.linalg.eigvals(chains.matrices(one)[0])

        def said(answer: Found, exact: Any = exact, values: Any = values) -> str:
            kept = exact[:, answer.get("columns", slice(None))]
            spectrum = "none given"
            if "eigenvalues" in answer:
                spectrum = verdicts.spectrum(answer["eigenvalues"], values)
            return f"error {verdicts.apart(answer['values'], kept):.0e}; eigenvalues {spectrum}"

        title = f"chain of {count} inertias and springs, 1 s, 1001 samples"
        found = table(title, "chain", going, chains.spec(one), seconds, said)
        going = tuple(tool for tool in going if "answer" in found[tool.title])


def show_ladder(every: tuple[Tool, ...], seconds: float) -> None:
    """A circuit."""
    one = ladders.Ladder()

    def said(answer: Found) -> str:
        exact = ladders.voltages(one, np.array(answer["times"]))[
            :, answer.get("columns", slice(None))
        ]
        inner = answer.get("inner")
        told = f"; analysis alone {inner:g} s" if inner is not None else ""
        return f"error {verdicts.apart(answer['values'], exact):.0e}{told}"

    title = f"RLC ladder of {one.sections} sections, 2 ms, 1001 samples"
    table(title, "ladder", every, ladders.spec(one), seconds, said)


def show_clutch(every: tuple[Tool, ...], seconds: float) -> None:
    """The clutch that locks and unlocks."""
    reference = fig11()

    def said(answer: Found) -> str:
        kept = answer.get("rows", slice(None))
        error = verdicts.apart(answer["values"], reference.states[kept, :2])
        if answer.get("smooth"):
            return f"smooths: never locks; speeds off by {error:.0e}"
        return f"{verdicts.locked(answer['events'], reference.events)}; speeds {error:.0e}"

    title = "Fig. 11: a clutch that locks and unlocks, 1 s, 1001 samples; lock and unlock to 1e-6 s"
    table(title, "clutch", every, drivelines.clutch_spec(), seconds, said)


def show_sweeps(every: tuple[Tool, ...], seconds: float) -> None:
    """Many pairs of parameters."""
    for linear in (True, False):
        kind = "linear tires" if linear else "tires that saturate"
        print(f"\nsweep of the differential without its clutch, {kind}; one core")
        print(line(("", "ready [s]", "/ ours", "runs/s", "of ours"), "result"), flush=True)
        base: Found = {}
        for tool in every:
            count = RUNS if tool.title in TOGETHER else FEW
            one = asked(tool, "sweep", drivelines.sweep_spec(linear, count), seconds)
            if one.get("cannot") != "circuits only":
                if tool == OURS[0] and "again" in one:
                    base = {**one, "rate": count / one["again"]}
                cells = [tool.title, *sweep_cells(one, count, base)]
                print(line(cells, sweep_said(one, linear, count)), flush=True)


def sweep_cells(one: Found, count: int, base: Found) -> list[str]:
    """What it takes to be ready, and runs per second, with ratios to ours."""
    if "again" not in one:
        return ["-", "", "-", ""]
    rate, ready = count / one["again"], max(one["compiled"], 0.0)
    return [
        number(ready), ratio(ready, base.get("compiled")), number(rate), ratio(rate, base.get("rate")),
    ]  # fmt: skip


def sweep_said(one: Found, linear: bool, count: int) -> str:
    """How far some of a sweep's results are off."""
    if trouble(one):
        return trouble(one)
    some, pairs = range(0, count, count // 20), drivelines.pairs(count)
    exact = np.array([drivelines.EXACT[linear](*pairs[k]) for k in some])
    return f"error {verdicts.beyond([one['answer']['values'][k] for k in some], exact):.0e}"


def show_gradient(every: tuple[Tool, ...], seconds: float) -> None:
    """A result with its derivatives."""
    exact = np.array(drivelines.gradient())

    def said(answer: Found) -> str:
        how = "central differences, " if "differences" in answer else ""
        return f"{how}error {verdicts.beyond(answer['gradient'], exact):.0e}"

    title = "derivatives of the linear differential's result with respect to two parameters"
    table(title, "gradient", every, drivelines.sweep_spec(True, 1), seconds, said)


ROWS: dict[str, Callable[[tuple[Tool, ...], float], None]] = {
    "chain": show_chains, "ladder": show_ladder, "clutch": show_clutch, "sweep": show_sweeps,
    "gradient": show_gradient,
}  # fmt: skip


def main() -> None:
    """All rows, all tools that can be had."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    environments.ENVIRONMENTS.mkdir(exist_ok=True)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    every = tools()
    for row in sys.argv[2:] or ROWS:
        ROWS[row](every, seconds)


if __name__ == "__main__":
    main()
