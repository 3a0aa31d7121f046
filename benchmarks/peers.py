"""Other bond-graph packages of the Python package index beside this one, on the same graphs.

Each peer has an environment of its own in ``.peers/``, made when it is missing, and each derivation a process
of its own. Only the way from a built graph to symbolic state equations is timed: the median of three (one,
if it is long), sympy's cache emptied before each. ``peak`` is the most that Python held in one more, traced.
A result is `right` if, with numbers for the values, it has as many states as ours, the same eigenvalues, and
the same response of the first mass's flow to the drive.
Run it alone on the machine: ``python benchmarks/peers.py [seconds for one derivation] [peer ...]``.
"""

import json
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import derivation
import numpy as np
import scipy.linalg
from tools.environments import ENVIRONMENTS, installed

Array = np.ndarray[Any, np.dtype[np.float64]]

HERE = Path(__file__).resolve().parent
NAMES = {"bondgraph": "bondgraph", "bondgraphtools": "BondGraphTools", "pybondgraph": "pyBondGraph"}
SIZES = (4, 8, 20, 50, 100, 200, 400)
BUILDERS = (derivation.chain, derivation.tree, derivation.mesh, derivation.gears)
MOST_FOR_GEARS = 100
POINTS = (0.31 + 0.77j, -0.4 + 1.3j, 1.1 + 0.2j)


def described(build: Callable[[int], Any], size: int) -> dict[str, Any]:
    """A graph as every peer's script reads it, with a number for each value."""
    graph = build(size)
    nodes = [[name, data["kind"], data.get("value")] for name, data in graph.nodes(data=True)]
    draw = random.Random(size)
    numbers = {value: draw.uniform(0.5, 2) for _, kind, value in nodes if value and kind != "Se"}
    return {"nodes": nodes, "bonds": [list(bond) for bond in graph.edges], "numbers": numbers}


def measured(peer: str, spec: dict[str, Any], seconds: float) -> dict[str, Any]:
    """What the worker could say before it ended, by itself or after too long a time."""
    python = sys.executable if peer == "ours" else str(ENVIRONMENTS / peer / "bin" / "python")
    command = [python, "-I", str(HERE / "peers" / "worker.py")]
    command += [str(HERE / "peers" / f"{peer}.py"), str(seconds)]
    options: dict[str, Any] = {"input": json.dumps(spec), "text": True, "cwd": ENVIRONMENTS}
    try:
        done = subprocess.run(command, capture_output=True, timeout=4 * seconds + 10, **options)
        said, failed = done.stdout, done.stderr.strip()
    except subprocess.TimeoutExpired as over:
        said, failed = (over.stdout or b"").decode(), ""
    results = [line[len("RESULT ") :] for line in said.splitlines() if line.startswith("RESULT ")]
    if results:
        return dict(json.loads(results[-1]))
    return {"error": failed.splitlines()[-1]} if failed else {"over": seconds}


def reduced(relations: dict[str, Any]) -> tuple[Array, Array, Array, float]:
    """The matrices of ``z' = A z + B u``, ``y = C z`` with the constraints resolved.

    Also by how much the relations, which may be more than there are unknowns, contradict each other;
    without end if they are too few.
    """
    names, rows = relations["x"], relations["rows"]
    rates, values, drive = (
        np.array([[row.get(name, 0.0) for name in relations[key]] for row in rows])
        for key in ("dx", "x", "u")
    )
    bound = np.abs(rates).max(axis=1) < 1e-12
    free = scipy.linalg.null_space(values[bound]) if bound.any() else np.eye(len(names))
    left, right = rates[~bound] @ free, np.hstack([-values[~bound] @ free, -drive[~bound]])
    both, _, rank, _ = np.linalg.lstsq(left, right, rcond=None)
    apart = float(np.abs(left @ both - right).max() / np.abs(right).max())
    apart = apart if rank == free.shape[1] else np.inf
    output = np.array([relations["output"].get(name, 0.0) for name in names])
    return both[:, : free.shape[1]], both[:, free.shape[1] :], output @ free, apart


def verdict(mine: dict[str, Any], other: dict[str, Any]) -> str:
    """`right`, or what differs from ours."""
    if "wrong" in other:
        return f"wrong: {other['wrong']}"
    if "relations" not in other:
        return f"not compared: {other['error']}" if "error" in other else "not compared: too long"
    if any("" in row for row in other["relations"]["rows"]):
        return "wrong: a constant in the equations"
    if not other["relations"]["rows"]:
        return "wrong: no equations"
    (A, B, C, _), (P, Q, R, apart) = reduced(mine["relations"]), reduced(other["relations"])
    if apart > 1e-6:
        return "wrong: the equations contradict each other or are too few"
    if A.shape != P.shape:
        return f"wrong: {len(P)} states, not {len(A)}"
    for s in POINTS:
        wanted, found = (s * np.eye(len(A)) - matrix for matrix in (A, P))
        if not np.allclose(np.linalg.slogdet(wanted), np.linalg.slogdet(found), rtol=1e-6):
            return "wrong: other eigenvalues"
        if not np.allclose(C @ np.linalg.solve(wanted, B), R @ np.linalg.solve(found, Q), 1e-6):
            return "wrong: another response to the drive"
    bound = len(other["relations"]["x"]) - len(P)
    return f"right, but {bound} dependent storages left as states" if bound else "right"


def shown(result: dict[str, Any]) -> tuple[str, str]:
    """Time and peak as the table has them."""
    if "time" not in result:
        return (f"> {result['over']:g}" if "over" in result else "-"), "-"
    peak = f"{result['peak']:.1f}" if result["peak"] is not None else "-"
    return f"{result['time']:.4f}", peak


def table(build: Callable[[int], Any], peers: dict[str, str], seconds: float) -> None:
    """One kind of graph: a line for each size and package until it takes too long or fails."""
    print(f"\n{build.__name__}: {' '.join((build.__doc__ or '').split())}")
    head = f"{'storages':>8} {'package':<15} {'time [s]':>10} {'peak [MB]':>10}"
    print(f"{head} {'/ ours':>8}  result")
    going = dict(peers)
    specs = [described(build, size) for size in SIZES]
    by_storages = {sum(kind in ("I", "C") for _, kind, _ in spec["nodes"]): spec for spec in specs}
    for storages, spec in by_storages.items():
        if not going or (build is derivation.gears and storages > MOST_FOR_GEARS):
            break
        mine = measured("ours", spec, seconds)
        print(f"{storages:>8} {'ours':<15} {shown(mine)[0]:>10} {shown(mine)[1]:>10}", flush=True)
        for peer, trouble in list(going.items()):
            other = {"error": trouble} if trouble else measured(peer, spec, seconds)
            time, peak = shown(other)
            ratio = f"{other['time'] / mine['time']:.1f}" if "time" in other else ""
            said = verdict(mine, other) if "time" in other else other.get("error", "")
            line = f"{storages:>8} {NAMES[peer]:<15} {time:>10} {peak:>10} {ratio:>8}  {said[:90]}"
            print(line.rstrip(), flush=True)
            if "time" not in other:
                del going[peer]


def main() -> None:
    """All kinds of graphs, all peers that can be had."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    ENVIRONMENTS.mkdir(exist_ok=True)
    peers = {
        peer: installed(peer, HERE / "peers" / f"{peer}.txt") for peer in sys.argv[2:] or NAMES
    }
    for build in BUILDERS:
        table(build, peers, seconds)


if __name__ == "__main__":
    main()
