"""Bodies with stops as bond graphs."""

from __future__ import annotations

from collections.abc import Sequence

import networkx as nx
import numpy as np
from references.build import bond_graph
from references.stops.line import Bound, Line, Place, Wave

import bondgraph as bg
from codegen import Constant, Result, Signal, Simulator, Sine, simulator


def graph(line: Line) -> nx.DiGraph:
    """A 1-junction for each body and each relative motion in use; ``v0``, ``F0``, ``q_<stop>``: states."""
    nodes, bonds, n = [], [], len(line.masses)
    for i, mass in enumerate(line.masses):
        nodes += [bg.One(f"n{i}"), bg.I(f"m{i}", mass, flow=f"v{i}"), bg.Se(f"p{i}", f"P{i}")]
        bonds.append(f"p{i}>n{i}>m{i}")
    for k in range(len(line.driven)):
        nodes += [bg.One(f"n{n + k}"), bg.Sf(f"w{k}", f"W{k}")]
        bonds.append(f"w{k}>n{n + k}")
    places = [*line.springs, *line.dampers, *(stop.place for stop in line.stops)]
    at: dict[Place, str] = {}
    for a, b in dict.fromkeys(places):
        at[a, b] = f"n{a}"
        if b is not None:
            at[a, b] = f"r{a}_{b}"
            nodes += [bg.Zero(f"z{a}_{b}"), bg.One(at[a, b])]
            bonds.append(f"n{a}>z{a}_{b}>n{b} z{a}_{b}>{at[a, b]}")
    for k, (place, (stiffness, _)) in enumerate(line.springs.items()):
        nodes.append(bg.C(f"c{k}", 1 / stiffness, effort=f"F{k}"))
        bonds.append(f"{at[place]}>c{k}")
    for k, (place, damping) in enumerate(line.dampers.items()):
        nodes.append(bg.R(f"b{k}", damping))
        bonds.append(f"{at[place]}>b{k}")
    for name, bounds in elements(line).items():
        ends = {"low" if one.way > 0 else "high": one.at for one in bounds}
        bounds_given = {"low": None, **ends}
        nodes.append(bg.Stop(name, **bounds_given, restitution=bounds[0].bounce))
        bonds.append(f"{at[bounds[0].place]}>{name}")
    return bond_graph(nodes, " ".join(bonds))


def elements(line: Line) -> dict[str, list[Bound]]:
    """The bounds by the elements that have them: ``s0.low`` and ``s0.high`` are of ``s0``."""
    found: dict[str, list[Bound]] = {}
    for stop in line.stops:
        found.setdefault(stop.name.partition(".")[0], []).append(stop)
    return found


def initial(line: Line) -> dict[str, float]:
    """The states at the start."""
    place = [*line.positions]
    found = {f"v{i}": v for i, v in enumerate(line.speeds)}
    found |= {f"F{k}": k_s * stretch for k, (k_s, stretch) in enumerate(line.springs.values())}
    for name, (one, *_) in elements(line).items():
        a, b = one.place
        found[f"q_{name}"] = place[a] - (0.0 if b is None else place[b])
    return found


def inputs(line: Line) -> dict[str, Signal | float]:
    """Forces and speeds as signals."""
    given = {f"P{i}": wave for i, wave in enumerate(line.forces or [Wave()] * len(line.masses))}
    given |= {f"W{k}": wave for k, wave in enumerate(line.driven)}
    return {name: _signal(wave) for name, wave in given.items()}


def _signal(wave: Wave) -> Signal | float:
    if not wave.amplitude:
        return wave.constant
    return Constant(wave.constant) + Sine(
        wave.amplitude, wave.omega / (2 * np.pi), phase=wave.phase
    )


def run(
    line: Line,
    times: Sequence[float] | np.ndarray,
    backend: str = "numpy",
    method: str = "auto",
    **settings: float,
) -> Result:
    """The toolkit's run, by this backend and no other."""
    made: Simulator = simulator(bg.derive(graph(line)), {}, backend=backend)
    result = made.run(times, initial(line), inputs(line), method=method, **settings)
    assert result.backend == backend
    return result
