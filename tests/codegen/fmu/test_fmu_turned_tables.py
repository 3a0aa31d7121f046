"""Tables that are turned round keep their values: one by itself would contradict the other."""

from typing import Any

import pytest
from oracles.routes.searched import cells

import codegen
from bondgraph.tables.looking import BACK
from codegen.fmu.tabled import arrays_of, scalars_of
from codegen.program.lower import lower


def test_python_refuses_other_values_of_one_by_name() -> None:
    kind = cells()
    module: dict[str, Any] = {}
    exec(codegen.to_python(kind.equations, kind.numbers), module)
    (name,) = module["TABLES"]
    assert name == f"rest{BACK}"
    with pytest.raises(ValueError, match="is turned round in this model: it keeps its values"):
        module["simulate"](
            [0.0, 1.0], kind.initial, {"i": 3.0}, step=0.1, tables={name: [0, 1, 2, 3]}
        )


def test_units_list_one_as_constant_and_c_marks_it() -> None:
    kind = cells()
    program = lower(kind.equations, {}, tuple(kind.numbers))
    array, axis = arrays_of(program.tables)
    assert (array.causality, axis.causality) == ("local", "local")
    assert list(scalars_of(program.tables)) == []
    assert "BG_TABLE_FIXED" in codegen.to_c(kind.equations, kind.numbers)["model.c"]
