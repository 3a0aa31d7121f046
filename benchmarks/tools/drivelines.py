"""Fig. 11's differential for tools that read equations: with its clutch, and without.

Equations: IMECE2008-69248, (13) to (19) and Appendix B, as `tests/references/fig11.py` has them. Without
the clutch the engine's torque is demanded from the first instant, and a run is asked for a halfshaft's
torque at its end: as a sweep over stiffness and wheel inertia, and its gradient with respect to these.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.integrate
import scipy.linalg
from numpy.typing import NDArray

from .modelica_text import model

Array = NDArray[np.float64]

NUMBERS = {
    "i": 2.8, "I_i": 0.1604, "I_1": 0.008, "I_2": 0.008, "I_w": 0.8, "k": 8600.0, "k_t": 200000.0,
    "r": 0.3, "lag": 0.04, "w_01": 80.0, "w_02": 82.0, "torque_e": 350.0, "torque_h": 1000.0,
    "limit": 1000.0,
}  # fmt: skip
"""SI units; ``limit``: the torque that a tire that saturates comes to."""

STEP_E, STEP_H = 0.1, 0.5
"""When the demands step with the clutch [s]."""

END_OPEN = 0.2
"""A run without the clutch [s]."""

WIDTH = 0.01
"""Of the tanh [rad/s] that stands for dry friction where a tool knows no events."""

GRID = 1001
"""Samples of a run of 1 s with the clutch."""

STATES = ("w_1", "w_2", "k_1", "k_2", "t_1", "t_2", "tau_e", "tau_h")
"""Speeds, torques of halfshafts, speeds of wheels, torques of engine and clutch."""


@dataclass(frozen=True)
class Dialect:
    """How a tool has its clutch: by events, with relations of one comparison each or not, or as a tanh."""

    events: bool
    relations: bool = False


def clutch_text(dialect: Dialect) -> str:
    """The differential with its clutch in Modelica.

    Slip is let go 1e-9 rad/s beyond nothing, so that what has just slipped is not stuck by rounding.
    """
    told = [*_declared(STATES), "Real tau_f;", "Real slip;"]
    engine, pressure = (
        f"if time >= {at} then torque_{name} else 0" for at, name in ((STEP_E, "e"), (STEP_H, "h"))
    )
    equations = [
        "slip = (w_1 - w_2)/2;", *_body("tau_f", linear=True),
        f"lag*der(tau_e) = ({engine}) - tau_e;", f"lag*der(tau_h) = ({pressure}) - tau_h;",
    ]  # fmt: skip
    if not dialect.events:
        return model("Driveline", told, [*equations, f"tau_f = tau_h*tanh((w_1 - w_2)/2/{WIDTH});"])
    told.append("Real hold;")
    equations.append("hold = k_2 - k_1 - (I_1 - I_2)*(i*tau_e - k_1 - k_2)/(I_1 + I_2 + i^2*I_i);")
    more, law = _by_relations() if dialect.relations else _by_mode()
    return model("Driveline", told + more, equations + law)


def _by_mode() -> tuple[list[str], list[str]]:
    """What is declared and told of a clutch whose mode is a whole number."""
    return ["discrete Integer mode(start = -1, fixed = true);"], [
        "tau_f = if mode == 0 then hold else mode*tau_h;",
        "when pre(mode)*slip < -1e-9 then",
        "  mode = if abs(hold) <= tau_h then 0 else -pre(mode);",
        "elsewhen pre(mode) == 0 and hold > tau_h then",
        "  mode = 1;",
        "elsewhen pre(mode) == 0 and hold < -tau_h then",
        "  mode = -1;",
        "end when;",
    ]


def _by_relations() -> tuple[list[str], list[str]]:
    """The same where each condition may be one comparison only."""
    stuck = "mode > -0.5 and mode < 0.5"
    told = ["Real back;", "Real up;", "Real down;", "discrete Real mode(start = -1, fixed = true);"]
    return told, [
        "tau_f = if mode > 0.5 then tau_h else if mode < -0.5 then -tau_h else hold;",
        "back = if mode > 0.5 then slip else if mode < -0.5 then -slip else 1;",
        f"up = if {stuck} then hold - tau_h else -1;",
        f"down = if {stuck} then -hold - tau_h else -1;",
        "when back < -1e-9 then",
        "  mode = if abs(hold) <= tau_h then 0 else -pre(mode);",
        "elsewhen up > 0 then",
        "  mode = 1;",
        "elsewhen down > 0 then",
        "  mode = -1;",
        "end when;",
    ]


def open_text(linear: bool) -> str:
    """The differential without its clutch in Modelica, with tires that are linear or saturate."""
    equations = [*_body("0", linear), "lag*der(tau_e) = torque_e - tau_e;"]
    return model("Driveline", _declared(STATES[:-1]), equations)


def _declared(states: tuple[str, ...]) -> list[str]:
    starts = {"w_1": 80, "w_2": 82, "t_1": 80, "t_2": 82}
    parameters = [f"parameter Real {name} = {value!r};" for name, value in NUMBERS.items()]
    return parameters + [
        f"Real {name}(start = {starts.get(name, 0)}, fixed = true);" for name in states
    ]


def _body(friction: str, linear: bool) -> list[str]:
    tires = [f"k_t*r/w_0{j}*(t_{j} - w_0{j})" for j in (1, 2)]
    if not linear:
        tires = [f"limit*tanh({tire}/limit)" for tire in tires]
    return [
        f"(I_1 + i^2*I_i/4)*der(w_1) + i^2*I_i/4*der(w_2) = i*tau_e/2 - {friction}/2 - k_1;",
        f"i^2*I_i/4*der(w_1) + (I_2 + i^2*I_i/4)*der(w_2) = i*tau_e/2 + {friction}/2 - k_2;",
        "der(k_1) = k*(w_1 - t_1);",
        "der(k_2) = k*(w_2 - t_2);",
        f"I_w*der(t_1) = k_1 - {tires[0]};",
        f"I_w*der(t_2) = k_2 - {tires[1]};",
    ]


def pairs(count: int) -> Array:
    """Stiffness [N m/rad] and wheel inertia [kg m^2] of so many runs, one row each."""
    share = np.linspace(0.0, 1.0, count)
    return np.column_stack([4300.0 + 8600.0 * share, 0.6 + 0.5 * (7.0 * share % 1.0)])


def open_matrix(k: Any, I_w: Any) -> NDArray[Any]:
    """M of ``z' = M z`` without the clutch, z the states and 1; complex numbers may be told."""
    p = NUMBERS
    M, a = np.zeros((8, 8), dtype=np.result_type(k, I_w, float)), p["i"] ** 2 * p["I_i"] / 4
    inverse = np.linalg.inv([[p["I_1"] + a, a], [a, p["I_2"] + a]])
    M[:2, 2:4], M[:2, 6] = -inverse, inverse @ [p["i"] / 2, p["i"] / 2]
    for j in (0, 1):
        slope, start = p["k_t"] * p["r"] / p[f"w_0{j + 1}"], p[f"w_0{j + 1}"]
        M[2 + j, [j, 4 + j]] = k, -k
        M[4 + j, [2 + j, 4 + j, 7]] = 1 / I_w, -slope / I_w, slope * start / I_w
    M[6, [6, 7]] = -1 / p["lag"], p["torque_e"] / p["lag"]
    return M


