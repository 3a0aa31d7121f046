"""Names that languages, headers, generated code and XML have uses of their own for."""

import networkx as nx

import bondgraph as bg

SETS = {
    "words of C": "double register static_ restrict inline volatile NULL errno size_t main",
    "macros of headers": "M_PI NAN INFINITY EOF HUGE_VAL BG_STATES linux unix I isgreater",
    "functions of C": "exp fabs j0 y1 gamma printf memcpy calloc bg_model_step bg_solve",
    "words of Python": "match case_ type print self float_ np math values parameters",
    "temporaries": "c0 c1 k0 q0 q1 sign_0 a_0_0 c2 d_P rate",
    "arguments": "out v m s w time signs mode now x",
    "letters of Greek": "τ ω Ω_1 φ̇ μ λ σ_0 ξ größe θ",
    "alike": "tau τ Tau TAU tau_ _tau tau__ ταυ t_au x",
}
"""Ten names each: of parameters, signals and integrals, in the order of `model`."""

RUDE = ['*/ "a" <b> & \\', "it's ??/ %s {0}", "τ <&\">'", "'''\"\"\""]
"""Names of nodes, with everything that ends a comment, a string, a tag or a line."""


def model(names: list[str]) -> tuple[bg.StateEquations, dict[str, float]]:
    """A mass on a spring with a law, friction and an integral, all of it called as told."""
    mass, spring, damping, level, push, speed, force, effort, slip, angle = names
    law = f"{damping}*{speed}**3 + {damping}*sin({angle})**2 + exp(-{speed}**2)*{force}"
    source, damper, brake, shown = RUDE
    nodes = [
        bg.Se(source, push, unit='<N&"', flow="f_of_push"), bg.One("n"),
        bg.I("mass", mass, flow=speed, unit="m/s'>"),
        bg.C(shown, spring, effort=force, flow="f_of_spring", unit="τ·<"),
        bg.R(damper, law=law, effort="e_of_law", flow="f_of_law"),
        bg.R(brake, law=bg.DryFriction(level), effort=effort, flow=slip),
        bg.Df("sensor", integrate=angle),
    ]  # fmt: skip
    graph = nx.DiGraph()
    graph.add_nodes_from(nodes)
    graph.add_edges_from(
        [(source, "n"), *(("n", node) for node, _ in nodes if node not in (source, "n"))]
    )
    values = {mass: 2.0, spring: 0.1, damping: 0.3, level: 0.2}
    return bg.derive(graph, outputs=[shown, brake]), values
