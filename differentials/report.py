"""Causality, modes, parameters and events as text that a person can read."""

from collections.abc import Hashable, Mapping, Sequence

import bondgraph as bg
from bondgraph.analyse.state_space import StateSpace
from codegen import Result
from differentials.aligned import table
from differentials.parameters import Parameter


def causality_text(causal: bg.CausalGraph) -> str:
    """Which storages are states, which is dependent, and why."""
    lines = [
        f"states (integral causality):        {_listed(causal.integral)}",
        f"dependent (derivative causality):   {_listed(causal.derivative)}",
    ]
    for name in causal.derivative:
        lines += ["", f"why {name!r} is dependent:"]
        lines += [f"  - {sentence}" for sentence in causal.why(name)]
    return "\n".join(lines)


def events_text(result: Result) -> str:
    """When friction ports stuck, slipped and crossed zero, switches changed, stops were met and state
    machines went from mode to mode, by lines."""
    words = {
        "stick": "sticks", "slip": "slips again", "cross": "crosses zero slip",
        "on": "turns on", "off": "turns off",
        "hit": "is hit", "touch": "is touched", "apart": "is left",
        "slide": "slides along a jump", "leave": "leaves the jump",
    }  # fmt: skip
    lines = [
        f"t = {e.time:.6f} s   {e.port} {words.get(e.kind, f'goes {e.kind}')}"
        for e in result.events
    ]
    return (
        "\n".join(lines)
        or "no events: nothing stuck, was released, changed its slip's sign or switched"
    )


def modes_text(model: StateSpace) -> str:
    """Frequency, damping and the largest parts of the shape of every mode."""
    rows = [("f [Hz]", "damping", "pole [1/s]", "moves most")]
    for mode in model.modes():
        by_size = sorted(mode.shape, key=lambda name: -abs(mode.shape[name]))
        speeds = [name for name in by_size if name.startswith("omega")] or by_size
        swings = mode.pole.imag > 0
        turning = f" +- {mode.pole.imag:.1f}i" if swings else ""
        rows.append((
            f"{mode.damped_frequency:.2f}" if swings else "-",
            f"{mode.damping:.4f}" if swings else "-",
            f"{mode.pole.real:.1f}{turning}",
            _shape(mode.shape, speeds),
        ))  # fmt: skip
    return table(rows)


def _shape(shape: Mapping[str, complex], names: Sequence[str]) -> str:
    """The speeds that move at least a fifth as much as the fastest, and which way."""
    largest = shape[names[0]]
    moving = [name for name in sorted(names) if abs(shape[name]) > 0.2 * abs(largest)]
    signs = {name: "-" if (shape[name] / shape[moving[0]]).real < 0 else "+" for name in moving}
    return " ".join(f"{signs[name]}{name}" for name in moving)


def parameters_text(parameters: Mapping[str, Parameter]) -> str:
    """Symbol, value, unit, meaning and source of parameters, one a line."""
    rows = [("symbol", "value", "unit", "meaning", "source")]
    rows += [
        (name, f"{p.value:.6g}", p.unit or "-", p.meaning, p.source)
        for name, p in parameters.items()
    ]
    return table(rows)


def _listed(names: tuple[Hashable, ...]) -> str:
    return ", ".join(str(name) for name in names) or "none"
