"""Models to export, of every kind, and what the simulator makes of them at an instant."""

from collections.abc import Iterator
from functools import cache
from types import ModuleType

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
import differentials
from codegen import Simulator
from codegen.inputs.pieces import Piece
from codegen.modes.choose import Occasion, decide
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.tuning import TUNING
from differentials.model import Model, model
from oracles.models import belt, clutches, oscillator, stacked_blocks

Case = tuple[bg.StateEquations, dict[str, float], dict]


def loaded(text: str) -> ModuleType:
    """An exported module, without a file."""
    module = ModuleType("exported")
    exec(compile(text, "exported", "exec"), module.__dict__)
    return module


@cache
def catalog_cases() -> tuple[tuple[str, Case], ...]:
    """The eight differentials, rigid and with halfshafts where there are any; derived once in a process."""
    return tuple(_catalog_cases())


@cache
def model_of(name: str) -> Model:
    """A differential's full model, derived once in a process."""
    return model(name)


@cache
def variant_of(
    name: str, halfshafts: bool = False, lumped: bool = True, backlash: bool = False
) -> bg.StateEquations:
    """A differential's equations, with its clutches' slips, derived once in a process."""
    graph = differentials.graph(name, halfshafts, lumped, backlash)
    return bg.derive(graph, outputs=list(differentials.catalog[name].clutches))


def catalog_case(name: str) -> Case:
    """A differential with halfshafts where there are any."""
    full = model_of(name)
    numbers = {symbol: one.value for symbol, one in full.parameters.items()}
    return full.equations, numbers | dict.fromkeys(full.starts, 80.0), dict(full.laws)


def _catalog_cases() -> Iterator[tuple[str, Case]]:
    for name in differentials.catalog:
        yield name, catalog_case(name)
        full, numbers = model_of(name), catalog_case(name)[1]
        rigid = differentials.equations(name)
        values = {symbol.name: numbers.get(symbol.name, 1.3) for symbol in rigid.parameters}
        clutch = {node: bg.DryFriction(level) for node, level in full.differential.clutches.items()}
        yield f"{name}-rigid", (rigid, values, clutch)


def _mass_with(*ports: tuple, bonds: str = "") -> bg.StateEquations:
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), *ports]
    return bg.derive(
        bond_graph(nodes, f"push>n>m {' '.join(f'n>{name}' for name, _ in ports)} {bonds}")
    )


def _crank(ratio: str, *more: tuple, bonds: str = "") -> nx.DiGraph:
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", ratio), bg.One("slider", flow="v"),
             bg.I("m", "m", priority=-1), bg.R("gas", law="c*f_gas**3"), *more]  # fmt: skip
    return bond_graph(nodes, f"drive>rot>J rot>angle rot>crank>slider>m slider>gas {bonds}")


def _slip_damper(*more: tuple, bonds: str = "") -> bg.StateEquations:
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.Zero("arm"),
             bg.R("damper", "b"), *more,
             bg.R("rub", law=bg.DryFriction("L", "1 + exp(-slip)/5"), effort="f", flow="s")]  # fmt: skip
    return bg.derive(bond_graph(nodes, f"push>mass>m mass>arm arm>damper arm>rub {bonds}"))


def lever() -> bg.StateEquations:
    """A speed shared between two masses of which one rubs: (m_1 + m_2) v_1' = m_2 V' - f."""
    nodes = [bg.Sf("drive", "V"), bg.Zero("beam"), bg.One("n1"), bg.I("m1", "m_1", flow="v_1", priority=1),
             bg.I("m2", "m_2", flow="v_2"),
             bg.R("rub", law=bg.DryFriction("L"), effort="f", flow="s")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "drive>beam>n1>m1 n1>rub beam>m2"))


def constrained() -> bg.StateEquations:
    """Two brakes on one shaft, the second behind a gear of ratio r."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.TF("gear", "r"),
             bg.R("b1", law=bg.DryFriction("L_1"), effort="f_1", flow="s_1"),
             bg.R("b2", law=bg.DryFriction("L_2"), effort="f_2", flow="s_2")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n>m n>b1 n>gear>b2"))


def _charged(value: str) -> bg.StateEquations:
    nodes = [bg.Se("s", value), bg.Zero("z"), bg.C("c", "C_1"), bg.R("r", "R")]
    return bg.derive(bond_graph(nodes, "s>z>c z>r"), outputs=["s"])


def _divider(value: str) -> bg.StateEquations:
    nodes = [bg.Se("s", value), bg.One("n"), bg.Zero("z"), bg.R("r", "R"), bg.C("upper", "C_1", effort="v_1"),
             bg.C("lower", "C_2", effort="v_2", priority=1)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "s>n>upper n>z>lower z>r"), outputs=["z"])


def _diode() -> bg.StateEquations:
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r", "R"), bg.R("diode", law="I_s*(exp(e_diode/V_T) - 1)",
             gives="flow")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "s>n>r n>diode"), outputs=["diode", "s"])


@cache
def small_cases() -> tuple[tuple[str, Case], ...]:
    """Nonlinear laws, loops, own states, moving ratios, E u', redundant and mixed friction."""
    return tuple(_small_cases())


