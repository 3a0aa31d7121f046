"""`Element`, a node that has been checked, and the constructors of nodes of every kind."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.lagging import Lagging
from bondgraph.nodes.laws import DryFriction, Law
from bondgraph.nodes.tasks import Machine, Reset, Task, Transition

Node = tuple[Hashable, dict[str, object]]
"""What networkx's ``add_nodes_from`` takes: a name and its attributes."""

Bond = tuple[Hashable, Hashable]

OTHER = {"effort": "flow", "flow": "effort"}
"""The variable that a port receives, by the one that it gives."""


@dataclass(frozen=True)
class Switch:
    """When a switch or a controlled junction of this name changes over.

    Off, it turns on as ``on`` rises above zero; on, it turns off as ``off`` does. While on, its port has
    zero effort, or zero flow, as ``gives`` says; while off it has zero of the other.

    ``stops``: whether it is a bound of a `Stop`; ``restitution``: the part of its speed that what meets the
    bound keeps. ``resets``: what it sets states to at its events. ``transition``: of a hidden one, on a port
    that carries nothing, the transition of a state machine that is taken as it turns on. ``reads``: of a
    hysteresis what it compares with its thresholds.
    """

    name: Hashable
    on: sp.Expr
    off: sp.Expr
    gives: str
    restitution: sp.Expr = sp.S.Zero
    stops: bool = False
    resets: tuple[Reset, ...] = ()
    transition: Transition | None = None
    reads: sp.Expr | None = None


@dataclass(frozen=True)
class Element:
    """One node, checked: what it is, its value or law, and the names of its effort and flow.

    A source's ``value`` is None: what it gives is its input, closed by ``law`` if it is known.
    ``gives`` is "effort" or "flow" where the causality is fixed: sources, open ports, laws, detectors.
    ``integral``: the state that a detector makes of what it reads. ``row``: of a port of a field, what it
    has per unit of each port's variable, by the ports' names; ``owner``: the field's node. ``energy``: of a
    storage with an energy function, that function. ``inverse``: of one with a law, its state as a function
    of what the law gives, so that it may have derivative causality. ``switch``: of an ideal switch, when it
    turns on and off. ``whole``: of a part of a node of several, a stop or a signal, that node, and
    ``declared`` its kind; ``at``: where that is not bonded to the first of these, the part that it is bonded
    to, or itself. ``task``: of a sampled controller, what it does at its instants; ``machine``: of a state
    machine, its modes; ``late``: of a delay, of what and how late it is. ``start``: of what keeps or makes a
    state, the value with which runs begin. ``by_inverse``: whether the law counts by its inverse alone, what
    it gives being the state. ``turned``: whether its law is turned round by what is known of it: a
    resistance then gives what its law, as it was written, receives. ``needed``: names that have to be
    positive for that.
    """

    name: Hashable
    kind: Kind
    value: sp.Expr | None
    effort: sp.Symbol | None
    flow: sp.Symbol | None
    law: Law | None = None
    priority: float = 0
    gives: str | None = None
    unit: str | None = None
    integral: sp.Symbol | None = None
    row: tuple[tuple[Hashable, sp.Expr], ...] = ()
    owner: Hashable | None = None
    energy: sp.Expr | None = None
    inverse: sp.Expr | None = None
    switch: Switch | None = None
    whole: Hashable | None = None
    start: sp.Expr | None = None
    by_inverse: bool = False
    turned: bool = False
    task: Task | None = None
    machine: Machine | None = None
    at: Hashable | None = None
    declared: Kind | None = None
    late: Lagging | None = None
    needed: frozenset[sp.Symbol] = frozenset()

    @property
    def absorbs(self) -> bool:
        """Whether power counts into it whichever way the arrow points."""
        return self.kind.absorbs or (self.whole is not None and self.whole == self.name)

    @property
    def is_function(self) -> bool:
        """Whether what it gives is a signal that was declared as a node."""
        return self.declared in (Kind.FUNCTION, Kind.MACHINE) and self.kind.supplies

    @property
    def of_signals(self) -> bool:
        """Whether it is a part of a node of signals, and carries no power."""
        return self.declared is not None and self.declared.signals

    @property
    def is_effort_told(self) -> bool:
        """Whether its effort is a signal that was declared as a node of two values."""
        return self.declared is Kind.HYSTERESIS and self.name == self.whole

    @property
    def one_port(self) -> bool:
        """True for everything but transformers, gyrators and junctions."""
        return self.kind.one_port

    @property
    def lets_go(self) -> bool:
        """Whether it is held or let go, as a switch or by dry friction, and so gives either variable."""
        return self.kind.switches or isinstance(self.law, DryFriction)

    @property
    def constant(self) -> sp.Expr:
        """The value of an element that has one: a linear storage or resistance, TF, GY."""
        if self.value is None:
            raise AttributeError(f"{self.kind} {self.name!r} has no constant value")
        return self.value

    @property
    def given(self) -> sp.Symbol | None:
        """The variable the element imposes, where that is fixed: an input of the equations."""
        return None if self.gives is None else self.variable(self.gives)

    @property
    def received(self) -> sp.Symbol | None:
        """The variable the structure imposes on the element, where that is fixed."""
        return None if self.gives is None else self.variable(OTHER[self.gives])

    @property
    def co_energy(self) -> sp.Symbol | None:
        """What a storage gives in integral causality: an inertia its flow, a compliance its effort."""
        return self.variable(self.kind.gives)

    @property
    def common(self) -> sp.Symbol | None:
        """The variable that the bonds of a junction have in common."""
        return self.variable(self.kind.common)

    def variable(self, which: str) -> sp.Symbol | None:
        """Its effort or its flow."""
        return self.effort if which == "effort" else self.flow


