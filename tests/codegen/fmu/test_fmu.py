"""What is in a unit: a valid description, sources that build, the same bytes every time."""

import logging
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import networkx as nx
import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from fmu_manipulation_toolbox import checker, operations
from oracles.units import belt, divider, duffing, figure_11

import bondgraph as bg
import codegen
from codegen.fmu import binaries as fmu_binaries
from codegen.fmu.switches import switching


@pytest.fixture
def _no_binaries(monkeypatch: pytest.MonkeyPatch) -> None:
    """Descriptions and sources need no compiler."""
    monkeypatch.setattr("codegen.fmu.export.binaries", lambda *_: {})


def _description(path: Path) -> ET.Element:
    return ET.fromstring(zipfile.ZipFile(path).read("modelDescription.xml"))


def test_flags_of_the_environment_are_the_compilers(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("CFLAGS", "-include nowhere.h")
    with pytest.raises(bg.SimulationError, match=r"nowhere\.h"):
        belt().written(tmp_path / "unit.fmu", "3.0")


@pytest.mark.usefixtures("_no_binaries")
@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("make", [duffing, divider, figure_11])
def test_description_meets_the_schema(make, version: str, tmp_path: Path) -> None:
    path = make().written(tmp_path / "unit.fmu", version)
    assert validate_fmu(str(path)) == []


@pytest.mark.usefixtures("_no_binaries")
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_another_tool_finds_nothing_wrong(
    version: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    path = duffing().written(tmp_path / "unit.fmu", version)
    with caplog.at_level(logging.ERROR, logger="fmu_manipulation_toolbox"):
        for check in (checker.OperationGenericCheck(), checker.OperationSemanticCheck()):
            operations.FMU(str(path)).apply_operation(check)
    assert caplog.records == []


def test_the_same_model_makes_the_same_bytes(tmp_path: Path) -> None:
    version = "2.0"
    one, other = (
        belt().written(tmp_path / name, version, name="belt").read_bytes()
        for name in ("a.fmu", "b.fmu")
    )
    assert one == other


@pytest.mark.usefixtures("_no_binaries")
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_another_start_makes_another_token(version: str, tmp_path: Path) -> None:
    token = "guid" if version == "2.0" else "instantiationToken"
    found = set()
    for speed in (0.1, 0.2, 0.1):
        path = belt().written(tmp_path / "unit.fmu", version, inputs={"v_b": speed})
        found.add(_description(path).get(token))
    assert len(found) == 2


@pytest.mark.usefixtures("_no_binaries")
def test_variables_say_what_they_are(tmp_path: Path) -> None:
    path = duffing().written(tmp_path / "unit.fmu", "3.0", inputs={"F": 1.5})
    listed = {one.name: one for one in read_model_description(str(path)).modelVariables}
    assert (listed["k"].causality, listed["k"].variability, float(listed["k"].start)) == (
        "parameter", "tunable", 4.0,
    )  # fmt: skip
    assert (listed["F"].causality, float(listed["F"].start)) == ("input", 1.5)
    assert (listed["v"].unit, float(listed["v"].start), listed["v"].initial) == (
        "m/s", -0.4, "exact",
    )  # fmt: skip
    assert listed["der(q_s)"].derivative is listed["q_s"]
    assert [one.name for one in listed.values() if one.causality == "output"] == ["f_rub"]
    assert listed["e_rub"].causality == "local"


@pytest.mark.usefixtures("_no_binaries")
def test_sources_are_listed_and_complete(tmp_path: Path) -> None:
    second = duffing().written(tmp_path / "a.fmu", "2.0")
    third = duffing().written(tmp_path / "b.fmu", "3.0")
    listed = {e.get("name") for e in _description(second).findall("CoSimulation/SourceFiles/File")}
    archive = zipfile.ZipFile(third)
    built = ET.fromstring(archive.read("sources/buildDescription.xml"))
    again = {e.get("name") for e in built.iter("SourceFile")}
    for path, names in ((second, listed), (third, again)):
        packed = {n.removeprefix("sources/") for n in zipfile.ZipFile(path).namelist()}
        assert {n for n in packed if n.endswith(".c")} == names
        assert "LICENSE" not in names


def test_switches_are_what_laws_compare() -> None:
    graph = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("force", "F"), bg.One("n"), bg.I("m", "m", flow="v"),
        bg.C("s", law="k*Max(q_s - gap, 0)"), bg.R("d", law="c*v*Abs(v)"),
    ])  # fmt: skip
    graph.add_edges_from([("force", "n"), ("n", "m"), ("n", "s"), ("n", "d")])
    program = codegen.lower(bg.derive(graph), None, ["m", "k", "c", "gap"])
    assert sorted(map(str, switching(program))) in (
        ["gap - q_s", "v"], ["-gap + q_s", "v"], ["f_d", "gap - q_s"], ["-gap + q_s", "f_d"],
    )  # fmt: skip


def test_what_cannot_be_written_is_refused(tmp_path: Path) -> None:
    case = belt()
    with pytest.raises(bg.SignalError, match=r"FMI version '1\.0'"):
        case.written(tmp_path / "a.fmu", "1.0")
    with pytest.raises(bg.SignalError, match="unknown input 'v_c'; the model's inputs are v_b"):
        case.written(tmp_path / "a.fmu", "2.0", inputs={"v_c": 1})
    with pytest.raises(bg.SignalError, match="platform 'amiga': there is x86_64-linux"):
        case.written(tmp_path / "a.fmu", "2.0", platforms=["amiga"])
    with pytest.raises(bg.SignalError, match="is not a state"):
        case.written(tmp_path / "a.fmu", "2.0", initial={"x": 1})


@pytest.mark.parametrize(("package", "platforms"), [("fmpy", None), ("ziglang", "all")])
def test_what_is_missing_is_told_with_the_command(
    package: str, platforms: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    find = fmu_binaries.importlib.util.find_spec
    monkeypatch.setattr(
        fmu_binaries.importlib.util, "find_spec", lambda n: None if n == package else find(n)
    )
    with pytest.raises(bg.MissingExtraError, match=r"pip install .bondgraph-toolkit\[export\]."):
        belt().written(tmp_path / "a.fmu", "2.0", platforms=platforms)


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("gcc 'x", r"CC is .*No closing quotation"),
        ("true", r"the C compiler true says that all went well and made no library"),
        ("/no/such/cc", r"/no/such/cc does not start"),
        ("false", r"linux: the C compiler failed: false"),
    ],
)
def test_a_compiler_that_cannot_be_used_is_told(
    command: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CC", command)
    (tmp_path / "a.fmu").write_bytes(b"old")
    with pytest.raises(bg.BondGraphError, match=message):
        belt().written(tmp_path / "a.fmu", "2.0")
    assert (tmp_path / "a.fmu").read_bytes() == b"old"