START = np.array([80.0, 82.0, 0.0, 0.0, 80.0, 82.0, 0.0, 1.0])
"""Of the states without the clutch and 1."""


def end_torque(k: Any, I_w: Any) -> Any:
    """The first halfshaft's torque [N m] at the end, exactly."""
    return (scipy.linalg.expm(open_matrix(k, I_w) * END_OPEN) @ START)[2]


def gradient() -> tuple[float, float]:
    """Its derivatives with respect to stiffness and wheel inertia, by imaginary steps."""
    k, I_w, tiny = NUMBERS["k"], NUMBERS["I_w"], 1e-30
    along = (end_torque(k + 1j * tiny * k, I_w) / k, end_torque(k, I_w + 1j * tiny * I_w) / I_w)
    return float(along[0].imag / tiny), float(along[1].imag / tiny)


def end_torque_saturated(k: float, I_w: float) -> float:
    """The same with tires that saturate, by scipy at a tolerance near rounding."""
    M, p = open_matrix(k, I_w), NUMBERS
    M[4:6, 4:6] = M[4:6, 7:] = 0.0
    w_0, limit = np.array([p["w_01"], p["w_02"]]), p["limit"]

    def rates(_: float, z: Array) -> Array:
        out = np.asarray(M @ z, dtype=np.float64)
        out[4:6] -= limit * np.tanh(p["k_t"] * p["r"] / w_0 * (z[4:6] - w_0) / limit) / I_w
        return out

    run = scipy.integrate.solve_ivp(rates, (0, END_OPEN), START, "DOP853", rtol=1e-13, atol=1e-11)
    return float(run.y[2, -1])


EXACT: dict[bool, Callable[[float, float], Any]] = {True: end_torque, False: end_torque_saturated}
"""By whether tires are linear."""


def clutch_spec() -> dict[str, Any]:
    """The run with the clutch as every tool's script reads it."""
    return {
        "numbers": NUMBERS, "step_e": STEP_E, "step_h": STEP_H, "samples": GRID, "width": WIDTH,
        "by_mode": clutch_text(Dialect(True)), "by_relations": clutch_text(Dialect(True, True)),
        "smooth": clutch_text(Dialect(False)),
    }  # fmt: skip


def sweep_spec(linear: bool, count: int) -> dict[str, Any]:
    """A sweep as every tool's script reads it; one run of it is what is derived for the gradient."""
    return {
        "numbers": NUMBERS, "linear": linear, "end": END_OPEN, "pairs": pairs(count).tolist(),
        "modelica": open_text(linear),
    }  # fmt: skip