def _small_cases() -> Iterator[tuple[str, Case]]:
    rub = bg.DryFriction("L")
    yield "duffing", (_mass_with(bg.C("s", law="k*q_s + c*q_s**3")), {"m": 1.3, "k": 4, "c": 9}, {})
    laws = "Min(v, 2) + sign(v)*sqrt(Abs(v)) - Max(v, t)/3 + atan2(v, 2) + v**(1/3 + 5/3)"
    yield "functions", (_mass_with(bg.R("r", law=laws)), {"m": 0.7}, {})
    yield "diode", (_diode(), {"R": 50.0, "I_s": 1e-9, "V_T": 0.05}, {})
    pair = _mass_with(bg.R("a", law="v - e_b/2"), bg.R("b", law="tanh(e_a)"))
    yield "loop", (pair, {"m": 2}, {})
    yield "oscillator", (bg.derive(oscillator()), {"m": 0.5, "k": 20.0, "F_c": 1.0}, {})
    yield "belt", (bg.derive(belt()), {"m": 1, "F_c": 2.0}, {})
    blocks = {"m_1": 1.0, "m_2": 2.0, "L_1": 1.0, "L_2": 0.5, "r_1": 1.2, "r_2": 1.4}
    yield "stacked", (bg.derive(stacked_blocks()), blocks, {})
    shafts = {"I_1": 0.5, "I_2": 0.25, "L_0": 10.0, "L_1": 25.0}
    two = clutches(bg.DryFriction("L_0"), bg.DryFriction("L_1", 1, 1.3))
    yield "clutches", (bg.derive(two), shafts, {})
    yield "constrained", (constrained(), {"m": 2.0, "L_1": 3.0, "L_2": 1.0, "r": 2.0}, {})
    yield "slip_damper", (_slip_damper(), {"m": 0.5, "b": 6.0, "L": 0.6}, {})
    ground = bg.R("ground", law=bg.DryFriction(0.4), effort="f_1", flow="s_1")
    mixed = _slip_damper(ground, bonds="mass>ground")
    yield "mixed", (mixed, {"m": 0.5, "b": 6.0, "L": 0.6}, {})
    heater = _mass_with(bg.R("rub", law=rub, effort="f", flow="s"), bg.R("more", law="f/10"))
    yield "heater", (heater, {"m": 2.0, "L": 0.3}, {})
    both = clutches(bg.DryFriction("L_0"), bg.DryFriction("L_1"))
    both.add_nodes_from([bg.R("loss", law="(f_0 + f_1)/20")])
    both.add_edge("n1", "loss")
    yield "clutches_with_loss", (bg.derive(both), shafts, {})
    moving = {"J": 0.5, "m": 2.0, "r": 0.3, "c": 0.4}
    yield "crank", (bg.derive(_crank("r*sin(theta)"), outputs=["slider"]), moving, {})
    brake = _crank("r*sin(theta)", bg.R("brake", law=bg.DryFriction(3.0)), bonds="rot>brake")
    yield "braked_crank", (bg.derive(brake, outputs=["brake"]), moving, {})
    geared = _crank("n", bg.Se("lever", "n"), bg.R("rest", 1), bonds="lever>rest")
    yield "geared", (bg.derive(geared, outputs=["slider", "J"]), moving, {})
    yield "lever", (lever(), {"m_1": 1.0, "m_2": 3.0, "L": 6.0}, {})
    for value in ("V", "3*V + 4*t"):
        yield f"divider {value}", (_divider(value), {"C_1": 2e-3, "C_2": 1e-3, "R": 40.0}, {})
        yield f"charged {value}", (_charged(value), {"C_1": 2e-3, "R": 40.0}, {})


def instant(ready: Simulator, t: float, x: np.ndarray, u: np.ndarray, du: np.ndarray):
    """The simulator's rates, readings and inputs at an instant, inputs moving at these rates."""
    closed, program = ready.closed, ready.closed.program
    pieces = [Piece(t, ((0, (a, b)),)) for a, b in zip(u.tolist(), du.tolist(), strict=True)]
    sources = [signal.piece(t) for signal in ready.sources(t, t)]
    pieces += sources
    u = np.append(u, [piece(t) for piece in sources])
    du = np.append(du, [piece.derivative(t) for piece in sources])
    s, slipping = ready.vector(t, x, u), tuple(1 for _ in program.friction)
    peaks = Peaks.none(closed)
    with np.errstate(all="ignore"):
        here = Sight(closed, t, s, pieces)
        peaks.see(here, slipping)
        ahead = 1e-3 * TUNING.look_ahead
        mode, s, *_ = decide(Occasion(closed, t, pieces, slipping, ahead, peaks), here)
        now = closed.evaluate(t, s, u, du, mode)
    rate = now.rate[: len(x)].copy()
    if not program.varying:
        rate[: len(program.states)] += now.numbers.R @ now.du
    names = [symbol.name for symbol in (*program.readings, *program.inputs)]
    return rate, dict(zip(names, [*now.y, *now.u], strict=True)), mode
