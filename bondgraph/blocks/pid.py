"""`PID`: a controller of three terms whose rate is filtered and whose integral does not wind up."""

from collections.abc import Hashable
from typing import Any

from bondgraph.blocks.static import check_room, limited
from bondgraph.blocks.told import known, told
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Node
from bondgraph.nodes.signals import Function, State


def PID(
    name: Hashable, input: object, kp: object, ki: object = 0, kd: object = 0, tau_d: object = None,
    low: object = None, high: object = None, tau_t: object = None, start: object = None,
) -> list[Node]:  # fmt: skip
    """A signal that is proportional to an error, its integral and its rate: a PID controller.

    ``input`` is the error e, ``"ref - omega"``. The signal is ``kp*e + I + D``, with ``I' = ki*e``, a state
    ``x_<name>_i`` that begins at ``start``, and ``D = kd*s/(tau_d*s + 1) e``, by a state ``x_<name>_d`` that
    is e behind a lag ``tau_d`` [s]: ``D = kd*(e - x_d)/tau_d``. A gain that is the number 0 has no state.

    With ``low``, ``high`` or both the signal stays within these bounds, and its integral does not wind up:

    - unless told otherwise I stays within the same bounds: it rests at one while e leads beyond
      (clamping, exact, as of `Integrator`);
    - with ``tau_t`` [s] it is led back by what the limit takes (back-calculation):
      ``I' = ki*e + (u - v)/tau_t``, where v, the signal ``<name>_unlimited``, is the sum before the limit and
      u the signal after it.

    Raises `StructureError`, naming the node, for a rate without a filter, times that are not positive,
    bounds without room between, and a ``tau_t`` that has nothing to lead back.

    >>> import bondgraph as bg
    >>> motor = bg.graph([bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
    ...                   bg.PID("tau", "ref - omega", kp="K", ki="K_i", high="most")], "motor > shaft > J")
    >>> bg.derive(motor).states, bg.derive(motor).further_states
    ((omega,), (x_tau_i,))
    """
    where = f"node {name!r}"
    integrates, rated = known(ki, where) != 0, known(kd, where) != 0
    _check(where, tau_d, tau_t, integrates, rated, low is not None or high is not None)
    check_room(where, low, high)
    nodes: list[Node] = []
    text, parts = "{kp}*{input}", {"kp": kp, "input": input}
    if integrates:
        own = f"x_{name}_i"
        text += f" + {own}"
        if tau_t is None:
            nodes.append(
                State(own, told(where, "{ki}*{input}", ki=ki, input=input), start, low, high)
            )
        else:
            back = f"{{ki}}*{{input}} + ({name} - {name}_unlimited)/{{tau_t}}"
            nodes.append(State(own, told(where, back, ki=ki, input=input, tau_t=tau_t), start))
    if rated:
        own = f"x_{name}_d"
        text += f" + {{kd}}*({{input}} - {own})/{{tau_d}}"
        parts |= {"kd": kd, "tau_d": tau_d}
        lag = told(where, f"({{input}} - {own})/{{tau_d}}", input=input, tau_d=tau_d)
        nodes.append(State(own, lag))
    whole = told(where, text, **parts)
    if tau_t is not None:
        nodes.append(Function(f"{name}_unlimited", whole))
        whole = f"{name}_unlimited"
    if low is not None or high is not None:
        whole = limited(where, whole, low, high)
    return [*nodes, Function(name, whole)]


def _check(where: str, tau_d: Any, tau_t: Any, integrates: bool, rated: bool, limits: bool) -> None:
    """Refuse what has no meaning."""
    if rated and tau_d is None:
        raise StructureError(
            f"{where}: a rate that is not filtered is improper; give tau_d, the filter's time constant"
        )
    if tau_t is not None and not (limits and integrates):
        raise StructureError(
            f"{where}: tau_t leads the integral back from a bound; give low or high, and ki"
        )
    for key, value in (("tau_d", tau_d), ("tau_t", tau_t)):
        if value is not None and (size := known(value, where)) is not None and size <= 0:
            raise StructureError(f"{where}: {key} is {size}; a time constant is above zero")
