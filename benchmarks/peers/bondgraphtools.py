"""`BondGraphTools`: relations that vanish, over momenta and displacements; all storages stay."""

import logging
from typing import Any

import BondGraphTools as bgt
import sympy as sp

logging.disable(logging.CRITICAL)


def build(spec: dict[str, Any]) -> Any:
    """The graph; port 1 of its transformer is the side that power comes from here."""
    model, made = bgt.new(name="model"), {}
    for name, kind, value in spec["nodes"]:
        if kind in ("One", "Zero"):
            made[name] = bgt.new("1" if kind == "One" else "0", name=name)
        else:
            made[name] = bgt.new(kind, name, value=None if kind == "Se" else sp.Symbol(value))
        bgt.add(model, made[name])
    gears = {name for name, kind, _ in spec["nodes"] if kind == "TF"}
    for tail, head in spec["bonds"]:
        one = (made[tail], 0) if tail in gears else made[tail]
        bgt.connect(one, (made[head], 1) if head in gears else made[head])
    return model


def derive(model: Any) -> Any:
    """What is timed."""
    return model, model.constitutive_relations


def relations(result: Any, spec: dict[str, Any]) -> dict[str, Any]:
    """The relations as they are; the output is the flow of the first mass."""
    model, found = result
    x = list(model.state_vars)
    first = next(name for name, (part, _) in model.state_vars.items() if part.name == "m_0")
    return {
        "x": x, "dx": [f"d{name}" for name in x], "u": ["u_0"],
        "rows": [{"": relation} for relation in found], "output": {first: 1 / sp.Symbol("m_0")},
    }  # fmt: skip
