"""Tables in expressions: called from text, opaque to algebra, with slopes, from arrays, files and pandas."""

import pickle
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

import bondgraph as bg
from bondgraph.algebra.lookups import Look
from bondgraph.algebra.residues import is_zero

drag = bg.LookupTable("drag", [0, 1, 3], [0, 2, 3])
torque = bg.LookupTable("torque", [0, 1, 2], [0, 1], [[0, 3], [0, 2], [0, 0]])
v, w, u = sp.symbols("v w u")


def test_text_calls_tables_by_name() -> None:
    found = bg.expression("2*drag(v + 1) - torque(w, u)*k", "law", [drag, torque])
    assert found == 2 * drag("v + 1") - torque(w, "u") * sp.Symbol("k")
    assert {str(name) for name in found.free_symbols} == {"v", "w", "u", "k"}
    assert bg.expression("Piecewise((drag(v), v > 0), (-drag(-v), True))", "law", [drag]).has(Look)
    assert bg.expression("drag(drag(v))", "law", [drag]) == drag(drag(v))


def test_text_calls_no_table_that_it_is_not_given() -> None:
    with pytest.raises(
        bg.ExpressionError, match="law: 'drag' is not a function an expression may use"
    ):
        bg.expression("drag(v)", "law")
    with pytest.raises(bg.ExpressionError, match=r"'drga'.*did you mean 'drag'"):
        bg.expression("drga(v)", "law", [drag])


@pytest.mark.parametrize(
    ("text", "says"),
    [("drag()", "drag takes 1 argument"), ("torque(w)", "torque takes 2 argument"),
     ("drag(v, w)", "drag takes 1")],
)  # fmt: skip
def test_calls_have_as_many_arguments_as_axes(text: str, says: str) -> None:
    with pytest.raises(bg.ExpressionError, match=says):
        bg.expression(text, "law", [drag, torque])
    with pytest.raises(bg.TableError, match=r"'torque' takes 2 argument\(s\), not 1"):
        torque("w")


def test_two_tables_of_one_name_are_refused() -> None:
    other = bg.LookupTable("drag", [0, 1], [0, 1])
    again = bg.LookupTable("drag", [0, 1, 3], [0, 2, 3])
    with pytest.raises(bg.TableError, match="two tables 'drag'; rename one"):
        bg.expression("drag(v)", "law", [drag, other])
    assert bg.expression("drag(v)", "law", [drag, again]) == drag(v)
    with pytest.raises(bg.TableError, match="is no LookupTable"):
        bg.expression("drag(v)", "law", ["drag"])  # type: ignore[list-item]


def test_slopes_are_tables_too() -> None:
    slope = sp.diff(drag(v**2), v)
    assert str(slope) == "2*v*drag'(v**2)"
    assert float(slope.subs(v, sp.Rational(1, 2))) == 2.0
    assert sp.diff(drag(v), v, 2) == 0
    cross = sp.diff(torque(w, u), w, u)
    assert str(cross) == "torque'xy(w, u)"
    assert float(cross.subs({w: sp.Rational(1, 2), u: sp.Rational(1, 2)})) == -1.0
    cubic = bg.LookupTable("cubic", [0, 1, 2, 3], [0, 1, 8, 27], method="akima")
    assert sp.diff(cubic(v), v, 3) != 0
    assert sp.diff(cubic(v), v, 4) == 0


def test_floats_of_tables_decide_nothing_exact() -> None:
    """Two tables that agree at a point are not equal there, nor is a value its number."""
    other = bg.LookupTable("other", [0, 1, 3], [0, 2, 3])
    assert not is_zero(drag(sp.Integer(1)) - other(sp.Integer(1)))
    assert not is_zero(drag(sp.Integer(1)) - 2)
    assert is_zero(drag(v) - drag(v))
    assert not is_zero(drag(v) - sp.diff(drag(v), v))


def test_tables_are_equal_by_what_they_hold() -> None:
    again = bg.LookupTable("drag", np.array([0, 1, 3]), np.array([0, 2, 3.0]))
    assert again == drag
    assert again(v) == drag(v)
    assert hash(again(v)) == hash(drag(v))
    for changed in (
        bg.LookupTable("drag", [0, 1, 3], [0, 2, 4]),
        bg.LookupTable("drag", [0, 1, 4], [0, 2, 3]),
        bg.LookupTable("drag", [0, 1, 3], [0, 2, 3], method="pchip"),
        bg.LookupTable("drag", [0, 1, 3], [0, 2, 3], outside="extend"),
        bg.LookupTable("grad", [0, 1, 3], [0, 2, 3]),
    ):
        assert changed != drag
        assert changed(v) != drag(v)
        assert drag(v) + changed(v) != 2 * drag(v)


def test_expressions_with_tables_can_be_pickled_and_rebuilt() -> None:
    law = torque(w, "u + 1") * sp.diff(drag(v), v)
    assert pickle.loads(pickle.dumps(law)) == law
    assert pickle.loads(pickle.dumps(drag)) == drag
    assert law.func(*law.args) == law


def test_numbers_are_there_when_asked_for() -> None:
    assert float(drag(2)) == 2.5
    assert float(drag(-1)) == 0.0
    assert float(drag("5")) == 3.0
    assert sp.N(bg.LookupTable("drag", [0, 1], [0, 1], outside="refuse")(2)) is sp.nan
    with pytest.raises(bg.ExpressionError, match="not a real number"):
        bg.expression("drag(2)", "law", [bg.LookupTable("drag", [0, 1], [0, 1], outside="refuse")])


def test_pandas_gives_points_without_being_needed() -> None:
    pandas = pytest.importorskip("pandas")
    series = pandas.Series([0.0, 2.0, 3.0], index=[0, 1, 3])
    assert bg.LookupTable("drag", series) == drag
    assert bg.LookupTable("drag", series.to_frame()) == drag
    frame = pandas.DataFrame([[0, 3], [0, 2], [0, 0]], index=[0, 1, 2], columns=[0, 1])
    assert bg.LookupTable("torque", frame) == torque
    frame.iloc[1, 1] = np.nan
    with pytest.raises(bg.TableError, match="table 'torque': row 2 of z, row 2: nan; fill the gap"):
        bg.LookupTable("torque", frame.astype(float))


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_files_have_two_columns_or_a_grid(mark: str, tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    for head in ("v [m/s],F [N]\n", ""):
        path.write_text((head + "0,0\n1, 2.0\n\n3,3e0\n").replace(",", mark), encoding="utf-8-sig")
        assert bg.LookupTable.read("drag", path) == drag
    path.write_text("w/u,0,1\n0,0,3\n1,0,2\n2,0,0\n".replace(",", mark))
    assert bg.LookupTable.read("torque", path) == torque
    assert (
        bg.LookupTable.read("torque", path, method="bilinear", outside="extend").outside == "extend"
    )
