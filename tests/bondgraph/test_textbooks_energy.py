"""Hydraulics, heat and transducers of textbooks, against balances of mass, energy and force."""

from collections.abc import Hashable, Mapping

import networkx as nx
import sympy as sp
from references.build import Node, bond_graph
from references.matrices import differences
from references.textbook import agree, rates, s, transfer
from rig.walked import WALKED

import bondgraph as bg

pytestmark = WALKED


def _with_ports(
    nodes: list[Node], bonds: str, ports: Mapping[tuple[str, str], str]
) -> "nx.DiGraph[Hashable]":
    graph = bond_graph(nodes, bonds)
    for bond, port in ports.items():
        graph.edges[bond]["port"] = port
    return graph


def test_a_cylinder_with_compressible_oil() -> None:
    """After Karnopp, Margolis, Rosenberg: pump, leakage, oil of compliance V/beta, piston with a load."""
    nodes: list[Node] = [
        bg.Sf("pump", "Q"), bg.Zero("oil"), bg.C("C", "V_0/beta"), bg.R("leak", "R_l"),
        bg.TF("piston", "1/A_p"), bg.One("rod"), bg.I("m", "m"), bg.R("b", "b"), bg.Se("load", "F"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "pump>oil>C oil>leak oil>piston>rod>m rod>b load>rod")
    pressure = "beta*q_C/V_0"
    agree(
        rates(graph),
        {
            "q_C": f"Q - {pressure}/R_l - A_p*p_m/m",
            "p_m": f"A_p*{pressure} - b*p_m/m + F",
        },
    )


def test_a_press_of_two_pistons() -> None:
    """After Karnopp, Margolis, Rosenberg: two pistons on one liquid, one mass dependent.

    ``(m_1 + m_2 (A_1/A_2)^2) v' = F_1 - (A_1/A_2) W``; the liquid's pressure is ``(F_1 - m_1 v')/A_1``.
    """
    nodes: list[Node] = [
        bg.Se("push", "F_1"), bg.One("small"), bg.I("one", "m_1", flow="v"),
        bg.TF("first", "A_1"), bg.Zero("liquid"), bg.De("gauge", effort="pressure"),
        bg.TF("second", "1/A_2"), bg.One("large"), bg.I("two", "m_2"), bg.Se("load", "W"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "push>small>one small>first>liquid>second>large>two large>load liquid>gauge"
    )
    agree(rates(graph, False), {"v": "(F_1 - A_1/A_2*W)/(m_1 + m_2*(A_1/A_2)**2)"})
    equations = bg.derive(graph, outputs=["liquid"])
    assert equations.inputs == sp.symbols("F_1 W")
    below = "(m_1*A_2**2 + m_2*A_1**2)"
    by_forces = [f"m_2*A_1/{below}", f"m_1*A_2/{below}"]
    assert differences(equations.D, [[bg.expression(text, "D") for text in by_forces]]) == {}


def test_a_hydrostatic_transmission() -> None:
    """After Borutzky, Bond Graph Methodology: pump and motor as transformers of their displacements.

    ``C P' = D_p w - P/R_l - D_m W``, ``J W' = D_m P - b W - T``; the pump takes the torque D_p P.
    """
    nodes: list[Node] = [
        bg.Sf("engine", "w_p"), bg.TF("pump", "D_p"), bg.Zero("line"), bg.C("oil", "C_h", effort="P"),
        bg.R("leak", "R_l"), bg.TF("motor", "1/D_m"), bg.One("shaft"), bg.I("J", "J_m", flow="W"),
        bg.R("b", "b"), bg.Se("load", "T"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "engine>pump>line>oil line>leak line>motor>shaft>J shaft>b shaft>load"
    )
    equations = bg.derive(graph, outputs=["engine"])
    D_p, D_m, R_l, b, C_h, J_m = sp.symbols("D_p D_m R_l b C_h J_m")
    assert equations.states == sp.symbols("P W")
    assert differences(equations.A, sp.diag(C_h, J_m)) == {}
    assert differences(equations.J, [[-1 / R_l, -D_m], [D_m, -b]]) == {}
    assert differences(equations.B, [[D_p, 0], [0, -1]]) == {}
    assert differences(equations.F, [[D_p, 0]]) == {}
    still = equations.J.inv() * -equations.B
    gain = bg.expression("D_p*D_m*R_l/(b + D_m**2*R_l)", "speed at rest")
    assert sp.cancel(still[1, 0] - gain) == 0


def test_two_tanks_and_a_pipe() -> None:
    """After Karnopp, Margolis, Rosenberg, and Gawthrop and Smith: two tanks, the pipe with inertia."""
    nodes: list[Node] = [
        bg.Sf("inflow", "Q"), bg.Zero("first"), bg.C("C1", "A_1/(rho*g)"), bg.One("pipe"),
        bg.I("water", "rho*l/A_0"), bg.R("walls", "R_1"), bg.Zero("second"), bg.C("C2", "A_2/(rho*g)"),
        bg.R("outlet", "R_2"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "inflow>first>C1 first>pipe>water pipe>walls pipe>second>C2 second>outlet"
    )
    flow = "A_0*p_water/(rho*l)"
    agree(
        rates(graph),
        {
            "q_C1": f"Q - {flow}",
            "p_water": f"rho*g*(q_C1/A_1 - q_C2/A_2) - R_1*{flow}",
            "q_C2": f"{flow} - rho*g*q_C2/(A_2*R_2)",
        },
    )


def test_torricellis_tanks_and_their_linearisation() -> None:
    """The same tanks by orifices: ``Q = k sqrt(p)``, and the slope ``k/(2 sqrt(p))`` of each."""
    nodes: list[Node] = [
        bg.Sf("inflow", "Q"), bg.Zero("first", effort="P_1"), bg.C("C1", "c_1", effort="P_1"),
        bg.One("pipe"), bg.R("orifice", law="k_1*sign(e_orifice)*sqrt(abs(e_orifice))", gives="flow"),
        bg.Zero("second", effort="P_2"), bg.C("C2", "c_2", effort="P_2"),
        bg.R("outlet", law="k_2*sign(P_2)*sqrt(abs(P_2))", gives="flow"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "inflow>first>C1 first>pipe>second>C2 pipe>orifice second>outlet")
    between, out = (
        f"{k}*sign({p})*sqrt(abs({p}))" for k, p in (("k_1", "(P_1 - P_2)"), ("k_2", "P_2"))
    )
    found = rates(graph, False)
    for state, text in {"P_1": f"(Q - {between})/c_1", "P_2": f"({between} - {out})/c_2"}.items():
        assert sp.expand(found[state] - bg.expression(text, state)) == 0
    model = bg.linearize(
        bg.derive(graph, outputs=["second"]), at={"P_1": 13, "P_2": 4, "e_orifice": 9}
    )
    k_1, k_2, c_1, c_2 = sp.symbols("k_1 k_2 c_1 c_2")
    one, two = k_1 / 6, k_2 / 4
    assert differences(model.A, sp.diag(c_1, c_2)) == {}
    assert differences(model.J, [[-one, one], [one, -one - two]]) == {}
    expected = one / ((c_1 * s + one) * (c_2 * s + one + two) - one**2)
    assert sp.cancel(transfer(model) - expected) == 0


def test_heat_through_a_wall() -> None:
    """After Karnopp, Margolis, Rosenberg, and Cellier: pseudo bonds of temperature and heat flow.

    ``c_i T_i'`` is the heat that comes minus the heat that goes.
    """
    nodes: list[Node] = [
        bg.Se("inside", "T_i"), bg.One("in"), bg.R("film", "R_0"), bg.Zero("first"),
        bg.C("C1", "c_1", effort="T_1"), bg.One("mid"), bg.R("core", "R_1"), bg.Zero("second"),
        bg.C("C2", "c_2", effort="T_2"), bg.One("out"), bg.R("air", "R_2"), bg.Se("outside", "T_o"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "inside>in>first>mid>second>out>outside in>film first>C1 mid>core second>C2 out>air"
    )
    agree(
        rates(graph, False),
        {
            "T_1": "((T_i - T_1)/R_0 - (T_1 - T_2)/R_1)/c_1",
            "T_2": "((T_1 - T_2)/R_1 - (T_2 - T_o)/R_2)/c_2",
        },
    )


def test_true_conduction_makes_entropy() -> None:
    """After Thoma, true bonds: two bodies ``T = T_0 exp(S/c)`` exchange the heat ``K (T_1 - T_2)``.

    Each body's entropy changes by the heat over its own temperature, so energy is kept.
    """
    nodes: list[Node] = []
    bonds = ""
    for at, other in ((1, 2), (2, 1)):
        law = f"K*(T_{at} - T_{other})/T_{at}"
        nodes += [bg.Zero(f"z{at}", effort=f"T_{at}"), bg.R(f"out{at}", law=law, gives="flow"),
                  bg.C(f"S{at}", energy=f"c_{at}*T_0*exp(q_S{at}/c_{at})")]  # fmt: skip
        bonds += f"z{at}>S{at} z{at}>out{at} "
    found = rates(bond_graph(nodes, bonds), False)
    T_1, T_2 = (f"T_0*exp(q_S{at}/c_{at})" for at in (1, 2))
    agree(
        found,
        {"q_S1": f"-K*({T_1} - {T_2})/({T_1})", "q_S2": f"-K*({T_2} - {T_1})/({T_2})"},
    )
    stored = sp.Add(*(bg.expression(f"T_0*exp(q_S{at}/c_{at})", "T") * found[f"q_S{at}"]
                      for at in (1, 2)))  # fmt: skip
    assert sp.cancel(stored) == 0


def test_a_resistor_heats_a_body() -> None:
    """After Thoma: a resistance that gives entropy; ``T S' = R i^2`` beside ``L i' = u - R i``."""
    nodes: list[Node] = [
        bg.Se("source", "u"), bg.One("loop"), bg.I("L", "L_0", flow="i"), bg.R("R", "R_0"),
        bg.Zero("body", effort="T"), bg.C("S", law="T_0*exp(q_S/c)"),
        bg.R("heat", law="-R_0*i**2/T", gives="flow"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>loop>L loop>R body>S body>heat")
    agree(
        rates(graph, False),
        {"i": "(u - R_0*i)/L_0", "q_S": "R_0*i**2/(T_0*exp(q_S/c))"},
    )


MICROPHONE = "q_mic_plates**2*(d - q_mic_skin)/(2*epsA) + k*q_mic_skin**2/2"


def _microphone() -> "nx.DiGraph[Hashable]":
    """Bias behind a resistance on the plates, sound on a membrane with mass and damping."""
    nodes: list[Node] = [
        bg.Se("bias", "E_0"), bg.One("loop"), bg.R("R", "R_0"), bg.Se("sound", "F"), bg.One("skin"),
        bg.I("m", "m", flow="v"), bg.R("b", "b"),
        bg.C("mic", energy=MICROPHONE, ports=["plates", "skin"]),
    ]  # fmt: skip
    return _with_ports(
        nodes,
        "bias>loop>R loop>mic sound>skin>m skin>b skin>mic",
        {("loop", "mic"): "plates", ("skin", "mic"): "skin"},
    )


def test_a_condenser_microphone() -> None:
    """After Karnopp, Margolis, Rosenberg: energy ``q^2 (d - x)/(2 eps A)`` and the membrane's spring.

    The plates' voltage is its slope along the charge, their pull the slope along the displacement.
    """
    q, x = "q_mic_plates", "q_mic_skin"
    agree(
        rates(_microphone(), False),
        {
            q: f"(E_0 - {q}*(d - {x})/epsA)/R_0",
            x: "v",
            "v": f"(F - b*v - k*{x} + {q}**2/(2*epsA))/m",
        },
    )


def test_a_condenser_microphone_about_its_bias() -> None:
    """The same: small changes about charge Q_0 and displacement x_0, slopes by differentiation."""
    model = bg.linearize(
        bg.derive(_microphone(), outputs=[]), at={"q_mic_plates": "Q_0", "q_mic_skin": "x_0"}
    )
    b, k, d, epsA, R_0, Q_0, x_0 = sp.symbols("b k d epsA R_0 Q_0 x_0")
    assert [str(state) for state in model.states] == ["v", "q_mic_plates", "q_mic_skin"]
    pull = Q_0 / epsA
    leak = [0, -(d - x_0) / (R_0 * epsA), pull / R_0]
    assert differences(model.A, sp.diag(sp.Symbol("m"), 1, 1)) == {}
    assert differences(model.J, [[-b, pull, -k], leak, [1, 0, 0]]) == {}
    assert differences(model.B, [[0, 1], [1 / R_0, 0], [0, 0]]) == {}


def test_a_solenoid() -> None:
    """After Karnopp, Margolis, Rosenberg: an electromagnet of flux and displacement, an IC field.

    Its electric port is behind a gyrator of 1, so both states are displacements of one C:
    ``E = lambda^2 (1 + x/d)/(2 L_0)``, current and pull are its slopes.
    """
    nodes: list[Node] = [
        bg.Se("source", "u"), bg.One("coil"), bg.R("R", "R_0"), bg.GY("flux", 1),
        bg.C("gap", energy="q_gap_flux**2*(1 + q_gap_x/d)/(2*L_0)", ports=["flux", "x"]),
        bg.One("armature"), bg.I("m", "m", flow="v"), bg.C("k", "1/k", effort="F_k"), bg.R("b", "b"),
    ]  # fmt: skip
    graph = _with_ports(
        nodes,
        "source>coil>R coil>flux>gap armature>gap armature>m armature>k armature>b",
        {("flux", "gap"): "flux", ("armature", "gap"): "x"},
    )
    flux = "q_gap_flux"
    agree(
        rates(graph, False),
        {
            flux: f"u - R_0*{flux}*(1 + q_gap_x/d)/L_0",
            "q_gap_x": "v",
            "v": f"(-{flux}**2/(2*d*L_0) - F_k - b*v)/m",
            "F_k": "k*v",
        },
    )


def test_a_piezoelectric_transducer() -> None:
    """After Karnopp, Margolis, Rosenberg, C fields: ``x = F/k + d V``, ``Q = d F + C V``.

    A mass on one side, a source behind a resistance on the other.
    """
    nodes: list[Node] = [
        bg.Se("push", "F_0"), bg.One("face"), bg.I("m", "m", flow="v"), bg.Se("source", "U"),
        bg.One("loop"), bg.R("R", "R_0"),
        bg.C("crystal", [["1/k", "d"], ["d", "C_0"]], ports=["side", "wire"],
             effort={"side": "F", "wire": "V"}),
    ]  # fmt: skip
    graph = _with_ports(
        nodes,
        "push>face>m face>crystal source>loop>R loop>crystal",
        {("face", "crystal"): "side", ("loop", "crystal"): "wire"},
    )
    equations = bg.derive(graph, outputs=["source"])
    m, k, d, C_0, R_0 = sp.symbols("m k d C_0 R_0")
    assert equations.states == sp.symbols("v F V")
    assert differences(equations.A, [[m, 0, 0], [0, 1 / k, d], [0, d, C_0]]) == {}
    assert differences(equations.J, [[0, -1, 0], [1, 0, 0], [0, 0, -1 / R_0]]) == {}
    assert differences(equations.B, [[1, 0], [0, 0], [0, 1 / R_0]]) == {}
    assert differences(equations.F, [[0, 0, -1 / R_0]]) == {}


def test_a_piezoelectric_transducer_at_a_stiff_source() -> None:
    """The same crystal at a voltage that is given: its electric port is dependent.

    ``F'/k + d U' = v``; the source gives ``d F' + C U' = d k v + (C - d^2 k) U'``.
    """
    nodes: list[Node] = [
        bg.Se("push", "F_0"), bg.One("face"), bg.I("m", "m", flow="v"), bg.Se("source", "U"),
        bg.C("crystal", [["1/k", "d"], ["d", "C_0"]], ports=["side", "wire"],
             effort={"side": "F", "wire": "V"}),
    ]  # fmt: skip
    graph = _with_ports(
        nodes,
        "push>face>m face>crystal source>crystal",
        {("face", "crystal"): "side", ("source", "crystal"): "wire"},
    )
    equations = bg.derive(graph, outputs=["source"])
    m, k, d, C_0 = sp.symbols("m k d C_0")
    assert equations.states == sp.symbols("v F")
    assert differences(equations.A, sp.diag(m, 1 / k)) == {}
    assert differences(equations.J, [[0, -1], [1, 0]]) == {}
    assert differences(equations.B, [[1, 0], [0, 0]]) == {}
    assert differences(equations.E, [[0, 0], [0, -d]]) == {}
    assert differences(equations.F, [[d * k, 0]]) == {}
    assert differences(equations.G, [[0, C_0 - d**2 * k]]) == {}


def test_a_loudspeaker() -> None:
    """After Borutzky and others: a voice coil as gyrator; the impedance shows the cone's resonance.

    ``Z = R + L s + (B l)^2 s/(m s^2 + b s + k)``.
    """
    nodes: list[Node] = [
        bg.Se("amplifier", "u"), bg.One("coil"), bg.R("R", "R_0"), bg.I("L", "L_0"), bg.GY("voice", "Bl"),
        bg.One("cone"), bg.I("m", "m"), bg.R("b", "b"), bg.C("k", "1/k"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "amplifier>coil>R coil>L coil>voice>cone>m cone>b cone>k")
    admittance = transfer(bg.derive(graph, outputs=["coil"]))
    impedance = bg.expression("R_0 + L_0*s + Bl**2*s/(m*s**2 + b*s + k)", "Z")
    assert sp.cancel(admittance * impedance - 1) == 0
