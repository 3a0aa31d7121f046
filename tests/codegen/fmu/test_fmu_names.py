"""Names that XML has to escape, that collide with those a unit makes up, or that no file name has."""

import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen.fmu.variables import plain

pytestmark = pytest.mark.usefixtures("compiled_quickly")


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_awkward_names_come_through(version: str, tmp_path: Path) -> None:
    graph = bond_graph(
        [bg.Se("pull", "time"), bg.One("n"), bg.I("m", "m", flow="fixed_internal_step", unit='<&"'),
         bg.C("s", "1/k", effort="N")],
        "pull>n>m n>s",
    )  # fmt: skip
    graph.add_nodes_from([bg.R('rub <&"', effort="tau", flow="omega", law=bg.DryFriction("mu"))])
    graph.add_edge("n", 'rub <&"')
    equations = bg.derive(graph, outputs=['rub <&"'])
    path = codegen.write_fmu(
        tmp_path / "unit.fmu", equations, {"m": 2.0, "k": 3.0, "mu": 0.5}, version=version,
        initial={"fixed_internal_step": 1.0}, name='a "name" <of> & things',
    )  # fmt: skip
    assert validate_fmu(str(path)) == []
    root = ET.fromstring(zipfile.ZipFile(path).read("modelDescription.xml"))
    assert root.get("modelName") == 'a "name" <of> & things'
    names = [one.name for one in read_model_description(str(path)).modelVariables]
    assert len(names) == len(set(names))
    assert {"time", "time_", "fixed_internal_step", "fixed_internal_step_"} <= set(names)
    assert 'mode(rub <&")' in names
    found = simulate_fmu(
        str(path), stop_time=0.1, output=["fixed_internal_step"], fmi_type="CoSimulation"
    )
    assert found["fixed_internal_step"][0] == 1.0


@pytest.mark.parametrize(
    ("name", "kept"),
    [("a b", "a b"), ("a\nb", "a_b"), ("\x01", "_"), ("", "_"), ("τ<&\"'", "τ<&\"'")],
)
def test_names_lose_only_what_xml_loses(name: str, kept: str) -> None:
    assert plain(name) == kept