def Se(name: Hashable, value: object = None, **more: object) -> Node:
    """An effort source. A bare name as value is an input of that name, anything else is known.

    ``"1*v"`` repeats a signal v of the model: an ideal follower. Without a value it repeats the signal
    that a wire brings, an edge from a `Function`, a `State` or a `Controller`.

    Raises nothing: `validate` looks at nodes.

    >>> Se("engine", "tau_e")
    ('engine', {'kind': 'Se', 'value': 'tau_e'})
    """
    return _node(name, Kind.SE, value=value, **more)


def Sf(name: Hashable, value: object = None, **more: object) -> Node:
    """A flow source. A bare name as value is an input of that name, anything else is known; without a value
    it repeats the signal that a wire brings, as `Se`.

    Raises nothing: `validate` looks at nodes.

    >>> Sf("pump", "Q_0 + dQ*t")
    ('pump', {'kind': 'Sf', 'value': 'Q_0 + dQ*t'})
    """
    return _node(name, Kind.SF, value=value, **more)


def I(  # noqa: E743
    name: Hashable, value: object = None, flow: object = None, law: object = None,
    priority: float = 0, **more: object,
) -> Node:  # fmt: skip
    """An inertia ``e = (value * f)'``, or the law ``f = law(p_<name>)`` of its momentum.

    The higher ``priority`` is tried first for integral causality. ``start=``: what its state is where a run
    begins, unless that tells another: the flow, with a law the momentum. ``energy=``: a function of
    ``p_<name>`` whose slope is the law. ``ports=``: names of several ports, each bond's given as ``port=`` on
    the edge; ``value`` is then their symmetric matrix, or ``energy`` a function of all ``p_<name>_<port>``,
    and ``start`` maps ports to what their states are.

    Raises nothing: `validate` looks at nodes.

    >>> I("m", "m", flow="v", priority=-1)
    ('m', {'kind': 'I', 'value': 'm', 'flow': 'v', 'priority': -1})
    """
    return _node(name, Kind.I, value=value, flow=flow, law=law, priority=priority, **more)


def C(
    name: Hashable, value: object = None, effort: object = None, law: object = None,
    priority: float = 0, **more: object,
) -> Node:  # fmt: skip
    """A compliance ``f = (value * e)'``, value = 1/stiffness, or the law ``e = law(q_<name>)``.

    ``energy=``, ``start=`` and ``ports=`` as for `I`, with ``q_<name>`` and ``q_<name>_<port>``.

    Raises nothing: `validate` looks at nodes.

    >>> C("spring", "1/k", effort="F"), C("duffing", law="k*q_duffing**3")[1]["law"]
    (('spring', {'kind': 'C', 'value': '1/k', 'effort': 'F'}), 'k*q_duffing**3')
    """
    return _node(name, Kind.C, value=value, effort=effort, law=law, priority=priority, **more)


def R(
    name: Hashable, value: object = None, effort: object = None, flow: object = None,
    law: object = None, gives: object = "effort", **more: object,
) -> Node:  # fmt: skip
    """A resistance ``e = value * f``; a law; or, with neither, an open port.

    Raises nothing: `validate` looks at nodes.

    An open port gives an input (its effort, or its flow with ``gives="flow"``) and receives an
    output. With ``ports=`` (see `I`) the value is a matrix, efforts over flows, or ``law`` has one for each
    port, which may read the variables ``e_<name>_<port>`` and ``f_<name>_<port>`` of all, and ``gives`` what
    each gives: a damper whose heat goes into a thermal port is

    >>> R("b", ports=["rod", "heat"], gives={"heat": "flow"},
    ...   law={"rod": "d*f_b_rod", "heat": "-d*f_b_rod**2/e_b_heat"})[0]
    'b'
    """
    return _node(
        name, Kind.R, value=value, effort=effort, flow=flow, law=law, gives=gives, **more
    )  # fmt: skip


