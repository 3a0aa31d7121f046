"""What notebooks and `print` show of rates, linear models, runs and sweeps, and what they complete."""

import pickle
import re
from collections.abc import Mapping

import numpy as np
import pytest
import sympy as sp
from references.latex_checks import check_latex

import bondgraph as bg
import codegen
import differentials


def _oscillator(damping: object = "b") -> bg.BondGraph:
    return bg.graph(
        [bg.Se("push", "F", unit="N"), bg.One("j"), bg.I("m", 2, flow="v", unit="m/s"),
         bg.C("k", "1/8", effort="f"), bg.R("d", damping)],
        "push > j > m, j > k, j > d",
    )  # fmt: skip


def _cells(html: str) -> list[list[str]]:
    return [re.findall(r"<t[hd]>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", html)]


def test_rates_are_a_mapping_that_shows_equations() -> None:
    found = bg.explicit(bg.derive(_oscillator()))
    v, f, F, b = sp.symbols("v f F b")
    assert isinstance(found, Mapping)
    assert dict(found) == found
    assert [sp.expand(rate) for rate in found.values()] == [F / 2 - f / 2 - b * v / 2, 8 * v]
    assert found["v"] == found[v]
    assert str(found).splitlines()[1] == "f' = 8*v"
    check_latex(found._repr_latex_())
    assert r"\dot{f} &= 8 v" in found._repr_latex_()
    assert found._ipython_key_completions_() == ["v", "f"]
    (name,) = pickle.loads(pickle.dumps(type(found)({v: f})))
    assert name == v
    with pytest.raises(KeyError, match=r"no 'w'.*there are v, f"):
        found["w"]
    with pytest.raises(TypeError, match="does not support item assignment"):
        found.rates[v] = 0  # type: ignore[index]


def test_no_rates_are_nothing_to_show() -> None:
    rates = bg.explicit(bg.derive(bg.graph([bg.Se("u", "u"), bg.R("r", 1)], "u > r")))
    assert len(rates) == 0
    assert rates._repr_latex_() is None


def test_a_linear_model_shows_its_matrices_and_in_numbers_its_poles() -> None:
    """``2 s^2 + s/2 + 8``: poles at ``(-1/2 +- sqrt(1/4 - 64)) / 4``."""
    named, numbers = (bg.linearize(bg.derive(_oscillator(b))) for b in ("b", "1/2"))
    imaginary = f"{np.sqrt(64 - 0.25) / 4:.5g}"
    assert "poles" not in named._repr_latex_()
    assert rf"-0.125 \pm {imaginary}\,i" in numbers._repr_latex_()
    check_latex(named._repr_latex_())
    assert str(named).startswith("[ 2    0 ] [v'] = [ -b  -1 ] [v]")
    space = numbers.numeric({})
    head, row = _cells(space._repr_html_())
    assert head == ["pole [1/s]", "frequency [Hz]", "damping"]
    assert row[0] == f"-0.125 ± {imaginary}i"
    assert [float(one) for one in row[1:]] == pytest.approx([2 / (2 * np.pi), 0.0625], rel=1e-4)
    assert all(one in str(space) for one in (*head, *row, "2 states, 1 input, 0 outputs"))


def test_a_run_is_a_table() -> None:
    run = codegen.simulator(bg.derive(_oscillator(0.5)), {}).run([0, 1], {"v": 3}, {"F": 0})
    html = run._repr_html_()
    assert "<p>2 samples from 0 to 1 s, 0 events, run by numpy</p>" in html
    assert "Columns: v, f, F" in html
    head, v, _ = _cells(html)
    assert head == ["", "first", "last", "least", "most"]
    assert v[:2] == ["v [m/s]", "3"]
    assert v[2] == f"{run['v'][-1]:.5g}"


def test_events_are_in_the_table_and_names_are_escaped() -> None:
    graph = bg.graph(
        [bg.Se("push", "F"), bg.One("j"), bg.I("m", 1, flow="v"),
         bg.R("<rub>", flow="w", effort="e", law=bg.DryFriction(1))],
        "push > j > m", ["j", "<rub>"],
    )  # fmt: skip
    html = codegen.simulator(bg.derive(graph), {}).run([0, 2], {"v": 1}, {"F": 0})._repr_html_()
    assert "1 s  &lt;rub&gt;: stick" in html
    assert "<rub>" not in html


def test_a_run_completes_every_signal_that_it_has() -> None:
    run = codegen.simulator(bg.derive(_oscillator(0.5)), {}).run([0, 1], inputs={"F": 0})
    names = run._ipython_key_completions_()
    assert {"v", "f", "F", "e_d", "f_d", "f_push"} <= set(names)
    assert len(names) == len(set(names))
    assert all(len(run[name]) == 2 for name in names)
    assert {"time", "states", "events", "plot", "summary"} <= set(dir(run))
    assert not {"observer", "ledger"} & set(dir(run))


def test_a_sweep_shows_ranges_and_completes_columns() -> None:
    family = codegen.Family(bg.derive(_oscillator("b")), {"b": 1})
    found = codegen.sweep(
        family, codegen.Grid(b=[1.0, 3.0]), [0, 1], {"end": codegen.final("v")}, {"v": 1},
        {"F": 0}, progress=False,
    )  # fmt: skip
    assert found._ipython_key_completions_() == ["b", "end"]
    head, b, end = _cells(found._repr_html_())
    assert (head, b) == (["", "least", "mean", "most"], ["b", "1", "2", "3"])
    assert end[3] == f"{found['end'].max():.5g}"
    assert "2 runs, 2 done, 0 failed" in str(found)


def test_parameters_scenarios_and_the_catalog_complete_their_names() -> None:
    for table in (differentials.PARAMETERS, differentials.scenarios, differentials.catalog):
        names = table._ipython_key_completions_()  # type: ignore[attr-defined]
        assert names == list(table)
        assert all(table[name] for name in names)


@pytest.mark.parametrize("package", [bg, codegen, differentials])
def test_public_names_alone_are_offered(package: object) -> None:
    offered = {"parts"} if package is differentials else set()
    assert set(dir(package)) == {*package.__all__, *offered}  # type: ignore[attr-defined]
    assert all(hasattr(package, name) for name in package.__all__)  # type: ignore[attr-defined]
