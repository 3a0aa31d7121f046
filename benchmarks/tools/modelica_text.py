"""Modelica texts of parts, and how a model is put together of them."""

from collections.abc import Sequence


def lines(*texts: str) -> str:
    """Texts one below the other, each with an end of line."""
    return "".join(text if text.endswith("\n") else f"{text}\n" for text in texts)


def model(name: str, declared: Sequence[str], equations: Sequence[str]) -> str:
    """A model of declarations and equations, each a line without its indentation.

    >>> print(model("Decay", ["Real x(start = 1);"], ["der(x) = -x;"]), end="")
    model Decay
      Real x(start = 1);
    equation
      der(x) = -x;
    end Decay;
    """
    head = [f"model {name}", *(f"  {line}" for line in declared), "equation"]
    return lines(*head, *(f"  {line}" for line in equations), f"end {name};")


CHAIN_PARTS = lines(
    "connector Flange\n  Real w;\n  flow Real tau;\nend Flange;",
    model(
        "Inertia",
        ["Flange a;", "parameter Real m = 1;", "Real w(start = 0, fixed = true);"],
        ["w = a.w;", "m*der(w) = a.tau;"],
    ),
    model(
        "Spring",
        ["Flange a;", "Flange b;", "parameter Real c = 1;", "Real tau(start = 0, fixed = true);"],
        ["c*der(tau) = a.w - b.w;", "a.tau = tau;", "b.tau = -tau;"],
    ),
    model("Damper", ["Flange a;", "parameter Real b = 1;"], ["a.tau = b*a.w;"]),
    model("Drive", ["Flange a;", "parameter Real u = 1;"], ["a.tau = -u;"]),
)
"""Rotating parts with the speed as what is equal and the torque as what adds up to nothing."""

CIRCUIT_PARTS = lines(
    "connector Pin\n  Real v;\n  flow Real i;\nend Pin;",
    model("Ground", ["Pin p;"], ["p.v = 0;"]),
    model("Source", ["Pin p;", "Pin n;", "parameter Real V = 1;"], ["p.v - n.v = V;", "p.i + n.i = 0;"]),
    model("Resistor", ["Pin p;", "Pin n;", "parameter Real R = 1;"],
          ["p.v - n.v = R*p.i;", "p.i + n.i = 0;"]),
    model("Inductor", ["Pin p;", "Pin n;", "parameter Real L = 1;", "Real i(start = 0, fixed = true);"],
          ["L*der(i) = p.v - n.v;", "p.i = i;", "n.i = -i;"]),
    model("Capacitor", ["Pin p;", "Pin n;", "parameter Real C = 1;", "Real v(start = 0, fixed = true);"],
          ["v = p.v - n.v;", "C*der(v) = p.i;", "p.i + n.i = 0;"]),
)  # fmt: skip
"""Parts of circuits."""
