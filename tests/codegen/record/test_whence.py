"""Missing inputs: whose they are, who reads them, what was meant."""

import re

import numpy as np
import pytest

import bondgraph as bg
import codegen

PATHS = ("road > contact > wheel > m", "contact > tyre", "wheel > spring", "wheel > damper")


def _missing(spring: str, damper: str, parameters: dict[str, float], **inputs: float) -> str:
    graph = bg.graph([
        bg.Sf("road", "v_r"), bg.Zero("contact"), bg.C("tyre", "1/k_t", effort="F"), bg.One("wheel"),
        bg.I("m", "m", flow="v_w"), bg.C("spring", law=spring), bg.R("damper", law=damper),
    ], *PATHS)  # fmt: skip
    model = codegen.simulator(bg.derive(graph), {"k_t": 9, "m": 1, "k": 2, **parameters})
    with pytest.raises(bg.SignalError, match=r"missing input\(s\)") as caught:
        model.run([0, 1], inputs=inputs)
    told = re.match(r"missing input\(s\) (.*): give each", str(caught.value))
    assert told is not None
    return told[1]


@pytest.mark.parametrize(
    ("spring", "damper", "parameters", "told"),
    [
        # A source's own input is nobody's misspelling, however near a state's name is.
        ("k*q_spring", "f_damper*abs(f_damper)", {}, "v_r (of Sf 'road')"),
        # A law without any signal tells what it could read; one with a signal lacks a number.
        ("k*q**3", "f_damper", {}, "v_r (of Sf 'road'), q (in the law of 'spring', which is over q_spring)"),
        ("k*q_spring", "k*z", {}, "v_r (of Sf 'road'), z (in the law of 'damper', which receives f_damper)"),
        ("k*q_spring", "c*f_damper", {}, "v_r (of Sf 'road'), c (in the law of 'damper')"),
        # Nearly a signal's name, or that of a number which nothing reads.
        (
            "k*q_sprin", "2*f_damper", {},
            "v_r (of Sf 'road'), q_sprin (did you mean 'q_spring'?; in the law of 'spring', "
            "which is over q_spring)",
        ),
        (
            "k*q_spring", "c_d*f_damper", {"c_dd": 2.0},
            "v_r (of Sf 'road'), c_d (did you mean 'c_dd'?; in the law of 'damper')",
        ),
        # Of several places all are told, or that there are more.
        (
            "k*q_spring*z", "z*f_damper", {},
            "v_r (of Sf 'road'), z (in the law of 'spring'; in the law of 'damper')",
        ),
    ],
)  # fmt: skip
def test_a_missing_input_tells_whose_it_is(
    spring: str, damper: str, parameters: dict, told: str
) -> None:
    assert _missing(spring, damper, parameters) == told


def test_a_law_put_later_is_told_as_well() -> None:
    graph = bg.graph([bg.Se("push", "F"), bg.One("cart"), bg.I("m", "m", flow="v"), bg.R("air")],
                     "push > cart > m", "cart > air")  # fmt: skip
    model = codegen.simulator(bg.derive(graph), {"m": 1}, {"air": "c*w"})
    with pytest.raises(bg.SignalError, match=r"w \(in the law of 'air', which receives f_air\)"):
        model.run([0, 1], inputs={"F": 1, "c": 2})


def test_a_value_that_lacks_a_number_is_told() -> None:
    graph = bg.graph([bg.Sf("pump", "Q"), bg.Zero("tank"), bg.C("C", "area/(rho*g)", effort="p")],
                     "pump > tank > C")  # fmt: skip
    model = codegen.simulator(bg.derive(graph), {"rho": 1000, "g": 9.81})
    with pytest.raises(bg.SignalError, match=r"area \(in the value of 'C'\): give"):
        model.run([0, 1], inputs={"Q": 1})


def test_a_law_that_reads_only_what_it_gives_is_refused() -> None:
    """An orifice gives a flow from its effort; taken the other way it is e = c*sqrt(e), without a flow."""
    nodes = [bg.Se("pump", "p"), bg.One("pipe"), bg.I("fluid", "I"),
             bg.R("orifice", effort="dp", flow="Q", law="c*sqrt(abs(dp))*sign(dp)")]  # fmt: skip
    with pytest.raises(bg.StructureError, match=r"'orifice'.*gives='flow'.*reads Q"):
        bg.derive(bg.graph(nodes, "pump > pipe > fluid", "pipe > orifice"))


@pytest.mark.parametrize("ask", [
    bg.explicit, bg.latex, bg.linearize, lambda g: codegen.simulator(g, {}), lambda g: codegen.Family(g, {}),
    lambda g: codegen.to_python(g, {}, name="g"),
])  # fmt: skip
def test_a_graph_in_place_of_equations_is_refused(ask) -> None:
    graph = bg.graph([bg.Se("push", "F"), bg.One("cart"), bg.I("m", 1)], "push > cart > m")
    with pytest.raises(
        bg.StructureError,
        match=r"bondgraph.derive.* not a BondGraph|not BondGraph; .*bondgraph.derive",
    ):
        ask(graph)


def test_equations_in_place_of_a_simulator_are_refused() -> None:
    graph = bg.graph([bg.Se("push", "F"), bg.One("cart"), bg.I("m", 1)], "push > cart > m")
    with pytest.raises(
        bg.StructureError, match=r"trim takes what codegen.simulator returns, not a StateEq"
    ):
        codegen.trim(bg.derive(graph))  # type: ignore[arg-type]


@pytest.mark.parametrize("given", [[1, 2], np.ones(3)])
def test_what_is_no_signal_has_its_way_out(given) -> None:
    graph = bg.graph([bg.Se("push", "F"), bg.One("cart"), bg.I("m", 1)], "push > cart > m")
    with pytest.raises(bg.SignalError, match=r"values at times are Sampled\(times, values\)"):
        codegen.simulator(bg.derive(graph), {}).run([0, 1], inputs={"F": given})


def test_unknown_signals_have_the_nearest_name() -> None:
    graph = bg.graph(
        [bg.Se("push", "F"), bg.One("cart"), bg.I("m", 1, flow="speed")], "push > cart > m"
    )
    run = codegen.simulator(bg.derive(graph), {}).run([0, 1], inputs={"F": 1})
    with pytest.raises(KeyError, match=r"no signal 'sped' \(did you mean 'speed'"):
        run["sped"]
    with pytest.raises(bg.SignalError, match=r"no signal 'sped' \(did you mean 'speed'"):
        run.integral("sped")