def TF(name: Hashable, m: object = None, **more: object) -> Node:
    """A transformer: ``e_in = m e_out``, ``f_out = m f_in``; a gear of ratio w_in/w_out is m = 1/ratio.

    Without ``m`` its ratio is the signal that a wire brings, an edge from a `Function`, a `State` or a
    `Controller`.

    Raises nothing: `validate` looks at nodes.

    >>> TF("gear", "1/i")
    ('gear', {'kind': 'TF', 'value': '1/i'})
    """
    return _node(name, Kind.TF, value=m, **more)


def GY(name: Hashable, r: object = None, **more: object) -> Node:
    """A gyrator: ``e_in = r f_out``, ``e_out = r f_in``; without ``r`` that is the signal that a wire brings.

    Raises nothing: `validate` looks at nodes.

    >>> GY("motor", "K")
    ('motor', {'kind': 'GY', 'value': 'K'})
    """
    return _node(name, Kind.GY, value=r, **more)


def Zero(name: Hashable, effort: object = None, **more: object) -> Node:
    """A 0-junction: one effort, flows that sum to zero. ``effort`` names the common effort.

    With ``on=`` (and ``off=``, see `Sw`) it is a controlled junction: off, its effort is zero. What it
    then takes to keep it there are ``e_<name>_switch`` and ``f_<name>_switch``.

    Raises nothing: `validate` looks at nodes.

    >>> Zero("node", effort="U")
    ('node', {'kind': 'Zero', 'effort': 'U'})
    """
    return _node(name, Kind.ZERO, effort=effort, **more)


def One(name: Hashable, flow: object = None, **more: object) -> Node:
    """A 1-junction: one flow, efforts that sum to zero. ``flow`` names the common flow.

    With ``on=`` (and ``off=``, see `Sw`) it is a controlled junction: off, its flow is zero. What it
    then takes to keep it there are ``e_<name>_switch`` and ``f_<name>_switch``.

    Raises nothing: `validate` looks at nodes.

    >>> One("shaft", flow="w")
    ('shaft', {'kind': 'One', 'flow': 'w'})
    """
    return _node(name, Kind.ONE, flow=flow, **more)


def De(name: Hashable, effort: object = None, integrate: object = None, **more: object) -> Node:
    """A detector of an effort: it draws no flow. ``integrate`` names the effort's integral, a state,
    which begins at ``start=``, or at 0.

    Raises nothing: `validate` looks at nodes.

    >>> De("gauge", effort="p", integrate="impulse")
    ('gauge', {'kind': 'De', 'effort': 'p', 'integrate': 'impulse'})
    """
    return _node(name, Kind.DE, effort=effort, integrate=integrate, **more)


def Df(name: Hashable, flow: object = None, integrate: object = None, **more: object) -> Node:
    """A detector of a flow: it takes no effort. ``integrate`` names the flow's integral, a state,
    which begins at ``start=``, or at 0.

    Raises nothing: `validate` looks at nodes.

    So an angle becomes a state that moduli can use:

    >>> Df("sensor", integrate="theta")
    ('sensor', {'kind': 'Df', 'integrate': 'theta'})
    """
    return _node(name, Kind.DF, flow=flow, integrate=integrate, **more)


def Sw(
    name: Hashable, on: object, off: object = None, reset: object = None, **more: object
) -> Node:
    """An ideal switch: zero effort while it is on (closed), zero flow while it is off (open).

    Raises nothing: `validate` looks at nodes.

    Off, it turns on as the expression ``on`` rises above zero; on, it turns off as ``off`` does, which
    is ``-on`` unless given; where they are at rest at zero it stays as it is. They may use any signal, its
    own effort and flow among them: `Diode`, which is also a `CheckValve`, and `Freewheel` write such a
    switch. One that an input from outside commands, which is 0 or 1:

    >>> Sw("key", on="gate - 1/2")
    ('key', {'kind': 'Sw', 'on': 'gate - 1/2'})

    ``reset``: states by name and what each becomes as it turns on, ``{"v": "-v/2"}``; or for both ways,
    ``{"on": {...}, "off": {...}}``. Expressions have the values just before, after the impulses of what
    comes to hold; all that are set at one instant are set together. Then the mode is decided anew.
    """
    return _node(name, Kind.SW, on=on, off=off, reset=reset, **more)


def _node(name: Hashable, kind: Kind, **attributes: object) -> Node:
    """The node with the attributes that say something; defaults are left out."""
    if attributes.get("priority") == 0:
        del attributes["priority"]
    if attributes.get("gives") == "effort":
        del attributes["gives"]
    return stated(name, kind, attributes)


def stated(name: Hashable, kind: Kind, attributes: Mapping[str, object]) -> Node:
    """The node with those of these attributes that say something.

    >>> stated("m", Kind.I, {"constant": 2, "flow": None})
    ('m', {'kind': 'I', 'constant': 2})
    """
    said = {key: value for key, value in attributes.items() if value is not None}
    return name, {"kind": str(kind), **said}
